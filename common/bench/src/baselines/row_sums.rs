//! Weighted sums of shifted rows of bytes, the kernel of both correlations.

use engine::instruction_set::InstructionSet;

use super::padded::BLOCK;

/// Rows with the same weight. Their plain sum must fit eight bits.
#[derive(Debug, Clone, Copy)]
pub(super) struct Group {
    /// Range of its offsets.
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) weight: u16,
}

/// Computes for each position of a row the sum over all groups of the weight times the bytes at the
/// group's offsets, saturated at 65535.
///
/// # Panics
/// The row does not consist of whole blocks, or a shifted row exceeds the bytes.
pub(super) fn fill(
    instructions: InstructionSet,
    bytes: &[u8],
    offsets: &[usize],
    groups: &[Group],
    sums: &mut [u16],
) {
    assert!(sums.len().is_multiple_of(BLOCK), "whole blocks");
    let farthest = offsets.iter().max().map_or(0, |&most| most + sums.len());
    assert!(farthest <= bytes.len(), "a row beyond the bytes");
    match instructions {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: the processor has what was detected.
        InstructionSet::Avx2 => unsafe { fill_avx2(bytes, offsets, groups, sums) },
        _ => fill_portable(bytes, offsets, groups, sums),
    }
}

/// Inlined, so that it is compiled for each instruction set.
#[inline(always)]
fn fill_portable(bytes: &[u8], offsets: &[usize], groups: &[Group], sums: &mut [u16]) {
    let (blocks, _) = sums.as_chunks_mut::<BLOCK>();
    for (i, block) in blocks.iter_mut().enumerate() {
        let mut totals = [0u16; BLOCK];
        for group in groups {
            let mut sum = [0u8; BLOCK];
            for &offset in &offsets[group.start..group.end] {
                let row = &bytes[offset + i * BLOCK..][..BLOCK];
                sum.iter_mut()
                    .zip(row)
                    .for_each(|(sum, &byte)| *sum += byte);
            }
            for (total, sum) in totals.iter_mut().zip(sum) {
                let weighted = u16::from(sum).wrapping_mul(group.weight);
                *total = total.saturating_add(weighted);
            }
        }
        *block = totals;
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn fill_avx2(bytes: &[u8], offsets: &[usize], groups: &[Group], sums: &mut [u16]) {
    fill_portable(bytes, offsets, groups, sums);
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn sums_are_those_of_plain_numbers(
            bytes in vec(0u8..15, 500..900), blocks in 1usize..4,
            groups in vec((vec(0usize..300, 0..17), 0u16..200), 0..12),
        ) {
            let mut offsets = Vec::new();
            let mut ranges = Vec::new();
            for (rows, weight) in &groups {
                ranges.push(Group { start: offsets.len(), end: offsets.len() + rows.len(), weight: *weight });
                offsets.extend(rows);
            }
            let plain: Vec<u16> = (0..blocks * BLOCK)
                .map(|i| groups.iter().fold(0u16, |total, (rows, weight)| {
                    let sum: u16 = rows.iter().map(|&row| u16::from(bytes[row + i])).sum();
                    total.saturating_add(sum * weight)
                }))
                .collect();
            for set in InstructionSet::available() {
                let mut sums = vec![7; blocks * BLOCK];
                fill(set, &bytes, &offsets, &ranges, &mut sums);
                prop_assert_eq!(&sums, &plain, "{}", set);
            }
        }
    }
}
