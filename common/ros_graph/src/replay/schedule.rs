//! Decides what to do next, and when; the caller passes the clock in.
//!
//! At a factor each message is due at its original, scaled distance from the first one, so that
//! errors do not accumulate; at `max` the next message follows the answer to the last scan. At the
//! end the answer to the last scan is awaited in both cases.

use messages::Stamp;

use crate::replay::Rate;

/// Next step of the caller. Times are `CLOCK_MONOTONIC` in nanoseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Action {
    Send,
    /// Sleep until this time, when the message is due.
    SleepUntil(i64),
    /// Wait for the answer to the last scan, or its timeout.
    AwaitAnswer,
    /// The answer to this scan has timed out.
    GiveUp(Stamp),
    /// Everything has been replayed, and answered or timed out.
    Done,
}

/// Pair of corresponding times of the recording and the clock.
#[derive(Debug, Clone, Copy)]
struct Anchor {
    log_ns: i64,
    clock_ns: i64,
}

#[derive(Debug)]
pub struct Schedule {
    rate: Rate,
    patience_ns: i64,
    anchor: Option<Anchor>,
    /// Time at which the last message was due, on the clock.
    last_due_ns: i64,
    /// Earliest time for the first message of this round.
    not_before_ns: i64,
    awaited: Option<Stamp>,
}

impl Schedule {
    /// Starts a schedule; an answer times out after `patience_s` seconds.
    pub fn new(rate: Rate, patience_s: f64) -> Self {
        Schedule {
            rate,
            patience_ns: (patience_s * 1e9) as i64,
            anchor: None,
            last_due_ns: i64::MIN,
            not_before_ns: i64::MIN,
            awaited: None,
        }
    }

    /// Returns the next step at `now_ns`; `pending_ns` is the log time of the next message, if
    /// there is one.
    pub fn next(&mut self, pending_ns: Option<i64>, now_ns: i64) -> Action {
        if let Some(stamp) = self.awaited
            && (self.rate == Rate::Max || pending_ns.is_none())
        {
            // A scan enters the graph when it is sent.
            if now_ns - stamp.entered_ns < self.patience_ns {
                return Action::AwaitAnswer;
            }
            self.awaited = None;
            return Action::GiveUp(stamp);
        }
        let Some(log_ns) = pending_ns else {
            return Action::Done;
        };
        let due_ns = self.due(log_ns, now_ns);
        if due_ns > now_ns {
            return Action::SleepUntil(due_ns);
        }
        self.last_due_ns = due_ns;
        Action::Send
    }

    pub fn scan_sent(&mut self, stamp: Stamp) {
        self.awaited = Some(stamp);
    }

    /// Stamp of the scan whose answer is awaited.
    pub fn awaited(&self) -> Option<Stamp> {
        self.awaited
    }

    pub fn answered(&mut self, stamp: Stamp) {
        if self.awaited.is_some_and(|awaited| awaited.is_of(stamp)) {
            self.awaited = None;
        }
    }

    /// Starts the recording again, `gap_ns` of its time after its last message.
    pub fn start_over(&mut self, gap_ns: i64) {
        self.anchor = None;
        self.not_before_ns = self.last_due_ns.saturating_add(self.scaled(gap_ns));
    }

    /// Continues after a pause: the next message is due at once.
    pub fn resume(&mut self) {
        self.anchor = None;
        self.not_before_ns = i64::MIN;
    }

    fn due(&mut self, log_ns: i64, now_ns: i64) -> i64 {
        if self.rate == Rate::Max {
            return now_ns;
        }
        let not_before_ns = self.not_before_ns;
        let anchor = *self.anchor.get_or_insert(Anchor {
            log_ns,
            clock_ns: now_ns.max(not_before_ns),
        });
        anchor
            .clock_ns
            .saturating_add(self.scaled(log_ns.saturating_sub(anchor.log_ns)))
    }

