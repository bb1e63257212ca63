//! Recent scans, kept at a common time until a search is requested.

use std::collections::VecDeque;

use engine::joined::{Kept, Seen};
use messages::{ScanHeader, Stamp};

/// Number of scans kept, and of requests waiting for scans that have not arrived.
const KEPT: usize = 64;

#[derive(Debug)]
pub(crate) struct KeptScan {
    pub(crate) header: ScanHeader,
    /// Number of joined lasers; 0 if lasers are not joined.
    pub(crate) lasers: u32,
    pub(crate) kept: Kept,
}

#[derive(Debug, Default)]
pub(crate) struct KeptScans {
    scans: VecDeque<KeptScan>,
    requests: VecDeque<Stamp>,
}

#[derive(Debug)]
pub(crate) enum Asked {
    Search(Box<KeptScan>),
    /// Refuse the request: its scan is no longer kept.
    Refuse(Stamp),
}

impl KeptScans {
    /// Stores a scan, and drops the oldest one if there are too many.
    pub(crate) fn keep(&mut self, header: &ScanHeader, lasers: u32, seen: &Seen<'_>) {
        if self.scans.len() == KEPT {
            self.scans.pop_front();
        }
        self.scans.push_back(KeptScan {
            header: *header,
            lasers,
            kept: Kept::of(seen),
        });
    }

    pub(crate) fn request(&mut self, stamp: Stamp) {
        if self.requests.len() == KEPT {
            self.requests.pop_front();
        }
        self.requests.push_back(stamp);
    }

    /// Returns the next request that can be answered or has to be refused; others keep waiting.
    pub(crate) fn next(&mut self) -> Option<Asked> {
        let newest = self.scans.back()?.header.stamp.counter;
        let at = self
            .requests
            .iter()
            .position(|request| request.counter <= newest)?;
        let request = self.requests.remove(at)?;
        let mut scans = self.scans.iter();
        let found = scans.position(|scan| scan.header.stamp.is_of(request));
        Some(match found.and_then(|at| self.scans.remove(at)) {
            Some(scan) => Asked::Search(Box::new(scan)),
            None => Asked::Refuse(request),
        })
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use engine::scan::Scan;

    use super::*;

    fn stamp(counter: u64) -> Stamp {
        Stamp {
            counter,
            ..Stamp::default()
        }
    }

    fn keep(scans: &mut KeptScans, counter: u64) {
        let header = ScanHeader {
            stamp: stamp(counter),
            ..Zeroable::zeroed()
        };
        let scan = Scan {
            angle_min: 0.0,
            angle_increment: 0.1,
            range_min_m: 0.0,
            range_max_m: 9.0,
            ranges: &[counter as f32],
        };
        scans.keep(&header, 0, &Seen::Still(scan));
    }

    #[test]
    fn requests_wait_for_their_scans_and_old_ones_are_refused() {
        let mut scans = KeptScans::default();
        scans.request(stamp(3));
        assert!(scans.next().is_none());
        (1..=3).for_each(|counter| keep(&mut scans, counter));
        let Some(Asked::Search(found)) = scans.next() else {
            panic!("scan 3 has come");
        };
        assert_eq!(found.header.stamp, stamp(3));
        assert_eq!(found.kept, Kept::of(&found.kept.seen()));
        // Scan 3 might still arrive.
        scans.request(stamp(3));
        assert!(scans.next().is_none());
        (4..=3 + KEPT as u64).for_each(|counter| keep(&mut scans, counter));
        assert!(matches!(scans.next(), Some(Asked::Refuse(of)) if of == stamp(3)));
        scans.request(stamp(2));
        assert!(matches!(scans.next(), Some(Asked::Refuse(of)) if of == stamp(2)));
        assert!(scans.next().is_none());
    }
}
