//! Writes ROS 2 recordings, with checksums of chunks, data and summary, schemas and quality of
//! service, so that other tools can read them too.
//!
//! Messages are written in the order in which they are passed; the caller decides when to flush,
//! split or stop.

mod encoded;
mod qos;

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::io::{BufWriter, Cursor, Seek, Write};
use std::path::Path;

use mcap::records::{MessageHeader, Metadata};
use mcap::{Attachment, McapError, WriteOptions};

pub use encoded::Encoded;

use crate::parse::reason;
use crate::{Kind, Message, RecordingError};

/// Compression of chunks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Packing {
    /// No chunks: messages are written to the file one by one.
    Loose,
    Plain,
    Zstd,
    Lz4,
}

pub struct RecordingWriter<W: Write + Seek> {
    writer: mcap::Writer<W>,
    /// Channel number and schema by topic.
    channels: HashMap<String, (u16, String)>,
    sequence: u32,
}

struct Definition<'a> {
    topic: &'a str,
    schema: &'a str,
    text: &'a str,
    encoding: &'a str,
    latched: bool,
}

impl RecordingWriter<BufWriter<File>> {
    pub fn create(path: impl AsRef<Path>, packing: Packing) -> Result<Self, RecordingError> {
        let path = path.as_ref();
        let file =
            File::create(path).map_err(|error| refused(format!("{}: {error}", path.display())))?;
        RecordingWriter::new(BufWriter::new(file), packing)
    }
}

impl RecordingWriter<Cursor<Vec<u8>>> {
    pub fn in_memory(packing: Packing) -> Result<Self, RecordingError> {
        RecordingWriter::new(Cursor::new(Vec::new()), packing)
    }
}

impl<W: Write + Seek> RecordingWriter<W> {
    pub fn new(sink: W, packing: Packing) -> Result<Self, RecordingError> {
        let compression = match packing {
            Packing::Loose | Packing::Plain => None,
            Packing::Zstd => Some(mcap::Compression::Zstd),
            Packing::Lz4 => Some(mcap::Compression::Lz4),
        };
        let writer = WriteOptions::new()
            .profile("ros2")
            .use_chunks(packing != Packing::Loose)
            .compression(compression)
            // Chunks are small: extra compression threads would only wait.
            .compression_threads(0)
            .create(sink)
            .map_err(failed)?;
        Ok(RecordingWriter {
            writer,
            channels: HashMap::new(),
            sequence: 0,
        })
    }

    /// Writes a message; all messages of a topic must have the same kind.
    pub fn write(
        &mut self,
        topic: &str,
        log_time_ns: i64,
        message: &Message,
    ) -> Result<(), RecordingError> {
        let body = message
            .encode()
            .map_err(|error| refused(error.to_string()))?;
        let kind = message.kind();
        let (schema, text) = (kind.schema(), kind.definition());
        self.write_bytes(topic, schema, text, "cdr", log_time_ns, &body)
    }

    pub fn write_encoded(&mut self, message: &Encoded) -> Result<(), RecordingError> {
        let definition = Definition {
            topic: &message.topic,
            schema: message.schema,
            text: message.definition,
            encoding: "cdr",
            latched: message.latched,
        };
        self.write_body(&definition, message.log_time_ns, &message.body)
    }

    /// Writes the encoded bytes of a message of any type; the first message of a topic determines
    /// its encoding. The topics of maps and of static transforms are latched.
    pub fn write_bytes(
        &mut self,
        topic: &str,
        schema: &str,
        definition: &str,
        encoding: &str,
        log_time_ns: i64,
        body: &[u8],
    ) -> Result<(), RecordingError> {
        let definition = Definition {
            topic,
            schema,
            text: definition,
            encoding,
            latched: matches!(
                Kind::of(schema, topic),
                Some(Kind::Map | Kind::StaticTransforms)
            ),
        };
        self.write_body(&definition, log_time_ns, body)
    }

    pub fn write_metadata(
        &mut self,
        name: &str,
        entries: &BTreeMap<String, String>,
    ) -> Result<(), RecordingError> {
        let record = Metadata {
            name: name.to_owned(),
            metadata: entries.clone(),
        };
        self.writer.write_metadata(&record).map_err(failed)
    }

