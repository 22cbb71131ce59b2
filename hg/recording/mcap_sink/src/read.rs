//! Reading a whole file, from its beginning to its end or to where a crash has cut it off.

use std::collections::BTreeMap;
use std::io::Read;

use mcap::parse_record;
use mcap::records::Record;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::McapError;

use crate::Failure;

/// Longest record and chunk that is believed: damaged lengths must not take all memory.
const LONGEST_BYTES: usize = 64 * 1024 * 1024;

/// What a file holds, in its order.
pub enum Item<'a> {
    Channel { topic: &'a str, schema: &'a [u8] },
    Message { topic: &'a str, time_ns: u64, data: &'a [u8] },
    Attachment { name: &'a str, data: &'a [u8] },
    /// Only a file that was completed has it.
    End,
}

/// Remembers schemas and topics, which messages name by number.
#[derive(Default)]
struct Directory {
    schemas: BTreeMap<u16, Vec<u8>>,
    topics: BTreeMap<u16, String>,
}

impl Directory {
    fn hand_out(&mut self, record: Record, take: &mut impl FnMut(Item)) {
        match record {
            Record::Schema { header, data } => {
                self.schemas.insert(header.id, data.into_owned());
            }
            // once more in the index
            Record::Channel(channel) if !self.topics.contains_key(&channel.id) => {
                let schema = self.schemas.get(&channel.schema_id).map_or(&[][..], |text| text);
                take(Item::Channel { topic: &channel.topic, schema });
                self.topics.insert(channel.id, channel.topic);
            }
            Record::Message { header, data } => {
                if let Some(topic) = self.topics.get(&header.channel_id) {
                    take(Item::Message { topic, time_ns: header.log_time, data: &data });
                }
            }
            Record::Attachment { header, data, .. } => {
                take(Item::Attachment { name: &header.name, data: &data });
            }
            Record::Footer(_) => take(Item::End),
            _ => {}
        }
    }
}

/// Hands out everything in `file`. A file that is cut off ends where it is.
pub fn read(mut file: impl Read, mut take: impl FnMut(Item)) -> Result<(), Failure> {
    let options = LinearReaderOptions::default()
        .with_skip_end_magic(true)
        .with_validate_chunk_crcs(true)
        .with_record_length_limit(LONGEST_BYTES);
    let mut reader = LinearReader::new_with_options(options);
    let mut directory = Directory::default();
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let count = file.read(reader.insert(wanted))?;
                reader.notify_read(count);
            }
            Ok(LinearReadEvent::Record { data, opcode }) => {
                directory.hand_out(parse_record(opcode, data)?, &mut take);
            }
            Err(McapError::UnexpectedEof) => return Ok(()),
            Err(failure) => return Err(failure.into()),
        }
    }
    Ok(())
}
