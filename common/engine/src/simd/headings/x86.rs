//! Votes at headings in the registers of AVX2.

use std::arch::x86_64::*;

use bytemuck::must_cast;

use super::{BinVotes, HEADINGS, HeadingLanes, IntervalRows, TABLE};
use crate::simd::table::look_up_avx2;
use crate::simd::{Avx2, avx2};

/// Headings of a register of AVX2.
const HALF: usize = HEADINGS / 2;

/// Two registers of 32 headings.
#[derive(Clone, Copy)]
pub(crate) struct Avx2Headings([__m256i; 2]);

avx2! {
    /// Returns the place in the table of the bin of each interval that is nearest to the
    /// centre.
    fn place(_set: Avx2, votes: &BinVotes, first: &[u8; HALF], last: &[u8; HALF]) -> __m256i {
        let centre = _mm256_set1_epi8(votes.centre.cast_signed());
        let bin = _mm256_max_epu8(_mm256_min_epu8(centre, must_cast(*last)), must_cast(*first));
        _mm256_subs_epu8(bin, _mm256_set1_epi8(votes.base.cast_signed()))
    }
}

#[inline(always)]
fn half_of(row: &[u8; HEADINGS], half: usize) -> &[u8; HALF] {
    &row.as_chunks().0[half]
}

avx2! {
    impl HeadingLanes for Avx2Headings {
        type Set = Avx2;

        fn none(_set: Avx2) -> Avx2Headings {
            Avx2Headings([_mm256_setzero_si256(); 2])
        }

        fn of_beam(set: Avx2, votes: &BinVotes, rows: IntervalRows<'_>) -> Avx2Headings {
            let [near_first, near_last, far_first, far_last] = rows;
            let near = |half| place(set, votes, half_of(near_first, half), half_of(near_last, half));
            let far = |half| place(set, votes, half_of(far_first, half), half_of(far_last, half));
            let mut places = [near(0), far(0), near(1), far(1)];
            // Otherwise the last entry, which stands for all bins beyond, is 0.
            if usize::from(votes.used) == TABLE {
                let last = _mm256_set1_epi8(TABLE as i8 - 1);
                places = places.map(|place| _mm256_min_epu8(place, last));
            }
            let found = look_up_avx2(set, &votes.table, votes.used.into(), places);
            Avx2Headings([
                _mm256_max_epu8(found[0], found[1]),
                _mm256_max_epu8(found[2], found[3]),
            ])
        }

        fn add(self, other: Avx2Headings) -> Avx2Headings {
            let ([first, second], [other_first, other_second]) = (self.0, other.0);
            Avx2Headings([
                _mm256_add_epi8(first, other_first),
                _mm256_add_epi8(second, other_second),
            ])
        }

        fn present(self) -> u64 {
            let mut present = 0;
            for (half, votes) in self.0.into_iter().enumerate() {
                let absent = _mm256_cmpeq_epi8(votes, _mm256_setzero_si256());
                let absent = _mm256_movemask_epi8(absent).cast_unsigned();
                present |= u64::from(!absent) << (HALF * half);
            }
            present
        }

        fn to_bytes(self) -> [u8; HEADINGS] {
            must_cast(self.0)
        }
    }
}
