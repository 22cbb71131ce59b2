//! What the EEPROM of a slave holds: identity, mailboxes, sync managers and PDOs (ETG.2010).

use crate::dictionary::{Dictionary, INPUT_ASSIGNMENT, OUTPUT_ASSIGNMENT};

const SIZE: usize = 2048; // bytes
const COE: u16 = 0x0004; // mailbox protocol

pub struct Identity {
    pub vendor: u32,
    pub product: u32,
    pub revision: u32,
    pub serial: u32,
}

/// Sync managers of a slave: start, most bytes, control, and kind (1 to 4: mailbox to and from the
/// slave, outputs, inputs).
pub struct Area {
    pub start: u16,
    pub bytes: u16,
    pub control: u8,
    pub kind: u8,
}

pub const MAILBOX_BYTES: u16 = 128;

/// Areas of a slave with mailboxes, and of a plain one.
pub const WITH_MAILBOX: [Area; 4] = [
    Area { start: 0x1000, bytes: MAILBOX_BYTES, control: 0x26, kind: 1 },
    Area { start: 0x1080, bytes: MAILBOX_BYTES, control: 0x22, kind: 2 },
    Area { start: 0x1100, bytes: 64, control: 0x64, kind: 3 },
    Area { start: 0x1400, bytes: 64, control: 0x20, kind: 4 },
];
pub const WITHOUT_MAILBOX: [Area; 2] = [
    Area { start: 0x1100, bytes: 64, control: 0x44, kind: 3 },
    Area { start: 0x1400, bytes: 64, control: 0x00, kind: 4 },
];

pub fn areas(has_mailbox: bool) -> &'static [Area] {
    if has_mailbox {
        &WITH_MAILBOX
    } else {
        &WITHOUT_MAILBOX
    }
}

/// Control of a sync manager: its outputs restart the watchdog.
pub const WATCHDOG_TRIGGER: u8 = 0x40;

pub fn eeprom(
    id: &Identity,
    name: &str,
    has_mailbox: bool,
    has_watchdog: bool,
    objects: &Dictionary,
) -> Vec<u8> {
    let mut image = vec![0; 0x80];
    image[0] = 0x08; // process data interface: 8 bit
    image[14] = checksum(&image[..14]);
    for (i, value) in [id.vendor, id.product, id.revision, id.serial].into_iter().enumerate() {
        image[0x10 + 4 * i..0x14 + 4 * i].copy_from_slice(&value.to_le_bytes());
    }
    if has_mailbox {
        let [to, from, ..] = &WITH_MAILBOX;
        for (at, word) in [
            (0x30, to.start),
            (0x32, to.bytes),
            (0x34, from.start),
            (0x36, from.bytes),
            (0x38, COE),
        ] {
            image[at..at + 2].copy_from_slice(&word.to_le_bytes());
        }
    }
    image[0x7C..0x7E].copy_from_slice(&((SIZE / 128 - 1) as u16).to_le_bytes());
    image[0x7E] = 1;

    add_category(&mut image, 10, &strings(name));
    add_category(&mut image, 30, &general(has_mailbox));
    add_category(&mut image, 40, if has_mailbox { &[1, 2, 3, 0] } else { &[1, 2] });
    add_category(&mut image, 41, &sync_managers(has_mailbox, has_watchdog, objects));
    add_category(&mut image, 50, &pdos(INPUT_ASSIGNMENT, has_mailbox, objects));
    add_category(&mut image, 51, &pdos(OUTPUT_ASSIGNMENT, has_mailbox, objects));
    image.resize(SIZE, 0xFF); // the end of the categories, and nothing behind it
    image
}

// CRC-8 with polynomial x^8 + x^2 + x + 1
fn checksum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0xFF, |crc, byte| {
        (0..8).fold(crc ^ byte, |crc, _| crc << 1 ^ if crc & 0x80 != 0 { 0x07 } else { 0 })
    })
}

fn add_category(image: &mut Vec<u8>, category: u16, bytes: &[u8]) {
    if bytes.is_empty() {
        return;
    }
    image.extend(category.to_le_bytes());
    image.extend((bytes.len().div_ceil(2) as u16).to_le_bytes());
    image.extend(bytes);
    if bytes.len() % 2 == 1 {
        image.push(0);
    }
}

fn strings(name: &str) -> Vec<u8> {
    let mut bytes = vec![1, name.len() as u8];
    bytes.extend(name.as_bytes());
    bytes
}

fn general(has_mailbox: bool) -> [u8; 32] {
    let mut bytes = [0; 32];
    bytes[2] = 1; // order: the first string
    bytes[3] = 1; // name: the first string
    bytes[5] = if has_mailbox { 0x0D } else { 0 }; // CoE: SDO, PDO assignment, PDO configuration
    bytes[16] = 0x11; // two ports with MII
    bytes
}

fn sync_managers(has_mailbox: bool, has_watchdog: bool, objects: &Dictionary) -> Vec<u8> {
    let mut bytes = Vec::new();
    for area in areas(has_mailbox) {
        let length = match area.kind {
            3 => objects.process_bytes(OUTPUT_ASSIGNMENT) as u16,
            4 => objects.process_bytes(INPUT_ASSIGNMENT) as u16,
            _ => area.bytes,
        };
        bytes.extend(area.start.to_le_bytes());
        bytes.extend(length.to_le_bytes());
        let control = if has_watchdog { area.control } else { area.control & !WATCHDOG_TRIGGER };
        bytes.extend([control, 0, 1, area.kind]);
    }
    bytes
}

fn pdos(assignment: u16, has_mailbox: bool, objects: &Dictionary) -> Vec<u8> {
    let sync_manager = u8::from(assignment == INPUT_ASSIGNMENT) + if has_mailbox { 2 } else { 0 };
    let mut bytes = Vec::new();
    for pdo in objects.pdos(assignment) {
        let entries = objects.entries(pdo);
        bytes.extend(pdo.to_le_bytes());
        bytes.extend([entries.len() as u8, sync_manager, 0, 0, 0, 0]);
        for entry in entries {
            bytes.extend(entry.index.to_le_bytes());
            bytes.extend([entry.subindex, 0, 0, entry.bits, 0, 0]);
        }
    }
    bytes
}
