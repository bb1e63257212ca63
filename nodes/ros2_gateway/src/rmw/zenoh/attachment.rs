//! Attachment of each message and each call.
//!
//! | bytes | field |
//! |---|---|
//! | 8 | sequence number, little-endian, counted up by its publisher |
//! | 8 | time of sending, nanoseconds since 1970, little-endian |
//! | 1 | 16, the length of what follows |
//! | 16 | sender |
//!
//! Early versions of `rmw_zenoh` wrote names between the fields; that is refused.

use zenoh::bytes::ZBytes;
use zenoh_ext::{z_deserialize, z_serialize};

use crate::GatewayError;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Attachment {
    pub(crate) sequence: i64,
    pub(crate) sent_ns: i64,
    /// Publisher or client: the hash of its token.
    pub(crate) sender: [u8; 16],
}

impl Attachment {
    pub(crate) fn encode(self) -> ZBytes {
        z_serialize(&(self.sequence, self.sent_ns, self.sender))
    }

    /// Reads the attachment of a message or call on `topic`.
    pub(crate) fn decode(topic: &str, bytes: &ZBytes) -> Result<Self, GatewayError> {
        match z_deserialize(bytes) {
            Ok((sequence, sent_ns, sender)) => Ok(Attachment {
                sequence,
                sent_ns,
                sender,
            }),
            Err(_) => Err(GatewayError::Refused(format!(
                "the attachment of {topic} has {} bytes: allowed are the 33 of rmw_zenoh \
                 (sequence number, time, sender)",
                bytes.len()
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BYTES: [u8; 33] = [
        1, 2, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 16, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12,
        13, 14, 15, 16,
    ];

    #[test]
    fn it_stands_as_rmw_zenoh_documents_it() {
        let attachment = Attachment {
            sequence: 0x201,
            sent_ns: 3,
            sender: std::array::from_fn(|i| i as u8 + 1),
        };
        assert_eq!(*attachment.encode().to_bytes(), BYTES);
        let back = Attachment::decode("/scan", &BYTES.as_slice().into()).unwrap();
        assert_eq!(back, attachment);
    }

    #[test]
    fn anything_else_is_refused() {
        let refused = |bytes: &[u8]| {
            let error = Attachment::decode("/scan", &bytes.into()).unwrap_err();
            let text = error.to_string();
            let length = format!("{} bytes", bytes.len());
            assert!(text.contains("/scan") && text.contains(&length), "{text}");
        };
        for length in 0..BYTES.len() {
            refused(&BYTES[..length]);
        }
        refused(&[&BYTES[..], &[0]].concat());
        let mut longer = BYTES;
        longer[16] = 17;
        refused(&longer);
        refused(b"\x0fsequence_number");
    }
}