    pub fn attach(
        &mut self,
        name: &str,
        media_type: &str,
        log_time_ns: i64,
        data: &[u8],
    ) -> Result<(), RecordingError> {
        let log_time = checked_time(log_time_ns)?;
        let attachment = Attachment {
            log_time,
            create_time: log_time,
            name: name.to_owned(),
            media_type: media_type.to_owned(),
            data: Cow::Borrowed(data),
        };
        self.writer.attach(&attachment).map_err(failed)
    }

    /// Ends the chunk: everything written so far survives a later failure.
    pub fn flush(&mut self) -> Result<(), RecordingError> {
        self.writer.flush().map_err(failed)
    }

    pub fn finish(mut self) -> Result<W, RecordingError> {
        self.writer.finish().map_err(failed)?;
        Ok(self.writer.into_inner())
    }

    fn write_body(
        &mut self,
        definition: &Definition,
        log_time_ns: i64,
        body: &[u8],
    ) -> Result<(), RecordingError> {
        let log_time = checked_time(log_time_ns)?;
        let (topic, schema) = (definition.topic, definition.schema);
        let channel_id = match self.channels.get(topic) {
            Some((id, known)) if known == schema => *id,
            Some((_, known)) => {
                return Err(refused(format!("{topic} has {known}, not {schema}")));
            }
            None => self.add_channel(definition)?,
        };
        self.sequence = self.sequence.wrapping_add(1);
        let header = MessageHeader {
            channel_id,
            sequence: self.sequence,
            log_time,
            publish_time: log_time,
        };
        self.writer
            .write_to_known_channel(&header, body)
            .map_err(failed)
    }

    fn add_channel(&mut self, definition: &Definition) -> Result<u16, RecordingError> {
        let (topic, schema) = (definition.topic, definition.schema);
        let text = definition.text.as_bytes();
        let schema_id = self.writer.add_schema(schema, "ros2msg", text);
        let schema_id = schema_id.map_err(failed)?;
        let metadata = [(qos::KEY.to_owned(), qos::offered(definition.latched))].into();
        let encoding = definition.encoding;
        let id = self
            .writer
            .add_channel(schema_id, topic, encoding, &metadata)
            .map_err(failed)?;
        self.channels
            .insert(topic.to_owned(), (id, schema.to_owned()));
        Ok(id)
    }
}

fn checked_time(log_time_ns: i64) -> Result<u64, RecordingError> {
    u64::try_from(log_time_ns)
        .map_err(|_| refused(format!("log time {log_time_ns} ns is before 1970")))
}

#[allow(clippy::needless_pass_by_value, reason = "it is given to map_err")]
fn failed(error: McapError) -> RecordingError {
    refused(reason(&error))
}

fn refused(reason: String) -> RecordingError {
    RecordingError::Write { reason }
}

/// Returns the text of a schema: that of a file, or ours for a known kind; else nothing.
pub(crate) fn definition_in<'a>(of_file: Option<&'a String>, schema: &str) -> &'a str {
    let own = Kind::ALL.into_iter().find(|kind| kind.schema() == schema);
    let text = of_file.map(String::as_str);
    text.or(own.map(Kind::definition)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn a_topic_keeps_its_kind_and_times_start_in_1970() {
        let mut writer = RecordingWriter::in_memory(Packing::Plain).unwrap();
        let records = sample::records();
        let (map, pose) = (&records[0].message, &records[4].message);
        writer.write("/map", 0, map).unwrap();
        let other = writer.write("/map", 0, pose).unwrap_err().to_string();
        assert!(
            other.contains("/map has nav_msgs/msg/OccupancyGrid, not geometry_msgs/"),
            "{other}"
        );
        let early = writer.write("/map", -1, map).unwrap_err().to_string();
        assert!(early.contains("log time -1 ns is before 1970"), "{early}");
        let Err(nowhere) = RecordingWriter::create("no/such/r.mcap", Packing::Plain) else {
            panic!("there is no such folder");
        };
        assert!(nowhere.to_string().contains("no/such/r.mcap"), "{nowhere}");
    }
}
