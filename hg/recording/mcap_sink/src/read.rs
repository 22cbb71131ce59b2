//! Reading a whole file, from its beginning to its end or to where a crash has cut it off. What is
//! damaged is left out and named: the CRCs show whether chunks and attachments are what was
//! written, and behind a record whose head is wrong the next one is searched for.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::os::fd::AsRawFd;
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;

use mcap::parse_record;
use mcap::records::{op, MessageIndex, Record};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, MAGIC};

use crate::Failure;

/// Longest record and chunk that is believed: damaged lengths must not take all memory.
const LONGEST_BYTES: u64 = 64 * 1024 * 1024;
/// Opcode and length of a record.
const HEAD_BYTES: u64 = 9;
/// Records that must follow each other for the first to be believed.
const CHAIN: usize = 3;
const WINDOW_BYTES: usize = 64 * 1024;
/// O_NONBLOCK, SEEK_DATA and ENXIO of Linux.
const NONBLOCK: i32 = 0o4000;
const SEEK_DATA: i32 = 3;
const ENXIO: i32 = 6;

extern "C" {
    fn lseek(file: i32, offset: i64, whence: i32) -> i64;
}

/// What a file holds, in its order.
pub enum Item<'a> {
    /// The type of the messages of a topic, before the topic itself.
    Type {
        topic: &'a str,
        name: &'a str,
    },
    Channel {
        topic: &'a str,
        schema: &'a [u8],
    },
    Message {
        topic: &'a str,
        time_ns: u64,
        data: &'a [u8],
    },
    Attachment {
        name: &'a str,
        data: &'a [u8],
    },
    /// Keys and values, each with a zero behind it.
    Metadata {
        name: &'a str,
        pairs: &'a [u8],
    },
    /// A part that cannot be read.
    Damage {
        part: &'a str,
    },
    /// A message of the part that was named last.
    Lost {
        topic: &'a str,
        time_ns: u64,
    },
    /// Only a file that was completed has it.
    End,
}

/// Records by their places in a file.
struct Records {
    file: BufReader<File>,
    size: u64,
    position: u64,
}

impl Records {
    fn open(path: &Path) -> io::Result<Self> {
        // a named pipe would be waited for; of regular files it means nothing
        let file = OpenOptions::new().read(true).custom_flags(NONBLOCK).open(path)?;
        if !file.metadata()?.is_file() {
            return Err(io::Error::other("it is no regular file"));
        }
        let size = file.metadata()?.len();
        Ok(Self { file: BufReader::with_capacity(WINDOW_BYTES, file), size, position: 0 })
    }

    fn read(&mut self, at: u64, count: usize) -> io::Result<Vec<u8>> {
        match i64::try_from(at as i128 - self.position as i128) {
            Ok(offset) => self.file.seek_relative(offset)?,
            Err(_) => drop(self.file.seek(SeekFrom::Start(at))?),
        }
        let mut data = vec![0; count];
        self.position = at;
        self.file.read_exact(&mut data)?;
        self.position += count as u64;
        Ok(data)
    }

    /// The place behind a record that may begin at `at`; `head` are the bytes there.
    fn end_of(&self, at: u64, head: &[u8]) -> Option<u64> {
        let end = at + HEAD_BYTES + length_of(head)?;
        (end <= self.size).then_some(end)
    }

    /// The place behind the record at `at`, if there may be one.
    fn end(&mut self, at: u64) -> io::Result<Option<u64>> {
        if at + HEAD_BYTES > self.size {
            return Ok(None);
        }
        let head = self.read(at, HEAD_BYTES as usize)?;
        Ok(self.end_of(at, &head))
    }

    fn is_end_of_file(&mut self, at: u64) -> io::Result<bool> {
        let is_magic = |data: Vec<u8>| data == MAGIC;
        Ok(at == self.size
            || at + MAGIC.len() as u64 == self.size && self.read(at, MAGIC.len()).map(is_magic)?)
    }

    /// Whether `count` records, or all up to the end, follow each other from `at` on.
    fn is_chain(&mut self, mut at: u64, count: usize) -> io::Result<bool> {
        for _ in 0..count {
            match self.end(at)? {
                Some(end) => at = end,
                None => return self.is_end_of_file(at),
            }
        }
        Ok(true)
    }

