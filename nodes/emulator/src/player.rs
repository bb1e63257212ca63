//! Schedules the messages of the drive.
//!
//! Pure: the caller passes the time. Playback starts on the first request for scans, and keeps the
//! recording's times or waits for the answer to each scan. Answers do not identify telegrams: an
//! answer belongs to the last scan if its scan entered the graph after that one was sent.

use messages::Stamp;
use ros_graph::replay::{Action, Rate, Schedule};

use crate::drive::Happening;

#[derive(Debug)]
pub(crate) struct Player {
    happenings: Vec<(i64, Happening)>,
    /// Time from the last event to the first of the next round, nanoseconds.
    gap_ns: i64,
    rate: Rate,
    looped: bool,
    schedule: Schedule,
    has_started: bool,
    is_over: bool,
    next: usize,
    wake_ns: Option<i64>,
    /// Number of scans that were due so far, over all rounds.
    scans: u64,
    /// Number of scans without an answer.
    pub(crate) unanswered: u64,
}

impl Player {
    pub(crate) fn new(
        happenings: Vec<(i64, Happening)>,
        rate: Rate,
        looped: bool,
        patience_s: f64,
    ) -> Self {
        let is_scan = |(_, happening): &&(i64, Happening)| matches!(happening, Happening::Scan(_));
        let gaps = happenings.iter().filter(is_scan).count().saturating_sub(1);
        let time = |entry: Option<&(i64, Happening)>| entry.map_or(0, |(log_ns, _)| *log_ns);
        let whole_ns = time(happenings.last()).saturating_sub(time(happenings.first()));
        Player {
            gap_ns: (whole_ns / gaps.max(1) as i64).max(1_000_000),
            happenings,
            rate,
            looped,
            schedule: Schedule::new(rate, patience_s),
            has_started: false,
            is_over: false,
            next: 0,
            wake_ns: None,
            scans: 0,
            unanswered: 0,
        }
    }

    pub(crate) fn start(&mut self) {
        self.has_started = true;
    }

    /// Returns the time of the next event; `None` if playback waits for a client or an answer.
    pub(crate) fn wake_ns(&self) -> Option<i64> {
        self.wake_ns
    }

    pub(crate) fn awaits_answer(&self) -> bool {
        self.rate == Rate::Max && self.schedule.awaited().is_some()
    }

    pub(crate) fn take(&mut self, now_ns: i64) -> Option<&Happening> {
        self.wake_ns = None;
        while self.has_started && !self.is_over {
            let pending_ns = self.happenings.get(self.next).map(|(log_ns, _)| *log_ns);
            match self.schedule.next(pending_ns, now_ns) {
                Action::Send => return self.advance(),
                Action::SleepUntil(due_ns) => {
                    self.wake_ns = Some(due_ns);
                    break;
                }
                Action::AwaitAnswer => break,
                Action::GiveUp(stamp) => {
                    self.unanswered += 1;
                    tracing::warn!(scan = stamp.counter, "got no answer on `hypotheses`");
                }
                Action::Done => self.is_over = true,
            }
        }
        None
    }

    fn advance(&mut self) -> Option<&Happening> {
        let at = self.next;
        self.next += 1;
        if self.looped && self.next == self.happenings.len() {
            self.next = 0;
            self.schedule.start_over(self.gap_ns);
        }
        let (_, happening) = self.happenings.get(at)?;
        self.scans += u64::from(matches!(happening, Happening::Scan(_)));
        Some(happening)
    }

    /// Returns the number of scans before the last one.
    pub(crate) fn counter(&self) -> u64 {
        self.scans.saturating_sub(1)
    }

    /// Records that the last scan was sent intact at `now_ns`, so that an answer is expected.
    pub(crate) fn sent(&mut self, now_ns: i64) {
        if self.rate == Rate::Max {
            self.schedule.scan_sent(Stamp {
                measured_ns: 0,
                entered_ns: now_ns,
                counter: self.counter(),
            });
        }
    }

    /// Records the answer to a scan that entered the graph at `entered_ns`.
    pub(crate) fn answered(&mut self, entered_ns: i64) {
        if let Some(awaited) = self.schedule.awaited()
            && entered_ns >= awaited.entered_ns
        {
            self.schedule.answered(awaited);
        }
    }

    pub(crate) fn is_over(&self) -> bool {
        self.is_over
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    fn player(times_ms: &[i64], rate: Rate, looped: bool) -> Player {
        let scans = times_ms.iter().enumerate();
        let happenings = scans.map(|(i, ms)| (ms * MS, Happening::Scan(i))).collect();
        Player::new(happenings, rate, looped, 1.0)
    }

    /// Returns index and counter of the scan that is due.
    fn take(player: &mut Player, now_ns: i64) -> Option<(usize, u64)> {
        match player.take(now_ns)? {
            &Happening::Scan(index) => Some((index, player.counter())),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_original_distances_from_the_start_on() {
        let mut player = player(&[700, 800, 950], Rate::Factor(0.5), false);
        assert_eq!(take(&mut player, i64::MAX), None, "nobody wants scans yet");
        player.start();
        assert_eq!(take(&mut player, 5 * MS), Some((0, 0)));
        assert_eq!(take(&mut player, 204 * MS), None);
        assert_eq!(player.wake_ns(), Some(205 * MS));
        assert_eq!(take(&mut player, 205 * MS), Some((1, 1)));
        // Calling late does not delay the following events.
        assert_eq!(take(&mut player, 206 * MS), None);
        assert_eq!(player.wake_ns(), Some(505 * MS));
        assert_eq!(take(&mut player, 600 * MS), Some((2, 2)));
        assert!(!player.is_over());
        assert_eq!(take(&mut player, 600 * MS), None);
        assert!(player.is_over() && player.wake_ns().is_none());
    }

    #[test]
    fn a_new_round_keeps_the_usual_distance() {
        let mut player = player(&[0, 100, 200], Rate::Factor(1.0), true);
        player.start();
        for step in 0..10 {
            let at_ns = step * 100 * MS;
            if step > 0 {
                assert_eq!(take(&mut player, at_ns - 1), None, "{step}");
            }
            assert_eq!(
                take(&mut player, at_ns),
                Some(((step % 3) as usize, step as u64))
            );
        }
        assert!(!player.is_over());
    }

    #[test]
    fn at_max_each_scan_waits_for_an_answer_to_the_one_before() {
        let mut player = player(&[0, 100, 200], Rate::Max, false);
        player.start();
        assert_eq!(take(&mut player, 10), Some((0, 0)));
        player.sent(10);
        assert!(player.awaits_answer());
        player.answered(9);
        assert_eq!(take(&mut player, 11), None, "that scan came in before");
        player.answered(12);
        assert_eq!(take(&mut player, 13), Some((1, 1)));
        // The answer to a lost scan is not awaited.
        assert_eq!(take(&mut player, 14), Some((2, 2)));
        player.sent(14);
        assert_eq!(take(&mut player, 15), None);
        assert!(!player.is_over(), "the last answer is waited for as well");
        assert_eq!(take(&mut player, 14 + 1000 * MS), None);
        assert!(player.is_over());
        assert_eq!(player.unanswered, 1);
    }
}
