//! Decides when the robot's particle filter gets an initial pose. Pure.
//!
//! It gets one when it starts, on request, and when its pose is far from every hypothesis of a
//! Unique scan twice in a row; always from a scan whose verdict is Unique.

use std::collections::VecDeque;

use geometry::Pose;

use crate::config::{Reach, Seed};

/// Number of answers kept for comparison: some seconds of scans.
const KEPT: usize = 128;

/// Largest time between a pose and the hypotheses it is compared with, nanoseconds: a robot at 2
/// m/s moves half the default distance beyond which it counts as lost.
const SAME_TIME_NS: i64 = 250_000_000;

/// Number of poses in a row that must be far from all hypotheses.
const ENOUGH: u32 = 2;

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Answer {
    pub(crate) measured_ns: i64,
    /// True if the verdict is Unique, and the pose is that of the robot.
    pub(crate) is_unique: bool,
    /// Possible poses, best first.
    pub(crate) map_from_base: Vec<Pose>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Belief {
    pub(crate) measured_ns: i64,
    pub(crate) map_from_base: Pose,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reason {
    /// The filter has just started.
    New,
    Asked,
    /// The filter's pose is far from all hypotheses.
    Lost,
}

#[derive(Debug)]
pub(crate) struct Seeding {
    when: Seed,
    beyond: Reach,
    wanted: Option<Reason>,
    answers: VecDeque<Answer>,
    /// Pose of the filter that is newer than every answer.
    waiting: Option<Belief>,
    apart: u32,
    /// Time of the scan that gave the last initial pose, nanoseconds.
    seeded_ns: i64,
}

impl Seeding {
    pub(crate) fn new(when: Seed, beyond: Reach) -> Self {
        Seeding {
            when,
            beyond,
            wanted: None,
            answers: VecDeque::with_capacity(KEPT),
            waiting: None,
            apart: 0,
            seeded_ns: i64::MIN,
        }
    }

    /// Notes a new particle filter, which gets an initial pose unless that is turned off.
    pub(crate) fn greet(&mut self) {
        if self.when != Seed::Never {
            self.wanted = self.wanted.or(Some(Reason::New));
        }
    }

    pub(crate) fn ask(&mut self) {
        self.wanted = Some(Reason::Asked);
    }

    pub(crate) fn on_belief(&mut self, belief: Belief) {
        // Poses from before the initial pose do not count.
        if self.when != Seed::Lost || belief.measured_ns <= self.seeded_ns {
            return;
        }
        let newest = self.answers.back().map(|answer| answer.measured_ns);
        if newest.is_some_and(|newest| newest >= belief.measured_ns) {
            self.judge(belief);
        } else {
            self.waiting = Some(belief);
        }
    }

    /// Takes the answer of a scan; returns the reason if its first pose is to be sent to the
    /// filter.
    pub(crate) fn on_answer(&mut self, answer: Answer) -> Option<Reason> {
        let (now_ns, is_unique) = (answer.measured_ns, answer.is_unique);
        if self.answers.back().is_some_and(|a| a.measured_ns > now_ns) {
            // The clock was set back: a recording that begins again.
            self.answers.clear();
            self.waiting = None;
            self.seeded_ns = i64::MIN;
        }
        if self.answers.len() == KEPT {
            self.answers.pop_front();
        }
        self.answers.push_back(answer);
        if let Some(belief) = self.waiting.take_if(|belief| belief.measured_ns <= now_ns) {
            self.judge(belief);
        }
        if !is_unique {
            return None;
        }
        let reason = self.wanted.take()?;
        self.apart = 0;
        self.seeded_ns = now_ns;
        Some(reason)
    }

    fn judge(&mut self, belief: Belief) {
        let apart_ns = |a: &&Answer| a.measured_ns.abs_diff(belief.measured_ns);
        let nearest = self.answers.iter().min_by_key(apart_ns);
        let Some(answer) = nearest.filter(|a| apart_ns(a) <= SAME_TIME_NS.unsigned_abs()) else {
            return;
        };
        let Reach { metres, radians } = self.beyond;
        let is_near = |pose: &Pose| pose.is_within(belief.map_from_base, metres, radians);
        if answer.map_from_base.iter().any(is_near) {
            self.apart = 0;
            self.wanted = self.wanted.filter(|reason| *reason != Reason::Lost);
        } else if answer.is_unique {
            self.apart += 1;
            if self.apart >= ENOUGH {
                self.wanted = self.wanted.or(Some(Reason::Lost));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    fn seeding(when: Seed) -> Seeding {
        let beyond = Reach {
            metres: 1.0,
            radians: 0.5,
        };
        Seeding::new(when, beyond)
    }

    fn answer(to: &mut Seeding, ms: i64, is_unique: bool, places: &[f64]) -> Option<Reason> {
        to.on_answer(Answer {
            measured_ns: ms * MS,
            is_unique,
            map_from_base: places.iter().map(|x| Pose::new(*x, 0.0, 0.0)).collect(),
        })
    }

    fn belief(ms: i64, x: f64) -> Belief {
        Belief {
            measured_ns: ms * MS,
            map_from_base: Pose::new(x, 0.0, 0.0),
        }
    }

    #[test]
    fn a_new_filter_gets_one_pose_by_a_unique_verdict() {
        for when in [Seed::Once, Seed::Lost] {
            let mut seeding = seeding(when);
            // There is no filter yet.
            assert_eq!(answer(&mut seeding, 0, true, &[1.0]), None);
            seeding.greet();
            assert_eq!(answer(&mut seeding, 100, false, &[1.0, 9.0]), None);
            assert_eq!(answer(&mut seeding, 200, true, &[1.0]), Some(Reason::New));
            assert_eq!(answer(&mut seeding, 300, true, &[1.0]), None);
        }
        let mut seeding = seeding(Seed::Never);
        seeding.greet();
        assert_eq!(answer(&mut seeding, 200, true, &[1.0]), None);
        seeding.ask();
        assert_eq!(answer(&mut seeding, 300, true, &[1.0]), Some(Reason::Asked));
    }

    #[test]
    fn a_lost_filter_gets_another_after_the_second_sign() {
        let mut seeding = seeding(Seed::Lost);
        answer(&mut seeding, 0, true, &[1.0]);
        seeding.on_belief(belief(0, 1.5));
        seeding.on_belief(belief(0, 9.0));
        assert_eq!(answer(&mut seeding, 100, true, &[1.0]), None);
        // This one comes before its answer does.
        seeding.on_belief(belief(200, 9.0));
        assert!(seeding.wanted.is_none());
        assert_eq!(answer(&mut seeding, 200, true, &[1.0]), Some(Reason::Lost));
        // Poses from before the initial pose do not count.
        seeding.on_belief(belief(200, 9.0));
        seeding.on_belief(belief(150, 9.0));
        assert_eq!(answer(&mut seeding, 300, true, &[1.0]), None);
    }

    #[test]
    fn a_pose_at_any_hypothesis_or_with_no_unique_verdict_is_not_lost() {
        let mut seeding = seeding(Seed::Lost);
        for ms in (0..1000).step_by(100) {
            assert_eq!(answer(&mut seeding, ms, ms % 200 == 0, &[1.0, 20.0]), None);
            seeding.on_belief(belief(ms, if ms % 200 == 0 { 20.0 } else { 9.0 }));
        }
        assert!(seeding.wanted.is_none());
        // Turned around at the right place.
        answer(&mut seeding, 2000, true, &[1.0]);
        for _ in 0..2 {
            let mut turned = belief(2000, 1.0);
            turned.map_from_base.yaw = 3.0;
            seeding.on_belief(turned);
        }
        assert!(seeding.wanted.is_some());
        // It recovered by itself, or a user moved it there.
        seeding.on_belief(belief(2000, 1.0));
        assert!(seeding.wanted.is_none());
    }

    #[test]
    fn only_what_is_of_one_time_is_compared_and_once_means_once() {
        for (when, beliefs_ms, expected) in [
            (Seed::Lost, [1000, 1000], Some(Reason::Lost)),
            (Seed::Lost, [700, 600], None),
            (Seed::Once, [1000, 1000], None),
        ] {
            let mut seeding = seeding(when);
            answer(&mut seeding, 1000, true, &[1.0]);
            for ms in beliefs_ms {
                seeding.on_belief(belief(ms, 9.0));
            }
            assert_eq!(seeding.wanted, expected, "{when:?}");
        }
    }

    #[test]
    fn a_clock_that_is_set_back_begins_again() {
        let mut seeding = seeding(Seed::Lost);
        seeding.ask();
        assert!(answer(&mut seeding, 5000, true, &[1.0]).is_some());
        assert_eq!(answer(&mut seeding, 0, true, &[1.0]), None);
        seeding.on_belief(belief(0, 9.0));
        seeding.on_belief(belief(0, 9.0));
        assert!(seeding.wanted.is_some());
    }
}