    /// Whether what is at `at` was a record before the file was cut off there.
    fn is_cut_off(&mut self, at: u64) -> io::Result<bool> {
        if at + HEAD_BYTES > self.size {
            return Ok(true);
        }
        let head = self.read(at, HEAD_BYTES as usize)?;
        let length = length_of(&head);
        Ok(length.is_some_and(|length| at + HEAD_BYTES + length > self.size))
    }

    /// The first place from `at` on that is not in a hole of the file.
    fn data_from(&mut self, at: u64) -> io::Result<u64> {
        let found = unsafe { lseek(self.file.get_ref().as_raw_fd(), at as i64, SEEK_DATA) };
        let next = match u64::try_from(found) {
            Ok(place) => place,
            Err(_) if io::Error::last_os_error().raw_os_error() == Some(ENXIO) => self.size,
            Err(_) => at,
        };
        self.position = self.file.seek(SeekFrom::Start(next))?;
        Ok(next)
    }

    /// The first place from `at` on where records begin.
    fn find(&mut self, mut at: u64) -> io::Result<Option<u64>> {
        while at + HEAD_BYTES <= self.size {
            let count = (self.size - at).min(WINDOW_BYTES as u64) as usize;
            let window = self.read(at, count)?;
            if window.iter().all(|byte| *byte == 0) {
                at = self.data_from(at + count as u64)?;
                continue;
            }
            let places = count - HEAD_BYTES as usize + 1;
            for i in 0..places {
                let place = at + i as u64;
                if self.end_of(place, &window[i..]).is_some() && self.is_chain(place, CHAIN)? {
                    return Ok(Some(place));
                }
            }
            at += places as u64;
        }
        Ok(None)
    }
}

/// The length behind the head of a record. A damaged one may be any number.
fn length_of(head: &[u8]) -> Option<u64> {
    let length = u64::from_le_bytes(head[1..HEAD_BYTES as usize].try_into().ok()?);
    let is_one = (op::HEADER..=op::DATA_END).contains(&head[0]) && length <= LONGEST_BYTES;
    is_one.then_some(length)
}

/// The record in `body`, if it fills it and holds what was written as far as that can be checked.
fn sound(opcode: u8, body: &[u8]) -> Option<Record<'_>> {
    if opcode == op::ATTACHMENT {
        attachment_name(body)?;
    }
    let record = parse_record(opcode, body).ok()?;
    let length = match &record {
        Record::Footer(_) => 20,
        Record::SummaryOffset(_) => 17,
        Record::DataEnd(_) => 4,
        Record::MessageIndex(index) => 6 + 16 * index.records.len(),
        Record::Schema { header, data } => {
            14 + header.name.len() + header.encoding.len() + data.len()
        }
        Record::Chunk { header, data } => 40 + header.compression.len() + data.len(),
        // any bytes may be a message, without a CRC
        _ => body.len(),
    };
    (length == body.len()).then_some(record)
}

/// Of an attachment whose lengths fit; the parser relies on that.
fn attachment_name(body: &[u8]) -> Option<String> {
    let text = |at: usize| {
        let length = u32::from_le_bytes(body.get(at..at + 4)?.try_into().ok()?) as usize;
        body.get(at + 4..at + 4 + length)
    };
    let name = text(16)?;
    let media_type = text(20 + name.len())?;
    let at = 24 + name.len() + media_type.len();
    let length = u64::from_le_bytes(body.get(at..at + 8)?.try_into().ok()?);
    let is_full = length.checked_add(at as u64 + 12)? == body.len() as u64;
    is_full.then(|| String::from_utf8_lossy(name).into_owned())
}

struct Reader<'a, Take: FnMut(Item)> {
    path: &'a Path,
    take: Take,
    /// Schemas and topics, which messages name by number.
    schemas: BTreeMap<u16, (String, Vec<u8>)>,
    topics: BTreeMap<u16, String>,
    /// Messages of the last chunk by topic, until the index of that is seen.
    unindexed: BTreeMap<u16, usize>,
    /// Something was damaged since the last chunk: that may have been a chunk.
    may_lack_chunk: bool,
    /// Messages are in chunks, as this program writes them. Other tools may write none: then what
    /// looks like a message is one.
    is_chunked: Option<bool>,
    has_ended: bool,
    has_read_index: bool,
}

