//! Copies a bag of any format to one recording.

use std::io::{Seek, Write};
use std::path::Path;

use crate::content::Content;
use crate::write::{RecordingWriter, definition_in};
use crate::{Recording, RecordingError, unpack};

/// True if [`Recording::open`] may be able to read it: a file with suitable content, or a folder.
pub fn is_recording(path: impl AsRef<Path>) -> bool {
    let path = path.as_ref();
    is_bag(path) || Content::of(path).is_ok_and(|content| content == Content::Mcap)
}

/// True if it is a bag of ROS 2 and not a plain MCAP file: a folder, its `metadata.yaml`, an SQLite
/// file, or a compressed file.
pub fn is_bag(path: impl AsRef<Path>) -> bool {
    let path = path.as_ref();
    let content = || Content::of(path).unwrap_or(Content::Unknown);
    path.is_dir()
        || matches!(
            content(),
            Content::Sqlite | Content::Metadata | Content::Zstd
        )
}

/// Writes the messages of all parts of a bag by log time, with every message decompressed; returns
/// the number of messages.
pub fn write_bag<W: Write + Seek>(
    path: impl AsRef<Path>,
    writer: &mut RecordingWriter<W>,
) -> Result<u64, RecordingError> {
    let recording = Recording::open(path)?;
    let definitions = recording.definitions();
    let mut messages = 0;
    for record in recording.raw_records() {
        let record = record?;
        let channel = record.channel;
        let schema = &*channel.schema;
        let text = definition_in(definitions.get(schema), schema);
        // A message that cannot be decompressed is copied unchanged: its reader gets the error.
        let body = unpack::message(&record.body).unwrap_or((&*record.body).into());
        writer.write_bytes(
            &channel.topic,
            schema,
            text,
            &channel.encoding,
            record.log_time_ns,
            &body,
        )?;
        messages += 1;
    }
    Ok(messages)
}
