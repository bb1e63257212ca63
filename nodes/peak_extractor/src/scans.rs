//! Recent scans and the data derived from them, kept until their votes arrive.

use std::collections::VecDeque;

use engine::scan::Scan;
use messages::{Reading, ScanHeader, Stamp, VotesHeader};

use crate::PeakError;

/// Number of scans kept, far more than ever wait for the search.
const KEPT: usize = 64;

#[derive(Debug, Default)]
pub struct Scans {
    /// Scans, newest last.
    kept: VecDeque<(ScanHeader, Vec<f32>)>,
    /// Beams of scans that were joined or deskewed, newest last.
    readings: VecDeque<(Stamp, Vec<Reading>)>,
    /// Vote headers by map, newest last.
    by_map: VecDeque<(Stamp, Vec<VotesHeader>)>,
}

impl Scans {
    /// Stores a scan, reusing the buffer of the oldest one.
    pub fn receive(&mut self, header: &ScanHeader, ranges: &[f32]) {
        let mut room = match self.kept.len() {
            KEPT => self
                .kept
                .pop_front()
                .map_or_else(Vec::new, |(_, room)| room),
            _ => Vec::new(),
        };
        room.clear();
        room.extend_from_slice(ranges);
        self.kept.push_back((*header, room));
    }

    /// Stores the beams of a scan that was joined or deskewed.
    pub fn take_readings(&mut self, stamp: Stamp, readings: &[Reading]) {
        if self.readings.len() == KEPT {
            self.readings.pop_front();
        }
        self.readings.push_back((stamp, readings.to_vec()));
    }

    /// Returns the beams of the scan with this stamp.
    ///
    /// # Errors
    /// If they were not received, or too long ago.
    pub fn readings(&self, stamp: Stamp) -> Result<&[Reading], PeakError> {
        let mut newest_first = self.readings.iter().rev();
        let found = newest_first.find(|(of, _)| of.is_of(stamp));
        found
            .map(|(_, readings)| &readings[..])
            .ok_or(PeakError::UnknownScan)
    }

    /// Stores the headers of the votes on each map.
    pub fn take_by_map(&mut self, stamp: Stamp, maps: &[VotesHeader]) {
        if self.by_map.len() == KEPT {
            self.by_map.pop_front();
        }
        self.by_map.push_back((stamp, maps.to_vec()));
    }

    /// Returns the headers of the votes on each map of the scan with this stamp.
    ///
    /// # Errors
    /// If they were not received, or too long ago.
    pub fn by_map(&self, stamp: Stamp) -> Result<&[VotesHeader], PeakError> {
        let mut newest_first = self.by_map.iter().rev();
        let found = newest_first.find(|(of, _)| of.is_of(stamp));
        found
            .map(|(_, maps)| &maps[..])
            .ok_or(PeakError::UnknownParts)
    }

    /// Returns the scan with this stamp.
    ///
    /// # Errors
    /// If it was not received, or too long ago.
    pub fn get(&self, stamp: Stamp) -> Result<Scan<'_>, PeakError> {
        let mut newest_first = self.kept.iter().rev();
        let found = newest_first.find(|(header, _)| header.stamp.is_of(stamp));
        let (header, ranges) = found.ok_or(PeakError::UnknownScan)?;
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
