//! The best poses of an intensity image, row by row, at one heading.

use messages::Vote;

use super::{CollectConfig, Collector, Distinct, VoteSet, order};
use crate::space::Space;

/// Buffers for the best poses of intensity images, kept from scan to scan.
#[derive(Debug, Default)]
pub(crate) struct FieldVotes {
    collector: Collector,
    bests: Vec<Vote>,
    distinct: Vec<Vote>,
}

impl FieldVotes {
    /// Collects the best poses of an image, row by row, at one heading.
    pub(crate) fn collect(
        &mut self,
        (field, width): (&[u16], usize),
        heading: u16,
        (config, space): (CollectConfig, &Space),
        found: &mut VoteSet,
    ) {
        self.collector.start(config);
        self.collector.take_field(field, width, heading);
        self.collector.finish(found);
        let wanted = config.candidates as usize;
        if wanted > 0 && found.best > 0 {
            best_of_blocks(field, width, heading, &mut self.bests);
            let distinct = Distinct::new(space, wanted, &mut self.distinct).and_close(found.best);
            found.add_candidates(&mut self.bests, distinct);
        }
    }
}

/// Side, in cells, of the blocks of an image whose best pose is a candidate.
const BLOCK: usize = 8;

/// Finds the best pose of each block of an intensity image, row by row, at one heading; none for
/// blocks without votes.
fn best_of_blocks(field: &[u16], width: usize, heading: u16, bests: &mut Vec<Vote>) {
    bests.clear();
    for (band, rows) in field.chunks(BLOCK * width).enumerate() {
        for left in (0..width).step_by(BLOCK) {
            let right = (left + BLOCK).min(width);
            let cells = rows.chunks_exact(width).enumerate().flat_map(|(y, row)| {
                let cells = (left..right).zip(&row[left..right]);
                cells.map(move |(x, &intensity)| Vote {
                    x: x as u16,
                    y: (BLOCK * band + y) as u16,
                    heading,
                    intensity,
                })
            });
            let best = cells.min_by_key(order).filter(|best| best.intensity > 0);
            bests.extend(best);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_block_of_an_image_has_one_best_pose() {
        // Two blocks side by side, and one row of two more.
        let (width, height) = (11, 9);
        let mut field = vec![0; width * height];
        (field[2 * width + 3], field[3 * width + 1]) = (5, 7);
        (field[8], field[width + 10]) = (4, 4);
        field[8 * width] = 1;
        let mut bests = Vec::new();
        best_of_blocks(&field, width, 6, &mut bests);
        let found: Vec<_> = bests.iter().map(|v| (v.x, v.y, v.intensity)).collect();
        assert_eq!(found, [(1, 3, 7), (8, 0, 4), (0, 8, 1)]);
        assert!(bests.iter().all(|vote| vote.heading == 6));
    }
}
