//! Moves messages that were measured before a scan in front of it.
//!
//! A recording is in the order of log times, where odometry or a true pose may follow the scan that
//! it belongs to. A search with a given heading, or the deskewing of a scan, needs it first. So a
//! scan is held back until everything that was recorded shortly after it has been read. All other
//! messages keep their order; memory is bounded by the window.

use std::collections::VecDeque;

use crate::replay::source::Timed;

/// Largest delay in log time of a message that is still moved before a scan, in nanoseconds.
const WINDOW_NS: i64 = 500_000_000;

/// Largest lag of odometry behind the scans that still covers the motion within them, in
/// nanoseconds.
const MARGIN_NS: i64 = 250_000_000;

/// Iterator over the same items, including errors, in playing order.
pub struct InOrder<I, E> {
    items: I,
    ended: bool,
    newest_ns: i64,
    /// Stamp of the last odometry that was returned.
    odometry_ns: i64,
    ahead: VecDeque<Result<Timed, E>>,
}

impl<E, I: Iterator<Item = Result<Timed, E>>> InOrder<I, E> {
    /// Reorders items that are sorted by log time.
    pub fn new(items: I) -> Self {
        InOrder {
            items,
            ended: false,
            newest_ns: i64::MIN,
            odometry_ns: i64::MIN,
            ahead: VecDeque::new(),
        }
    }

    /// Reads ahead until the first item can be returned.
    fn look_ahead(&mut self) {
        while !self.ended && !self.sees_far_enough() {
            match self.items.next() {
                Some(item) => {
                    if let Ok(timed) = &item {
                        self.newest_ns = timed.log_time_ns;
                    }
                    self.ahead.push_back(item);
                }
                None => self.ended = true,
            }
        }
    }

    fn sees_far_enough(&self) -> bool {
        match self.ahead.front() {
            None => false,
            Some(Ok(scan)) if scan.is_scan() => {
                self.newest_ns.saturating_sub(scan.log_time_ns) > WINDOW_NS
            }
            Some(_) => true,
        }
    }

    /// Takes the next item behind the front scan that was measured by the time of the scan, or
    /// odometry that covers the motion within it.
    fn take_overdue(&mut self) -> Option<Timed> {
        let scan = self
            .ahead
            .front()?
            .as_ref()
            .ok()
            .filter(|item| item.is_scan())?;
        let (stamp_ns, due_ns) = (scan.stamp_ns(), scan.log_time_ns);
        let needed_until_ns = scan
            .motion_until_ns()
            .map(|ns| ns.saturating_add(MARGIN_NS));
        let lacks_odometry = needed_until_ns.is_some_and(|until_ns| self.odometry_ns < until_ns);
        let belongs = |item: &Timed| {
            let delay_ns = item.log_time_ns.saturating_sub(due_ns);
            let by_then = item.stamp_ns() <= stamp_ns || (lacks_odometry && item.is_odometry());
            !item.is_scan() && by_then && delay_ns <= WINDOW_NS
        };
        let mut items = self.ahead.iter();
        let index = items.position(|item| item.as_ref().is_ok_and(belongs))?;
        let mut overdue = self.ahead.remove(index)?.ok()?;
        overdue.log_time_ns = due_ns;
        Some(overdue)
    }
}

impl<E, I: Iterator<Item = Result<Timed, E>>> Iterator for InOrder<I, E> {
    type Item = Result<Timed, E>;

