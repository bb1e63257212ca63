//! Rows of bits of which only the bytes with any bits are kept.
//!
//! A block sees few distances in a direction, so three of four bytes have no bits. A mask
//! for each sixteen says which are kept; the others need not come from memory.

use std::ops::Range;

use super::{Byte, READ};
use crate::simd::words::QUAD;

/// A byte of which no block has bits.
const NOTHING: Byte = [0; QUAD];

/// Rows of bits of quads, one after the other.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct PackedRows {
    /// A mask for each word of each row, with a bit for each of its bytes that is kept.
    pub masks: Vec<u16>,
    /// Bytes that have bits.
    pub bytes: Vec<Byte>,
}

/// The rows of a quad.
#[derive(Debug, Clone)]
pub(crate) struct SetRows<'a> {
    /// Rows that have any bits, from the nearest bin on.
    pub rows: Range<usize>,
    /// Bytes of a row.
    pub(super) stride: usize,
    pub(super) masks: &'a [u16],
    /// Kept bytes, and [`READ`] more that can be read.
    pub bytes: &'a [Byte],
}

/// Number of words in a row of this many bytes.
pub(super) fn words(stride: usize) -> usize {
    stride.div_ceil(READ)
}

impl PackedRows {
    pub(super) fn push(&mut self, row: &[Byte]) {
        for word in row.chunks(READ) {
            let (mut kept, mut count, mut mask) = ([NOTHING; READ], 0, 0);
            for (i, &byte) in word.iter().enumerate() {
                let is_kept = byte != NOTHING;
                kept[count] = byte;
                count += usize::from(is_kept);
                mask |= u16::from(is_kept) << i;
            }
            self.bytes.extend_from_slice(&kept[..count]);
            self.masks.push(mask);
        }
    }

    /// Lets words be read from any byte on, and gives back unused capacity.
    pub(super) fn finish(&mut self) {
        self.bytes.resize(self.bytes.len() + READ, NOTHING);
        self.bytes.shrink_to_fit();
        self.masks.shrink_to_fit();
    }

    /// Size in bytes.
    pub(super) fn size(&self) -> usize {
        size_of_val(&self.masks[..]) + size_of_val(&self.bytes[..])
    }
}

impl<'a> SetRows<'a> {
    /// Returns the masks of the words of a row, which must be one of `rows`.
    #[inline(always)]
    pub(crate) fn masks_of(&self, row: usize) -> &'a [u16] {
        let words = words(self.stride);
        &self.masks[(row - self.rows.start) * words..][..words]
    }

    /// Number of bytes that are kept of the rows before one.
    #[inline(always)]
    pub(crate) fn kept_before(&self, row: usize) -> usize {
        let before = row.saturating_sub(self.rows.start) * words(self.stride);
        let masks = self.masks[..before.min(self.masks.len())].iter();
        masks.map(|mask| mask.count_ones() as usize).sum()
    }

    /// Unpacks all rows into `plain`.
    pub(super) fn unpack(&self, plain: &mut Vec<Byte>) {
        plain.clear();
        let mut kept = self.bytes.iter();
        for row in self.masks.chunks(words(self.stride)) {
            let is_kept = |byte: usize| row[byte / READ] >> (byte % READ) & 1 == 1;
            let byte = |byte| match is_kept(byte) {
                true => *kept.next().expect("as many as the masks say"),
                false => NOTHING,
            };
            plain.extend((0..self.stride).map(byte));
        }
    }
}

#[cfg(test)]
impl SetRows<'_> {
    /// Packs rows of equal length, the first of which has the number `first`.
    pub(crate) fn of(first: usize, plain: &[Vec<Byte>], then: impl FnOnce(&SetRows<'_>)) {
        let stride = plain.first().map_or(1, Vec::len);
        let mut packed = PackedRows::default();
        plain.iter().for_each(|row| packed.push(row));
        packed.finish();
        then(&SetRows {
            rows: first..first + plain.len(),
            stride,
            masks: &packed.masks,
            bytes: &packed.bytes,
        });
    }
}
