//! Messages as bytes: `rustdds` carries them and does not read them.

use std::convert::Infallible;

use rustdds::RepresentationIdentifier;
use rustdds::bytes::Bytes;
use rustdds::no_key::{Decode, DeserializerAdapter, SerializerAdapter};

/// Bytes before the fields of a message in CDR.
pub(super) const HEADER: usize = 4;

#[derive(Debug, PartialEq, Eq)]
pub(super) enum Payload {
    /// The message with its header.
    Cdr(Vec<u8>),
    /// Size of a message that is longer than allowed, bytes.
    TooLong(usize),
}

/// The format: plain CDR in both byte orders in, little-endian out.
pub(super) struct Raw;

impl SerializerAdapter<Bytes> for Raw {
    type Error = Infallible;

    fn output_encoding() -> RepresentationIdentifier {
        RepresentationIdentifier::CDR_LE
    }

    fn to_bytes(fields: &Bytes) -> Result<Bytes, Infallible> {
        Ok(fields.clone())
    }
}

impl DeserializerAdapter<Payload> for Raw {
    type Error = Infallible;
    type Decoded = Payload;

    fn supported_encodings() -> &'static [RepresentationIdentifier] {
        &[
            RepresentationIdentifier::CDR_LE,
            RepresentationIdentifier::CDR_BE,
        ]
    }

    fn transform_decoded(decoded: Payload) -> Payload {
        decoded
    }
}

/// Decoder that copies messages of at most this many bytes.
#[derive(Debug, Clone, Copy)]
pub(super) struct AtMost(pub(super) usize);

impl Decode<'_, Payload> for AtMost {
    type Error = Infallible;

    fn decode_bytes(
        self,
        fields: &[u8],
        encoding: RepresentationIdentifier,
    ) -> Result<Payload, Infallible> {
        let length = HEADER + fields.len();
        if length > self.0 {
            return Ok(Payload::TooLong(length));
        }
        let order = u8::from(encoding == RepresentationIdentifier::CDR_LE);
        let mut bytes = Vec::with_capacity(length);
        bytes.extend([0, order, 0, 0]);
        bytes.extend(fields);
        Ok(Payload::Cdr(bytes))
    }
}

/// Removes the header of a message in little-endian CDR.
pub(super) fn fields(cdr: Vec<u8>) -> Bytes {
    let mut bytes = Bytes::from(cdr);
    bytes.split_off(HEADER.min(bytes.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_is_taken_off_and_put_back() {
        let cdr = ros::cdr::encode(&7u32).unwrap();
        let fields = fields(cdr.clone());
        assert_eq!(*fields, 7u32.to_le_bytes());
        let decode = |most| AtMost(most).decode_bytes(&fields, Raw::output_encoding());
        assert_eq!(decode(8), Ok(Payload::Cdr(cdr)));
        assert_eq!(decode(7), Ok(Payload::TooLong(8)));
    }
}
