//! Bins of distances: one byte says how far a ray goes.
//!
//! Bins are one and a half cells wide at first and wider in each further piece
//! of the scale, as tapers of far readings are wider, too. A piece is a line in
//! integers, and the bin is the least of all lines, so a whole row of ranges
//! is binned at once.

use crate::directions::Directions;
use crate::grid::Grid;

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

/// Number of bins.
const BINS: usize = 256;

/// Scale that puts ranges, in steps, into bins.
#[derive(Debug, Clone)]
pub(crate) struct Bins {
    /// Lines of all pieces, for each class of directions.
    lines: Vec<[Line; PIECES.len()]>,
    /// Fewest steps in each bin or a later one, 256 for each class.
    firsts: Vec<u16>,
    /// Bin of each number of steps up to the longest ray, class by class.
    bins: Vec<u8>,
    longest: u16,
}

/// The line `start + (steps · slope >> 16)`, in bins.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line {
    start: u16,
    slope: u16,
}

impl Bins {
    /// Bin of a ray that sees nothing, and of cells in which no robot can stand.
    pub(crate) const NOTHING: u8 = u8::MAX;

    /// Makes the scale for the rays of a grid.
    pub(crate) fn new(grid: &Grid, directions: &Directions) -> Self {
        // No ray has more steps than it crosses columns or rows.
        Self::up_to(grid.width().max(grid.height()) as u16, directions)
    }

    /// Makes the scale for rays of up to `longest` steps.
    fn up_to(longest: u16, directions: &Directions) -> Self {
        let mut all = Bins {
            lines: Vec::with_capacity(directions.classes()),
            firsts: Vec::with_capacity(BINS * directions.classes()),
            bins: Vec::new(),
            longest,
        };
        for class in 0..directions.classes() {
            let lines = PIECES.map(|(start, cells_per_bin)| {
                let steps_per_bin = directions.steps_per_cell(class) * cells_per_bin;
                let slope = (65_536.0 / steps_per_bin).round() as u16;
                Line { start, slope }
            });
            let start = all.firsts.len();
            for steps in 0..=longest {
                let bins = lines.iter().map(|line| line.at(steps));
                let bin = bins.min().unwrap_or(0).min(u16::from(Self::NOTHING) - 1);
                all.bins.push(bin as u8);
                let end = start + usize::from(bin) + 1;
                all.firsts.resize(end.max(all.firsts.len()), steps);
            }
            all.firsts.resize(start + BINS, longest.saturating_add(1));
            all.lines.push(lines);
        }
        all
    }

    /// Returns the bin of a range in steps along a class of directions: at least 1, and never
    /// lower for more steps. Steps beyond the longest ray count as the longest.
    #[inline(always)]
    pub(crate) fn bin(&self, class: usize, steps: u16) -> u8 {
        self.bins[class * (usize::from(self.longest) + 1) + usize::from(steps.min(self.longest))]
    }

    /// Returns the range of the steps in bins `first..=last`, the end exclusive.
    #[inline(always)]
    pub(crate) fn span(&self, class: usize, first: u8, last: u8) -> (u16, u16) {
        let firsts = &self.firsts[class * BINS..][..BINS];
        let end = usize::from(last) + 1;
        (
            firsts[usize::from(first)],
            if end < BINS { firsts[end] } else { 0 },
        )
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
    pub(crate) fn at(self, steps: u16) -> u16 {
        self.start + ((u32::from(steps) * u32::from(self.slope)) >> 16) as u16
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::limits::MAX_SIDE;

    #[test]
    fn bins_rise_with_the_steps_and_stay_below_nothing() {
        for count in [8, 16, 360, 720, 3600] {
            let directions = Directions::new(count).unwrap();
            let bins = Bins::up_to(u16::MAX - 1, &directions);
            for class in 0..directions.classes() {
                let least = |steps| bins.lines(class).iter().map(|line| line.at(steps)).min();
                let mut before = 1;
                for steps in 0..u16::MAX {
                    let bin = bins.bin(class, steps);
                    assert!(before <= bin && bin < Bins::NOTHING, "{class}: {steps}");
                    let is_least = least(steps) == Some(u16::from(bin));
                    assert!(is_least || u32::from(steps) >= MAX_SIDE, "{class}: {steps}");
                    before = bin;
                }
                assert!(least(u16::MAX) >= Some(u16::from(Bins::NOTHING)));
            }
        }
    }

    #[test]
    fn near_bins_are_narrow_and_far_ones_wider() {
        let bins = Bins::up_to(u16::MAX - 1, &Directions::new(8).unwrap());
        let along_axis = [0, 1, 2, 3, 4, 40, 60, 1200, 5000].map(|steps| bins.bin(0, steps));
        assert_eq!(along_axis, [1, 1, 2, 3, 3, 27, 41, 213, 241]);
        // A diagonal step is 1.4 cells long.
        assert_eq!([1, 2, 3].map(|steps| bins.bin(1, steps)), [1, 2, 3]);
    }
}
