//! A place where the robot may be, and its evidence.

use std::cmp::Reverse;

use geometry::{Covariance, Pose};
use messages::{Hypothesis, TrackReason, Verdict};
use nalgebra::{Matrix3, Rotation2, SymmetricEigen};

use super::driven_path::DrivenPath;
use super::seen::{Fitted, with_map_error};
use crate::peaks::{Places, Target};

/// Largest number of places kept, and the largest numbers of old and new ones (older than one key
/// scan or not). Old places keep their slots, so that a search does not evict them and re-create
/// them as new.
pub(super) const MAX: usize = MAX_OLD + MAX_NEW;
pub(super) const MAX_OLD: usize = 20;
pub(super) const MAX_NEW: usize = 12;

/// A place found by a search for one scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Number of the map, among those searched together.
    pub map: u32,
    /// Pose of the target frame in the map.
    pub pose: Pose,
    /// Covariance of that pose.
    pub covariance: Covariance,
    /// Votes of the pose from which the place was refined.
    pub votes: u64,
    /// True if the verdict on the scan alone is `Unique` and this is its place.
    pub is_only: bool,
}

/// Largest standard deviation of a candidate's position, in metres. Without it, a candidate that a
/// scan does not constrain along a corridor would confirm places metres away.
const LOOSEST_M: f64 = 0.3;

impl Candidate {
    fn of(map: u32, hypothesis: Hypothesis, target: Target) -> Self {
        let laser = hypothesis.map_from_laser.into();
        let pose = target.from_laser(laser);
        Candidate {
            map,
            pose,
            covariance: Covariance::from_rows(hypothesis.covariance).carried(laser, pose),
            votes: hypothesis.intensity,
            is_only: false,
        }
    }

    /// Returns the candidates among the places that a search in this process found, as poses of
    /// frame `of`. They pass through the messages of the graph, so that both round alike.
    #[must_use]
    pub fn of_places(places: &Places, of: Target, target: Target) -> Vec<Self> {
        let found = places.places.iter();
        let found = found.map(|place| (place.map, place.hypothesis(0, of)));
        Candidate::of_hypotheses(Some(places.verdict), found, target)
    }

    /// Returns the candidates with the most votes among the places that a search found, which come
    /// best first, each with the number of its map. Few are kept because some places fit any scan
    /// well by chance, and each of them must be distinguished from the true one.
    #[must_use]
    pub fn of_hypotheses(
        verdict: Option<Verdict>,
        found: impl Iterator<Item = (u32, Hypothesis)>,
        target: Target,
    ) -> Vec<Self> {
        let found = found.map(|(map, hypothesis)| Candidate::of(map, hypothesis, target));
        let mut candidates: Vec<Self> = found.collect();
        if let Some(best) = candidates.first_mut() {
            best.is_only = verdict == Some(Verdict::Unique);
        }
        candidates.sort_unstable_by_key(|candidate| Reverse(candidate.votes));
        candidates.truncate(MAX);
        let best = candidates.first().map_or(0, |best| best.votes);
        candidates.retain(|candidate| 2 * candidate.votes >= best);
        candidates
    }

    /// Pose and covariance, in the form that places use.
    pub(super) fn at(&self) -> (Pose, Matrix3<f64>) {
        // The covariance already contains the additional error of a drawn map.
        let covariance = with_map_error(self.covariance.into(), 0.0);
        (self.pose, tightened(covariance))
    }
}

/// Shrinks a covariance so that no axis of its position is longer than [`LOOSEST_M`].
fn tightened(covariance: Matrix3<f64>) -> Matrix3<f64> {
    let position = covariance.fixed_view::<2, 2>(0, 0).into_owned();
    let SymmetricEigen {
        eigenvectors,
        eigenvalues,
    } = position.symmetric_eigen();
    let share = eigenvalues.map(|v| (LOOSEST_M / v.max(1e-12).sqrt()).min(1.0));
    let squeeze =
        eigenvectors * nalgebra::Matrix2::from_diagonal(&share) * eigenvectors.transpose();
    let mut all = Rotation2::identity().to_homogeneous();
    all.fixed_view_mut::<2, 2>(0, 0).copy_from(&squeeze);
    all * covariance * all.transpose()
}

