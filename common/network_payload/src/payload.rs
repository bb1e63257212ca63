//! Encodes and decodes messages.
//!
//! | field | postcard | meaning |
//! |---|---|---|
//! | `sender` | varint(u64) | the session id of the sending process, a random number |
//! | `sequence` | varint(u64) | number from 0 for each topic of a sender; a gap is a loss |
//! | `clock_ns` | varint(i64) | the sender's `CLOCK_MONOTONIC` when it was sent; [`Received::rebase`] |
//! | header | its fields in order | see `messages` |
//! | items | varint(count), then each | see `messages` |

use serde::{Deserialize, Serialize};

use crate::{Wire, WireError, bytes};

/// Compression level of zstd: the fastest ordinary one. Maps shrink to a few per cent at any level.
const LEVEL: i32 = 1;
/// Characters of an unknown encoding shown in an error.
const SHOWN: usize = 80;

/// Fields in front of each message; see the module.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Preamble {
    pub sender: u64,
    pub sequence: u64,
    pub clock_ns: i64,
}

#[derive(Debug)]
pub struct Received<T: Wire> {
    pub preamble: Preamble,
    /// Header of the message; its times are of the sender's clock until [`Received::rebase`].
    pub header: T::Header,
    pub items: Vec<T::Item>,
}

impl<T: Wire> Received<T> {
    /// Converts the header's times from the sender's clock to this machine's, which shows `now_ns`:
    /// what was 5 ms old when it was sent is 5 ms old now. The unknown time on the network is not
    /// counted.
    pub fn rebase(&mut self, now_ns: i64) {
        let sent_ns = self.preamble.clock_ns;
        T::each_time(&mut self.header, |time_ns| {
            let age_ns = sent_ns.saturating_sub(*time_ns).max(0);
            *time_ns = now_ns.saturating_sub(age_ns);
        });
    }
}

pub fn encoding<T: Wire>() -> String {
    let packed = if T::COMPRESSED { "+zstd" } else { "" };
    format!("application/postcard{packed};backcast.{}", T::SCHEMA)
}

pub fn encode<T: Wire>(
    preamble: &Preamble,
    header: &T::Header,
    items: &[T::Item],
) -> Result<Vec<u8>, WireError> {
    T::check(header, items)?;
    let failed = |source| WireError::Postcard {
        topic: T::NAME,
        source,
    };
    let start = Vec::with_capacity(256 + size_of_val(items));
    let payload = postcard::to_extend(&(preamble, header), start).map_err(failed)?;
    let payload = bytes::append(items, payload).map_err(failed)?;
    check_length::<T>(payload.len())?;
    if !T::COMPRESSED {
        return Ok(payload);
    }
    zstd::bulk::compress(&payload, LEVEL).map_err(packing::<T>)
}

/// Decodes a payload whose given encoding is `found`.
pub fn decode<T: Wire>(found: &str, payload: &[u8]) -> Result<Received<T>, WireError> {
    let expected = encoding::<T>();
    if found != expected {
        let topic = T::NAME;
        let found = found.chars().take(SHOWN).collect();
        return Err(WireError::Encoding {
            topic,
            found,
            expected,
        });
    }
    check_length::<T>(payload.len())?;
    if T::COMPRESSED {
        let unpacked = zstd::bulk::decompress(payload, T::MAX_BYTES).map_err(packing::<T>)?;
        return read(&unpacked);
    }
    read(payload)
}

fn read<T: Wire>(payload: &[u8]) -> Result<Received<T>, WireError> {
    let failed = |source| WireError::Postcard {
        topic: T::NAME,
        source,
    };
    let ((preamble, header), rest) =
        postcard::take_from_bytes::<(Preamble, T::Header)>(payload).map_err(failed)?;
    let (items, rest) = bytes::take::<T::Item>(rest).map_err(failed)?;
    if !rest.is_empty() {
        let found = rest.len();
        return Err(WireError::Trailing {
            topic: T::NAME,
            found,
        });
    }
    T::check(&header, &items)?;
    Ok(Received {
        preamble,
        header,
        items,
    })
}

fn check_length<T: Wire>(found: usize) -> Result<(), WireError> {
    let most = T::MAX_BYTES;
    if found <= most {
        return Ok(());
    }
    let topic = T::NAME;
    Err(WireError::TooLong { topic, found, most })
}

