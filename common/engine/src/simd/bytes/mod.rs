//! Vectors of bytes: the operations of a sweep on many cells at once.
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

/// Panic message: every slice holds at least a vector.
const ENOUGH: &str = "as many numbers as a vector has";

/// The longest profile whose taper a look-up holds: from its first vote to its
/// end a byte counts the steps, and no vote is left at 255.
pub(crate) const MAX_REACH: usize = 127;

/// Votes of a beam by the steps that are left, laid out for the look-up of one instruction
/// set.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Lookup {
    /// Contents, written by [`Lanes`].
    bytes: [u8; 256],
    /// Layout of the bytes; each instruction set has its own kinds.
    pub kind: u8,
    /// Steps that are left if the ray ends at the reading.
    reach: u8,
    /// Number of parts of the bytes in use, for kinds that have parts.
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

    /// Makes the table by the steps that are left, for the first `size` numbers.
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

/// A vector of bytes, one for each of neighbouring cells. Slices hold at least a vector or,
/// for pairs, the bytes of two.
pub(crate) trait Lanes: Copy {
    /// The token of the instruction set.
    type Set: Copy;
    /// Numbers of 16 bits, one for each of the cells of a vector.
    type Pair: Copy;
    /// Masks of the cells of a vector that end rays.
    type Cells: Copy;

    /// Number of cells of a vector: a power of two, at most 64.
    const WIDTH: usize;
    /// Number of vectors that are swept at a time, 1 or 3: with their votes they fill the
    /// registers.
    const AT_A_TIME: usize;

    fn splat(set: Self::Set, byte: u8) -> Self;
    fn load(set: Self::Set, from: &[u8]) -> Self;
    fn store(self, to: &mut [u8]);
    fn add(self, other: Self) -> Self;
    /// Adds the bytes to numbers of 16 bits if `ADD`, else overwrites those.
    fn widen<const ADD: bool>(self, to: &mut [u16]);

    /// Returns the masks of the cells of a vector, the first cell in the lowest bit. Blocked
    /// cells count only if `BLOCKED`.
    fn cells<const BLOCKED: bool>(set: Self::Set, occupied: u64, blocked: u64) -> Self::Cells;
    /// Returns the steps left in cells, given those left in the next ones: `end` if the cell is
    /// occupied, 0 if it blocks, else one less.
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
    /// Converts to bytes; greater numbers become 255 or 0, which have no votes.
    fn narrow(set: Self::Set, pair: Self::Pair) -> Self;

    /// Makes the look-up of a taper of at most [`MAX_REACH`]; at most `highest` steps are left.
    fn lookup(set: Self::Set, taper: &Taper<'_>, highest: u8) -> Lookup;
    /// Adds the votes for the steps that are left.
    fn vote<const N: usize>(
        set: Self::Set,
        votes: &mut [Self; N],
        left: &[Self; N],
        lookup: &Lookup,
    );
}
