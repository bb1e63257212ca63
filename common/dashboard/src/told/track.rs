//! The way that the robot has come.

use std::collections::VecDeque;

use serde::Serialize;

use super::Answer;

/// Poses that are kept: some minutes.
const CAPACITY: usize = 3000;

/// One pose of the way: x, y and the first letter of the verdict.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct TrackPoint(pub(crate) f64, pub(crate) f64, pub(crate) char);

/// The best poses of the last scans, all in one map.
#[derive(Debug, Default)]
pub(crate) struct Track {
    map_id: String,
    points: VecDeque<TrackPoint>,
}

impl Track {
    /// Takes the best pose of an answer, if it has one. In another map a new way
    /// begins.
    pub(crate) fn hear(&mut self, answer: &Answer) {
        if answer.map_id != self.map_id {
            self.map_id.clone_from(&answer.map_id);
            self.points.clear();
        }
        let Some(best) = answer.hypotheses.first() else {
            return;
        };
        if self.points.len() == CAPACITY {
            self.points.pop_front();
        }
        let millimetres = |metres: f64| (metres * 1e3).round() / 1e3;
        let letter = answer.verdict.chars().next().unwrap_or('?');
        let (x, y) = (millimetres(best.laser.x), millimetres(best.laser.y));
        self.points.push_back(TrackPoint(x, y, letter));
    }

    /// The poses, oldest first.
    pub(crate) fn points(&self) -> impl Iterator<Item = &TrackPoint> {
        self.points.iter()
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{HypothesesHeader, Hypothesis, Pose2, Verdict};

    use super::*;

    fn answer(map_id: u64, x: f64) -> Answer {
        let header = HypothesesHeader {
            map_id,
            verdict: Verdict::Unique as u32,
            ..Zeroable::zeroed()
        };
        let best = Hypothesis {
            map_from_laser: Pose2 {
                x,
                y: 0.0,
                yaw: 0.0,
            },
            ..Zeroable::zeroed()
        };
        Answer::new(&header, &[best], 0)
    }

    #[test]
    fn the_newest_poses_of_one_map_are_kept() {
        let mut track = Track::default();
        for i in 0..CAPACITY + 5 {
            track.hear(&answer(1, i as f64));
        }
        assert_eq!(track.points().count(), CAPACITY);
        assert_eq!(track.points().next(), Some(&TrackPoint(5.0, 0.0, 'U')));
        track.hear(&answer(2, 1.0));
        assert_eq!(track.points().count(), 1);
    }
}