    /// Returns the next item; log times never decrease.
    fn next(&mut self) -> Option<Self::Item> {
        self.look_ahead();
        let overdue = self.take_overdue().map(Ok);
        let item = overdue.or_else(|| self.ahead.pop_front())?;
        if let Ok(timed) = &item
            && timed.is_odometry()
        {
            self.odometry_ns = timed.stamp_ns();
        }
        Some(item)
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{GroundTruth, Odometry, ScanHeader};
    use proptest::prelude::*;

    use super::*;
    use crate::replay::source::Content;

    const MS: i64 = 1_000_000;

    fn scan(log_ms: i64, stamp_ms: i64) -> Timed {
        let mut header = ScanHeader::zeroed();
        header.stamp.measured_ns = stamp_ms * MS;
        Timed {
            log_time_ns: log_ms * MS,
            content: Content::Scan(Box::new(header), Vec::new()),
        }
    }

    fn truth(log_ms: i64, stamp_ms: i64) -> Timed {
        let mut truth = GroundTruth::zeroed();
        truth.stamp.measured_ns = stamp_ms * MS;
        Timed {
            log_time_ns: log_ms * MS,
            content: Content::GroundTruth(Box::new(truth)),
        }
    }

    /// Formats items as `s` or `t`, the stamp, and the time when they are due, in milliseconds.
    fn played(items: Vec<Timed>) -> Vec<String> {
        let items = items.into_iter().map(Ok::<_, String>);
        let show = |item: Timed| {
            let letter = if item.is_scan() { 's' } else { 't' };
            format!("{letter}{}@{}", item.stamp_ns() / MS, item.log_time_ns / MS)
        };
        InOrder::new(items)
            .map(|item| show(item.unwrap()))
            .collect()
    }

    #[test]
    fn a_late_truth_comes_before_its_scan_and_is_due_with_it() {
        let items = vec![scan(10, 5), truth(12, 5), scan(20, 15), truth(21, 15)];
        assert_eq!(played(items), ["t5@10", "s5@10", "t15@20", "s15@20"]);
    }

    #[test]
    fn odometry_comes_before_the_scan_whose_motion_it_shows() {
        let odometry = |log_ms: i64| {
            let mut odometry = Odometry::zeroed();
            odometry.stamp.measured_ns = log_ms * MS;
            Timed {
                log_time_ns: log_ms * MS,
                content: Content::Odometry(Box::new(odometry)),
            }
        };
        let mut moving = scan(10, 10);
        if let Content::Scan(header, ranges) = &mut moving.content {
            header.time_increment_s = 0.05;
            *ranges = vec![1.0; 3];
        }
        // Its last beam is at 110 ms, and the odometry may lag.
        let items = vec![
            moving,
            odometry(100),
            odometry(300),
            odometry(400),
            odometry(480),
        ];
        let expected = ["t100@10", "t300@10", "t400@10", "s10@10", "t480@480"];
        assert_eq!(played(items), expected);
        let items = vec![scan(10, 10), odometry(100)];
        assert_eq!(played(items), ["s10@10", "t100@100"]);
    }

    #[test]
    fn what_was_measured_after_the_scan_stays_behind_it() {
        let items = vec![truth(9, 4), scan(10, 5), truth(11, 6), scan(20, 6)];
        assert_eq!(played(items), ["t4@9", "s5@10", "t6@11", "s6@20"]);
    }

    #[test]
    fn what_comes_too_late_is_not_waited_for() {
        let items = vec![scan(0, 0), truth(501, 0), scan(502, 500)];
        assert_eq!(played(items), ["s0@0", "t0@501", "s500@502"]);
    }

    #[test]
    fn errors_keep_their_place() {
        let items = vec![Ok(scan(0, 0)), Err("bad"), Ok(truth(1, 0)), Err("end")];
        let seen: Vec<_> = InOrder::new(items.into_iter())
            .map(|item| item.map(|item| item.is_scan()))
            .collect();
        assert_eq!(seen, [Ok(false), Ok(true), Err("bad"), Err("end")]);
    }

    proptest! {
        #[test]
        fn nothing_is_lost_scans_keep_their_order_and_time_never_goes_back(
            steps in proptest::collection::vec((0i64..400, -600i64..600, any::<bool>()), 0..60),
        ) {
            let mut log_ms = 0;
            let mut items = Vec::new();
            for (step, lag, is_scan) in steps {
                log_ms += step;
                items.push(if is_scan { scan(log_ms, log_ms) } else { truth(log_ms, log_ms + lag) });
            }
            let read = |item: &Timed| (item.is_scan(), item.stamp_ns());
            let mut expected: Vec<_> = items.iter().map(read).collect();
            let scans: Vec<_> = expected.iter().copied().filter(|item| item.0).collect();
            let ordered: Vec<_> = InOrder::new(items.into_iter().map(Ok::<_, ()>)).map(Result::unwrap).collect();
            let mut found: Vec<_> = ordered.iter().map(read).collect();
            prop_assert_eq!(found.iter().copied().filter(|item| item.0).collect::<Vec<_>>(), scans);
            prop_assert!(ordered.is_sorted_by_key(|item| item.log_time_ns));
            expected.sort_unstable();
            found.sort_unstable();
            prop_assert_eq!(found, expected);
        }
    }
}
