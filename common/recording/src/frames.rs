//! A file, or a chunk's content, as a row of records.
//!
//! | bytes | field |
//! |---|---|
//! | 1 | opcode: the record's type |
//! | 8 | length of the body |
//! | length | body |
//!
//! The library's own readers reserve what a length claims, count an overlong
//! record of an unpacked chunk below zero, and say no place; so its constants
//! and its writer are used, and its readers are not.

use crate::Damage;
use crate::fields::Fields;

/// A record as it stands in the bytes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame<'a> {
    pub(crate) opcode: u8,
    /// Start of the record: of its opcode.
    pub(crate) at: usize,
    pub(crate) body: &'a [u8],
}

/// The records from a place on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frames<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Frames<'a> {
    pub(crate) fn new(bytes: &'a [u8], at: usize) -> Self {
        Frames { bytes, at }
    }

    /// Where the next record starts.
    pub(crate) fn position(&self) -> usize {
        self.at
    }

    /// The next record, or `None` where the bytes end between two records.
    ///
    /// # Errors
    /// Where they end within one.
    pub(crate) fn next(&mut self) -> Result<Option<Frame<'a>>, Damage> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let Some((&opcode, rest)) = rest.split_first() else {
            return Ok(None);
        };
        let mut fields = Fields::new(rest);
        let body = fields
            .u64("length")
            .and_then(|length| fields.bytes("body", length))
            .map_err(|_| self.truncated())?;
        let at = self.at;
        self.at += 9 + body.len();
        Ok(Some(Frame { opcode, at, body }))
    }

    /// The next record, where one must follow.
    pub(crate) fn expect(&mut self) -> Result<Frame<'a>, Damage> {
        self.next()?.ok_or_else(|| self.truncated())
    }

    fn truncated(&self) -> Damage {
        Damage::Truncated {
            length: self.bytes.len() as u64,
            at: self.at as u64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_follow_each_other_until_the_bytes_end() {
        let bytes = b"..\x05\x02\0\0\0\0\0\0\0hi\x81\0\0\0\0\0\0\0\0";
        let mut frames = Frames::new(bytes, 2);
        let first = frames.next().unwrap().unwrap();
        assert_eq!((first.opcode, first.at, first.body), (5, 2, &b"hi"[..]));
        let second = frames.expect().unwrap();
        assert_eq!((second.opcode, second.at, second.body.len()), (0x81, 13, 0));
        assert!(frames.next().unwrap().is_none());
        let end = Damage::Truncated { length: 22, at: 22 };
        assert_eq!(frames.expect().unwrap_err(), end);
    }

    #[test]
    fn a_length_beyond_the_end_is_a_cut() {
        for bytes in [
            &b"\x05"[..],
            b"\x05\x02\0\0",
            b"\x05\x02\0\0\0\0\0\0\0h",
            b"\x05\xff\xff\xff\xff\xff\xff\xff\xff",
        ] {
            let error = Frames::new(bytes, 0).next().unwrap_err();
            let length = bytes.len() as u64;
            assert_eq!(error, Damage::Truncated { length, at: 0 });
        }
    }
}
