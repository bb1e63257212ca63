//! Bins of distances: one byte says how far a ray goes.
//!
//! Bins are one and a half cells wide at first and wider in each further piece
//! of the scale, as tapers of far readings are wider, too. A piece is a line in
//! integers, and the bin is the least of all lines, so a whole row of ranges
//! is binned at once.

use crate::directions::Directions;

/// Bin of each piece's line at distance 0, and the width of its bins in cells. A step along
/// a diagonal is 1.4 cells long, and no step may span more than a bin, or directions of
/// different classes would not agree where a bin is. The last line is nearly flat: no ray
/// within a map's sides reaches its end, and yet [`NO_RANGE`](crate::program::NO_RANGE)
/// gives [`Bins::NOTHING`] without a special case.
const PIECES: [(u16, f64); 7] = [
    (1, 1.5),
    (11, 2.0),
    (51, 4.0),
    (101, 8.0),
    (176, 32.0),
    (224, 256.0),
    (240, 4096.0),
];

/// Scale that puts ranges, in steps, into bins.
#[derive(Debug, Clone)]
pub(crate) struct Bins {
    /// Lines of all pieces, for each class of directions.
    lines: Vec<[Line; PIECES.len()]>,
}

/// The line `start + (steps · slope >> 16)`, in bins.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line {
    pub start: u16,
    pub slope: u16,
}

impl Bins {
    /// Bin of a ray that sees nothing, and of cells in which no robot can stand.
    pub(crate) const NOTHING: u8 = u8::MAX;

    pub(crate) fn new(directions: &Directions) -> Self {
        let lines = (0..directions.classes()).map(|class| {
            PIECES.map(|(start, cells_per_bin)| {
                let steps_per_bin = directions.steps_per_cell(class) * cells_per_bin;
                let slope = (65_536.0 / steps_per_bin).round() as u16;
                Line { start, slope }
            })
        });
        Bins {
            lines: lines.collect(),
        }
    }

    /// Returns the bin of a range in steps along a class of directions: at least 1, and never
    /// lower for more steps.
    #[inline(always)]
    pub(crate) fn bin(&self, class: usize, steps: u16) -> u8 {
        let bins = self.lines[class].iter().map(|line| line.at(steps));
        bins.min().unwrap_or(0).min(u16::from(Self::NOTHING) - 1) as u8
    }

    /// Returns the lines whose minimum is the bin of a range on any map, and at least
    /// [`Bins::NOTHING`] for no range.
    #[inline(always)]
    pub(crate) fn lines(&self, class: usize) -> &[Line; PIECES.len()] {
        &self.lines[class]
    }
}

impl Line {
    #[inline(always)]
    fn at(self, steps: u16) -> u16 {
        self.start + ((u32::from(steps) * u32::from(self.slope)) >> 16) as u16
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::MAX_SIDE;

    #[test]
    fn bins_rise_with_the_steps_and_stay_below_nothing() {
        for count in [8, 16, 360, 720, 3600] {
            let directions = Directions::new(count).unwrap();
            let bins = Bins::new(&directions);
            for class in 0..directions.classes() {
                let mut before = 1;
                for steps in 0..u16::MAX {
                    let bin = bins.bin(class, steps);
                    assert!(before <= bin && bin < Bins::NOTHING, "{class}: {steps}");
                    before = bin;
                }
            }
        }
    }

    #[test]
    fn near_bins_are_narrow_and_far_ones_wider() {
        let directions = Directions::new(8).unwrap();
        let bins = Bins::new(&directions);
        let along_axis = [0, 1, 2, 3, 4, 40, 60, 1200, 5000].map(|steps| bins.bin(0, steps));
        assert_eq!(along_axis, [1, 1, 2, 3, 3, 27, 41, 213, 241]);
        // A diagonal step is 1.4 cells long.
        assert_eq!([1, 2, 3].map(|steps| bins.bin(1, steps)), [1, 2, 3]);
    }

    #[test]
    fn lines_give_the_bins_of_all_ranges_and_of_none() {
        let directions = Directions::new(360).unwrap();
        let bins = Bins::new(&directions);
        let least = |lines: &[Line], steps| lines.iter().map(|line| line.at(steps)).min();
        for class in 0..directions.classes() {
            let all = bins.lines(class);
            for steps in 0..MAX_SIDE as u16 {
                let bin = Some(u16::from(bins.bin(class, steps)));
                assert_eq!(least(all, steps), bin, "{class}: {steps}");
            }
            assert!(least(all, u16::MAX) >= Some(u16::from(Bins::NOTHING)));
        }
    }
}
