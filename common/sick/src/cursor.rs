//! Reads the fields of a telegram's content in order, in the encoding of its device.
//!
//! Each read names its field, so that errors say where and what. It never reads past the end and
//! never skips.

use crate::SickError;
use crate::cola::Encoding;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Text,
    BigEndian,
    LittleEndian,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Cursor<'a> {
    rest: &'a [u8],
    at: usize,
    form: Form,
}

impl<'a> Cursor<'a> {
    /// Creates a cursor over the CoLa fields in `rest`, which begins `at` bytes into the content.
    pub(crate) fn new(encoding: Encoding, rest: &'a [u8], at: usize) -> Self {
        let form = match encoding {
            Encoding::Text => Form::Text,
            Encoding::Binary => Form::BigEndian,
        };
        Cursor { rest, at, form }
    }

    /// Creates a cursor over the payload of an LMS2xx.
    pub(crate) fn little_endian(rest: &'a [u8]) -> Self {
        let form = Form::LittleEndian;
        Cursor { rest, at: 0, form }
    }

    pub(crate) fn is_text(&self) -> bool {
        self.form == Form::Text
    }

    pub(crate) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    pub(crate) fn take(
        &mut self,
        field: &'static str,
        count: usize,
    ) -> Result<&'a [u8], SickError> {
        let parts = self.rest.split_at_checked(count);
        let (head, rest) = parts.ok_or_else(|| self.short(field, count))?;
        self.rest = rest;
        self.at += count;
        Ok(head)
    }

    /// Skips to byte `at` of the content, which must not be before the current one.
    pub(crate) fn skip_to(&mut self, at: usize) -> Result<&mut Self, SickError> {
        self.take("what is skipped", at.saturating_sub(self.at))?;
        Ok(self)
    }

    /// Takes bytes, which are not numbers.
    pub(crate) fn array<const N: usize>(
        &mut self,
        field: &'static str,
    ) -> Result<[u8; N], SickError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(field, N)?);
        Ok(array)
    }

    /// Takes the next word of text and the space after it.
    fn word(&mut self, field: &'static str) -> Result<&'a [u8], SickError> {
        let end = self.rest.iter().position(|&byte| byte == b' ');
        let word = self.take(field, end.unwrap_or(self.rest.len()))?;
        if word.is_empty() {
            return Err(self.short(field, 1));
        }
        self.skip_space();
        Ok(word)
    }

    fn skip_space(&mut self) {
        if let Some((b' ', rest)) = self.rest.split_first() {
            self.rest = rest;
            self.at += 1;
        }
    }

    /// Takes a word of text as a number of this many bits: hexadecimal, or decimal after a sign.
    pub(crate) fn number(&mut self, field: &'static str, bits: u32) -> Result<u32, SickError> {
        let offset = self.at;
        let word = self.word(field)?;
        let least = -(1i64 << (bits - 1));
        let value = match word {
            [b'+' | b'-', _, ..] => str::from_utf8(word).ok().and_then(|word| word.parse().ok()),
            _ => hexadecimal(word),
        };
        match value {
            Some(value) if (least..1 << bits).contains(&value) => {
                Ok((value & ((1 << bits) - 1)) as u32)
            }
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
        match self.form {
            Form::Text => self.number(field, 8).map(|value| value as u8),
            Form::BigEndian | Form::LittleEndian => self.array(field).map(|[byte]| byte),
        }
    }

    pub(crate) fn u16(&mut self, field: &'static str) -> Result<u16, SickError> {
        match self.form {
            Form::Text => self.number(field, 16).map(|value| value as u16),
            Form::BigEndian => self.array(field).map(u16::from_be_bytes),
            Form::LittleEndian => self.array(field).map(u16::from_le_bytes),
        }
    }

    pub(crate) fn i16(&mut self, field: &'static str) -> Result<i16, SickError> {
        self.u16(field).map(u16::cast_signed)
    }

    pub(crate) fn u32(&mut self, field: &'static str) -> Result<u32, SickError> {
        match self.form {
            Form::Text => self.number(field, 32),
            Form::BigEndian => self.array(field).map(u32::from_be_bytes),
            Form::LittleEndian => self.array(field).map(u32::from_le_bytes),
        }
    }

    pub(crate) fn i32(&mut self, field: &'static str) -> Result<i32, SickError> {
        self.u32(field).map(u32::cast_signed)
    }

    pub(crate) fn f32(&mut self, field: &'static str) -> Result<f32, SickError> {
        let read = |cursor: &mut Self, field| cursor.u32(field).map(f32::from_bits);
        self.checked(field, read, |value| value.is_finite(), "a finite number")
    }

    pub(crate) fn pair(&mut self, field: &'static str) -> Result<[u8; 2], SickError> {
        Ok([self.u8(field)?, self.u8(field)?])
    }

    /// Takes exactly `N` characters.
    pub(crate) fn letters<const N: usize>(
        &mut self,
        field: &'static str,
    ) -> Result<[u8; N], SickError> {
        if !self.is_text() {
            return self.array(field);
        }
        let offset = self.at;
        let word = self.word(field)?;
        word.try_into()
            .map_err(|_| field_error(field, offset, &word.escape_ascii(), "a word of its length"))
    }

    /// Takes `count` characters, which may include spaces.
    pub(crate) fn characters(
        &mut self,
        field: &'static str,
        count: usize,
    ) -> Result<&'a [u8], SickError> {
        let characters = self.take(field, count)?;
        match self.rest.first() {
            Some(other) if self.is_text() && *other != b' ' => {
                let found = other.escape_ascii();
                Err(field_error(field, self.at, &found, "a space behind it"))
            }
            _ => {
                if self.is_text() {
                    self.skip_space();
                }
                Ok(characters)
            }
        }
    }

    /// Takes a value that `is_allowed` accepts; `allowed` describes those in words.
    pub(crate) fn checked<T: ToString>(
        &mut self,
        field: &'static str,
        read: impl FnOnce(&mut Self, &'static str) -> Result<T, SickError>,
        is_allowed: impl FnOnce(&T) -> bool,
        allowed: &'static str,
    ) -> Result<T, SickError> {
        let offset = self.at;
        let value = read(self, field)?;
        match is_allowed(&value) {
            true => Ok(value),
            false => Err(field_error(field, offset, &value, allowed)),
        }
    }

    /// Takes a u8 of at most `max`; `allowed` is the same range in words.
    pub(crate) fn u8_upto(
        &mut self,
        field: &'static str,
        max: u8,
        allowed: &'static str,
    ) -> Result<u8, SickError> {
        self.checked(field, Self::u8, |&value| value <= max, allowed)
    }

    /// Takes a u16 of at most `max`; `allowed` is the same range in words.
    pub(crate) fn u16_upto(
        &mut self,
        field: &'static str,
        max: u16,
        allowed: &'static str,
    ) -> Result<u16, SickError> {
        self.checked(field, Self::u16, |&value| value <= max, allowed)
    }

    /// Takes a u8 that `known` accepts; `allowed` lists the accepted codes.
    pub(crate) fn known<T>(
        &mut self,
        field: &'static str,
        known: impl FnOnce(u8) -> Option<T>,
        allowed: &'static str,
    ) -> Result<T, SickError> {
        let offset = self.at;
        let code = self.u8(field)?;
        known(code).ok_or_else(|| field_error(field, offset, &format!("{code:#04x}"), allowed))
    }

    /// Takes a u8 that is 0 or 1.
    pub(crate) fn bool(&mut self, field: &'static str) -> Result<bool, SickError> {
        self.u8_upto(field, 1, "0 or 1").map(|value| value == 1)
    }

    /// Takes a u16 flag: true if a block follows.
    pub(crate) fn flag(&mut self, field: &'static str) -> Result<bool, SickError> {
        self.u16_upto(field, 1, "0 or 1").map(|value| value == 1)
    }

    pub(crate) fn offset(&self) -> usize {
        self.at
    }

    pub(crate) fn end(&self) -> Result<(), SickError> {
        match (self.at, self.rest.len()) {
            (_, 0) => Ok(()),
            (offset, left) => Err(SickError::Trailing { offset, left }),
        }
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

/// Returns the value of 1 to 8 hexadecimal digits.
fn hexadecimal(word: &[u8]) -> Option<i64> {
    let digits = word.iter().map(|&byte| char::from(byte).to_digit(16));
    let value = digits
        .take(9)
        .try_fold(0, |value, digit| Some(value << 4 | i64::from(digit?)))?;
    (word.len() <= 8).then_some(value)
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

    fn text(text: &str) -> Cursor<'_> {
        Cursor::new(Encoding::Text, text.as_bytes(), 0)
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
    fn a_number_that_is_none_is_refused_with_its_place() {
        let mut cursor = Cursor::new(Encoding::Binary, &[0, 0, 0x7f, 0xc0, 0, 0], 0);
        assert_eq!(cursor.u16("gap").unwrap(), 0);
        let text = cursor.f32("scale").unwrap_err().to_string();
        assert!(text.contains("byte 2") && text.contains("NaN"), "{text}");
    }
}
