//! Recent scans and the data derived from them, kept until their votes arrive.

use std::collections::VecDeque;

use engine::scan::Scan;
use messages::{Reading, ScanHeader, Stamp, VotesHeader};

use crate::PeakError;

/// Number of scans kept, far more than ever wait for the search.
const KEPT: usize = 64;

#[derive(Debug, Default)]
pub struct Scans {
    kept: Ring<ScanHeader, f32>,
    readings: Ring<(), Reading>,
    by_map: Ring<(), VotesHeader>,
}

/// The last messages by the stamp of their scan, newest last.
#[derive(Debug)]
struct Ring<H, T>(VecDeque<(Stamp, H, Vec<T>)>);

impl<H, T> Default for Ring<H, T> {
    fn default() -> Self {
        Ring(VecDeque::new())
    }
}

impl<H, T: Copy> Ring<H, T> {
    fn push(&mut self, stamp: Stamp, header: H, items: &[T]) {
        if self.0.len() == KEPT {
            self.0.pop_front();
        }
        self.0.push_back((stamp, header, items.to_vec()));
    }

    fn get(&self, stamp: Stamp) -> Option<(&H, &[T])> {
        let mut newest_first = self.0.iter().rev();
        let (_, header, items) = newest_first.find(|(of, ..)| of.is_of(stamp))?;
        Some((header, items))
    }
}

impl Scans {
    pub fn receive(&mut self, header: &ScanHeader, ranges: &[f32]) {
        self.kept.push(header.stamp, *header, ranges);
    }

    pub fn take_readings(&mut self, stamp: Stamp, readings: &[Reading]) {
        self.readings.push(stamp, (), readings);
    }

    pub fn readings(&self, stamp: Stamp) -> Result<&[Reading], PeakError> {
        let found = self.readings.get(stamp);
        Ok(found.ok_or(PeakError::UnknownScan)?.1)
    }

    pub fn take_by_map(&mut self, stamp: Stamp, maps: &[VotesHeader]) {
        self.by_map.push(stamp, (), maps);
    }

    pub fn by_map(&self, stamp: Stamp) -> Result<&[VotesHeader], PeakError> {
        let found = self.by_map.get(stamp);
        Ok(found.ok_or(PeakError::UnknownParts)?.1)
    }

    pub fn get(&self, stamp: Stamp) -> Result<Scan<'_>, PeakError> {
        let (header, ranges) = self.kept.get(stamp).ok_or(PeakError::UnknownScan)?;
        Ok(Scan::of(header, ranges))
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;

    fn header(counter: u64) -> ScanHeader {
        ScanHeader {
            stamp: Stamp {
                counter,
                ..Stamp::default()
            },
            angle_increment: 0.5,
            ..Zeroable::zeroed()
        }
    }

    #[test]
    fn the_last_scans_are_found_by_their_stamp() {
        let mut scans = Scans::default();
        for counter in 0..=KEPT as u64 {
            scans.receive(&header(counter), &[counter as f32]);
        }
        let ranges = |counter| {
            scans
                .get(header(counter).stamp)
                .map(|scan| scan.ranges.to_vec())
        };
        assert_eq!(ranges(1).unwrap(), [1.0]);
        assert_eq!(ranges(KEPT as u64).unwrap(), [KEPT as f32]);
        assert!(matches!(ranges(0), Err(PeakError::UnknownScan)));
    }
}