    /// Converts a duration of the recording to the clock.
    fn scaled(&self, recorded_ns: i64) -> i64 {
        match self.rate {
            Rate::Factor(factor) => (recorded_ns as f64 / factor) as i64,
            Rate::Max => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;
    /// Recordings have much later times than a clock that started at boot.
    const LOG: i64 = 1_700_000_000_000 * MS;

    fn at(log_ms: i64) -> Option<i64> {
        Some(LOG + log_ms * MS)
    }

    fn stamp(counter: u64, entered_ms: i64) -> Stamp {
        Stamp {
            measured_ns: 0,
            entered_ns: entered_ms * MS,
            counter,
        }
    }

    #[test]
    fn the_original_distances_scaled_without_drift() {
        for (factor, stretch) in [(1.0, 100), (2.0, 50), (0.1, 1000)] {
            let mut schedule = Schedule::new(Rate::Factor(factor), 1.0);
            assert_eq!(schedule.next(at(0), 5 * MS), Action::Send);
            for step in 1..1000 {
                let due = (5 + step * stretch) * MS;
                let pending = at(step * 100);
                assert_eq!(schedule.next(pending, due - 1), Action::SleepUntil(due));
                // Each wake-up is late by a millisecond, which does not shift the next due time.
                assert_eq!(schedule.next(pending, due + MS), Action::Send);
            }
        }
    }

    #[test]
    fn what_is_overdue_is_sent_at_once() {
        let mut schedule = Schedule::new(Rate::Factor(1.0), 1.0);
        schedule.next(at(0), 0);
        assert_eq!(schedule.next(at(10), 50 * MS), Action::Send);
        assert_eq!(schedule.next(at(-10), 50 * MS), Action::Send);
    }

    #[test]
    fn at_a_factor_only_the_last_answer_is_waited_for() {
        let mut schedule = Schedule::new(Rate::Factor(1.0), 1.0);
        schedule.next(at(0), 0);
        schedule.scan_sent(stamp(0, 0));
        assert_eq!(schedule.next(at(10), 10 * MS), Action::Send);
        schedule.scan_sent(stamp(1, 10));
        schedule.answered(stamp(0, 0));
        assert_eq!(schedule.next(None, 11 * MS), Action::AwaitAnswer);
        schedule.answered(stamp(1, 10));
        assert_eq!(schedule.next(None, 12 * MS), Action::Done);
    }

    #[test]
    fn at_max_everything_waits_for_the_answer() {
        let mut schedule = Schedule::new(Rate::Max, 1.0);
        assert_eq!(schedule.next(at(0), 0), Action::Send);
        schedule.scan_sent(stamp(0, 0));
        assert_eq!(schedule.next(at(9999), MS), Action::AwaitAnswer);
        // The same counter with another measuring time is another scan; the time of entering the
        // graph does not matter.
        schedule.answered(Stamp {
            measured_ns: 7,
            ..stamp(0, 0)
        });
        assert_eq!(schedule.next(at(9999), MS), Action::AwaitAnswer);
        schedule.answered(stamp(0, 7));
        assert_eq!(schedule.next(at(9999), MS), Action::Send);
        assert_eq!(schedule.next(None, MS), Action::Done);
    }

    #[test]
    fn patience_ends_and_the_run_goes_on() {
        let mut schedule = Schedule::new(Rate::Max, 0.5);
        schedule.scan_sent(stamp(3, 100));
        assert_eq!(schedule.next(at(0), 599 * MS), Action::AwaitAnswer);
        let given_up = Action::GiveUp(stamp(3, 100));
        assert_eq!(schedule.next(at(0), 600 * MS), given_up);
        assert_eq!(schedule.next(at(0), 600 * MS), Action::Send);
    }

    #[test]
    fn a_new_round_keeps_its_distance_from_the_last() {
        let mut schedule = Schedule::new(Rate::Factor(2.0), 1.0);
        schedule.next(at(0), 0);
        assert_eq!(schedule.next(at(1000), 501 * MS), Action::Send);
        schedule.start_over(200 * MS);
        let due = 600 * MS;
        assert_eq!(schedule.next(at(0), 502 * MS), Action::SleepUntil(due));
        assert_eq!(schedule.next(at(0), 603 * MS), Action::Send);
        let due = 1100 * MS;
        assert_eq!(schedule.next(at(1000), 604 * MS), Action::SleepUntil(due));
    }

    #[test]
    fn a_pause_is_not_made_up_for() {
        let mut schedule = Schedule::new(Rate::Factor(1.0), 1.0);
        assert_eq!(schedule.next(at(0), 0), Action::Send);
        schedule.resume();
        assert_eq!(schedule.next(at(100), 900 * MS), Action::Send);
        assert_eq!(
            schedule.next(at(200), 901 * MS),
            Action::SleepUntil(1000 * MS)
        );
    }
}
