//! Takes fields off the content of a telegram, one after the other.
//!
//! Each read names its field, so that an error says where and what. It never
//! reads past the end and never skips.

use crate::LmsError;

#[derive(Debug, Clone)]
pub(crate) struct Cursor<'a> {
    rest: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    pub(crate) fn new(content: &'a [u8]) -> Self {
        Cursor {
            rest: content,
            at: 0,
        }
    }

    /// Bytes taken so far.
    pub(crate) fn offset(&self) -> usize {
        self.at
    }

    pub(crate) fn take(&mut self, field: &'static str, count: usize) -> Result<&'a [u8], LmsError> {
        let (head, rest) = self
            .rest
            .split_at_checked(count)
            .ok_or_else(|| self.short(field, count))?;
        self.rest = rest;
        self.at += count;
        Ok(head)
    }

    fn array<const N: usize>(&mut self, field: &'static str) -> Result<[u8; N], LmsError> {
        let (&head, rest) = self
            .rest
            .split_first_chunk::<N>()
            .ok_or_else(|| self.short(field, N))?;
        self.rest = rest;
        self.at += N;
        Ok(head)
    }

    pub(crate) fn u8(&mut self, field: &'static str) -> Result<u8, LmsError> {
        self.array(field).map(u8::from_be_bytes)
    }

    pub(crate) fn u16(&mut self, field: &'static str) -> Result<u16, LmsError> {
        self.array(field).map(u16::from_be_bytes)
    }

    pub(crate) fn i16(&mut self, field: &'static str) -> Result<i16, LmsError> {
        self.array(field).map(i16::from_be_bytes)
    }

    pub(crate) fn u32(&mut self, field: &'static str) -> Result<u32, LmsError> {
        self.array(field).map(u32::from_be_bytes)
    }

    pub(crate) fn i32(&mut self, field: &'static str) -> Result<i32, LmsError> {
        self.array(field).map(i32::from_be_bytes)
    }

    pub(crate) fn f32(&mut self, field: &'static str) -> Result<f32, LmsError> {
        let offset = self.at;
        let value = self.array(field).map(f32::from_be_bytes)?;
        if value.is_finite() {
            return Ok(value);
        }
        Err(field_error(field, offset, &value, "a finite number"))
    }

    pub(crate) fn bytes<const N: usize>(
        &mut self,
        field: &'static str,
    ) -> Result<[u8; N], LmsError> {
        self.array(field)
    }

    /// A u8 of at most `max`; `allowed` says the same in words.
    pub(crate) fn u8_upto(
        &mut self,
        field: &'static str,
        max: u8,
        allowed: &'static str,
    ) -> Result<u8, LmsError> {
        let offset = self.at;
        let value = self.u8(field)?;
        if value <= max {
            return Ok(value);
        }
        Err(field_error(field, offset, &value, allowed))
    }

    /// A u16 of at most `max`; `allowed` says the same in words.
    pub(crate) fn u16_upto(
        &mut self,
        field: &'static str,
        max: u16,
        allowed: &'static str,
    ) -> Result<u16, LmsError> {
        let offset = self.at;
        let value = self.u16(field)?;
        if value <= max {
            return Ok(value);
        }
        Err(field_error(field, offset, &value, allowed))
    }

    /// A u16 that says whether a block follows.
    pub(crate) fn flag(&mut self, field: &'static str) -> Result<bool, LmsError> {
        self.u16_upto(field, 1, "0 or 1").map(|value| value == 1)
    }

    /// Checks that nothing is left.
    pub(crate) fn end(&self) -> Result<(), LmsError> {
        if self.rest.is_empty() {
            return Ok(());
        }
        Err(LmsError::Trailing {
            offset: self.at,
            left: self.rest.len(),
        })
    }

    fn short(&self, field: &'static str, needed: usize) -> LmsError {
        LmsError::Short {
            field,
            offset: self.at,
            needed,
            left: self.rest.len(),
        }
    }
}

pub(crate) fn field_error(
    field: &'static str,
    offset: usize,
    found: &impl ToString,
    allowed: &'static str,
) -> LmsError {
    LmsError::Field {
        field,
        offset,
        found: found.to_string(),
        allowed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_big_endian_and_counts() {
        let mut cursor = Cursor::new(&[1, 2, 0xff, 0xfe, 0x3f, 0x80, 0, 0]);
        assert_eq!(cursor.u16("a").unwrap(), 0x0102);
        assert_eq!(cursor.i16("b").unwrap(), -2);
        assert_eq!(cursor.f32("c").unwrap(), 1.0);
        assert_eq!(cursor.offset(), 8);
        cursor.end().unwrap();
    }

    #[test]
    fn errors_name_field_and_place() {
        let mut cursor = Cursor::new(&[0, 2, 0, 0, 0x7f, 0xc0, 0, 0, 1]);
        let text = cursor.flag("name").unwrap_err().to_string();
        assert_eq!(
            text,
            "byte 0 of the telegram: `name` is 2, allowed is 0 or 1"
        );
        assert_eq!(cursor.u16("gap").unwrap(), 0);
        let text = cursor.f32("scale").unwrap_err().to_string();
        assert!(text.contains("byte 4") && text.contains("NaN"), "{text}");
        let text = cursor.u32("time").unwrap_err().to_string();
        assert_eq!(
            text,
            "byte 8 of the telegram: `time` takes 4 bytes, 1 are left of the content"
        );
        let text = cursor.end().unwrap_err().to_string();
        assert_eq!(
            text,
            "byte 8 of the telegram: 1 bytes follow the last field, none may"
        );
    }
}
