//! The path of the robot.

use std::collections::VecDeque;

use messages::Pose2;
use serde::Serialize;

use super::{Answer, Tracked, push_within};

/// Maximum number of poses: some minutes.
const CAPACITY: usize = 3000;

/// A pose of the laser: x, y, the first letter of the tracker's state (of the verdict without a
/// tracker), and the heading.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct TrackPoint(f64, f64, char, f64);

/// Poses of the last scans in one map: the tracker's or, without one, the best of each scan.
#[derive(Debug, Default)]
pub(crate) struct Track {
    map_id: String,
    points: VecDeque<TrackPoint>,
    /// True if the poses are the tracker's.
    is_tracked: bool,
}

impl Track {
    /// Takes the best pose of a result; ignored if there is a tracker.
    pub(crate) fn on_answer(&mut self, answer: &Answer) {
        if self.is_tracked {
            return;
        }
        let best = &answer.answer.best;
        self.add(&best.map_id, answer.answer.verdict, best.laser);
    }

    /// Takes the tracker's pose, if it is from a scan. The first one starts a new track.
    pub(crate) fn on_pose(&mut self, pose: &Tracked) {
        if !std::mem::replace(&mut self.is_tracked, true) {
            self.points.clear();
        }
        let pose = &pose.pose;
        if pose.from_scan {
            self.add(&pose.place.map_id, pose.state, pose.place.laser);
        }
    }

    /// Adds a pose; another map starts a new track.
    fn add(&mut self, map_id: &str, word: &str, pose: Option<Pose2>) {
        if map_id != self.map_id {
            map_id.clone_into(&mut self.map_id);
            self.points.clear();
        }
        let Some(pose) = pose else {
            return;
        };
        let rounded = |value: f64| (value * 1e3).round() / 1e3;
        let letter = word.chars().next().unwrap_or('?');
        let (x, y, yaw) = (rounded(pose.x), rounded(pose.y), rounded(pose.yaw));
        push_within(CAPACITY, &mut self.points, TrackPoint(x, y, letter, yaw));
    }

    pub(crate) fn points(&self) -> impl Iterator<Item = &TrackPoint> {
        self.points.iter()
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{HypothesesHeader, Hypothesis, Pose2, TrackState, Verdict};

    use super::super::tracked::tests::{header, tracked};
    use super::*;

    fn answer(map_id: u64, x: f64) -> Answer {
        let header = HypothesesHeader {
            map_id,
            verdict: Verdict::Unique as u32,
            ..Zeroable::zeroed()
        };
        let best = Hypothesis {
            map_id,
            map_from_laser: Pose2::new(x, 0.0, 0.0),
            ..Zeroable::zeroed()
        };
        Answer::new(&header, &[best], &|_| None, 0)
    }

    #[test]
    fn the_newest_poses_of_one_map_are_kept() {
        let mut track = Track::default();
        for i in 0..CAPACITY + 5 {
            track.on_answer(&answer(1, i as f64));
        }
        assert_eq!(track.points().count(), CAPACITY);
        assert_eq!(track.points().next(), Some(&TrackPoint(5.0, 0.0, 'U', 0.0)));
        track.on_answer(&answer(2, 1.0));
        assert_eq!(track.points().count(), 1);
    }

    #[test]
    fn with_a_tracker_the_way_is_its_own() {
        let mut track = Track::default();
        track.on_answer(&answer(0, 9.0));
        let pose = header(TrackState::Doubtful, 1.5);
        track.on_pose(&tracked(&pose, b""));
        track.on_answer(&answer(0, 9.0));
        let mut between = header(TrackState::Unique, 1.6);
        between.from_scan = 0;
        track.on_pose(&tracked(&between, b""));
        let points: Vec<_> = track.points().copied().collect();
        assert_eq!(points, [TrackPoint(1.5, 2.0, 'D', 0.5)]);
    }
}