fn packing<T: Wire>(error: impl std::error::Error + Send + Sync + 'static) -> WireError {
    WireError::Compression {
        topic: T::NAME,
        most: T::MAX_BYTES,
        source: error.into(),
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{FrameName, HealthHeader, MapHeader, Name, ScanHeader, Stamp, topic};
    use proptest::prelude::*;

    use super::*;

    const PREAMBLE: Preamble = Preamble {
        sender: 7,
        sequence: 3,
        clock_ns: 1_000,
    };

    fn scan() -> ScanHeader {
        ScanHeader {
            stamp: Stamp {
                measured_ns: -5,
                entered_ns: 400,
                counter: 9,
            },
            angle_min: -1.5,
            angle_increment: 0.5,
            frame: FrameName::new("laser"),
            ..Zeroable::zeroed()
        }
    }

    fn map(width: u32, height: u32) -> MapHeader {
        MapHeader {
            width,
            height,
            resolution_m: 0.05,
            ..MapHeader::default()
        }
    }

    #[test]
    fn what_is_encoded_is_decoded() {
        let ranges = [1.0, f32::INFINITY, 2.5];
        let payload = encode::<topic::Scan>(&PREAMBLE, &scan(), &ranges).unwrap();
        let back = decode::<topic::Scan>(&encoding::<topic::Scan>(), &payload).unwrap();
        assert_eq!((back.preamble, back.header), (PREAMBLE, scan()));
        assert_eq!(back.items, ranges);
    }

    #[test]
    fn maps_are_compressed() {
        let cells = vec![255; 1_000_000];
        let mut map = map(1000, 1000);
        map.map_id = map.id_of(&cells);
        let payload = encode::<topic::Map>(&PREAMBLE, &map, &cells).unwrap();
        assert!(payload.len() < 10_000, "{}", payload.len());
        let encoding = encoding::<topic::Map>();
        assert_eq!(encoding, "application/postcard+zstd;backcast.Map/v2");
        let back = decode::<topic::Map>(&encoding, &payload).unwrap();
        assert_eq!((back.header, back.items), (map, cells));
    }

    #[test]
    fn another_schema_is_refused_before_the_payload_is_looked_at() {
        for found in [
            "",
            "application/postcard",
            "application/postcard;backcast.Scan/v1",
            "zenoh/bytes",
        ] {
            let error = decode::<topic::Scan>(found, &[]).unwrap_err();
            assert!(matches!(error, WireError::Encoding { .. }), "{error}");
        }
    }

    #[test]
    fn a_frame_that_unpacks_to_too_much_is_refused() {
        let most = topic::Map::MAX_BYTES;
        let bomb = zstd::bulk::compress(&vec![0; most + 1], 1).unwrap();
        assert!(bomb.len() < most / 1000, "{}", bomb.len());
        let error = decode::<topic::Map>(&encoding::<topic::Map>(), &bomb).unwrap_err();
        assert!(matches!(error, WireError::Compression { .. }), "{error}");
        let error = decode::<topic::Map>(&encoding::<topic::Map>(), b"no frame").unwrap_err();
        assert!(matches!(error, WireError::Compression { .. }), "{error}");
    }

    #[test]
    fn bytes_behind_the_message_are_refused() {
        let mut payload = encode::<topic::Scan>(&PREAMBLE, &scan(), &[1.0]).unwrap();
        payload.push(0);
        let error = decode::<topic::Scan>(&encoding::<topic::Scan>(), &payload).unwrap_err();
        assert!(
            matches!(error, WireError::Trailing { found: 1, .. }),
            "{error}"
        );
    }

    #[test]
    fn times_are_as_old_here_as_they_were_there() {
        let payload = encode::<topic::Scan>(&PREAMBLE, &scan(), &[]).unwrap();
        let mut back = decode::<topic::Scan>(&encoding::<topic::Scan>(), &payload).unwrap();
        back.rebase(50_000);
        assert_eq!(back.header.stamp.entered_ns, 50_000 - 600);
        assert_eq!(back.header.stamp.measured_ns, -5, "a date, no age");
        // A time in the future becomes age 0, and nothing overflows.
        back.header.stamp.entered_ns = i64::MAX;
        back.preamble.clock_ns = i64::MIN;
        back.rebase(50_000);
        assert_eq!(back.header.stamp.entered_ns, 50_000);
    }

    #[test]
    fn a_name_that_does_not_fit_is_refused() {
        let header = HealthHeader {
            node: Name::new("engine"),
            ..Zeroable::zeroed()
        };
        let payload = encode::<topic::Health>(&PREAMBLE, &header, &[]).unwrap();
        let at = payload.windows(6).position(|w| w == b"engine").unwrap();
        let mut long = payload[..at - 1].to_vec();
        long.push(33);
        long.extend([b'x'; 33]);
        long.extend(&payload[at + 6..]);
        let error = decode::<topic::Health>(&encoding::<topic::Health>(), &long).unwrap_err();
        assert!(matches!(error, WireError::Postcard { .. }), "{error}");
    }

    proptest! {
        #[test]
        fn any_bytes_are_read_or_refused(payload in proptest::collection::vec(any::<u8>(), 0..300)) {
            for name in topic::NAMES {
                struct Try<'a>(&'a [u8]);
                impl crate::Visit for Try<'_> {
                    type Output = bool;
                    fn visit<T: Wire>(self) -> bool {
                        read::<T>(self.0).is_ok() | decode::<T>(&encoding::<T>(), self.0).is_ok()
                    }
                }
                prop_assert!(crate::by_name(name, Try(&payload)).is_some());
            }
        }

        #[test]
        fn a_damaged_scan_is_read_or_refused(at in 0..60usize, with in any::<u8>(), cut in 0..60usize) {
            let mut payload = encode::<topic::Scan>(&PREAMBLE, &scan(), &[1.0, 2.0]).unwrap();
            let end = payload.len().saturating_sub(cut);
            payload.truncate(end.max(1));
            let at = at % payload.len();
            payload[at] = with;
            if let Ok(scan) = decode::<topic::Scan>(&encoding::<topic::Scan>(), &payload) {
                prop_assert!(scan.header.angle_min.is_finite());
            }
        }
    }
}
