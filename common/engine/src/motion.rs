//! Motion of the robot by odometry, between its samples and a little beyond them.

use std::collections::VecDeque;

use geometry::Pose;

/// Largest gap between two samples that tell the motion between them: within half a second a robot
/// brakes and turns.
const MAX_GAP_NS: i64 = 500_000_000;

/// Time for which the last twist is extrapolated, and the first one backwards: a scan of a slow
/// laser (8 Hz) and the lag of odometry behind it.
const MAX_BEYOND_NS: i64 = 250_000_000;

/// Odometry has stopped after this many of its usual sample periods without a sample, but not
/// before the minimum time, because stamps are irregular.
const MISSED_SAMPLES: i64 = 4;
const MIN_SILENCE_NS: i64 = 500_000_000;

/// Number of periods whose median is the usual period.
const PERIODS: usize = 8;

/// Differences of poses that rounding alone explains, in metres and radians.
const ROUNDING: f64 = 1e-4;

/// Jump back in time at which a recording has started again; samples that are less late are
/// dropped.
const BEGUN_ANEW_NS: i64 = 1_000_000_000;

/// Largest speed of a robot, in metres per second, and additional error of a sample, in metres.
const FASTEST_M_S: f64 = 10.0;
const OFF_M: f64 = 0.5;

/// Odometry that restarts counts from the robot's pose at that time. A sample this near to the
/// origin (metres and radians), and this far from the sample before and from its extrapolation, is
/// the first after a restart.
const START: (f64, f64) = (0.05, 0.05);
const FROM_BEFORE: (f64, f64) = (0.2, 0.1);

/// Poses of a moving frame over time, sorted by stamp.
#[derive(Debug, Clone)]
pub struct Motion {
    samples: VecDeque<(i64, Pose)>,
    keep: usize,
    starts: u32,
    /// First sample since the start, and the time of the first sample with a different pose.
    first: Option<Pose>,
    moved_ns: Option<i64>,
}

/// Pose of the frame at some time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Located {
    /// Pose in the odometry's frame.
    pub odom_from_child: Pose,
    /// True if the time is between two samples, not beyond them.
    pub is_between: bool,
}

impl Motion {
    /// Creates an empty history that keeps at most this many of the newest samples.
    #[must_use]
    pub fn keeping(samples: usize) -> Self {
        Motion {
            samples: VecDeque::new(),
            keep: samples,
            starts: 0,
            first: None,
            moved_ns: None,
        }
    }

    /// Adds a sample with its stamp in nanoseconds. At a restart of odometry all earlier samples
    /// are forgotten, because the motion in between is unknown.
    pub fn add(&mut self, stamp_ns: i64, odom_from_child: Pose) {
        if !odom_from_child.is_finite() {
            return;
        }
        if let Some(&newest) = self.samples.back() {
            if self.begins_anew(newest, (stamp_ns, odom_from_child)) {
                self.samples.clear();
                self.starts += 1;
                (self.first, self.moved_ns) = (None, None);
            } else if stamp_ns <= newest.0 {
                return;
            }
        }
        if self.samples.len() >= self.keep {
            self.samples.pop_front();
        }
        let first = *self.first.get_or_insert(odom_from_child);
        if !odom_from_child.is_within(first, ROUNDING, ROUNDING) {
            self.moved_ns.get_or_insert(stamp_ns);
        }
        self.samples.push_back((stamp_ns, odom_from_child));
    }

    /// True if a sample cannot follow the newest one.
    fn begins_anew(&self, (newest_ns, newest): (i64, Pose), (stamp_ns, now): (i64, Pose)) -> bool {
        let later_ns = stamp_ns.saturating_sub(newest_ns);
        if later_ns <= 0 {
            return later_ns < -BEGUN_ANEW_NS;
        }
        let goes_on = |from: Pose| now.is_within(from, FROM_BEFORE.0, FROM_BEFORE.1);
        let at_start = now.is_within(Pose::IDENTITY, START.0, START.1)
            && !goes_on(newest)
            && !self.until(stamp_ns).is_some_and(goes_on);
        at_start || now.distance_to(newest) > OFF_M + FASTEST_M_S * later_ns as f64 / 1e9
    }

    /// Number of restarts of odometry; poses before and after a restart cannot be compared.
    pub fn starts(&self) -> u32 {
        self.starts
    }

    /// Time of the newest sample, in nanoseconds.
    pub fn newest_ns(&self) -> Option<i64> {
        self.samples.back().map(|&(stamp, _)| stamp)
    }

    /// True if a sample of this time or later may arrive soon: the newest one is at most half a
    /// second older.
    #[must_use]
    pub fn may_reach(&self, stamp_ns: i64) -> bool {
        self.newest_ns()
            .is_some_and(|newest| stamp_ns.saturating_sub(newest) <= MAX_GAP_NS)
    }

    /// True if any sample up to a time differs from the first since the start. Odometry that has
    /// never changed may be dead and does not tell the motion of the robot.
    #[must_use]
    pub fn has_moved(&self, stamp_ns: i64) -> bool {
        self.moved_ns.is_some_and(|moved| moved <= stamp_ns)
    }

