//! 32 bytes as an array, for the compiler to lay on whatever there is.
//!
//! Few processors look up many bytes at once in a way that it finds by itself.
//! But votes only fall with the distance from the reading, in few levels, and
//! to count the levels takes comparisons alone.

use super::{Lanes, Lookup};
use crate::program::Taper;

const WIDTH: usize = 32;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Portable([u8; WIDTH]);

/// All ones in a cell's byte.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cells {
    open: [u8; WIDTH],
    occupied: [u8; WIDTH],
}

impl Lanes for Portable {
    const WIDTH: usize = WIDTH;
    type Pair = [u16; WIDTH];
    type Cells = Cells;

    #[inline(always)]
    unsafe fn zero() -> Self {
        Portable([0; WIDTH])
    }

    #[inline(always)]
    unsafe fn splat(bytes: u32) -> Self {
        Portable([bytes as u8; WIDTH])
    }

    #[inline(always)]
    unsafe fn load(from: *const u8) -> Self {
        unsafe { Portable(from.cast::<[u8; WIDTH]>().read_unaligned()) }
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut u8) {
        unsafe { to.cast::<[u8; WIDTH]>().write_unaligned(self.0) }
    }

    #[inline(always)]
    unsafe fn add(mut self, other: Self) -> Self {
        for i in 0..WIDTH {
            self.0[i] = self.0[i].wrapping_add(other.0[i]);
        }
        self
    }

    #[inline(always)]
    unsafe fn widen<const ADD: bool>(self, to: *mut u16) {
        unsafe {
            let to = to.cast::<[u16; WIDTH]>();
            let mut numbers = if ADD { to.read_unaligned() } else { [0; WIDTH] };
            for (number, byte) in numbers.iter_mut().zip(self.0) {
                *number = number.wrapping_add(u16::from(byte));
            }
            to.write_unaligned(numbers);
        }
    }

    #[inline(always)]
    unsafe fn cells<const BLOCKED: bool>(
        occupied: *const u64,
        blocked: *const u64,
        index: usize,
    ) -> Cells {
        unsafe {
            let bits = |rows: *const u64| *rows.add(index / 2) >> (32 * (index % 2)) as u32;
            let blocked = if BLOCKED { bits(blocked) } else { 0 };
            let (mut open, occupied) = (spread(bits(occupied) | blocked), spread(bits(occupied)));
            for byte in &mut open {
                *byte = !*byte;
            }
            Cells { open, occupied }
        }
    }

    #[inline(always)]
    unsafe fn step<const BLOCKED: bool>(mut self, cells: Cells, end: Self) -> Self {
        for i in 0..WIDTH {
            let next = self.0[i].saturating_sub(1) & cells.open[i];
            self.0[i] = next | (end.0[i] & cells.occupied[i]);
        }
        self
    }

    #[inline(always)]
    unsafe fn splat_pair(numbers: u32) -> [u16; WIDTH] {
        [numbers as u16; WIDTH]
    }

    #[inline(always)]
    unsafe fn load_pair(from: *const u16) -> [u16; WIDTH] {
        unsafe { from.cast::<[u16; WIDTH]>().read_unaligned() }
    }

    #[inline(always)]
    unsafe fn store_pair(pair: [u16; WIDTH], to: *mut u16) {
        unsafe { to.cast::<[u16; WIDTH]>().write_unaligned(pair) }
    }

    #[inline(always)]
    unsafe fn step_pair<const BLOCKED: bool>(
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
    unsafe fn narrow(pair: [u16; WIDTH]) -> Self {
        let mut bytes = [0; WIDTH];
        for i in 0..WIDTH {
            bytes[i] = pair[i].min(255) as u8;
        }
        Portable(bytes)
    }

    fn lookup(taper: &Taper<'_>, _highest: u8) -> Lookup {
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
    unsafe fn vote<const N: usize>(votes: &mut [Self; N], left: &[Self; N], lookup: &Lookup) {
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

/// All ones in the bytes whose bit is set.
#[inline(always)]
fn spread(bits: u64) -> [u8; WIDTH] {
    let mut bytes = [0; WIDTH];
    for (i, byte) in bytes.iter_mut().enumerate() {
        let bit = (bits >> (8 * (i / 8))) as u8 & (1 << (i % 8));
        *byte = if bit != 0 { u8::MAX } else { 0 };
    }
    bytes
}
