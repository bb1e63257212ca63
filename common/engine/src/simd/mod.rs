//! Vectors of numbers in the registers of an instruction set.
//!
//! [`Portable`] and [`Avx2`] are tokens: each proves that the processor has the
//! instructions, which was checked when the first one was made ([`Simd::new`]). Vectors can
//! only be made with a token, and nothing that takes these instructions can be called
//! without a token or a vector. So the code of the search and of the sweeps is safe, and
//! written once for all sets: it is a [`Kernel`], generic over the [`Set`], which
//! [`Simd::run`] runs compiled for the one at hand.
//!
//! The modules here hold the code that differs between the sets. There the macro `avx2!`
//! compiles functions for AVX2, in which its instructions are safe to use.
//! Calling such a function is all that is `unsafe`, and it happens in one place, in
//! [`compiled!`]. Memory is read and written through arrays and slices alone.
//!
//! `docs/engine_measurements.md` says why this is not done by `fearless_simd`.

pub(crate) mod headings;
pub(crate) mod numbers;
pub(crate) mod table;
pub(crate) mod words;

use crate::instruction_set::InstructionSet;

/// Cells along the side of a small block, whose votes and ranges are adjacent in memory.
pub(crate) const SIDE: usize = 4;

/// Cells of such a block, row by row.
pub(crate) const CELLS: usize = SIDE * SIDE;

/// Compiles functions for a set of instructions: those of an implementation of a trait, a
/// single one, or kernels.
///
/// The first argument of each function is a token of the set, or a value that is only made
/// with one.
#[cfg(target_arch = "x86_64")]
macro_rules! compiled {
    (
        [$features:literal]
        impl $trait:ident for $type:ty {
            $($(#[$about:meta])* type $associated:ident = $associated_type:ty;)*
            $(const $constant:ident: $constant_type:ty = $constant_value:expr;)*
            $(
                fn $name:ident (
                    $first:ident $(: $first_type:ty)? $(, $argument:ident: $argument_type:ty)* $(,)?
                ) $(-> $result:ty)? $body:block
            )*
        }
    ) => {
        impl $type {
            $(
                #[inline]
                #[target_feature(enable = $features)]
                fn $name (
                    $first $(: $first_type)? $(, $argument: $argument_type)*
                ) $(-> $result)? $body
            )*
        }

        impl $trait for $type {
            $($(#[$about])* type $associated = $associated_type;)*
            $(const $constant: $constant_type = $constant_value;)*
            $(
                #[inline(always)]
                fn $name (
                    $first $(: $first_type)? $(, $argument: $argument_type)*
                ) $(-> $result)? {
                    // SAFETY: the first argument is a token or was made with one, so the
                    // processor has the instructions.
                    unsafe { <$type>::$name($first $(, $argument)*) }
                }
            )*
        }
    };
    ([$features:literal] kernels for $token:ident) => {
        impl $token {
            #[inline(always)]
            fn run<K: Kernel>(self, kernel: K) -> K::Result {
                #[target_feature(enable = $features)]
                fn compiled<K: Kernel>(set: $token, kernel: K) -> K::Result {
                    kernel.run(set)
                }
                // SAFETY: the token proves that the processor has the instructions.
                unsafe { compiled(self, kernel) }
            }
        }
    };
    (
        [$features:literal]
        $(#[$attribute:meta])*
        $visibility:vis fn $name:ident (
            $token:ident: $token_type:ty $(, $argument:ident: $argument_type:ty)* $(,)?
        ) $(-> $result:ty)? $body:block
    ) => {
        $(#[$attribute])*
        #[inline(always)]
        $visibility fn $name (
            $token: $token_type $(, $argument: $argument_type)*
        ) $(-> $result)? {
            #[inline]
            #[target_feature(enable = $features)]
            fn compiled (
                $token: $token_type $(, $argument: $argument_type)*
            ) $(-> $result)? $body
            // SAFETY: the token proves that the processor has the instructions.
            unsafe { compiled($token $(, $argument)*) }
        }
    };
}

/// [`compiled!`] for AVX2; the features are those of [`InstructionSet::Avx2`].
#[cfg(target_arch = "x86_64")]
macro_rules! avx2 {
    ($($item:tt)*) => {
        $crate::simd::compiled! { ["avx2,bmi1,bmi2,lzcnt,popcnt"] $($item)* }
    };
}

#[cfg(target_arch = "x86_64")]
pub(crate) use {avx2, compiled};

/// The baseline CPU.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Portable;

/// Proof that the processor has [`InstructionSet::Avx2`].
#[cfg(target_arch = "x86_64")]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Avx2(());

/// A token, and the vectors of its instruction set.
pub(crate) trait Set: numbers::Numbers + table::Tables {
    type Words: words::BitWords<Set = Self>;
}

impl Set for Portable {
    type Words = words::Words;
}

#[cfg(target_arch = "x86_64")]
impl Set for Avx2 {
    type Words = words::Avx2Words;
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
    Avx2(Avx2),
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
            InstructionSet::Avx2 => Simd::Avx2(Avx2(())),
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

#[cfg(target_arch = "x86_64")]
avx2! { kernels for Avx2 }
