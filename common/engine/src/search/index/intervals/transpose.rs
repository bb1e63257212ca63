//! Transposes bytes stored block by block for each direction into bytes stored direction by
//! direction for each block.

/// Bytes of a word: the number of directions transposed at a time.
pub(super) const WORD: usize = 8;

/// Number of blocks transposed at a time.
pub(super) const TILE: usize = WORD * WORD;

/// Transposes the bytes of 64 blocks in eight directions, a row of words each: the word of
/// block `8 · i + j`, with a byte for each direction, is then `[j][i]`.
#[inline(always)]
pub(super) fn transpose(words: &mut [[u64; WORD]; WORD]) {
    // Squares of bytes swap places across the diagonal: of four, two and one.
    swap(words, 4, 0x0000_0000_FFFF_FFFF);
    swap(words, 2, 0x0000_FFFF_0000_FFFF);
    swap(words, 1, 0x00FF_00FF_00FF_00FF);
}

/// Swaps the upper part of each word with the lower part, `low`, of the word `distance`
/// rows on.
#[inline(always)]
fn swap(words: &mut [[u64; WORD]; WORD], distance: usize, low: u64) {
    let bits = 8 * distance;
    for i in 0..WORD {
        if i & distance != 0 {
            continue;
        }
        #[expect(clippy::needless_range_loop, reason = "two words change at a time")]
        for lane in 0..WORD {
            let (a, b) = (words[i][lane], words[i + distance][lane]);
            words[i][lane] = (a & low) | ((b & low) << bits);
            words[i + distance][lane] = ((a >> bits) & low) | (b & !low);
        }
    }
}
