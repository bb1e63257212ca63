//! From a chunk's packed bytes to its records, checked.

use std::borrow::Cow;
use std::io::{self, Read};

use crate::Damage;
use crate::layout::ChunkRecord;

/// Most bytes that a chunk may unpack to. Writers aim at about a megabyte; a
/// single message, such as a large map, can make a chunk as large as itself.
pub const MAX_CHUNK_BYTES: u64 = 1 << 30;

/// The records of the chunk that starts at byte `at`.
///
/// Memory grows with what really unpacks, never with what the chunk claims.
pub(crate) fn unpack<'a>(chunk: &ChunkRecord<'a>, at: u64) -> Result<Cow<'a, [u8]>, Damage> {
    let claimed = chunk.unpacked_size;
    if claimed > MAX_CHUNK_BYTES {
        return Err(Damage::ChunkSize { at, claimed });
    }
    let content = match chunk.compression {
        "" => Cow::Borrowed(chunk.packed),
        "zstd" => zstd::Decoder::with_buffer(chunk.packed)
            .and_then(|decoder| read(decoder, claimed))
            .map_err(|error| does_not_unpack(at, &error))?,
        "lz4" => lz4::Decoder::new(chunk.packed)
            .and_then(|decoder| read(decoder, claimed))
            .map_err(|error| does_not_unpack(at, &error))?,
        other => {
            return Err(Damage::Compression {
                at,
                found: other.to_owned(),
            });
        }
    };
    let found = content.len() as u64;
    if found != claimed {
        return Err(Damage::ChunkContent { at, claimed, found });
    }
    let saved = chunk.checksum;
    if saved == 0 {
        return Ok(content);
    }
    match crc32fast::hash(&content) {
        found if found == saved => Ok(content),
        found => Err(Damage::ChunkChecksum { at, saved, found }),
    }
}

/// One byte more than claimed shows that there are more.
fn read<'a>(decoder: impl Read, claimed: u64) -> io::Result<Cow<'a, [u8]>> {
    let mut content = Vec::new();
    decoder.take(claimed + 1).read_to_end(&mut content)?;
    Ok(Cow::Owned(content))
}

fn does_not_unpack(at: u64, error: &io::Error) -> Damage {
    Damage::Unpack {
        at,
        reason: error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    const CONTENT: &[u8] = b"records, records, records, records, records";

    fn packed(compression: &str) -> Vec<u8> {
        match compression {
            "zstd" => zstd::encode_all(CONTENT, 0).unwrap(),
            "lz4" => {
                let mut encoder = lz4::EncoderBuilder::new().build(Vec::new()).unwrap();
                encoder.write_all(CONTENT).unwrap();
                let (bytes, result) = encoder.finish();
                result.unwrap();
                bytes
            }
            _ => CONTENT.to_vec(),
        }
    }

    fn chunk<'a>(compression: &'a str, packed: &'a [u8]) -> ChunkRecord<'a> {
        ChunkRecord {
            unpacked_size: CONTENT.len() as u64,
            checksum: crc32fast::hash(CONTENT),
            compression,
            packed,
        }
    }

    #[test]
    fn every_packing_unpacks_and_is_checked() {
        for compression in ["", "zstd", "lz4"] {
            let packed = packed(compression);
            let sound = chunk(compression, &packed);
            assert_eq!(&*unpack(&sound, 7).unwrap(), CONTENT);

            let other = ChunkRecord {
                checksum: 1,
                ..chunk(compression, &packed)
            };
            assert!(matches!(
                unpack(&other, 7),
                Err(Damage::ChunkChecksum {
                    at: 7,
                    saved: 1,
                    ..
                })
            ));
            let unchecked = ChunkRecord {
                checksum: 0,
                ..chunk(compression, &packed)
            };
            assert_eq!(&*unpack(&unchecked, 7).unwrap(), CONTENT);
        }
    }

    #[test]
    fn other_sizes_than_claimed_are_refused() {
        for compression in ["", "zstd", "lz4"] {
            let packed = packed(compression);
            for claimed in [0, CONTENT.len() as u64 - 1, CONTENT.len() as u64 + 1] {
                let wrong = ChunkRecord {
                    unpacked_size: claimed,
                    ..chunk(compression, &packed)
                };
                assert!(matches!(
                    unpack(&wrong, 7),
                    Err(Damage::ChunkContent { at: 7, .. })
                ));
            }
            let absurd = ChunkRecord {
                unpacked_size: 4 << 30,
                ..chunk(compression, &packed)
            };
            assert!(matches!(
                unpack(&absurd, 7),
                Err(Damage::ChunkSize {
                    claimed: 0x1_0000_0000,
                    ..
                })
            ));
        }
    }

    #[test]
    fn an_allowed_claim_reserves_nothing_that_is_not_there() {
        // A gigabyte is claimed and a few bytes are there: this would take
        // seconds and the memory of a small machine if it were believed.
        let packed = packed("zstd");
        let claim = ChunkRecord {
            unpacked_size: MAX_CHUNK_BYTES,
            ..chunk("zstd", &packed)
        };
        let content = zstd::Decoder::with_buffer(&packed[..]).unwrap();
        let Cow::Owned(read) = read(content, MAX_CHUNK_BYTES).unwrap() else {
            panic!("what was unpacked is owned");
        };
        assert!(read.capacity() < 1 << 16, "{}", read.capacity());
        assert!(unpack(&claim, 7).is_err());
    }

    #[test]
    fn cut_and_unknown_packings_are_refused() {
        for compression in ["zstd", "lz4"] {
            let packed = packed(compression);
            for length in 0..packed.len() {
                // The last bytes of lz4 only say that nothing follows.
                let result = unpack(&chunk(compression, &packed[..length]), 7);
                if let Ok(content) = result {
                    assert_eq!((&*content, compression), (CONTENT, "lz4"));
                }
            }
        }
        assert!(matches!(
            unpack(&chunk("br", CONTENT), 7),
            Err(Damage::Compression { .. })
        ));
    }
}
