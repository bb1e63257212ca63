//! Look-ups and shuffles in the registers of AVX2.

use std::arch::x86_64::*;

use bytemuck::{must_cast, must_cast_ref};

use super::words::{BYTES, Words};
use super::{Kernel, LANES, PIECE, Set, TABLE};

/// Proof that the processor has [`InstructionSet::Avx2`](crate::instruction_set::InstructionSet).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Avx2(pub(super) ());

/// Added to an index, it sets the highest bit unless the index is below 16: then nothing is
/// looked up.
const BEYOND: i8 = (0x80 - PIECE) as i8;

/// In each half of a register, four bytes of each block one after the other.
const BY_BLOCKS: [u8; 16] = [0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15];

/// For each mask of eight, the number of selected places before each place, as a byte.
static PLACES: [u64; 256] = places();

const fn places() -> [u64; 256] {
    let mut places = [0; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut i, mut next) = (0, 0);
        while i < 8 {
            places[mask] |= next << (8 * i);
            next += mask as u64 >> i & 1;
            i += 1;
        }
        mask += 1;
    }
    places
}

impl Avx2 {
    /// Runs a kernel compiled for the set.
    #[inline(always)]
    pub(super) fn run<K: Kernel>(self, kernel: K) -> K::Result {
        #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
        fn compiled<K: Kernel>(set: Avx2, kernel: K) -> K::Result {
            kernel.run(set)
        }
        // SAFETY: the token proves that the processor has the instructions.
        unsafe { compiled(self, kernel) }
    }
}

impl Set for Avx2 {
    #[inline(always)]
    fn look_up(self, table: &[u8; TABLE], used: usize, index: [u8; LANES]) -> [u8; LANES] {
        // SAFETY: the token proves that the processor has the instructions.
        unsafe { look_up(table, used, index) }
    }

    #[inline(always)]
    fn present(self, numbers: [u8; LANES]) -> u32 {
        // SAFETY: the token proves that the processor has the instructions.
        unsafe { present(numbers) }
    }

    #[inline(always)]
    fn expand(self, mask: u16, bytes: &[u8; BYTES]) -> Words {
        // SAFETY: the token proves that the processor has the instructions.
        unsafe { expand(mask, bytes) }
    }

    #[inline(always)]
    fn sorted(self, words: Words) -> Words {
        // SAFETY: the token proves that the processor has the instructions.
        unsafe { sorted(words) }
    }
}

#[inline]
#[target_feature(enable = "avx2")]
fn look_up(table: &[u8; TABLE], used: usize, index: [u8; LANES]) -> [u8; LANES] {
    let index = must_cast(index);
    let [first, others @ ..]: &[[u8; PIECE]; TABLE / PIECE] = must_cast_ref(table);
    let mut found = look_up_piece(first, 0, index);
    for (piece, number) in others.iter().zip(1..used.div_ceil(PIECE)) {
        found = _mm256_or_si256(found, look_up_piece(piece, number, index));
    }
    must_cast(found)
}

/// Looks 32 numbers up in piece `number` of a table; others than its own give 0.
#[inline]
#[target_feature(enable = "avx2")]
fn look_up_piece(piece: &[u8; PIECE], number: usize, index: __m256i) -> __m256i {
    // Numbers that go below 0 are beyond 16, too.
    let index = _mm256_sub_epi8(index, _mm256_set1_epi8((PIECE * number) as i8));
    let index = _mm256_adds_epu8(index, _mm256_set1_epi8(BEYOND));
    _mm256_shuffle_epi8(_mm256_broadcastsi128_si256(must_cast(*piece)), index)
}

#[inline]
#[target_feature(enable = "avx2")]
fn present(numbers: [u8; LANES]) -> u32 {
    let absent = _mm256_cmpeq_epi8(must_cast(numbers), _mm256_setzero_si256());
    !_mm256_movemask_epi8(absent).cast_unsigned()
}

#[inline]
#[target_feature(enable = "avx2")]
fn expand(mask: u16, bytes: &[u8; BYTES]) -> Words {
    let [low, high] = mask.to_le_bytes();
    let half = |from: usize| bytes[from..].first_chunk().expect("half of them");
    let rest = 4 * low.count_ones() as usize;
    Words(must_cast([
        expand_half(low, half(0)),
        expand_half(high, half(rest)),
    ]))
}

#[inline]
#[target_feature(enable = "avx2")]
fn expand_half(mask: u8, bytes: &[u8; BYTES / 2]) -> __m256i {
    let places = _mm_cvtsi64_si128(PLACES[usize::from(mask)].cast_signed());
    let spread = _mm256_permutevar8x32_epi32(must_cast(*bytes), _mm256_cvtepu8_epi32(places));
    let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    let set = _mm256_and_si256(_mm256_set1_epi32(i32::from(mask)), bits);
    _mm256_and_si256(spread, _mm256_cmpeq_epi32(set, bits))
}

#[inline]
#[target_feature(enable = "avx2")]
fn sorted(Words(halves): Words) -> Words {
    let bytes = _mm256_broadcastsi128_si256(must_cast(BY_BLOCKS));
    let order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
    let [low, high]: [__m256i; 2] = must_cast(halves);
    // After the shuffle, the parts of each block are adjacent.
    Words(must_cast([
        _mm256_permutevar8x32_epi32(_mm256_shuffle_epi8(low, bytes), order),
        _mm256_permutevar8x32_epi32(_mm256_shuffle_epi8(high, bytes), order),
    ]))
}
