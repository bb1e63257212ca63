//! Reads the records of a chunk, with decompression and checksum by the library.

use mcap::McapError;
use mcap::records::{ChunkHeader, Record, op};
use mcap::sans_io::LinearReader;

use crate::feed::{each_record, feed, part_options};
use crate::parse::{parse, reason};
use crate::{Damage, MAX_CHUNK_BYTES};

/// Size of a chunk's fields before its packed records, without the name of the compression.
const HEADER_BYTES: usize = 40;

/// A chunk whose claimed sizes are within the limits.
#[derive(Debug)]
pub(crate) struct Chunk<'a> {
    at: u64,
    header: ChunkHeader,
    /// The record without its opcode, its length, and any bytes after the packed records.
    body: &'a [u8],
}

impl<'a> Chunk<'a> {
    pub(crate) fn of(body: &'a [u8], at: u64) -> Result<Self, Damage> {
        let Record::Chunk { header, data } = parse(op::CHUNK, body, at)? else {
            return Err(damaged(at, "it is none".to_owned()));
        };
        let claimed = header.uncompressed_size;
        // The library checks this size only if there is a checksum, and never for uncompressed
        // chunks. If a compressed chunk claims too small a size, records may be missing; its
        // checksum, the data checksum or the message count of the summary reveals that.
        if claimed > MAX_CHUNK_BYTES {
            let reason = format!("claims {claimed} bytes; at most {MAX_CHUNK_BYTES} are allowed");
            return Err(Damage::Chunk { at, reason });
        }
        let found = header.compressed_size;
        if header.compression.is_empty() && found != claimed {
            let reason = format!("claims {claimed} bytes but holds {found}");
            return Err(Damage::Chunk { at, reason });
        }
        let end = HEADER_BYTES + header.compression.len() + data.len();
        let body = body.get(..end).unwrap_or(body);
        Ok(Chunk { at, header, body })
    }

    pub(crate) fn is_checked(&self) -> bool {
        self.header.uncompressed_crc != 0
    }

    /// Passes each of its records to `take`; none if the checksum is wrong.
    ///
    /// The reader gets the chunk without any bytes after the packed records. In an uncompressed
    /// chunk it trusts the length of a record without comparing it with the end of the chunk's
    /// records; its count of remaining bytes then underflows: a panic in builds with overflow
    /// checks, otherwise it reads bytes of the next field as records. If its input ends with the
    /// records, it reports the missing bytes as an error.
    pub(crate) fn each_record(
        &self,
        take: impl FnMut(u8, &[u8]) -> Result<(), Damage>,
    ) -> Result<(), Damage> {
        let options = part_options().with_prevalidate_chunk_crcs(true);
        let mut reader = LinearReader::new_with_options(options);
        let length = (self.body.len() as u64).to_le_bytes();
        feed(&mut reader, 1, &mut &[op::CHUNK][..]);
        feed(&mut reader, length.len(), &mut &length[..]);
        each_record(reader, self.body, take, |error| self.damage(error))
    }

    fn damage(&self, error: McapError) -> Damage {
        let at = self.at;
        let reason = match error {
            McapError::BadChunkCrc { saved, calculated } => {
                format!("is damaged: its checksum is {calculated:08x}, written was {saved:08x}")
            }
            McapError::UnsupportedCompression(found) => {
                format!("is packed as {found:?}; allowed: zstd, lz4, or not at all")
            }
            McapError::DecompressionError(_) | McapError::Io(_) => {
                format!("does not unpack: {}", reason(&error))
            }
            McapError::UnexpectedEof
            | McapError::UnexpectedEoc
            | McapError::RecordTooLarge { .. } => {
                return damaged(at, "its content ends within a record".to_owned());
            }
            other => return damaged(at, reason(&other)),
        };
        Damage::Chunk { at, reason }
    }
}

fn damaged(at: u64, reason: String) -> Damage {
    Damage::Record {
        at,
        kind: "chunk",
        reason,
    }
}

#[cfg(test)]
mod tests {
    use mcap::MAGIC;

    use super::*;
    use crate::feed::options;
    use crate::sample;
    use crate::write::Packing;

    const PACKINGS: [Packing; 3] = [Packing::Plain, Packing::Zstd, Packing::Lz4];
    /// Offsets of the fields: sizes have eight bytes, the checksum has four.
    const CLAIMED: usize = 16;
    const CHECKSUM: usize = 24;

    fn body(packing: Packing) -> Vec<u8> {
        let file = sample::bytes(packing);
        let mut reader = LinearReader::new_with_options(options().with_emit_chunks(true));
        feed(&mut reader, MAGIC.len(), &mut &MAGIC[..]);
        let mut chunks = Vec::new();
        let take = |opcode, body: &[u8]| {
            chunks.extend((opcode == op::CHUNK).then(|| body.to_vec()));
            Ok(())
        };
        each_record(reader, &file[MAGIC.len()..], take, |error| {
            panic!("{error}")
        })
        .unwrap();
        chunks.swap_remove(0)
    }

    fn messages(body: &[u8]) -> Result<usize, Damage> {
        let mut messages = 0;
        Chunk::of(body, 7)?.each_record(|opcode, _| {
            messages += usize::from(opcode == op::MESSAGE);
            Ok(())
        })?;
        Ok(messages)
    }