    /// True if the newest two samples differ by more than rounding: a tenth of a millimetre or of a
    /// milliradian.
    pub fn is_moving(&self) -> bool {
        let mut newest = self.samples.iter().rev().map(|&(_, pose)| pose);
        match (newest.next(), newest.next()) {
            (Some(last), Some(before)) => !last.is_within(before, ROUNDING, ROUNDING),
            _ => false,
        }
    }

    /// Returns the pose of the frame at a time from samples up to that time only, so that later
    /// samples change nothing. The last twist is extrapolated for at most a quarter of a second;
    /// beyond that the frame stays where it was. `None` before the first sample, and once samples
    /// have stopped: for half a second and four usual periods.
    #[must_use]
    pub fn until(&self, stamp_ns: i64) -> Option<Pose> {
        let after = self
            .samples
            .partition_point(|&(stamp, _)| stamp <= stamp_ns);
        let &(end_ns, end) = self.samples.get(after.checked_sub(1)?)?;
        let beyond_ns = stamp_ns.saturating_sub(end_ns);
        if beyond_ns > MIN_SILENCE_NS.max(self.usual_period_ns(after) * MISSED_SAMPLES) {
            return None;
        }
        let start = after.checked_sub(2).and_then(|i| self.samples.get(i));
        let moved_on = start.and_then(|&start| on_arc(start, (end_ns, end), stamp_ns));
        Some(moved_on.unwrap_or(end))
    }

    /// Median of the last periods between the first `count` samples, in nanoseconds; 0 without any.
    fn usual_period_ns(&self, count: usize) -> i64 {
        let first = count.saturating_sub(PERIODS + 1);
        let stamps = || self.samples.range(first..count).map(|&(stamp, _)| stamp);
        let mut periods = [0; PERIODS];
        let mut found = 0;
        for (before, after) in stamps().zip(stamps().skip(1)) {
            periods[found] = after.saturating_sub(before);
            found += 1;
        }
        let periods = &mut periods[..found];
        periods.sort_unstable();
        periods.get(found / 2).copied().unwrap_or(0)
    }

    /// Returns the pose of the frame at a time: on the arc of constant twist between the two
    /// samples around it, or on that of the nearest two for at most a quarter of a second beyond
    /// them. `None` if no samples cover it.
    #[must_use]
    pub fn at(&self, stamp_ns: i64) -> Option<Located> {
        let after = self.samples.partition_point(|&(stamp, _)| stamp < stamp_ns);
        let exact = self.samples.get(after).filter(|(at, _)| *at == stamp_ns);
        if let Some(&(_, odom_from_child)) = exact {
            return Some(Located {
                odom_from_child,
                is_between: true,
            });
        }
        let is_between = 0 < after && after < self.samples.len();
        let second = after.clamp(1, self.samples.len().checked_sub(1).filter(|&n| n > 0)?);
        let (start, end) = (self.samples.get(second - 1)?, self.samples.get(second)?);
        Some(Located {
            odom_from_child: on_arc(*start, *end, stamp_ns)?,
            is_between,
        })
    }
}

