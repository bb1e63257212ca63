//! Bytes side by side: what a sweep does to many cells at once.
//!
//! A cell's byte is the number of steps that are *left* before a taper ends:
//! 0 where the ray sees nothing or too far, `end` in an obstacle, one less for
//! each step away from it. So the votes are a table look-up by what is left,
//! and one saturating subtraction moves all cells a step on.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod portable;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2Bytes;
pub(crate) use portable::Portable;

use crate::program::Taper;

/// What every slice has that vectors are read of or stored to.
const ENOUGH: &str = "as many numbers as a vector has";

/// The longest profile whose taper a look-up holds: from its first vote to its
/// end a byte counts the steps, and no vote is left at 255.
pub(crate) const MAX_REACH: usize = 127;

/// The votes of a beam by the steps that are left, laid out as one instruction
/// set looks them up.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Lookup {
    /// What [`Lanes`] wrote here.
    bytes: [u8; 256],
    /// How the bytes are laid out; each instruction set has its own kinds.
    pub kind: u8,
    /// Steps that are left where the ray ends at the reading.
    reach: u8,
    /// Parts of the bytes that are in use, where the kind asks.
    parts: u8,
}

impl Lookup {
    fn new(kind: u8, taper: &Taper<'_>) -> Self {
        Lookup {
            bytes: [0; 256],
            kind,
            reach: taper.profile.len() as u8,
            parts: 0,
        }
    }

    /// The table by what is left, for the first `size` numbers.
    #[cfg(target_arch = "x86_64")]
    fn by_left(kind: u8, taper: &Taper<'_>, size: usize) -> Self {
        let mut lookup = Lookup::new(kind, taper);
        let reach = taper.profile.len();
        for left in 1..size.min(2 * reach) {
            lookup.bytes[left] = taper.profile[left.abs_diff(reach)];
        }
        lookup
    }
}

/// A vector of bytes, one for each of neighbouring cells. Slices hold a vector at least,
/// or the bytes of two.
pub(crate) trait Lanes: Copy {
    /// The token of the instruction set.
    type Set: Copy;
    /// Numbers of 16 bits, one for each of the cells of a vector.
    type Pair: Copy;
    /// Where rays end among the cells of a vector.
    type Cells: Copy;

    /// Cells of a vector; at most 64 and a power of two.
    const WIDTH: usize;
    /// Vectors that are swept at a time, 1, 3 or 5: with their votes they fill the
    /// registers.
    const AT_A_TIME: usize;

    fn splat(set: Self::Set, byte: u8) -> Self;
    fn load(set: Self::Set, from: &[u8]) -> Self;
    fn store(self, to: &mut [u8]);
    fn add(self, other: Self) -> Self;
    /// Adds the bytes to numbers of 16 bits, or sets those.
    fn widen<const ADD: bool>(self, to: &mut [u16]);

    /// The cells of a vector, the first in the lowest bit. There are blocked ones only
    /// where `BLOCKED` says so.
    fn cells<const BLOCKED: bool>(set: Self::Set, occupied: u64, blocked: u64) -> Self::Cells;
    /// What is left a step before cells with this much left: `end` where the cell
    /// is occupied, nothing where it blocks.
    fn step<const BLOCKED: bool>(self, cells: Self::Cells, end: Self) -> Self;

    fn splat_pair(set: Self::Set, number: u16) -> Self::Pair;
    fn load_pair(set: Self::Set, from: &[u8]) -> Self::Pair;
    fn store_pair(set: Self::Set, pair: Self::Pair, to: &mut [u8]);
    fn step_pair<const BLOCKED: bool>(
        set: Self::Set,
        pair: Self::Pair,
        cells: Self::Cells,
        end: Self::Pair,
    ) -> Self::Pair;
    /// As bytes; what no byte holds becomes 255 or 0, which have no votes.
    fn narrow(set: Self::Set, pair: Self::Pair) -> Self;

    /// The look-up of a taper of at most [`MAX_REACH`]; what is left is at most
    /// `highest`.
    fn lookup(set: Self::Set, taper: &Taper<'_>, highest: u8) -> Lookup;
    /// Adds the votes for what is left.
    fn vote<const N: usize>(
        set: Self::Set,
        votes: &mut [Self; N],
        left: &[Self; N],
        lookup: &Lookup,
    );
}