/// A place that is kept from scan to scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Identity of the place; two places that meet become one.
    pub id: u32,
    /// Number of its map.
    pub map: u32,
    /// Map from which the robot may have come by a transition, while that is undecided.
    pub crossed_from: Option<u32>,
    /// True if a hint expects the robot there.
    pub is_expected: bool,
    pub pose: Pose,
    pub covariance: Matrix3<f64>,
    /// Log odds of the place; the value of the best place is subtracted at each key scan.
    pub log_weight: f64,
    /// Number of key scans for which it has been kept, including the first.
    pub age: u32,
    /// Mean score of its last key scans.
    pub mean: f64,
    /// Score of the last scan.
    pub last: f64,
    /// Prediction of pose and covariance for the last scan.
    pub predicted: (Pose, Matrix3<f64>),
    /// Squared deviation of the last fit from that prediction.
    pub off: f64,
    /// Pose and covariance at which the comparison with odometry starts, and the path since.
    pub anchor: (Pose, Matrix3<f64>),
    pub since_anchor: DrivenPath,
    /// Path from the anchor to the last key scan.
    pub until_key: DrivenPath,
    /// Motion of the place on the map since the anchor, as a share of the distance between key
    /// scans, 0..=1.
    pub novelty: f64,
    /// Log odds of "nowhere" against this place by the last scan alone, and the reason if positive.
    pub nowhere: f64,
    pub doubt: Option<TrackReason>,
}

/// Novelty from which a place counts as moved.
const MOVED: f64 = 0.5;

/// Distances within which two places are one answer, in metres and radians.
const DISTINCT_M: f64 = 1.0;
const DISTINCT_RADIANS: f64 = 15.0 * std::f64::consts::PI / 180.0;

/// Number of key scans in the mean score.
const MEAN_OVER: u32 = 8;

impl Place {
    pub(super) fn born(id: u32, (map, found): (u32, &Fitted), log_weight: f64) -> Self {
        Place {
            id,
            map,
            crossed_from: None,
            is_expected: false,
            pose: found.pose,
            covariance: found.covariance,
            log_weight,
            age: 1,
            mean: found.score,
            last: found.score,
            predicted: (found.pose, found.covariance),
            off: 0.0,
            anchor: (found.pose, found.covariance),
            since_anchor: DrivenPath::default(),
            until_key: DrivenPath::default(),
            novelty: 0.0,
            nowhere: 0.0,
            doubt: None,
        }
    }

    /// True if a pose on a map is within these metres and radians of the place.
    pub(super) fn is_within(&self, (map, pose): (u32, Pose), metres: f64, radians: f64) -> bool {
        self.map == map && self.pose.is_within(pose, metres, radians)
    }

    /// True if a pose on a map is a different answer.
    pub(super) fn is_apart_from(&self, at: (u32, Pose)) -> bool {
        !self.is_within(at, DISTINCT_M, DISTINCT_RADIANS)
    }

    /// True if the robot may have gone from one of the places to the other by a transition.
    pub(super) fn is_across(&self, other: &Place) -> bool {
        self.map != other.map
            && (self.crossed_from == Some(other.map) || other.crossed_from == Some(self.map))
    }

    pub(super) fn set(&mut self, fitted: &Fitted) {
        self.pose = fitted.pose;
        self.covariance = fitted.covariance;
        self.last = fitted.score;
        self.off = fitted.off;
    }

    /// Adds the last score to the mean, as that of a key scan.
    pub(super) fn grow(&mut self) {
        let before = f64::from(self.age.min(MEAN_OVER));
        self.mean = (self.mean * before + self.last) / (before + 1.0);
        self.age += 1;
        // A place that did not move keeps its anchor.
        self.until_key = self.since_anchor;
        if self.novelty >= MOVED {
            self.anchor = (self.pose, self.covariance);
            self.until_key = DrivenPath::default();
        }
    }
}