/// Returns the pose at a time on the arc of constant twist through two samples; `None` if they are
/// too far apart, or the time is too far beyond them.
fn on_arc(
    (start_ns, start): (i64, Pose),
    (end_ns, end): (i64, Pose),
    stamp_ns: i64,
) -> Option<Pose> {
    let beyond_ns = (start_ns.saturating_sub(stamp_ns)).max(stamp_ns.saturating_sub(end_ns));
    if end_ns - start_ns > MAX_GAP_NS || beyond_ns > MAX_BEYOND_NS {
        return None;
    }
    let share = (stamp_ns - start_ns) as f64 / (end_ns - start_ns) as f64;
    Some(start.towards(end, share))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    const TENTH: i64 = 100_000_000;

    fn motion(poses: &[(i64, Pose)]) -> Motion {
        let mut motion = Motion::keeping(8);
        for &(tenth, pose) in poses {
            motion.add(tenth * TENTH, pose);
        }
        motion
    }

    #[test]
    fn between_samples_the_twist_is_constant() {
        let quarter = motion(&[(0, Pose::IDENTITY), (2, Pose::new(1.0, 1.0, FRAC_PI_2))]);
        // A quarter of a circle of radius 1 about (0, 1).
        let eighth = Pose::new(0.5f64.sqrt(), 1.0 - 0.5f64.sqrt(), FRAC_PI_2 / 2.0);
        let found = quarter.at(TENTH).unwrap();
        assert!(found.is_between);
        assert!(found.odom_from_child.is_within(eighth, 1e-12, 1e-12));
        let beyond = quarter.at(4 * TENTH).unwrap();
        assert!(!beyond.is_between);
        let half = Pose::new(0.0, 2.0, 2.0 * FRAC_PI_2);
        assert!(beyond.odom_from_child.is_within(half, 1e-12, 1e-12));
        assert_eq!(quarter.at(5 * TENTH), None, "0.3 s beyond");
        assert!(quarter.at(-TENTH).is_some_and(|found| !found.is_between));
    }

    #[test]
    fn a_hole_says_nothing_and_a_single_sample_only_its_own_time() {
        let hole = motion(&[(0, Pose::IDENTITY), (9, Pose::new(1.0, 0.0, 0.0))]);
        assert_eq!(hole.at(4 * TENTH), None);
        assert!(hole.at(9 * TENTH).is_some_and(|found| found.is_between));
        let single = motion(&[(3, Pose::IDENTITY)]);
        assert!(single.at(3 * TENTH).is_some());
        assert_eq!(single.at(3 * TENTH + 1), None);
        assert_eq!(motion(&[]).at(0), None);
    }

    #[test]
    fn odometry_that_has_stopped_is_unknown() {
        let east = |tenth: i64| (tenth, Pose::new(tenth as f64 / 10.0, 0.0, 0.0));
        let until = |motion: &Motion, tenth: i64| motion.until(tenth * TENTH).is_some();
        let fast = motion(&[0, 1, 2, 3].map(east));
        assert!(until(&fast, 8) && !until(&fast, 9) && until(&fast, 0));
        assert!(!until(&fast, -1), "before the first");
        let slow = motion(&[0, 20, 40, 60].map(east));
        assert!(
            until(&slow, 140) && !until(&slow, 141),
            "four of its periods"
        );
        // A single hole among the samples does not count as a period.
        let hole = motion(&[0, 1, 2, 90, 91, 92].map(east));
        assert!(!until(&hole, 98) && !until(&hole, 60) && until(&hole, 90));
        let single = motion(&[east(0)]);
        assert!(until(&single, 5) && !until(&single, 6));
        let unstamped = motion(&[east(0), (0, Pose::new(1.0, 0.0, 0.0))]);
        assert!(unstamped.until(i64::MAX).is_none());
    }

    #[test]
    fn odometry_that_has_never_changed_is_recognized() {
        let at = |x| Pose::new(x, 0.0, 0.0);
        let mut motion = motion(&[(0, at(2.0)), (1, at(2.00001)), (2, at(2.1)), (3, at(2.1))]);
        let known = [1, 2, 3].map(|tenth| motion.has_moved(tenth * TENTH));
        assert_eq!(known, [false, true, true]);
        motion.add(4 * TENTH, Pose::IDENTITY);
        assert!(!motion.has_moved(4 * TENTH), "it began anew");
    }

    #[test]
    fn late_samples_are_left_out_and_a_recording_may_begin_again() {
        let east = |x| Pose::new(x, 0.0, 0.0);
        let mut motion = motion(&[(20, east(0.0)), (22, east(2.0)), (21, east(9.0))]);
        let middle = motion.at(21 * TENTH).unwrap().odom_from_child;
        assert!(middle.is_within(east(1.0), 1e-12, 1e-12));
        motion.add(0, east(5.0));
        assert_eq!((motion.newest_ns(), motion.starts()), (Some(0), 1));
        assert!(motion.may_reach(5 * TENTH) && !motion.may_reach(6 * TENTH));
    }
    #[test]
    fn odometry_that_counts_from_the_start_again_has_begun_anew() {
        let far = Pose::new(3.0, -1.0, 2.0);
        let next = |pose| {
            let mut motion = motion(&[(10, Pose::IDENTITY), (12, far)]);
            motion.add(14 * TENTH, pose);
            (motion.starts(), motion.until(14 * TENTH))
        };
        // From the origin to 3 m in a fifth of a second is too fast.
        assert_eq!(next(far), (1, Some(far)));
        assert_eq!(next(far.then(Pose::new(1.0, 0.0, 0.5))).0, 1);
        let first = Pose::new(0.02, 0.0, 0.01);
        assert_eq!(next(first), (2, Some(first)));
        // The robot drives through the origin, and stands there.
        let mut through = Motion::keeping(8);
        for tenth in 0..8 {
            let pose = Pose::new(0.15 * (tenth as f64 - 4.0), 0.0, 0.0);
            through.add(tenth * TENTH, pose);
            through.add(tenth * TENTH + 1, pose);
        }
        assert_eq!(through.starts(), 0);
        // The robot turns on the spot where it started, at 90 degrees per second and ten samples
        // per second.
        let turned = |tenth| (tenth, Pose::new(0.0, 0.0, 0.157 * (tenth as f64 - 4.0)));
        let turning: Vec<_> = (0..8).map(turned).collect();
        assert_eq!(motion(&turning).starts(), 0);
        // Scans before the restart are not covered, and nothing is interpolated across it.
        let mut anew = motion(&[(10, far), (12, far)]);
        anew.add(13 * TENTH, Pose::IDENTITY);
        assert_eq!((anew.until(12 * TENTH), anew.at(12 * TENTH)), (None, None));
    }
}
