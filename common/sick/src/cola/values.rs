//! Values of a channel, encoded or in memory.

use super::writer::Writer;
use crate::SickError;
use crate::cursor::Cursor;

/// Values of 16 bits, or of 8 bits widened to 16; iterating decodes them in place.
#[derive(Debug, Clone, Copy)]
pub struct Values<'a> {
    place: Place<'a>,
    count: usize,
}

#[derive(Debug, Clone, Copy)]
enum Place<'a> {
    BigEndian(&'a [u8]),
    LittleEndian(&'a [u8]),
    Narrow(&'a [u8]),
    /// Words that have been validated, each a number of this many bits.
    Words(Cursor<'a>, u32),
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
        let place = if cursor.is_text() {
            let (words, bits) = (*cursor, 8 * width as u32);
            for _ in 0..count {
                cursor.number("values", bits)?;
            }
            Place::Words(words, bits)
        } else {
            let bytes = cursor.take("values", count * width)?;
            match width {
                1 => Place::Narrow(bytes),
                _ => Place::BigEndian(bytes),
            }
        };
        Ok(Values { place, count })
    }

    pub(crate) fn little_endian(bytes: &'a [u8]) -> Self {
        Values {
            place: Place::LittleEndian(bytes),
            count: bytes.len() / 2,
        }
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

/// Compares the decoded values, regardless of the encoding.
impl PartialEq for Values<'_> {
    fn eq(&self, other: &Self) -> bool {
        (*self).eq(*other)
    }
}

impl Iterator for Values<'_> {
    type Item = u16;

    fn next(&mut self) -> Option<u16> {
        self.count = self.count.checked_sub(1)?;
        match &mut self.place {
            Place::BigEndian(bytes) => first(bytes).map(u16::from_be_bytes),
            Place::LittleEndian(bytes) => first(bytes).map(u16::from_le_bytes),
            Place::Narrow(bytes) => first(bytes).map(|[byte]| byte.into()),
            Place::Words(words, bits) => Some(words.number("values", *bits).ok()? as u16),
            Place::Listed(values) => first(values).map(|[value]| value),
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.count, Some(self.count))
    }
}

impl ExactSizeIterator for Values<'_> {}

/// Takes the first items off a slice.
fn first<T: Copy, const N: usize>(rest: &mut &[T]) -> Option<[T; N]> {
    let (first, after) = rest.split_first_chunk()?;
    *rest = after;
    Some(*first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cola::Encoding;

    #[test]
    fn words_with_a_sign_have_as_many_bits_as_the_channel() {
        for (width, values) in [(1, [0xC8, 0xF7]), (2, [0xC8, 0xFFF7])] {
            let mut cursor = Cursor::new(Encoding::Text, b"C8 -9", 0);
            let read = Values::read(&mut cursor, 2, width).unwrap();
            assert_eq!(read.collect::<Vec<_>>(), values);
        }
    }
}
