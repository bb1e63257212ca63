//! Metadata and attachments of a recording.
//!
//! They are listed and can be extracted, but not interpreted.

use std::collections::BTreeMap;
use std::ops::Range;

use mcap::records::Record;
use serde::Serialize;

use crate::Damage;
use crate::parse::parse;

/// Size of an attachment's fields before its data, without the texts: two times, the lengths of two
/// texts, and the length of the data.
const FIXED_BYTES: usize = 8 + 8 + 4 + 4 + 8;

/// A file inside a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AttachedFile {
    pub name: String,
    /// Media type, such as `image/png`.
    pub media_type: String,
    /// Time at which it was added, in nanoseconds since 1970.
    pub log_time_ns: u64,
    pub(crate) file: usize,
    pub(crate) bytes: Range<usize>,
}

impl AttachedFile {
    pub fn len(&self) -> usize {
        self.bytes.len()
    }

    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }
}

/// Named key-value entries.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct MetadataRecord {
    /// Name; several records may have the same.
    pub name: String,
    pub entries: BTreeMap<String, String>,
}

#[derive(Debug, Default)]
pub(crate) struct Extras {
    pub(crate) attachments: Vec<AttachedFile>,
    pub(crate) metadata: Vec<MetadataRecord>,
}

impl Extras {
    /// Adds an attachment or a metadata record; `place` is the range from its opcode to the end of
    /// its body.
    pub(crate) fn add(
        &mut self,
        opcode: u8,
        body: &[u8],
        place: &Range<usize>,
    ) -> Result<(), Damage> {
        match parse(opcode, body, place.start as u64)? {
            Record::Attachment { header, data, .. } => {
                let from = place.end - body.len()
                    + FIXED_BYTES
                    + header.name.len()
                    + header.media_type.len();
                self.attachments.push(AttachedFile {
                    name: header.name,
                    media_type: header.media_type,
                    log_time_ns: header.log_time,
                    file: 0,
                    bytes: from..from + data.len(),
                });
            }
            Record::Metadata(record) => self.metadata.push(MetadataRecord {
                name: record.name,
                entries: record.metadata,
            }),
            _ => {}
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::sample;
    use crate::write::{Packing, RecordingWriter};

    #[test]
    fn files_and_entries_come_back() {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        let entries = [("map_id".to_owned(), "17".to_owned())].into();
        writer.write_metadata("backcast", &entries).unwrap();
        writer
            .attach("a.yaml", "text/yaml", 7, b"image: a.png")
            .unwrap();
        writer.attach("empty", "", 8, b"").unwrap();
        let recording = sample::opened(writer);
        assert_eq!(recording.damage(), None);
        assert_eq!(recording.metadata()[0].name, "backcast");
        assert_eq!(recording.metadata()[0].entries, entries);
        let [yaml, empty] = recording.attachments() else {
            panic!("{:?}", recording.attachments());
        };
        assert_eq!(
            (&*yaml.name, &*yaml.media_type, yaml.log_time_ns),
            ("a.yaml", "text/yaml", 7)
        );
        assert_eq!(recording.content_of(yaml), b"image: a.png");
        assert!(empty.is_empty() && recording.content_of(empty).is_empty());
    }
}
