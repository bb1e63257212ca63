//! Head of each file: metadata about the recorder, and attached files.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{Seek, Write};
use std::path::Path;

use recording::RecordingError;
use recording::write::{Encoded, RecordingWriter};
use ros_graph::export::Entry;
use transport::wall_ns;

use crate::{Config, RecorderError};

/// Head of a file, and the latched content that each file has to start with.
#[derive(Debug, Default)]
pub(crate) struct Preamble {
    metadata: BTreeMap<String, String>,
    files: Vec<File>,
    said: BTreeMap<&'static str, BTreeMap<String, String>>,
    latched: BTreeMap<Cow<'static, str>, Encoded>,
}

#[derive(Debug)]
struct File {
    name: String,
    media_type: &'static str,
    content: Vec<u8>,
    /// Time of reading, nanoseconds since 1970.
    read_ns: i64,
}

impl Preamble {
    pub(crate) fn new(config: &Config, graph: &str) -> Result<Self, RecorderError> {
        let entry = |key: &str, value: String| (key.to_owned(), value);
        let arguments: Vec<String> = std::env::args().skip(1).collect();
        Ok(Preamble {
            metadata: BTreeMap::from([
                entry("version", env!("CARGO_PKG_VERSION").to_owned()),
                entry("git_commit", env!("BACKCAST_COMMIT").to_owned()),
                entry("graph", graph.to_owned()),
                entry("arguments", arguments.join(" ")),
            ]),
            files: config
                .attach
                .iter()
                .map(|path| read(path))
                .collect::<Result<_, _>>()?,
            ..Preamble::default()
        })
    }

    /// Remembers entries that later files need at their head.
    pub(super) fn note(&mut self, entry: &Entry) {
        match entry {
            Entry::Message(message) if message.latched => {
                self.latched.insert(message.topic.clone(), message.clone());
            }
            Entry::Message(_) => {}
            Entry::Metadata(name, entries) => {
                self.said.insert(name, entries.clone());
            }
        }
    }

    /// Writes the head of a file whose messages begin at `from_ns`.
    pub(super) fn write<W: Write + Seek>(
        &self,
        writer: &mut RecordingWriter<W>,
        from_ns: Option<i64>,
    ) -> Result<(), RecordingError> {
        writer.write_metadata("backcast", &self.metadata)?;
        for (name, entries) in &self.said {
            writer.write_metadata(name, entries)?;
        }
        for file in &self.files {
            writer.attach(&file.name, file.media_type, file.read_ns, &file.content)?;
        }
        for message in self.latched.values() {
            let log_time_ns = from_ns.unwrap_or(message.log_time_ns);
            writer.write_encoded(&Encoded {
                log_time_ns,
                ..message.clone()
            })?;
        }
        Ok(())
    }
}

fn read(path: &Path) -> Result<File, RecorderError> {
    let content = std::fs::read(path).map_err(RecorderError::file(format!(
        "cannot read {}, which is to be put into the recording",
        path.display()
    )))?;
    let suffix = path.extension().unwrap_or_default().to_string_lossy();
    let media_type = match &*suffix {
        "yaml" | "yml" => "application/yaml",
        "png" => "image/png",
        "pgm" => "image/x-portable-graymap",
        "bmp" => "image/bmp",
        "json" => "application/json",
        _ => "application/octet-stream",
    };
    let name = path.file_name().unwrap_or(path.as_os_str());
    Ok(File {
        name: name.to_string_lossy().into_owned(),
        media_type,
        content,
        read_ns: wall_ns(),
    })
}
