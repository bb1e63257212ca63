//! 32 bytes as an array, for the compiler to vectorize.
//!
//! On few processors does the compiler find an instruction that looks up many bytes at
//! once. But votes only fall with the distance from the reading, in few levels, and
//! counting the levels takes only comparisons.

use bytemuck::must_cast;

use super::{ENOUGH, Lanes, Lookup};
use crate::program::Taper;
use crate::simd;

const WIDTH: usize = 32;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Portable([u8; WIDTH]);

/// Masks with all ones in the bytes of open and of occupied cells.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cells {
    open: [u8; WIDTH],
    occupied: [u8; WIDTH],
}

impl Lanes for Portable {
    type Set = simd::Portable;
    type Pair = [u16; WIDTH];
    type Cells = Cells;

    const WIDTH: usize = WIDTH;
    const AT_A_TIME: usize = 1;

    #[inline(always)]
    fn splat(_: Self::Set, byte: u8) -> Self {
        Portable([byte; WIDTH])
    }

    #[inline(always)]
    fn load(_: Self::Set, from: &[u8]) -> Self {
        Portable(*from.first_chunk().expect(ENOUGH))
    }

    #[inline(always)]
    fn store(self, to: &mut [u8]) {
        *to.first_chunk_mut().expect(ENOUGH) = self.0;
    }

    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        for i in 0..WIDTH {
            self.0[i] = self.0[i].wrapping_add(other.0[i]);
        }
        self
    }

    #[inline(always)]
    fn widen<const ADD: bool>(self, to: &mut [u16]) {
        let to: &mut [u16; WIDTH] = to.first_chunk_mut().expect(ENOUGH);
        let mut numbers = if ADD { *to } else { [0; WIDTH] };
        for (number, byte) in numbers.iter_mut().zip(self.0) {
            *number = number.wrapping_add(u16::from(byte));
        }
        *to = numbers;
    }

    #[inline(always)]
    fn cells<const BLOCKED: bool>(_: Self::Set, occupied: u64, blocked: u64) -> Cells {
        let blocked = if BLOCKED { blocked } else { 0 };
        let (mut open, occupied) = (spread(occupied | blocked), spread(occupied));
        for byte in &mut open {
            *byte = !*byte;
        }
        Cells { open, occupied }
    }

    #[inline(always)]
    fn step<const BLOCKED: bool>(mut self, cells: Cells, end: Self) -> Self {
        for i in 0..WIDTH {
            let next = self.0[i].saturating_sub(1) & cells.open[i];
            self.0[i] = next | (end.0[i] & cells.occupied[i]);
        }
        self
    }

    #[inline(always)]
    fn splat_pair(_: Self::Set, number: u16) -> [u16; WIDTH] {
        [number; WIDTH]
    }

    #[inline(always)]
    fn load_pair(_: Self::Set, from: &[u8]) -> [u16; WIDTH] {
        must_cast::<[u8; 2 * WIDTH], _>(*from.first_chunk().expect(ENOUGH))
    }

    #[inline(always)]
    fn store_pair(_: Self::Set, pair: [u16; WIDTH], to: &mut [u8]) {
        *to.first_chunk_mut().expect(ENOUGH) = must_cast::<_, [u8; 2 * WIDTH]>(pair);
    }

    #[inline(always)]
    fn step_pair<const BLOCKED: bool>(
        _: Self::Set,
        mut pair: [u16; WIDTH],
        cells: Cells,
        end: [u16; WIDTH],
    ) -> [u16; WIDTH] {
        for i in 0..WIDTH {
            let (open, occupied) = (cells.open[i] as i8, cells.occupied[i] as i8);
            let next = pair[i].saturating_sub(1) & i16::from(open) as u16;
            pair[i] = next | (end[i] & i16::from(occupied) as u16);
        }
        pair
    }

    #[inline(always)]
    fn narrow(_: Self::Set, pair: [u16; WIDTH]) -> Self {
        Portable(pair.map(|number| number.min(255) as u8))
    }

    fn lookup(_: Self::Set, taper: &Taper<'_>, _highest: u8) -> Lookup {
        let mut lookup = Lookup::new(0, taper);
        let below = taper.profile[1..].iter().chain([&0]);
        let drops = taper
            .profile
            .iter()
            .zip(below)
            .map(|(here, next)| here - next);
        for (distance, drop) in drops.enumerate().filter(|&(_, drop)| drop > 0) {
            let level = 2 * usize::from(lookup.parts);
            lookup.bytes[level] = distance as u8;
            lookup.bytes[level + 1] = drop;
            lookup.parts += 1;
        }
        lookup
    }

    #[inline(always)]
    fn vote<const N: usize>(
        _: Self::Set,
        votes: &mut [Self; N],
        left: &[Self; N],
        lookup: &Lookup,
    ) {
        for (votes, left) in votes.iter_mut().zip(left) {
            let mut distances = [0; WIDTH];
            for (distance, left) in distances.iter_mut().zip(left.0) {
                *distance = left.abs_diff(lookup.reach);
            }
            let levels = lookup.bytes.chunks_exact(2);
            for level in levels.take(usize::from(lookup.parts)) {
                let (farthest, drop) = (level[0], level[1]);
                for (votes, distance) in votes.0.iter_mut().zip(distances) {
                    let vote = if distance <= farthest { drop } else { 0 };
                    *votes = votes.wrapping_add(vote);
                }
            }
        }
    }
}

/// Returns all ones in the bytes whose bit is set.
#[inline(always)]
fn spread(bits: u64) -> [u8; WIDTH] {
    let mut bytes = [0; WIDTH];
    for (i, byte) in bytes.iter_mut().enumerate() {
        let bit = (bits >> (8 * (i / 8))) as u8 & (1 << (i % 8));
        *byte = if bit != 0 { u8::MAX } else { 0 };
    }
    bytes
}