    /// True if the chunk is refused with these words.
    fn is_refused(body: &[u8], words: &str) -> bool {
        let damage = messages(body).err().map(|damage| damage.to_string());
        damage.is_some_and(|damage| {
            damage.starts_with("the chunk at byte 7") && damage.contains(words)
        })
    }

    fn claimed(body: &[u8]) -> u64 {
        u64::from_le_bytes(*body[CLAIMED..].first_chunk().unwrap())
    }

    fn claiming(mut body: Vec<u8>, size: u64) -> Vec<u8> {
        body[CLAIMED..CLAIMED + 8].copy_from_slice(&size.to_le_bytes());
        body
    }

    fn with_checksum(mut body: Vec<u8>, checksum: u32) -> Vec<u8> {
        body[CHECKSUM..CHECKSUM + 4].copy_from_slice(&checksum.to_le_bytes());
        body
    }

    fn packed(body: &[u8], name: &str, bytes: &[u8]) -> Vec<u8> {
        let length = (name.len() as u32).to_le_bytes();
        let size = (bytes.len() as u64).to_le_bytes();
        [&body[..28], &length, name.as_bytes(), &size, bytes].concat()
    }

    #[test]
    fn every_packing_unpacks_and_is_checked() {
        for packing in PACKINGS {
            let sound = body(packing);
            assert_eq!(messages(&sound), Ok(4), "{packing:?}");
            assert!(Chunk::of(&sound, 7).unwrap().is_checked());
            let wrong = with_checksum(sound.clone(), 1);
            assert!(is_refused(&wrong, "written was 00000001"));
            let unchecked = with_checksum(sound, 0);
            assert_eq!(messages(&unchecked), Ok(4), "{packing:?}");
            assert!(!Chunk::of(&unchecked, 7).unwrap().is_checked());
        }
    }

    #[test]
    fn other_sizes_than_claimed_are_refused() {
        for packing in PACKINGS {
            let sound = body(packing);
            let size = claimed(&sound);
            for other in [0, size - 1, size + 1] {
                let words = match packing {
                    Packing::Zstd | Packing::Lz4 if other < size => "its checksum is",
                    Packing::Zstd | Packing::Lz4 => "does not unpack",
                    _ => "bytes but holds",
                };
                let body = claiming(sound.clone(), other);
                assert!(is_refused(&body, words), "{packing:?}, {other}");
            }
            for absurd in [MAX_CHUNK_BYTES + 1, u64::MAX] {
                for checksum in [0, 1] {
                    let body = with_checksum(claiming(sound.clone(), absurd), checksum);
                    assert!(is_refused(
                        &body,
                        &format!("claims {absurd} bytes; at most")
                    ));
                }
            }
        }
    }

    #[test]
    fn a_chunk_without_checksum_that_ends_within_a_record_is_refused() {
        for packing in [Packing::Zstd, Packing::Lz4] {
            let sound = with_checksum(body(packing), 0);
            let size = claimed(&sound);
            assert!(is_refused(&claiming(sound, size - 1), "does not unpack"));
        }
        let plain = with_checksum(body(Packing::Plain), 0);
        let records = &plain[HEADER_BYTES..];
        let cut = packed(&plain, "", &records[..records.len() - 1]);
        assert!(matches!(
            messages(&claiming(cut, records.len() as u64 - 1)),
            Err(Damage::Record { kind: "chunk", .. })
        ));
    }

    #[test]
    fn cut_and_unknown_packings_are_refused() {
        for (packing, name) in [(Packing::Zstd, "zstd"), (Packing::Lz4, "lz4")] {
            let sound = body(packing);
            let bytes = &sound[HEADER_BYTES + name.len()..];
            for length in 0..bytes.len() {
                // The last bytes of lz4 only mark the end, with a checksum of their own; the
                // chunk's checksum has covered the content.
                let is_after_content = name == "lz4" && bytes.len() - length <= 8;
                let cut = packed(&sound, name, &bytes[..length]);
                let is_whole = messages(&cut) == Ok(4) && is_after_content;
                let is_good = is_whole || is_refused(&cut, "does not unpack");
                assert!(is_good, "{name}, {length}");
            }
        }
        let plain = body(Packing::Plain);
        let unknown = packed(&plain, "br", &plain[HEADER_BYTES..]);
        assert!(is_refused(&unknown, "is packed as \"br\""));
    }

    #[test]
    fn what_follows_the_records_is_stepped_over() {
        for packing in PACKINGS {
            let longer = [body(packing), b"a field of a later version".to_vec()].concat();
            assert_eq!(messages(&longer), Ok(4), "{packing:?}");
        }
    }

    #[test]
    fn an_unpacked_record_that_reaches_beyond_the_records_is_refused() {
        // A record that claims eight bytes, four of which are in the chunk.
        let record = [&[op::MESSAGE, 8, 0, 0, 0, 0, 0, 0, 0][..], b"mine"].concat();
        let start = claiming(vec![0; 28], record.len() as u64);
        let body = [packed(&start, "", &record), b"not mine".to_vec()].concat();
        assert_eq!(
            messages(&body),
            Err(damaged(7, "its content ends within a record".to_owned()))
        );
    }
}
