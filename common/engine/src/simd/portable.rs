//! The baseline CPU, of which the compiler chooses the instructions.

#[cfg(target_arch = "aarch64")]
use super::PIECE;
use super::words::{BYTES, QUAD, Words};
use super::{LANES, Set, TABLE};

/// The baseline CPU.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Portable;

impl Set for Portable {
    #[cfg(not(target_arch = "aarch64"))]
    #[inline(always)]
    fn look_up(self, table: &[u8; TABLE], used: usize, index: [u8; LANES]) -> [u8; LANES] {
        let mut found = [0; LANES];
        for (found, index) in found.iter_mut().zip(index) {
            *found = if usize::from(index) < used {
                table[usize::from(index) % TABLE]
            } else {
                0
            };
        }
        found
    }

    #[cfg(target_arch = "aarch64")]
    #[inline(always)]
    fn look_up(self, table: &[u8; TABLE], used: usize, index: [u8; LANES]) -> [u8; LANES] {
        let halves: [[u8; PIECE]; LANES / PIECE] = bytemuck::must_cast(index);
        bytemuck::must_cast(halves.map(|half| look_up_neon(table, used, half)))
    }

    #[inline(always)]
    fn present(self, numbers: [u8; LANES]) -> u32 {
        let numbers = numbers.iter().enumerate();
        numbers.fold(0, |bits, (i, &number)| bits | u32::from(number > 0) << i)
    }

    #[inline(always)]
    fn expand(self, mask: u16, bytes: &[u8; BYTES]) -> Words {
        let from: &[[u8; QUAD]; BYTES / QUAD] = bytemuck::cast_ref(bytes);
        let mut fours = [[0; QUAD]; BYTES / QUAD];
        let mut next = 0;
        for (i, to) in fours.iter_mut().enumerate() {
            if mask >> i & 1 == 1 {
                *to = from[next];
                next += 1;
            }
        }
        Words(bytemuck::cast(fours))
    }

    #[inline(always)]
    fn sorted(self, Words(halves): Words) -> Words {
        Words(halves.map(|half| {
            let bytes: [u8; BYTES / 2] = bytemuck::cast(half);
            std::array::from_fn(|block| {
                u64::from_le_bytes(std::array::from_fn(|i| bytes[QUAD * i + block]))
            })
        }))
    }
}

/// Looks 16 numbers up in a table of which `used` entries are not 0; numbers beyond those
/// give 0. Every ARM processor of 64 bits has NEON.
#[cfg(target_arch = "aarch64")]
#[inline(always)]
fn look_up_neon(table: &[u8; TABLE], used: usize, index: [u8; PIECE]) -> [u8; PIECE] {
    use std::arch::aarch64::*;

    use bytemuck::must_cast;

    let index: uint8x16_t = must_cast(index);
    let pieces: [uint8x16_t; 4] = must_cast(*table);
    must_cast(if used <= PIECE {
        // SAFETY: every processor of this architecture has NEON.
        unsafe { vqtbl1q_u8(pieces[0], index) }
    } else {
        let [first, second, third, fourth] = pieces;
        // SAFETY: every processor of this architecture has NEON.
        unsafe { vqtbl4q_u8(uint8x16x4_t(first, second, third, fourth), index) }
    })
}
