//! A scan program laid out for bounds from sets of visible ranges.
//!
//! A beam's taper is covered by nested windows of distances, each with a share of its
//! votes. Beams are grouped by their bearings modulo 8.

use std::ops::Range;

use super::group::Group;
use super::quad_rows::RowLayout;
use crate::directions::Directions;
use crate::program::ScanProgram;
use crate::search::index::bins::Bins;
use crate::search::index::bits;
use crate::search::index::intervals::ROW_SHIFT;
use crate::simd::Simd;

/// Number of groups of beams: one for each bearing modulo 8.
pub(crate) const GROUPS: usize = 8;

/// A scan program laid out for bounds from sets; made again for each scan.
#[derive(Debug, Clone, Default)]
pub(crate) struct SetProgram {
    pub(crate) simd: Simd,
    /// Unit of the sums, in votes: all peaks are multiples of it.
    pub(crate) unit: u16,
    /// Number of planes that hold every sum.
    pub(crate) planes: usize,
    /// One group for each bearing modulo 8.
    pub(crate) groups: [Group; GROUPS],
    pub(crate) layout: RowLayout,
}

impl SetProgram {
    pub(crate) fn make(
        &mut self,
        program: &ScanProgram,
        directions: &Directions,
        bins: &Bins,
        simd: Simd,
    ) {
        let peaks = (0..program.beams()).map(|beam| program.peak(beam));
        let unit = peaks.reduce(greatest_common_divisor).unwrap_or(1).max(1);
        (self.simd, self.unit) = (simd, unit);
        self.layout.start(directions.count());
        for (shift, group) in (0..).zip(&mut self.groups) {
            group.start(shift);
        }
        for beam in 0..program.beams() {
            let bearing = program.bearing(beam);
            for (plane, rows) in windows(program, beam, directions, bins, unit) {
                let window = self.layout.window(rows, bearing / 8);
                self.groups[bearing % 8].push(plane, window);
            }
        }
        let nothing = self.layout.nothing();
        self.groups
            .iter_mut()
            .for_each(|group| group.lay_out(nothing));
        let possible: u16 = self.groups.iter().map(|group| group.possible).sum();
        self.planes = (u16::BITS - possible.leading_zeros()) as usize;
    }
}

fn greatest_common_divisor(a: u16, b: u16) -> u16 {
    if b == 0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}

/// Returns windows of rows of sets that cover the taper of a beam in all classes of
/// directions, each with the plane of its share. Each binary digit 1 of the peak has a
/// window, the highest digit one for the whole taper.
fn windows(
    program: &ScanProgram,
    beam: usize,
    directions: &Directions,
    bins: &Bins,
    unit: u16,
) -> impl Iterator<Item = (usize, Range<usize>)> {
    let peak = program.peak(beam) / unit;
    let planes = (0..bits::PLANES).rev();
    planes
        .filter(move |plane| peak >> plane & 1 == 1)
        .filter_map(move |plane| {
            // Windows of higher planes cover votes up to here.
            let below = unit * (peak >> plane >> 1 << plane << 1);
            let rows = (0..directions.classes()).filter_map(|class| {
                let taper = program.taper(beam, class);
                let votes = |&votes: &u8| u16::from(votes) > below;
                let last = taper.profile.partition_point(votes).checked_sub(1)? as u16;
                let row = |at| usize::from(bins.bin(class, at) >> ROW_SHIFT);
                Some((
                    row(taper.centre.saturating_sub(last)),
                    row(taper.centre + last) + 1,
                ))
            });
            let (first, end) = rows.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
            Some((plane, first..end))
        })
}
