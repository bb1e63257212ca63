//! Assembles interleaved partial scans.
//!
//! The mirror turns once for each part, and each part has one value per degree: a scan has two
//! parts at half a degree and four at a quarter. Parts must arrive in order, so that a lost part
//! costs the whole scan and two scans are never mixed.

use super::scan::Scan;

#[derive(Debug, Clone)]
pub struct PartialScans {
    width_deg: usize,
    parts: usize,
    /// Index of the next part expected.
    next: usize,
    readings: Vec<u16>,
}

impl PartialScans {
    /// Creates an assembler for scans of this width and resolution; `None` unless the resolution is
    /// 1, 1/2 or 1/4 of a degree.
    pub fn new(width_deg: u16, resolution_raw_1e2_deg: u16) -> Option<Self> {
        let parts = match resolution_raw_1e2_deg {
            100 => 1,
            50 => 2,
            25 => 4,
            _ => return None,
        };
        let width_deg = usize::from(width_deg);
        Some(PartialScans {
            width_deg,
            parts,
            next: 0,
            readings: vec![0; width_deg * parts + 1],
        })
    }

    /// Adds a part; returns the readings of the whole scan after the last one.
    pub fn add(&mut self, scan: &Scan<'_>) -> Option<&[u16]> {
        let step = usize::from(scan.part?) * self.parts;
        let part = step / 4;
        let expected = self.width_deg + usize::from(part == 0);
        if part == 0 {
            self.next = 0;
        }
        if !step.is_multiple_of(4) || part != self.next || scan.readings.len() != expected {
            self.next = 0;
            return None;
        }
        let places = self.readings.iter_mut().skip(part).step_by(self.parts);
        for (place, reading) in places.zip(scan.readings) {
            *place = reading;
        }
        self.next += 1;
        if self.next < self.parts {
            return None;
        }
        self.next = 0;
        Some(&self.readings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lms2xx::Unit;

    /// Adds the part of this quarter; each reading is its own index in the whole scan.
    fn add(scans: &mut PartialScans, quarter: u8, parts: u16) -> Option<Vec<u16>> {
        let first = u16::from(quarter) * parts / 4;
        let count = if quarter == 0 { 101 } else { 100 };
        let readings: Vec<u16> = (0..count).map(|degree| degree * parts + first).collect();
        let scan = Scan {
            part: Some(quarter),
            ..Scan::new(Unit::Centimetre, &readings)
        };
        scans.add(&scan).map(<[u16]>::to_vec)
    }

    #[test]
    fn parts_interleave_at_every_resolution() {
        for (resolution, quarters) in [(100, vec![0]), (50, vec![0, 2]), (25, vec![0, 1, 2, 3])] {
            let parts = quarters.len() as u16;
            let mut scans = PartialScans::new(100, resolution).unwrap();
            let (&last, before) = quarters.split_last().unwrap();
            for &quarter in before {
                assert_eq!(add(&mut scans, quarter, parts), None);
            }
            let whole = add(&mut scans, last, parts).unwrap();
            assert_eq!(whole, (0..=100 * parts).collect::<Vec<_>>());
        }
        assert!(PartialScans::new(100, 33).is_none());
    }

    #[test]
    fn a_lost_part_costs_its_scan_and_no_other() {
        let mut scans = PartialScans::new(100, 25).unwrap();
        for quarter in [0, 1, 3, 0, 1, 2] {
            assert_eq!(add(&mut scans, quarter, 4), None);
        }
        assert!(add(&mut scans, 3, 4).is_some());
        // A scan at half a degree has no part at a quarter.
        let mut scans = PartialScans::new(100, 50).unwrap();
        assert_eq!(add(&mut scans, 1, 2), None);
    }
}
