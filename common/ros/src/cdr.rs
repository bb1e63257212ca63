//! CDR as used by ROS 2: a header of four bytes, then the fields.
//!
//! | bytes | field |
//! |---|---|
//! | 2 | representation: `00 00` big-endian, `00 01` little-endian |
//! | 2 | options, not used |
//! | … | fields, each aligned to its size, counted from here |

use byteorder::{BigEndian, LittleEndian};
use serde::Serialize;
use serde::de::DeserializeOwned;

const BIG_ENDIAN: [u8; 2] = [0, 0];
const LITTLE_ENDIAN: [u8; 2] = [0, 1];

/// Decodes a message. Bytes after its last field are ignored, as in ROS: writers add padding, and a
/// later version of a type may have more fields.
pub fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, String> {
    let Some((&[kind, format, _, _], body)) = bytes.split_first_chunk() else {
        return Err(format!(
            "it has {} bytes, less than a CDR header",
            bytes.len()
        ));
    };
    let result = match [kind, format] {
        BIG_ENDIAN => cdr_encoding::from_bytes::<T, BigEndian>(body),
        LITTLE_ENDIAN => cdr_encoding::from_bytes::<T, LittleEndian>(body),
        other => {
            return Err(format!(
                "its representation is {:02x} {:02x}; allowed: plain CDR, 00 00 or 00 01",
                other[0], other[1]
            ));
        }
    };
    let (message, _) = result.map_err(|error| error.to_string())?;
    Ok(message)
}

/// Encodes a message, little-endian.
pub fn encode<T: Serialize>(message: &T) -> Result<Vec<u8>, cdr_encoding::Error> {
    let mut bytes = vec![LITTLE_ENDIAN[0], LITTLE_ENDIAN[1], 0, 0];
    bytes.extend(cdr_encoding::to_vec::<T, LittleEndian>(message)?);
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Header, LaserScan, PoseStamped, TfMessage, Time};

    fn scan() -> LaserScan {
        LaserScan {
            header: Header::new(Time { sec: 7, nanosec: 8 }, "laser"),
            angle_min: -1.5,
            ranges: vec![1.0, f32::INFINITY],
            ..LaserScan::default()
        }
    }

    /// Expected bytes on the wire, from the layout of the message.
    fn scan_bytes(big: bool) -> Vec<u8> {
        let word = |value: u32| match big {
            true => value.to_be_bytes(),
            false => value.to_le_bytes(),
        };
        let floats = |values: &[f32]| -> Vec<u8> {
            values
                .iter()
                .flat_map(|value| word(value.to_bits()))
                .collect()
        };
        [
            &[0, u8::from(!big), 0, 0][..],
            &[7, 8, 6].map(word).concat(),
            b"laser\0\0\0",
            &floats(&[-1.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            &word(2),
            &floats(&[1.0, f32::INFINITY]),
            &word(0),
        ]
        .concat()
    }

    #[test]
    fn both_byte_orders_decode() {
        assert_eq!(decode::<LaserScan>(&scan_bytes(false)).unwrap(), scan());
        assert_eq!(decode::<LaserScan>(&scan_bytes(true)).unwrap(), scan());
        assert_eq!(encode(&scan()).unwrap(), scan_bytes(false));
    }

    #[test]
    fn doubles_are_aligned_to_eight_after_the_header() {
        let mut pose = PoseStamped::default();
        pose.header.frame_id = "map".to_owned();
        pose.pose.position.x = 2.5;
        let bytes = encode(&pose).unwrap();
        // 4 + 8 (stamp) + 4 (length) + 4 ("map\0") ends at 20, 16 of the body.
        assert_eq!(bytes[20..28], 2.5f64.to_le_bytes());
        pose.header.frame_id = "maps".to_owned();
        let bytes = encode(&pose).unwrap();
        assert_eq!(bytes[28..36], 2.5f64.to_le_bytes(), "21 rounds up to 24");
        assert_eq!(decode::<PoseStamped>(&bytes).unwrap(), pose);
    }

    #[test]
    fn what_is_not_plain_cdr_is_refused() {
        let reason = |bytes: &[u8]| decode::<LaserScan>(bytes).unwrap_err();
        assert_eq!(
            reason(b"\0\x01\0"),
            "it has 3 bytes, less than a CDR header"
        );
        assert_eq!(
            reason(b"\0\x07\0\0"),
            "its representation is 00 07; allowed: plain CDR, 00 00 or 00 01"
        );
        for length in 4..scan_bytes(false).len() {
            assert!(decode::<LaserScan>(&scan_bytes(false)[..length]).is_err());
        }
    }

    #[test]
    fn bytes_after_the_last_field_do_not_matter() {
        for more in [1, 3, 8, 500] {
            let mut long = scan_bytes(false);
            long.extend(vec![9; more]);
            assert_eq!(decode::<LaserScan>(&long).unwrap(), scan());
        }
    }

    #[test]
    fn sequences_that_claim_more_than_is_there_are_refused() {
        let mut bytes = scan_bytes(false);
        // The count of the ranges comes after the header (20 bytes) and seven floats.
        let at = 4 + 20 + 28;
        assert_eq!(bytes[at..at + 4], 2u32.to_le_bytes());
        bytes[at..at + 4].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(decode::<LaserScan>(&bytes).is_err());
        let transforms = [&[0, 1, 0, 0][..], &u32::MAX.to_le_bytes()].concat();
        assert!(decode::<TfMessage>(&transforms).is_err());
    }

    proptest::proptest! {
        #[test]
        fn no_bytes_make_it_panic(bytes in proptest::collection::vec(proptest::num::u8::ANY, 0..300)) {
            for order in [0, 1] {
                let bytes = [&[0, order, 0, 0][..], &bytes].concat();
                let _ = decode::<LaserScan>(&bytes);
                let _ = decode::<TfMessage>(&bytes);
                let _ = decode::<crate::Odometry>(&bytes);
                let _ = decode::<crate::OccupancyGridMsg>(&bytes);
            }
        }
    }
}
