//! Reads the fields of a telegram's content in order, in either encoding.
//!
//! Each read names its field, so that errors say where and what. It never reads past the end and
//! never skips.

use super::Encoding;
use super::words::{leading_hex, length_of_words};
use crate::SickError;

#[derive(Debug, Clone)]
pub(crate) struct Cursor<'a> {
    rest: &'a [u8],
    at: usize,
    encoding: Encoding,
    /// True if these bytes have already been parsed to their end.
    is_checked: bool,
}

impl<'a> Cursor<'a> {
    /// Creates a cursor over `rest`, which begins `at` bytes into the content.
    pub(crate) fn new(encoding: Encoding, rest: &'a [u8], at: usize) -> Self {
        Cursor {
            rest,
            at,
            encoding,
            is_checked: false,
        }
    }

    /// Marks the bytes as already validated.
    pub(crate) fn checked(mut self) -> Self {
        self.is_checked = true;
        self
    }

    /// Takes `count` numbers in text form; validates each of them the first time.
    pub(crate) fn numbers(
        &mut self,
        field: &'static str,
        count: usize,
        bits: u32,
    ) -> Result<&'a [u8], SickError> {
        let text = self.rest;
        if self.is_checked {
            self.take(field, length_of_words(text, count))?;
            return Ok(text);
        }
        for _ in 0..count {
            self.number(field, bits)?;
        }
        Ok(text)
    }

    pub(crate) fn encoding(&self) -> Encoding {
        self.encoding
    }

    pub(crate) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    pub(crate) fn take(
        &mut self,
        field: &'static str,
        count: usize,
    ) -> Result<&'a [u8], SickError> {
        let (head, rest) = self
            .rest
            .split_at_checked(count)
            .ok_or_else(|| self.short(field, count))?;
        self.rest = rest;
        self.at += count;
        Ok(head)
    }

    fn array<const N: usize>(&mut self, field: &'static str) -> Result<[u8; N], SickError> {
        let (&head, rest) = self
            .rest
            .split_first_chunk::<N>()
            .ok_or_else(|| self.short(field, N))?;
        self.rest = rest;
        self.at += N;
        Ok(head)
    }

    /// Takes the next word of text and the space after it.
    fn word(&mut self, field: &'static str) -> Result<&'a [u8], SickError> {
        let end = self.rest.iter().position(|&byte| byte == b' ');
        let end = end.unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        if word.is_empty() {
            return Err(self.short(field, 1));
        }
        self.advance_past_space(rest, end);
        Ok(word)
    }

    fn advance_past_space(&mut self, rest: &'a [u8], taken: usize) {
        match rest.split_first() {
            Some((b' ', rest)) => {
                self.rest = rest;
                self.at += taken + 1;
            }
            _ => {
                self.rest = rest;
                self.at += taken;
            }
        }
    }

    /// Takes a word of text as a number of this many bits.
    pub(crate) fn number(&mut self, field: &'static str, bits: u32) -> Result<u32, SickError> {
        if let Some((value, length)) = leading_hex(self.rest)
            && (bits == 32 || value >> bits == 0)
        {
            let rest = self.rest.get(length..).unwrap_or_default();
            self.advance_past_space(rest, length);
            return Ok(value);
        }
        self.unusual_number(field, bits)
    }

    /// Takes a signed decimal number, or reports the word as invalid.
    #[cold]
    fn unusual_number(&mut self, field: &'static str, bits: u32) -> Result<u32, SickError> {
        let offset = self.at;
        let word = self.word(field)?;
        let decimal = match word {
            [b'+' | b'-', _, ..] => str::from_utf8(word)
                .ok()
                .and_then(|word| word.parse::<i64>().ok()),
            _ => None,
        };
        let allowed = (-(1i64 << (bits - 1)))..(1i64 << bits);
        match decimal {
            Some(value) if allowed.contains(&value) => Ok((value & ((1 << bits) - 1)) as u32),
            _ => Err(field_error(
                field,
                offset,
                &word.escape_ascii(),
                match bits {
                    8 => "a number of 8 bits",
                    16 => "a number of 16 bits",
                    _ => "a number of 32 bits",
                },
            )),
        }
    }

    pub(crate) fn u8(&mut self, field: &'static str) -> Result<u8, SickError> {
        match self.encoding {
            Encoding::Binary => self.array(field).map(u8::from_be_bytes),
            Encoding::Text => self.number(field, 8).map(|value| value as u8),
        }
    }

    pub(crate) fn u16(&mut self, field: &'static str) -> Result<u16, SickError> {
        match self.encoding {
            Encoding::Binary => self.array(field).map(u16::from_be_bytes),
            Encoding::Text => self.number(field, 16).map(|value| value as u16),
        }
    }

    pub(crate) fn i16(&mut self, field: &'static str) -> Result<i16, SickError> {
        self.u16(field).map(u16::cast_signed)
    }

    pub(crate) fn u32(&mut self, field: &'static str) -> Result<u32, SickError> {
        match self.encoding {
            Encoding::Binary => self.array(field).map(u32::from_be_bytes),
            Encoding::Text => self.number(field, 32),
        }
    }

    pub(crate) fn i32(&mut self, field: &'static str) -> Result<i32, SickError> {
        self.u32(field).map(u32::cast_signed)
    }

    pub(crate) fn f32(&mut self, field: &'static str) -> Result<f32, SickError> {
        let offset = self.at;
        let value = self.u32(field).map(f32::from_bits)?;
        if value.is_finite() {
            return Ok(value);
        }
        Err(field_error(field, offset, &value, "a finite number"))
    }

    pub(crate) fn pair(&mut self, field: &'static str) -> Result<[u8; 2], SickError> {
        Ok([self.u8(field)?, self.u8(field)?])
    }

    /// Takes exactly `N` characters.
    pub(crate) fn letters<const N: usize>(
        &mut self,
        field: &'static str,
    ) -> Result<[u8; N], SickError> {
        let offset = self.at;
        match self.encoding {
            Encoding::Binary => self.array(field),
            Encoding::Text => {
                let word = self.word(field)?;
                word.try_into().map_err(|_| {
                    field_error(field, offset, &word.escape_ascii(), "a word of its length")
                })
            }
        }
    }

    /// Takes `count` characters, which may include spaces.
    pub(crate) fn characters(
        &mut self,
        field: &'static str,
        count: usize,
    ) -> Result<&'a [u8], SickError> {
        let characters = self.take(field, count)?;
        if self.encoding == Encoding::Text {
            let offset = self.at;
            match self.rest.first() {
                None => {}
                Some(b' ') => self.advance_past_space(self.rest, 0),
                Some(other) => {
                    let found = other.escape_ascii();
                    return Err(field_error(field, offset, &found, "a space behind it"));
                }
            }
        }
        Ok(characters)
    }

    /// Takes a u8 of at most `max`; `allowed` is the same range in words.
    pub(crate) fn u8_upto(
        &mut self,
        field: &'static str,
        max: u8,
        allowed: &'static str,
    ) -> Result<u8, SickError> {
        let offset = self.at;
        let value = self.u8(field)?;
        if value <= max {
            return Ok(value);
        }
        Err(field_error(field, offset, &value, allowed))
    }

    /// Takes a u16 of at most `max`; `allowed` is the same range in words.
    pub(crate) fn u16_upto(
        &mut self,
        field: &'static str,
        max: u16,
        allowed: &'static str,
    ) -> Result<u16, SickError> {
        let offset = self.at;
        let value = self.u16(field)?;
        if value <= max {
            return Ok(value);
        }
        Err(field_error(field, offset, &value, allowed))
    }

    /// Takes a u8 that is 0 or 1.
    pub(crate) fn bool(&mut self, field: &'static str) -> Result<bool, SickError> {
        self.u8_upto(field, 1, "0 or 1").map(|value| value == 1)
    }

    /// Takes a u16 flag: true if a block follows.
    pub(crate) fn flag(&mut self, field: &'static str) -> Result<bool, SickError> {
        self.u16_upto(field, 1, "0 or 1").map(|value| value == 1)
    }

    /// Returns the number of bytes taken so far.
    pub(crate) fn offset(&self) -> usize {
        self.at
    }

    /// Checks that no bytes are left.
    pub(crate) fn end(&self) -> Result<(), SickError> {
        if self.rest.is_empty() {
            return Ok(());
        }
        Err(SickError::Trailing {
            offset: self.at,
            left: self.rest.len(),
        })
    }

    fn short(&self, field: &'static str, needed: usize) -> SickError {
        SickError::Short {
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
) -> SickError {
    SickError::Field {
        field,
        offset,
        found: found.to_string(),
        allowed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn binary(bytes: &[u8]) -> Cursor<'_> {
        Cursor::new(Encoding::Binary, bytes, 0)
    }

    fn text(text: &str) -> Cursor<'_> {
        Cursor::new(Encoding::Text, text.as_bytes(), 0)
    }

    #[test]
    fn reads_big_endian_and_counts() {
        let mut cursor = binary(&[1, 2, 0xff, 0xfe, 0x3f, 0x80, 0, 0]);
        assert_eq!(cursor.u16("a").unwrap(), 0x0102);
        assert_eq!(cursor.i16("b").unwrap(), -2);
        assert_eq!(cursor.f32("c").unwrap(), 1.0);
        assert_eq!(cursor.offset(), 8);
        cursor.end().unwrap();
    }

    #[test]
    fn reads_words_of_hex_and_signed_decimals() {
        let mut cursor = text("1388 FFF92230 -450000 +25 3f800000 FFFE DIST1 a b 7");
        assert_eq!(cursor.u16("a").unwrap(), 5000);
        assert_eq!(cursor.i32("b").unwrap(), -450_000);
        assert_eq!(cursor.i32("c").unwrap(), -450_000);
        assert_eq!(cursor.u8("d").unwrap(), 25);
        assert_eq!(cursor.f32("e").unwrap(), 1.0);
        assert_eq!(cursor.i16("f").unwrap(), -2);
        assert_eq!(&cursor.letters::<5>("g").unwrap(), b"DIST1");
        assert_eq!(cursor.characters("h", 3).unwrap(), b"a b");
        assert_eq!((cursor.offset(), cursor.u8("i").unwrap()), (50, 7));
        cursor.end().unwrap();
    }

    #[test]
    fn words_that_are_no_numbers_are_refused() {
        let refuse = |word: &str, expected: &str| {
            let error = text(word).u8("x").unwrap_err().to_string();
            assert!(error.contains(expected), "{word}: {error}");
        };
        refuse("100", "`x` is 100, allowed is a number of 8 bits");
        refuse("+256", "`x` is +256, allowed");
        refuse("-129", "`x` is -129, allowed");
        refuse("0x1", "`x` is 0x1, allowed");
        refuse("000000001", "allowed is a number of 8 bits");
        refuse("+", "`x` is +, allowed");
        refuse("", "`x` takes 1 bytes, 0 are left");
        refuse(" 1", "`x` takes 1 bytes, 2 are left");
        assert!(text("FFFFFFFFF").u32("x").is_err());
        assert!(text("DIST12").letters::<5>("x").is_err());
        assert!(text("abc").characters("x", 2).is_err());
    }

    #[test]
    fn errors_name_field_and_place() {
        let mut cursor = binary(&[0, 2, 0, 0, 0x7f, 0xc0, 0, 0, 1]);
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
