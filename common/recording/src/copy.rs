//! A bag, whatever it is made of, written again as one recording.

use std::io::{Seek, Write};
use std::path::Path;

use crate::content::Content;
use crate::write::{RecordingWriter, definition};
use crate::{Kind, Recording, RecordingError, unpack};

/// Whether it is something that [`Recording::open`] may read: by its content, or a
/// folder.
#[must_use]
pub fn is_recording(path: impl AsRef<Path>) -> bool {
    let path = path.as_ref();
    is_bag(path) || Content::of(path).is_ok_and(|content| content == Content::Mcap)
}

/// Whether it is what ROS 2 calls a bag and no plain MCAP file: a folder, its
/// `metadata.yaml`, a file in SQLite, or one that is packed.
#[must_use]
pub fn is_bag(path: impl AsRef<Path>) -> bool {
    let path = path.as_ref();
    let content = || Content::of(path).unwrap_or(Content::Unknown);
    path.is_dir()
        || matches!(
            content(),
            Content::Sqlite | Content::Metadata | Content::Zstd
        )
}

/// Writes what a bag holds, all its parts by log time, every message unpacked;
/// returns the number of messages.
///
/// # Errors
/// The bag cannot be read or is damaged, or the recording cannot be written.
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
        let own = Kind::ALL.into_iter().find(|kind| kind.schema() == schema);
        let text = definitions.get(schema).map(String::as_str);
        let text = text.or(own.map(definition)).unwrap_or_default();
        // What does not unpack is kept as it is: whoever reads it gets the error.
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
