//! Values of a channel, encoded or in memory.

use super::Encoding;
use super::cursor::Cursor;
use super::words::leading_hex;
use super::writer::Writer;
use crate::SickError;

/// Values of 16 bits, or of 8 bits widened to 16; iterating decodes them in place.
#[derive(Debug, Clone, Copy)]
pub struct Values<'a> {
    place: Place<'a>,
    count: usize,
}

#[derive(Debug, Clone, Copy)]
enum Place<'a> {
    /// Two bytes each, big-endian.
    Wide(&'a [u8]),
    /// One byte each.
    Narrow(&'a [u8]),
    /// Words separated by spaces, each a number of this many bits.
    Words(&'a [u8], u32),
    /// A slice in memory.
    Listed(&'a [u16]),
}

impl<'a> Values<'a> {
    /// Takes `count` values of `width` bytes off the content and validates them.
    pub(super) fn read(
        cursor: &mut Cursor<'a>,
        count: usize,
        width: usize,
    ) -> Result<Self, SickError> {
        let place = match (cursor.encoding(), width) {
            (Encoding::Text, _) => {
                let bits = 8 * width as u32;
                Place::Words(cursor.numbers("values", count, bits)?, bits)
            }
            (Encoding::Binary, 1) => Place::Narrow(cursor.take("values", count)?),
            (Encoding::Binary, _) => Place::Wide(cursor.take("values", count * 2)?),
        };
        Ok(Values { place, count })
    }

    pub(super) fn write(self, writer: &mut Writer<'_>, width: usize) {
        for value in self {
            match width {
                1 => writer.u8(value as u8),
                _ => writer.u16(value),
            }
        }
    }
}

impl<'a> From<&'a [u16]> for Values<'a> {
    fn from(values: &'a [u16]) -> Self {
        Values {
            place: Place::Listed(values),
            count: values.len(),
        }
    }
}

impl Iterator for Values<'_> {
    type Item = u16;

    fn next(&mut self) -> Option<u16> {
        self.count = self.count.checked_sub(1)?;
        match &mut self.place {
            Place::Wide(bytes) => {
                let (value, rest) = bytes.split_first_chunk::<2>()?;
                *bytes = rest;
                Some(u16::from_be_bytes(*value))
            }
            Place::Narrow(bytes) => {
                let (value, rest) = bytes.split_first()?;
                *bytes = rest;
                Some((*value).into())
            }
            Place::Words(text, bits) => next_word(text, *bits),
            Place::Listed(values) => {
                let (value, rest) = values.split_first()?;
                *values = rest;
                Some(*value)
            }
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.count, Some(self.count))
    }
}

impl ExactSizeIterator for Values<'_> {}

/// Takes one word off text that has been validated.
fn next_word(text: &mut &[u8], bits: u32) -> Option<u16> {
    if let Some((value, length)) = leading_hex(text) {
        *text = text.get(length + 1..).unwrap_or_default();
        return Some(value as u16);
    }
    let mut cursor = Cursor::new(Encoding::Text, text, 0);
    let value = cursor.number("values", bits).ok()?;
    *text = cursor.rest();
    Some(value as u16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_with_a_sign_have_as_many_bits_as_the_channel() {
        for (width, values) in [(1, [0xC8, 0xF7]), (2, [0xC8, 0xFFF7])] {
            let mut cursor = Cursor::new(Encoding::Text, b"C8 -9", 0);
            let read = Values::read(&mut cursor, 2, width).unwrap();
            assert_eq!(read.collect::<Vec<_>>(), values);
        }
    }
}
