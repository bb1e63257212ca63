//! Joins the answer to a scan alone and the tracker's pose to a row, in either order. Pure.
//!
//! A row is due once it has both. The pose of a later scan ends the wait: a scan may not have been
//! searched, or be answered after the next one is tracked.

use std::collections::VecDeque;

use messages::Stamp;

use super::answer::ScanAnswer;
use super::tracked::{Row, TrackedPose};

/// Largest number of answers that wait for their poses, so that a dead tracker does not hold them
/// back.
const CAPACITY: usize = 16;

/// Answers and poses that wait for the other half.
#[derive(Debug, Default)]
pub struct Rows {
    waiting: VecDeque<(Stamp, Row)>,
    /// Scan of the last row returned.
    printed: Option<Stamp>,
}

impl Rows {
    /// Adds the answer to a scan alone; returns the rows that are due.
    pub fn answer(&mut self, scan: Stamp, single: ScanAnswer) -> Vec<Row> {
        let set = |row: &mut Row| row.single = Some(single);
        self.add(scan, set, |rows, row| {
            rows.waiting.push_back((scan, row));
            rows.release(rows.waiting.len().saturating_sub(CAPACITY))
        })
    }

    /// Adds the tracker's pose of a scan; returns the rows that are due.
    pub fn pose(&mut self, scan: Stamp, pose: TrackedPose) -> Vec<Row> {
        let set = |row: &mut Row| row.pose = Some(pose);
        self.add(scan, set, |rows, row| {
            let waiting = rows.waiting.iter();
            let earlier = waiting.take_while(|(waiting, _)| is_before(*waiting, scan));
            let released = rows.release(earlier.count());
            rows.waiting.push_front((scan, row));
            released
        })
    }

    /// Sets a half of a scan's row, which makes the row due if the other half is there; `wait`
    /// queues the row of a new scan.
    fn add(
        &mut self,
        scan: Stamp,
        set: impl FnOnce(&mut Row),
        wait: impl FnOnce(&mut Self, Row) -> Vec<Row>,
    ) -> Vec<Row> {
        let mut waiting = self.waiting.iter_mut().enumerate();
        if let Some((at, (_, row))) = waiting.find(|(_, (waiting, _))| waiting.is_of(scan)) {
            set(row);
            return self.release(at + 1);
        }
        if self.is_printed(scan) {
            return Vec::new();
        }
        let mut row = Row {
            stamp_ns: scan.measured_ns,
            single: None,
            pose: None,
        };
        set(&mut row);
        wait(self, row)
    }

    pub fn finish(&mut self) -> Vec<Row> {
        self.release(self.waiting.len())
    }

    /// True if the row of a scan was returned, before its other half or that of a later scan came.
    fn is_printed(&self, scan: Stamp) -> bool {
        let is_printed = |printed: Stamp| printed.is_of(scan) || is_before(scan, printed);
        self.printed.is_some_and(is_printed)
    }

    fn release(&mut self, rows: usize) -> Vec<Row> {
        let released: Vec<_> = self.waiting.drain(..rows).collect();
        if let Some((scan, _)) = released.last() {
            self.printed = Some(*scan);
        }
        released.into_iter().map(|(_, row)| row).collect()
    }
}

/// True if a scan came before another of the same sender. The counter of a restarted sender begins
/// again, at a later time.
fn is_before(scan: Stamp, other: Stamp) -> bool {
    scan.counter < other.counter && scan.entered_ns <= other.entered_ns
}

#[cfg(test)]
mod tests {
    use messages::{TrackState, Verdict};

    use super::*;
    use crate::testing::{answer as single, message, pose};

    /// Returns the stamps of answer and pose of each row, which equal their counters.
    fn printed(rows: &[Row]) -> Vec<(Option<i64>, Option<i64>)> {
        let show = |row: &Row| {
            let single = row.single.as_ref().map(|line| line.stamp_ns);
            (single, row.pose.as_ref().map(|pose| pose.stamp_ns))
        };
        rows.iter().map(show).collect()
    }

    fn answer(rows: &mut Rows, counter: u64) -> Vec<(Option<i64>, Option<i64>)> {
        let (header, found) = message(counter as i64, counter, Verdict::Unique as u32);
        printed(&rows.answer(header.stamp, single(&header, &found)))
    }

    fn track(rows: &mut Rows, counter: u64) -> Vec<(Option<i64>, Option<i64>)> {
        let header = pose(counter as i64, counter, TrackState::Unique);
        printed(&rows.pose(header.stamp, TrackedPose::new(&header, b"")))
    }

    #[test]
    fn a_row_is_printed_once_both_are_there() {
        let mut rows = Rows::default();
        assert_eq!(answer(&mut rows, 1), []);
        assert_eq!(track(&mut rows, 1), [(Some(1), Some(1))]);
        assert_eq!(track(&mut rows, 2), []);
        assert_eq!(answer(&mut rows, 2), [(Some(2), Some(2))]);
        // The tracker is slower than the search.
        assert_eq!(answer(&mut rows, 3), []);
        assert_eq!(answer(&mut rows, 4), []);
        assert_eq!(track(&mut rows, 3), [(Some(3), Some(3))]);
        assert_eq!(track(&mut rows, 4), [(Some(4), Some(4))]);
        assert_eq!(printed(&rows.finish()), []);
    }

    #[test]
    fn a_scan_that_is_not_searched_waits_for_the_next_pose_alone() {
        let mut rows = Rows::default();
        assert_eq!(track(&mut rows, 1), []);
        assert_eq!(track(&mut rows, 2), [(None, Some(1))]);
        // The answer to the first scan is late: its row was printed.
        assert_eq!(answer(&mut rows, 1), []);
        assert_eq!(answer(&mut rows, 2), [(Some(2), Some(2))]);
        assert_eq!(track(&mut rows, 3), []);
        assert_eq!(printed(&rows.finish()), [(None, Some(3))]);
    }

    #[test]
    fn a_tracker_that_ended_does_not_keep_answers_back() {
        let mut rows = Rows::default();
        for counter in 0..CAPACITY as u64 {
            assert_eq!(answer(&mut rows, counter), []);
        }
        assert_eq!(answer(&mut rows, 99), [(Some(0), None)]);
        assert_eq!(track(&mut rows, 0), [], "a scan has one row");
        assert_eq!(rows.finish().len(), CAPACITY);
    }

    #[test]
    fn a_source_that_was_started_again_counts_again() {
        let mut rows = Rows::default();
        assert_eq!(answer(&mut rows, 7), []);
        assert_eq!(track(&mut rows, 7), [(Some(7), Some(7))]);
        let (mut header, found) = message(9, 0, Verdict::Unique as u32);
        header.stamp.entered_ns += 1;
        rows.answer(header.stamp, single(&header, &found));
        let mut again = pose(9, 0, TrackState::Unique);
        again.stamp = header.stamp;
        let rows = rows.pose(again.stamp, TrackedPose::new(&again, b""));
        assert_eq!(printed(&rows), [(Some(9), Some(9))]);
    }
}
