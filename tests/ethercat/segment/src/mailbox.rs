//! Mails of a master and their answers: SDO transfers of CoE (ETG.1000.6), expedited and normal.

use crate::device::Device;
use crate::dictionary::Abort;
use crate::sii::MAILBOX_BYTES;

const HEADER: usize = 6;
const COE: u8 = 3; // kinds of mail
const FAILED: u8 = 0;
const UNSUPPORTED_PROTOCOL: u16 = 2;
const INVALID_HEADER: u16 = 6;
const SDO_REQUEST: u8 = 2; // services of CoE
const SDO_RESPONSE: u8 = 3;
const MOST_NORMAL: usize = MAILBOX_BYTES as usize - HEADER - 2 - 8;

/// The answer to one mail.
pub fn answer(mail: &[u8], device: &mut dyn Device, is_pre_op: bool) -> Vec<u8> {
    let length = usize::from(u16::from_le_bytes([mail[0], mail[1]]));
    let kind = mail[5] & 0x0F;
    let counter = mail[5] & 0x70;
    if HEADER + length > mail.len() {
        return failure(INVALID_HEADER, counter);
    }
    let body = &mail[HEADER..HEADER + length];
    if kind != COE || body.len() < 10 || body[1] >> 4 != SDO_REQUEST {
        return failure(UNSUPPORTED_PROTOCOL, counter);
    }
    let sdo = &body[2..];
    let (index, subindex) = (u16::from_le_bytes([sdo[1], sdo[2]]), sdo[3]);
    let response = match sdo[0] >> 5 {
        2 => upload(index, subindex, device),
        1 => download(sdo, index, subindex, device, is_pre_op),
        _ => Err(Abort::UnknownCommand),
    };
    let response = response.unwrap_or_else(|abort| {
        let mut bytes = command(0x80, index, subindex);
        bytes.extend((abort as u32).to_le_bytes());
        bytes
    });
    // an abort is sent as a request, everything else as a response
    let service = if response[0] == 0x80 { SDO_REQUEST } else { SDO_RESPONSE };
    let mut coe = vec![0, service << 4];
    coe.extend(response);
    envelope(&coe, COE, counter)
}

fn upload(index: u16, subindex: u8, device: &mut dyn Device) -> Result<Vec<u8>, Abort> {
    let bytes = device.objects().upload(index, subindex)?;
    if bytes.len() <= 4 {
        let mut response = command(0x43 | (4 - bytes.len() as u8) << 2, index, subindex);
        response.extend(bytes);
        response.resize(8, 0);
        return Ok(response);
    }
    let sent = &bytes[..bytes.len().min(MOST_NORMAL)];
    let mut response = command(0x41, index, subindex);
    response.extend((sent.len() as u32).to_le_bytes());
    response.extend(sent);
    Ok(response)
}

fn download(
    sdo: &[u8],
    index: u16,
    subindex: u8,
    device: &mut dyn Device,
    is_pre_op: bool,
) -> Result<Vec<u8>, Abort> {
    let is_expedited = sdo[0] & 2 != 0;
    let has_size = sdo[0] & 1 != 0;
    let bytes = if is_expedited {
        let unused = if has_size { usize::from(sdo[0] >> 2 & 3) } else { 0 };
        &sdo[4..8 - unused]
    } else {
        let size = u32::from_le_bytes([sdo[4], sdo[5], sdo[6], sdo[7]]) as usize;
        // what does not fit into one mail would come in segments
        sdo.get(8..8usize.saturating_add(size)).ok_or(Abort::WrongLength)?
    };
    device.download(index, subindex, bytes, is_pre_op)?;
    let mut response = command(0x60, index, subindex);
    response.resize(8, 0);
    Ok(response)
}

fn command(specifier: u8, index: u16, subindex: u8) -> Vec<u8> {
    let [low, high] = index.to_le_bytes();
    vec![specifier, low, high, subindex]
}

fn failure(error: u16, counter: u8) -> Vec<u8> {
    let mut body = vec![1, 0];
    body.extend(error.to_le_bytes());
    envelope(&body, FAILED, counter)
}

fn envelope(body: &[u8], kind: u8, counter: u8) -> Vec<u8> {
    let mut mail = (body.len() as u16).to_le_bytes().to_vec();
    mail.extend([0, 0, 0, kind | counter]);
    mail.extend(body);
    mail
}
