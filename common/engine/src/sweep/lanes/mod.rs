//! Bytes side by side: what a sweep does to many cells at once.
//!
//! A cell's byte is the number of steps that are *left* before a taper ends:
//! 0 where the ray sees nothing or too far, `end` in an obstacle, one less for
//! each step away from it. So the votes are a table look-up by what is left,
//! and one saturating subtraction moves all cells a step on.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod portable;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;
#[cfg(target_arch = "x86_64")]
pub(crate) use avx512::Avx512;
pub(crate) use portable::Portable;

use crate::program::Taper;

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

/// A vector of bytes, one for each of neighbouring cells.
///
/// # Safety
/// All functions need a processor with the vector's instruction set. Pointers
/// must be good for a vector, or the two of a pair; they need no alignment.
pub(crate) trait Lanes: Copy {
    /// Cells of a vector; at most 64 and a power of two.
    const WIDTH: usize;
    /// Numbers of 16 bits, one for each of the same cells.
    type Pair: Copy;
    /// Where rays end among the cells of a vector.
    type Cells: Copy;

    unsafe fn zero() -> Self;
    /// The lowest byte of a number whose four bytes are the same.
    unsafe fn splat(bytes: u32) -> Self;
    unsafe fn load(from: *const u8) -> Self;
    unsafe fn store(self, to: *mut u8);
    unsafe fn add(self, other: Self) -> Self;
    /// Adds the bytes to numbers of 16 bits, or sets those.
    unsafe fn widen<const ADD: bool>(self, to: *mut u16);

    /// The cells of vector `index` from rows of bits. `blocked` is read where
    /// `BLOCKED` says that there is any such cell.
    unsafe fn cells<const BLOCKED: bool>(
        occupied: *const u64,
        blocked: *const u64,
        index: usize,
    ) -> Self::Cells;
    /// What is left a step before cells with so much left: `end` where the cell
    /// is occupied, nothing where it blocks.
    unsafe fn step<const BLOCKED: bool>(self, cells: Self::Cells, end: Self) -> Self;

    unsafe fn splat_pair(numbers: u32) -> Self::Pair;
    unsafe fn load_pair(from: *const u16) -> Self::Pair;
    unsafe fn store_pair(pair: Self::Pair, to: *mut u16);
    unsafe fn step_pair<const BLOCKED: bool>(
        pair: Self::Pair,
        cells: Self::Cells,
        end: Self::Pair,
    ) -> Self::Pair;
    /// As bytes; what no byte holds becomes 255 or 0, which have no votes.
    unsafe fn narrow(pair: Self::Pair) -> Self;

    /// The look-up of a taper of at most [`MAX_REACH`]; what is left is at most
    /// `highest`.
    fn lookup(taper: &Taper<'_>, highest: u8) -> Lookup;
    /// Adds the votes for what is left.
    unsafe fn vote<const N: usize>(votes: &mut [Self; N], left: &[Self; N], lookup: &Lookup);
}
