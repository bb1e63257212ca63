//! Vectors of 16-bit numbers, as wide as each instruction set has them.
//!
//! A value of a type here is the proof that the processor has the instructions:
//! it can only be made where the compiler may use them.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

/// What can be done with vectors; numbers are unsigned unless said otherwise.
pub(crate) trait Lanes: Copy {
    type Vector: Copy;

    /// Numbers in a vector.
    const COUNT: usize;

    fn splat(self, value: u16) -> Self::Vector;

    /// The first [`Lanes::COUNT`] numbers.
    fn load(self, from: &[u16]) -> Self::Vector;

    /// To the first [`Lanes::COUNT`] numbers.
    fn store(self, vector: Self::Vector, to: &mut [u16]);

    /// To the first [`Lanes::COUNT`] bytes; the numbers are at most 255.
    fn store_bytes(self, vector: Self::Vector, to: &mut [u8]);

    fn add(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn add_saturating(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn sub(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn sub_saturating(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn and(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn or(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn min(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn max(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;

    /// The greater ones, as signed numbers.
    fn max_signed(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;

    /// `a · b >> 16`.
    fn mul_high(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;

    /// `(a + b + 1) >> 1`.
    fn average(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;

    /// `a << 4`.
    fn shift_nibble(self, a: Self::Vector) -> Self::Vector;

    /// Where numbers are at least as great as others, a bit each.
    fn at_least(self, a: Self::Vector, b: Self::Vector) -> u64;
}

/// What every processor has, left to the compiler.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Portable;

const PORTABLE: usize = 8;

/// Operations lane by lane.
macro_rules! by_lane {
    ($($operation:ident($a:ident, $b:ident) $value:expr;)*) => {
        $(
            #[inline(always)]
            fn $operation(self, a: Self::Vector, b: Self::Vector) -> Self::Vector {
                std::array::from_fn(|i| {
                    let ($a, $b) = (a[i], b[i]);
                    $value
                })
            }
        )*
    };
}

impl Lanes for Portable {
    type Vector = [u16; PORTABLE];

    const COUNT: usize = PORTABLE;

    #[inline(always)]
    fn splat(self, value: u16) -> Self::Vector {
        [value; PORTABLE]
    }

    #[inline(always)]
    fn load(self, from: &[u16]) -> Self::Vector {
        let from = &from[..PORTABLE];
        std::array::from_fn(|i| from[i])
    }

    #[inline(always)]
    fn store(self, vector: Self::Vector, to: &mut [u16]) {
        to[..PORTABLE].copy_from_slice(&vector);
    }

    #[inline(always)]
    fn store_bytes(self, vector: Self::Vector, to: &mut [u8]) {
        to[..PORTABLE].copy_from_slice(&vector.map(|number| number as u8));
    }

    #[inline(always)]
    fn shift_nibble(self, a: Self::Vector) -> Self::Vector {
        a.map(|number| number << 4)
    }

    #[inline(always)]
    fn at_least(self, a: Self::Vector, b: Self::Vector) -> u64 {
        let pairs = a.iter().zip(&b).enumerate();
        pairs.fold(0, |bits, (i, (a, b))| bits | u64::from(a >= b) << i)
    }

    by_lane! {
        add(a, b) a.wrapping_add(b);
        add_saturating(a, b) a.saturating_add(b);
        sub(a, b) a.wrapping_sub(b);
        sub_saturating(a, b) a.saturating_sub(b);
        and(a, b) a & b;
        or(a, b) a | b;
        min(a, b) a.min(b);
        max(a, b) a.max(b);
        max_signed(a, b) a.cast_signed().max(b.cast_signed()).cast_unsigned();
        mul_high(a, b) ((u32::from(a) * u32::from(b)) >> 16) as u16;
        average(a, b) ((u32::from(a) + u32::from(b) + 1) >> 1) as u16;
    }
}

/// Operations by one instruction each.
#[cfg(target_arch = "x86_64")]
macro_rules! by_instruction {
    ($($operation:ident: $instruction:ident,)*) => {
        $(
            #[inline(always)]
            fn $operation(self, a: Self::Vector, b: Self::Vector) -> Self::Vector {
                // SAFETY: `self` proves that the processor has the instruction.
                unsafe { $instruction(a, b) }
            }
        )*
    };
}

/// 16 numbers.
#[cfg(target_arch = "x86_64")]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Avx2(());

#[cfg(target_arch = "x86_64")]
impl Avx2 {
    #[inline]
    #[target_feature(enable = "avx2")]
    pub(crate) fn new() -> Self {
        Avx2(())
    }
}

#[cfg(target_arch = "x86_64")]
impl Lanes for Avx2 {
    type Vector = __m256i;

    const COUNT: usize = 16;

    #[inline(always)]
    fn splat(self, value: u16) -> Self::Vector {
        // SAFETY: `self` proves that the processor has the instruction.
        unsafe { _mm256_set1_epi16(value.cast_signed()) }
    }

    #[inline(always)]
    fn load(self, from: &[u16]) -> Self::Vector {
        let from = &from[..Self::COUNT];
        // SAFETY: as above, and the slice is as long as a vector.
        unsafe { _mm256_loadu_si256(from.as_ptr().cast()) }
    }

    #[inline(always)]
    fn store(self, vector: Self::Vector, to: &mut [u16]) {
        let to = &mut to[..Self::COUNT];
        // SAFETY: as above, and the slice is as long as a vector.
        unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), vector) }
    }

    #[inline(always)]
    fn store_bytes(self, vector: Self::Vector, to: &mut [u8]) {
        let to = &mut to[..Self::COUNT];
        // SAFETY: as above, and the slice is as long as half a vector.
        unsafe {
            // Packing joins the halves of each half; the first and third hold numbers.
            let packed = _mm256_packus_epi16(vector, vector);
            let bytes = _mm256_castsi256_si128(_mm256_permute4x64_epi64::<0b1000>(packed));
            _mm_storeu_si128(to.as_mut_ptr().cast(), bytes);
        }
    }

    #[inline(always)]
    fn shift_nibble(self, a: Self::Vector) -> Self::Vector {
        // SAFETY: as above.
        unsafe { _mm256_slli_epi16::<4>(a) }
    }

    #[inline(always)]
    fn at_least(self, a: Self::Vector, b: Self::Vector) -> u64 {
        // SAFETY: as above.
        unsafe {
            let is = _mm256_cmpeq_epi16(_mm256_max_epu16(a, b), a);
            // Packing joins the halves of each half; the first and third hold bytes.
            let bytes = _mm256_packs_epi16(is, is);
            let bytes = _mm256_castsi256_si128(_mm256_permute4x64_epi64::<0b1000>(bytes));
            u64::from(_mm_movemask_epi8(bytes).cast_unsigned())
        }
    }

    by_instruction! {
        add: _mm256_add_epi16,
        add_saturating: _mm256_adds_epu16,
        sub: _mm256_sub_epi16,
        sub_saturating: _mm256_subs_epu16,
        and: _mm256_and_si256,
        or: _mm256_or_si256,
        min: _mm256_min_epu16,
        max: _mm256_max_epu16,
        max_signed: _mm256_max_epi16,
        mul_high: _mm256_mulhi_epu16,
        average: _mm256_avg_epu16,
    }
}

/// 32 numbers.
#[cfg(target_arch = "x86_64")]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Avx512(());

#[cfg(target_arch = "x86_64")]
impl Avx512 {
    #[inline]
    #[target_feature(enable = "avx512f,avx512bw")]
    pub(crate) fn new() -> Self {
        Avx512(())
    }
}

#[cfg(target_arch = "x86_64")]
impl Lanes for Avx512 {
    type Vector = __m512i;

    const COUNT: usize = 32;

    #[inline(always)]
    fn splat(self, value: u16) -> Self::Vector {
        // SAFETY: `self` proves that the processor has the instruction.
        unsafe { _mm512_set1_epi16(value.cast_signed()) }
    }

    #[inline(always)]
    fn load(self, from: &[u16]) -> Self::Vector {
        let from = &from[..Self::COUNT];
        // SAFETY: as above, and the slice is as long as a vector.
        unsafe { _mm512_loadu_si512(from.as_ptr().cast()) }
    }

    #[inline(always)]
    fn store(self, vector: Self::Vector, to: &mut [u16]) {
        let to = &mut to[..Self::COUNT];
        // SAFETY: as above, and the slice is as long as a vector.
        unsafe { _mm512_storeu_si512(to.as_mut_ptr().cast(), vector) }
    }

    #[inline(always)]
    fn store_bytes(self, vector: Self::Vector, to: &mut [u8]) {
        let to = &mut to[..Self::COUNT];
        // SAFETY: as above, and the slice is as long as half a vector.
        unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), _mm512_cvtepi16_epi8(vector)) }
    }

    #[inline(always)]
    fn shift_nibble(self, a: Self::Vector) -> Self::Vector {
        // SAFETY: as above.
        unsafe { _mm512_slli_epi16::<4>(a) }
    }

    #[inline(always)]
    fn at_least(self, a: Self::Vector, b: Self::Vector) -> u64 {
        // SAFETY: as above.
        unsafe { _mm512_cmpge_epu16_mask(a, b).into() }
    }

    by_instruction! {
        add: _mm512_add_epi16,
        add_saturating: _mm512_adds_epu16,
        sub: _mm512_sub_epi16,
        sub_saturating: _mm512_subs_epu16,
        and: _mm512_and_si512,
        or: _mm512_or_si512,
        min: _mm512_min_epu16,
        max: _mm512_max_epu16,
        max_signed: _mm512_max_epi16,
        mul_high: _mm512_mulhi_epu16,
        average: _mm512_avg_epu16,
    }
}
