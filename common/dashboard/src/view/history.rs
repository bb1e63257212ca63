//! States of the last hour: start, reason, and the robot's poses.

use std::collections::VecDeque;

use messages::Pose2;
use serde::Serialize;

use super::{Answer, Tracked, push_within};

const KEPT_NS: i64 = 3600 * 1_000_000_000;

/// Maximum number of states, in case they change fast.
const CAPACITY: usize = 300;

/// Without a scan for this time, the state is `NoData`.
const SILENT_AFTER_NS: i64 = 2_000_000_000;

const NO_DATA: &str = "NoData";

/// A state of the robot, which lasts until the next one begins.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Period<'a> {
    /// The tracker's state or, without a tracker, the verdict; `NoData` without scans.
    pub(crate) state: &'static str,
    pub(crate) why: &'a str,
    /// Time since the state began.
    pub(crate) ago_s: f64,
    /// Pose at the start of the state: of the base or, if its mount is not known, of the laser.
    pub(crate) first: Option<Pose2>,
    /// Pose of the last scan in this state, in the same frame as `first`.
    pub(crate) last: Option<Pose2>,
}

/// A robot's new state, and the one before, as posted to a webhook.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct StateChange<'a> {
    pub(crate) robot: &'a str,
    /// `None` if it is not known (a graph on another machine).
    pub(crate) graph: Option<&'a str>,
    /// Start of the new state, in seconds since 1970.
    pub(crate) since_s: f64,
    /// The state before; `None` for the first one.
    pub(crate) before: Option<&'static str>,
    pub(crate) before_pose: Option<Pose2>,
    #[serde(flatten)]
    pub(crate) period: Period<'a>,
}

#[derive(Debug)]
struct Entry {
    state: &'static str,
    why: String,
    from_ns: i64,
    first: Option<Pose2>,
    last: Option<Pose2>,
}

#[derive(Debug, Default)]
pub(crate) struct History {
    entries: VecDeque<Entry>,
}

impl History {
    /// Takes the result of a scan, in graphs without a tracker; true if a state begins.
    pub(crate) fn on_answer(&mut self, answer: &Answer, now_ns: i64) -> bool {
        let answer = &answer.answer;
        let pose = answer.best.base.or(answer.best.laser);
        self.add(answer.verdict, &answer.says, pose, now_ns)
    }

    /// Takes the tracker's pose; true if a state begins.
    pub(crate) fn on_pose(&mut self, pose: &Tracked, now_ns: i64) -> bool {
        let place = &pose.pose.place;
        let at = place.base.or(place.laser);
        self.add(pose.pose.state, &pose.why, at, now_ns)
    }

    /// Checks whether no scan has come since `newest_ns`; true if this begins a state.
    pub(crate) fn look_for_silence(&mut self, newest_ns: Option<i64>, now_ns: i64) -> bool {
        let since_ns = newest_ns.unwrap_or(now_ns);
        let is_silent = now_ns.saturating_sub(since_ns) > SILENT_AFTER_NS;
        is_silent && self.add(NO_DATA, "no scan came", None, since_ns)
    }

    fn add(&mut self, state: &'static str, why: &str, pose: Option<Pose2>, now_ns: i64) -> bool {
        if let Some(entry) = self.entries.back_mut()
            && entry.state == state
        {
            entry.last = pose.or(entry.last);
            return false;
        }
        // The state that held when the hour began stays.
        while let Some(second) = self.entries.get(1)
            && now_ns.saturating_sub(second.from_ns) >= KEPT_NS
        {
            self.entries.pop_front();
        }
        let before_ns = self.entries.back().map_or(i64::MIN, |entry| entry.from_ns);
        let entry = Entry {
            state,
            why: why.to_owned(),
            from_ns: now_ns.max(before_ns),
            first: pose,
            last: pose,
        };
        push_within(CAPACITY, &mut self.entries, entry);
        true
    }

    /// States, oldest first, with ages at `now_ns`.
    pub(crate) fn periods(&self, now_ns: i64) -> impl DoubleEndedIterator<Item = Period<'_>> {
        self.entries.iter().map(move |entry| Period {
            state: entry.state,
            why: &entry.why,
            ago_s: now_ns.saturating_sub(entry.from_ns).max(0) as f64 / 1e9,
            first: entry.first,
            last: entry.last,
        })
    }
}

#[cfg(test)]
mod tests {
    use messages::TrackState;

    use super::super::tracked::tests::{header, tracked as shown};
    use super::*;

    const SECOND: i64 = 1_000_000_000;

    fn tracked(state: TrackState, x: f64) -> Tracked {
        shown(&header(state, x), b"one place: none")
    }

    fn states(history: &History, now_ns: i64) -> Vec<(&'static str, f64)> {
        let periods = history.periods(now_ns);
        periods.map(|period| (period.state, period.ago_s)).collect()
    }

    #[test]
    fn a_state_lasts_until_another_begins() {
        let mut history = History::default();
        assert!(history.on_pose(&tracked(TrackState::Unique, 1.0), SECOND));
        assert!(!history.on_pose(&tracked(TrackState::Unique, 2.0), 2 * SECOND));
        assert!(history.on_pose(&tracked(TrackState::Lost, 3.0), 3 * SECOND));
        let expected = [("Unique", 9.0), ("Lost", 7.0)];
        assert_eq!(states(&history, 10 * SECOND), expected);
        let first = history.periods(0).next().unwrap();
        assert_eq!((first.why, first.ago_s), ("one place", 0.0));
        let ends = (first.first.unwrap().x, first.last.unwrap().x);
        assert_eq!(ends, (1.0, 2.0));
    }

    #[test]
    fn silence_began_with_the_last_scan_and_ends_with_the_next() {
        let mut history = History::default();
        assert!(
            !history.look_for_silence(None, 9 * SECOND),
            "nothing came yet"
        );
        history.on_pose(&tracked(TrackState::Unique, 1.0), SECOND);
        assert!(!history.look_for_silence(Some(SECOND), 3 * SECOND));
        assert!(history.look_for_silence(Some(SECOND), 4 * SECOND));
        assert!(!history.look_for_silence(Some(SECOND), 5 * SECOND), "once");
        assert!(history.on_pose(&tracked(TrackState::Unique, 1.0), 6 * SECOND));
        let expected = [("Unique", 5.0), ("NoData", 5.0), ("Unique", 0.0)];
        assert_eq!(states(&history, 6 * SECOND), expected);
    }

    #[test]
    fn an_hour_and_the_state_before_it_are_kept() {
        let mut history = History::default();
        let pair = [TrackState::Unique, TrackState::Doubtful];
        for (minute, state) in (0..100).zip(pair.into_iter().cycle()) {
            history.on_pose(&tracked(state, 0.0), minute * 60 * SECOND);
        }
        let kept = states(&history, 99 * 60 * SECOND);
        assert_eq!((kept.len(), kept[0].1), (61, 3600.0));
        for (at, state) in (6000..7000).zip(pair.into_iter().cycle()) {
            history.on_pose(&tracked(state, 0.0), at * SECOND);
        }
        assert_eq!(history.periods(0).count(), CAPACITY);
    }
}
