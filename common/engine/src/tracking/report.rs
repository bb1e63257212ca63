//! The tracker's report.

use geometry::{Covariance, Pose};
use messages::{TrackReason, TrackState};

use super::driven_path::DrivenPath;
use super::nowhere::is_blind;

/// Pose of the robot, its certainty, and the reason.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Report {
    /// State of the tracker.
    pub state: TrackState,
    /// Reason for the state.
    pub reason: TrackReason,
    /// Number of the map of the pose, among those searched together.
    pub map: u32,
    /// Pose of the target frame in the map: the believed place, otherwise the leading one.
    pub pose: Option<Pose>,
    /// Covariance of the pose, in m², m·rad and rad². Unless the state is `Unique`, it spans all
    /// places kept on the pose's map; it cannot express places on other maps.
    pub covariance: Covariance,
    /// Probability that the robot is there, 0..=1.
    pub probability: f64,
    /// Score of the last scan there, at most 1.
    pub score: f64,
    /// Natural logarithm of the odds of that probability.
    pub lead: f64,
    /// Number of places close to the best in weight, including it.
    pub rivals: u32,
    /// Number of maps with such places.
    pub maps: u32,
    /// Distances from the best place to the nearest and the farthest of the others on its map, in
    /// metres.
    pub apart_m: (f64, f64),
    /// Time at which the state began, in nanoseconds.
    pub since_ns: i64,
    /// Distance driven since then, in metres.
    pub since_m: f64,
}

/// Distance within which places are one spot in two headings, in metres.
const SAME_SPOT_M: f64 = 1.0;
const ONE_SPOT: &str = "on one spot";

impl Report {
    /// Returns the report after odometry moved the robot by this step since the last scan, with its
    /// error scaled by `odometry_error` (`--odometry-error`). The covariance grows, and a unique
    /// pose becomes doubtful once the robot may be at more than one place.
    #[must_use]
    pub fn carried(&self, step: Pose, odometry_error: f64) -> Self {
        let Some(pose) = self.pose else {
            return *self;
        };
        let mut path = DrivenPath::default();
        path.add(Some(step));
        let (pose, covariance) = path.carry((pose, self.covariance.into()), odometry_error);
        let is_lost_sight = self.state == TrackState::Unique && is_blind(&(pose, covariance));
        let (state, reason) = match is_lost_sight {
            true => (TrackState::Doubtful, TrackReason::NoScan),
            false => (self.state, self.reason),
        };
        Report {
            state,
            reason,
            pose: Some(pose),
            covariance: covariance.into(),
            ..*self
        }
    }

    /// Returns the reason in words, and advice if there is any.
    pub fn words(&self) -> String {
        match self.reason_and_advice() {
            (reason, "") => reason,
            (reason, advice) => format!("{reason}: {advice}"),
        }
    }

    /// Splits the text of [`Report::words`] into reason and advice; the latter may be empty.
    #[must_use]
    pub fn split(words: &str) -> (&str, &str) {
        words.rsplit_once(": ").unwrap_or((words, ""))
    }

    fn reason_and_advice(&self) -> (String, &'static str) {
        const MOVE: &str = "drive a few metres or turn on the spot, or mark a region";
        let is_doubtful = self.state == TrackState::Doubtful;
        let fit = format!("fit {:.2}", self.score.clamp(0.0, 1.0));
        let since = format!("since {:.0} m", self.since_m);
        match self.reason {
            TrackReason::NoScan if is_doubtful => {
                let advice = "is the laser running and connected?";
                ("no scan for some metres".into(), advice)
            }
            TrackReason::NoScan => ("waiting for the first scan".into(), ""),
            TrackReason::NoMap => ("waiting for a map".into(), ""),
            TrackReason::NoSearch => ("waiting for the first search of the map".into(), ""),
            TrackReason::OnePlace => (format!("one place, {fit}, {since}"), ""),
            TrackReason::SeveralPlaces => {
                let apart = self.apart();
                let reason = format!("{} places fit, {apart}, {since}", self.rivals);
                match apart == ONE_SPOT {
                    true => (reason, "turn, or drive a few metres"),
                    false => (reason, MOVE),
                }
            }
            TrackReason::TooEarly => (format!("one place leads, {fit}, {since}"), MOVE),
            TrackReason::PoorFit if is_doubtful => {
                let advice = "is the view blocked, or the map out of date?";
                (format!("only {fit}, {since}"), advice)
            }
            TrackReason::PoorFit => (format!("only {fit}, {since}"), MOVE),
            TrackReason::OdometryJump => {
                let advice = "is the laser mirrored, frozen or covered?";
                (format!("laser and odometry disagree, {fit}"), advice)
            }
            TrackReason::AnotherPlace => (format!("scans fit better elsewhere, {since}"), MOVE),
            TrackReason::NoPlace => ("no place on the map fits".into(), "is it this map?"),
        }
    }

    fn apart(&self) -> String {
        let (nearest, farthest) = self.apart_m;
        match self.rivals {
            _ if self.maps > 1 => format!("on {} maps", self.maps),
            _ if farthest <= SAME_SPOT_M => ONE_SPOT.into(),
            0..=2 => format!("{farthest:.0} m apart"),
            _ => format!("{nearest:.0} to {farthest:.0} m apart"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(state: TrackState, reason: TrackReason) -> Report {
        Report {
            state,
            reason,
            map: 0,
            pose: None,
            covariance: Covariance::from_deviations(0.0, 0.0, 0.0),
            probability: 0.5,
            score: 0.14,
            lead: 1.0,
            rivals: 2,
            maps: 1,
            apart_m: (25.2, 25.2),
            since_ns: 0,
            since_m: 3.0,
        }
    }

    #[test]
    fn reason_and_advice_are_found_again_in_the_words() {
        let states = (0..4).filter_map(TrackState::from_code);
        for (state, reason) in states.flat_map(|state| {
            let reasons = (0..10).filter_map(TrackReason::from_code);
            reasons.map(move |reason| (state, reason))
        }) {
            let report = report(state, reason);
            let (why, advice) = report.reason_and_advice();
            assert_eq!(Report::split(&report.words()), (&*why, advice));
        }
    }

    #[test]
    fn without_scans_the_ellipse_grows_until_the_pose_is_doubtful() {
        let at = Report {
            pose: Some(Pose::new(1.0, 2.0, 0.0)),
            covariance: Covariance::from_deviations(0.03, 0.03, 0.03),
            ..report(TrackState::Unique, TrackReason::OnePlace)
        };
        assert_eq!(at.carried(Pose::IDENTITY, 1.0).covariance, at.covariance);
        let near = at.carried(Pose::new(1.0, 0.0, 0.0), 1.0);
        assert_eq!(near.state, TrackState::Unique);
        // 15 cm per metre, from the study of eight robots' odometry.
        assert!((near.covariance.to_rows()[0].sqrt() - 0.15f64.hypot(0.03)).abs() < 1e-9);
        let far = at.carried(Pose::new(4.0, 0.0, 0.0), 1.0);
        assert_eq!(far.pose, Some(Pose::new(5.0, 2.0, 0.0)));
        assert_eq!(far.state, TrackState::Doubtful);
        assert_eq!(
            far.words(),
            "no scan for some metres: is the laser running and connected?"
        );
    }

    #[test]
    fn one_spot_in_two_headings_is_distinguished_by_turning() {
        let spot = Report {
            apart_m: (0.1, 0.3),
            ..report(TrackState::Searching, TrackReason::SeveralPlaces)
        };
        assert_eq!(
            spot.words(),
            "2 places fit, on one spot, since 3 m: turn, or drive a few metres"
        );
    }
}