impl<Take: FnMut(Item)> Reader<'_, Take> {
    fn hand_out(&mut self, record: Record) {
        match record {
            Record::Schema { header, data } => {
                self.schemas.entry(header.id).or_insert_with(|| (header.name, data.into_owned()));
            }
            // once more in the index
            Record::Channel(channel) if !self.topics.contains_key(&channel.id) => {
                let (name, schema) = self.schemas.get(&channel.schema_id).map_or(
                    ("", &[][..]), |(name, text)| (name.as_str(), &text[..]));
                (self.take)(Item::Type { topic: &channel.topic, name });
                (self.take)(Item::Channel { topic: &channel.topic, schema });
                self.topics.insert(channel.id, channel.topic);
            }
            Record::Message { header, data } => {
                *self.unindexed.entry(header.channel_id).or_default() += 1;
                if let Some(topic) = self.topics.get(&header.channel_id) {
                    (self.take)(Item::Message { topic, time_ns: header.log_time, data: &data });
                }
            }
            Record::Attachment { header, data, .. } => {
                (self.take)(Item::Attachment { name: &header.name, data: &data });
            }
            Record::Metadata(metadata) => {
                let texts = metadata.metadata.iter().flat_map(|(key, value)| [key, value]);
                let pairs: Vec<u8> = texts.flat_map(|text| [text.as_bytes(), b"\0"].concat()).collect();
                (self.take)(Item::Metadata { name: &metadata.name, pairs: &pairs });
            }
            Record::MessageIndex(index) => self.report_lost(&index),
            Record::DataEnd(_) | Record::Footer(_) => self.has_ended = true,
            _ => {}
        }
    }

    /// Whether all of a chunk is what was written; then it is handed out.
    fn hand_out_chunk(&mut self, mut rest: &[u8]) -> bool {
        let options = LinearReaderOptions::default()
            .with_skip_start_magic(true)
            .with_skip_end_magic(true)
            .with_prevalidate_chunk_crcs(true)
            .with_record_length_limit(LONGEST_BYTES as usize);
        let mut reader = LinearReader::new_with_options(options);
        self.unindexed.clear();
        while let Some(event) = reader.next_event() {
            match event {
                Ok(LinearReadEvent::ReadRequest(wanted)) => {
                    let (now, later) = rest.split_at(wanted.min(rest.len()));
                    reader.insert(now.len()).copy_from_slice(now);
                    reader.notify_read(now.len());
                    rest = later;
                }
                Ok(LinearReadEvent::Record { data, opcode }) => match parse_record(opcode, data) {
                    Ok(record) => self.hand_out(record),
                    Err(_) => return false,
                },
                Err(_) => return false,
            }
        }
        self.may_lack_chunk = false;
        true
    }

    /// Messages of a chunk that could not be read.
    fn report_lost(&mut self, index: &MessageIndex) {
        let is_known = self.unindexed.remove(&index.channel_id) == Some(index.records.len());
        let topic = self.topics.get(&index.channel_id);
        if let (false, true, Some(topic)) = (is_known, self.may_lack_chunk, topic) {
            for entry in &index.records {
                (self.take)(Item::Lost { topic, time_ns: entry.log_time });
            }
        }
    }

    fn report_damage(&mut self, opcode: u8, body: &[u8], at: u64, end: u64) -> io::Result<()> {
        let part = match (opcode, attachment_name(body)) {
            _ if self.has_ended => format!("index at byte {at}"),
            (op::MESSAGE_INDEX | op::DATA_END, _) => format!("index at byte {at}"),
            (op::HEADER | op::METADATA, _) => format!("metadata at byte {at}"),
            (op::CHUNK, _) => format!("chunk at byte {at}"),
            (op::ATTACHMENT, Some(name)) => format!("attachment {name}"),
            _ => format!("bytes {at} to {end}"),
        };
        (self.take)(Item::Damage { part: &part });
        self.may_lack_chunk = true;
        self.is_chunked.get_or_insert(true);
        if opcode == op::CHUNK {
            self.unindexed.clear();
        }
        if self.topics.is_empty() && !self.has_read_index {
            self.has_read_index = true;
            self.learn_from_index()?;
        }
        Ok(())
    }

    /// The first chunk describes the topics; the index at the end of the file repeats that.
    fn learn_from_index(&mut self) -> io::Result<()> {
        let mut records = Records::open(self.path)?;
        let mut at = MAGIC.len() as u64;
        loop {
            let has_record = records.is_chain(at, 1)? && at + HEAD_BYTES <= records.size;
            let next = if has_record { Some(at) } else { records.find(at + 1)? };
            let Some(start) = next else { break };
            at = records.end(start)?.unwrap_or(records.size);
            let opcode = records.read(start, 1)?[0];
            if opcode == op::SCHEMA || opcode == op::CHANNEL {
                let record = records.read(start, (at - start) as usize)?;
                if let Some(record) = sound(opcode, &record[HEAD_BYTES as usize..]) {
                    self.hand_out(record);
                }
            }
        }
        Ok(())
    }
    /// Hands out the record at `at`, or names what is damaged there. The place of the next record;
    /// None: no more follow.
    fn take_record(&mut self, records: &mut Records, at: u64) -> io::Result<Option<u64>> {
        let Some(end) = records.end(at)? else { return self.pass_damage(records, at) };
        let record = records.read(at, (end - at) as usize)?;
        let (opcode, body) = (record[0], &record[HEAD_BYTES as usize..]);
        let parsed = sound(opcode, body);
        let has_next = records.is_chain(end, 1)?;
        // the others have no CRC: where no record follows, the length may be wrong
        let next = if has_next { Some(end) } else { records.find(at + 1)? };
        let is_whole = match parsed {
            Some(Record::Chunk { header, .. }) => {
                if header.compression == "lz4" {
                    return Err(io::Error::other("its compression must be zstd or none, got lz4"));
                }
                self.is_chunked = Some(true);
                self.hand_out_chunk(&record)
            }
            // of a damaged chunk
            Some(Record::Message { .. }) if *self.is_chunked.get_or_insert(false) => false,
            Some(record)
                if matches!(record, Record::Attachment { .. }) || next.is_none() || has_next =>
            {
                self.hand_out(record);
                true
            }
            _ => false,
        };
        if is_whole {
            return Ok(Some(end));
        }
        self.report_damage(opcode, body, at, next.unwrap_or(records.size))?;
        Ok(next)
    }

    /// The same where there is no head of a record.
    fn pass_damage(&mut self, records: &mut Records, at: u64) -> io::Result<Option<u64>> {
        if records.is_end_of_file(at)? {
            return Ok(None);
        }
        let next = records.find(at + 1)?;
        if next.is_some() || !records.is_cut_off(at)? {
            self.report_damage(0, &[], at, next.unwrap_or(records.size))?;
        }
        Ok(next)
    }

    /// The place of the first record, behind the magic bytes.
    fn first_record(&mut self, records: &mut Records) -> Result<u64, Failure> {
        let at = MAGIC.len() as u64;
        let magic = if records.size >= at { records.read(0, MAGIC.len())? } else { Vec::new() };
        if magic == MAGIC {
            return Ok(at);
        }
        // zeros: it was cut off to nothing while it was written
        let is_hole = !magic.is_empty() && magic.iter().all(|byte| *byte == 0);
        let begins = if is_hole { records.find(at)? } else { Some(at) };
        let Some(begin) = begins else { return Err(McapError::BadMagic.into()) };
        if !(records.size > begin && records.is_chain(begin, CHAIN)?) {
            return Err(McapError::BadMagic.into());
        }
        self.report_damage(0, &[], 0, begin)?;
        Ok(begin)
    }
}

/// Hands out everything in a file that is as it was written. A file that is cut off ends there.
pub fn read(path: &Path, take: impl FnMut(Item)) -> Result<(), Failure> {
    let mut records = Records::open(path)?;
    let mut reader = Reader {
        path,
        take,
        schemas: BTreeMap::new(),
        topics: BTreeMap::new(),
        unindexed: BTreeMap::new(),
        may_lack_chunk: false,
        is_chunked: None,
        has_ended: false,
        has_read_index: false,
    };
    let mut at = reader.first_record(&mut records)?;
    while let Some(next) = reader.take_record(&mut records, at)? {
        at = next;
    }
    if reader.has_ended || records.size > at && records.is_end_of_file(at)? {
        (reader.take)(Item::End);
    }
    Ok(())
}
