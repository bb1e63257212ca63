//! Squares of eight by eight sums, turned over.

/// A square of sums: rows of eight.
pub(super) type Square = [[u16; 8]; 8];

/// The square whose rows are the columns of this one.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(super) fn transposed(square: &Square) -> Square {
    use std::arch::x86_64::*;
    // SAFETY: every x86-64 processor has SSE2; squares and vectors have the
    // same size, and all bits mean a number in both.
    unsafe {
        let mut rows = std::mem::transmute::<Square, [__m128i; 8]>(*square);
        // Three rounds that interleave rows i and i + 4 turn a square over.
        for _ in 0..3 {
            let before = rows;
            for i in 0..4 {
                let (a, b) = (before[i], before[i + 4]);
                rows[2 * i] = _mm_unpacklo_epi16(a, b);
                rows[2 * i + 1] = _mm_unpackhi_epi16(a, b);
            }
        }
        std::mem::transmute::<[__m128i; 8], Square>(rows)
    }
}

/// The square whose rows are the columns of this one.
#[cfg(not(target_arch = "x86_64"))]
#[inline(always)]
pub(super) fn transposed(square: &Square) -> Square {
    std::array::from_fn(|i| std::array::from_fn(|j| square[j][i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_become_columns() {
        let square: Square = std::array::from_fn(|i| std::array::from_fn(|j| (8 * i + j) as u16));
        let turned: Square = std::array::from_fn(|i| std::array::from_fn(|j| (8 * j + i) as u16));
        assert_eq!(transposed(&square), turned);
    }
}
