//! Little-endian fields, one after another, out of bytes that may be anything.
//!
//! Nothing is copied or reserved: a length that claims more than is there is an
//! error before it is used.

use std::fmt;

/// What is left of a record's bytes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fields<'a> {
    rest: &'a [u8],
}

/// A field that is not sound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BadField {
    /// It needs more bytes than are left.
    Short {
        field: &'static str,
        needed: u64,
        left: usize,
    },
    /// It should be text, but is not UTF-8.
    Text { field: &'static str },
}

impl<'a> Fields<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Fields { rest: bytes }
    }

    /// All bytes that are left.
    pub(crate) fn rest(self) -> &'a [u8] {
        self.rest
    }

    pub(crate) fn u16(&mut self, field: &'static str) -> Result<u16, BadField> {
        self.array(field).map(u16::from_le_bytes)
    }

    pub(crate) fn u32(&mut self, field: &'static str) -> Result<u32, BadField> {
        self.array(field).map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self, field: &'static str) -> Result<u64, BadField> {
        self.array(field).map(u64::from_le_bytes)
    }

    /// A length of four bytes, then as much UTF-8.
    pub(crate) fn text(&mut self, field: &'static str) -> Result<&'a str, BadField> {
        let length = self.u32(field)?;
        let bytes = self.bytes(field, u64::from(length))?;
        std::str::from_utf8(bytes).map_err(|_| BadField::Text { field })
    }

    /// As many bytes as a length said.
    pub(crate) fn bytes(&mut self, field: &'static str, length: u64) -> Result<&'a [u8], BadField> {
        let short = BadField::Short {
            field,
            needed: length,
            left: self.rest.len(),
        };
        let length = usize::try_from(length).map_err(|_| short)?;
        let (bytes, rest) = self.rest.split_at_checked(length).ok_or(short)?;
        self.rest = rest;
        Ok(bytes)
    }

    fn array<const N: usize>(&mut self, field: &'static str) -> Result<[u8; N], BadField> {
        let (array, rest) = self.rest.split_first_chunk().ok_or(BadField::Short {
            field,
            needed: N as u64,
            left: self.rest.len(),
        })?;
        self.rest = rest;
        Ok(*array)
    }
}

impl fmt::Display for BadField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BadField::Short {
                field,
                needed,
                left,
            } => write!(f, "its {field} needs {needed} bytes, {left} are left"),
            BadField::Text { field } => write!(f, "its {field} is not UTF-8"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_come_in_order() {
        let mut fields = Fields::new(b"\x01\x02\x03\0\0\0\x04\0\0\0\0\0\0\0\x02\0\0\0hi!");
        assert_eq!(fields.u16("a"), Ok(0x0201));
        assert_eq!(fields.u32("b"), Ok(3));
        assert_eq!(fields.u64("c"), Ok(4));
        assert_eq!(fields.text("d"), Ok("hi"));
        assert_eq!(fields.rest(), b"!");
    }

    #[test]
    fn claims_beyond_the_end_are_errors() {
        let claim = Fields::new(b"\xff\xff\xff\xffhi")
            .text("topic")
            .unwrap_err();
        assert_eq!(
            claim.to_string(),
            "its topic needs 4294967295 bytes, 2 are left"
        );
        let cut = Fields::new(b"\x01").u16("id").unwrap_err();
        assert_eq!(cut.to_string(), "its id needs 2 bytes, 1 are left");
        let text = Fields::new(b"\x01\0\0\0\xff").text("topic").unwrap_err();
        assert_eq!(text.to_string(), "its topic is not UTF-8");
        assert!(Fields::new(b"").bytes("data", u64::MAX).is_err());
    }
}
