//! Kernels that are compiled for each instruction set, and the operations in which sets differ.
//!
//! [`Portable`] and [`Avx2`](avx2::Avx2) are tokens: each proves that the processor has the
//! instructions, which was checked when it was made ([`Simd::new`]). The code of the search and of
//! the sweeps is safe, and written once for all sets: it is a [`Kernel`], generic over the
//! [`Set`], which [`Simd::run`] runs compiled for the one at hand.
//!
//! Most loops are plain, and the compiler vectorizes them. Only look-ups and shuffles of bytes, for
//! which it does not find the instructions, are written for each set: the methods of [`Set`].
//! Calling a function that was compiled for AVX2 is all that is `unsafe`, and memory is read and
//! written through arrays and slices alone.
//!
//! `docs/engine_measurements.md` says why this is not done by `fearless_simd`.

#[cfg(target_arch = "x86_64")]
mod avx2;
pub(crate) mod headings;
mod portable;
pub(crate) mod words;

use crate::instruction_set::InstructionSet;
use portable::Portable;
use words::{BYTES, Words};

/// Cells along the side of a small block, whose votes and ranges are adjacent in memory.
pub(crate) const SIDE: usize = 4;

/// Cells of such a block, row by row.
pub(crate) const CELLS: usize = SIDE * SIDE;

/// Largest number of entries of a short table, which one instruction can look up.
pub(crate) const TABLE: usize = 64;

/// Number of bytes that are looked up together.
pub(crate) const LANES: usize = 32;

/// Number of entries that an instruction of AVX2 and NEON looks up.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
const PIECE: usize = 16;

/// A token, and the operations of its instruction set.
pub(crate) trait Set: Copy {
    /// Looks numbers up in a table of which `used` entries are not 0; numbers beyond those
    /// give 0.
    fn look_up(self, table: &[u8; TABLE], used: usize, index: [u8; LANES]) -> [u8; LANES];

    /// Returns a bit for each number that is not 0.
    fn present(self, numbers: [u8; LANES]) -> u32;

    /// Spreads groups of four bytes: places that the mask selects get the next group of
    /// `bytes`, others get no bits.
    fn expand(self, mask: u16, bytes: &[u8; BYTES]) -> Words;

    /// Returns words from bytes in the order of sets: the first of each block, the second of
    /// each, and so on.
    fn sorted(self, words: Words) -> Words;
}

/// Work that is compiled for each instruction set.
pub(crate) trait Kernel {
    type Result;

    /// Must be `#[inline(always)]`, and so must all that it calls in its loops.
    fn run<S: Set>(self, set: S) -> Self::Result;
}

/// An instruction set that this processor has.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Simd {
    Portable(Portable),
    #[cfg(target_arch = "x86_64")]
    Avx2(avx2::Avx2),
}

impl Default for Simd {
    fn default() -> Self {
        Simd::Portable(Portable)
    }
}

impl Simd {
    /// Returns the token of an instruction set.
    ///
    /// # Panics
    /// If this processor does not have it.
    pub(crate) fn new(set: InstructionSet) -> Self {
        match set.checked() {
            InstructionSet::Portable => Simd::Portable(Portable),
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => Simd::Avx2(avx2::Avx2(())),
            #[cfg(not(target_arch = "x86_64"))]
            _ => unreachable!("checked above"),
        }
    }

    /// Runs a kernel compiled for this set.
    #[inline(always)]
    pub(crate) fn run<K: Kernel>(self, kernel: K) -> K::Result {
        match self {
            Simd::Portable(set) => kernel.run(set),
            #[cfg(target_arch = "x86_64")]
            Simd::Avx2(set) => set.run(kernel),
        }
    }
}
