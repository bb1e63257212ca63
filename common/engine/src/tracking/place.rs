//! A place where the robot may be, and how much speaks for it.

use std::cmp::Reverse;

use geometry::{Covariance, Pose};
use messages::{Hypothesis, TrackReason, Verdict};
use nalgebra::{Matrix3, Rotation2, SymmetricEigen};

use super::driven_path::DrivenPath;
use super::limits::MAX;
use super::seen::{Fitted, with_map_error};
use crate::peaks::Target;

/// A place that a search found for one scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Number of the map, among those that are searched together.
    pub map: u32,
    /// Of the target frame.
    pub pose: Pose,
    /// Of that pose.
    pub covariance: Covariance,
    /// Of the pose that led there.
    pub votes: u64,
    /// Whether the verdict on the scan alone is `Unique`, and this is its place.
    pub is_only: bool,
}

/// Along what a scan does not constrain, a candidate is taken to be known as well as this,
/// metres, or a search would confirm places that lie metres apart.
const LOOSEST_M: f64 = 0.3;

impl Candidate {
    fn of(map: u32, hypothesis: &Hypothesis, target: Target) -> Self {
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

    /// Fills in those of the places that a search found, best first as messages say them, each
    /// with the number of its map, for which the votes speak most: of many places, some fit a
    /// scan well by chance, and with each there is one more to distinguish from the true one.
    pub fn fill<'a>(
        candidates: &mut Vec<Self>,
        verdict: Option<Verdict>,
        found: impl Iterator<Item = (u32, &'a Hypothesis)>,
        target: Target,
    ) {
        candidates.clear();
        candidates.extend(found.map(|(map, hypothesis)| Candidate::of(map, hypothesis, target)));
        if let Some(best) = candidates.first_mut() {
            best.is_only = verdict == Some(Verdict::Unique);
        }
        candidates.sort_unstable_by_key(|candidate| Reverse(candidate.votes));
        candidates.truncate(MAX);
        let best = candidates.first().map_or(0, |best| best.votes);
        candidates.retain(|candidate| 2 * candidate.votes >= best);
    }

    /// Its pose and covariance, as places have it.
    pub(super) fn at(&self) -> (Pose, Matrix3<f64>) {
        // What a drawn map errs by in addition is in it.
        let covariance = with_map_error(self.covariance.0, 0.0);
        (self.pose, tightened(covariance))
    }
}

/// A covariance whose position has no longer axis than [`LOOSEST_M`].
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

/// A place that is kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Which it is; two that meet become one.
    pub id: u32,
    /// Number of the map that it is on.
    pub map: u32,
    /// The map from which the robot may have come there by a transition, while it is not decided
    /// whether it did.
    pub crossed_from: Option<u32>,
    /// Whether somebody has said that the robot is there.
    pub is_expected: bool,
    pub pose: Pose,
    pub covariance: Matrix3<f64>,
    /// How much speaks for it, natural logarithm of odds; that of the best is
    /// subtracted at each key scan.
    pub log_weight: f64,
    /// Key scans that it has been kept for, the first included.
    pub age: u32,
    /// Of the scores at its last key scans.
    pub mean: f64,
    /// The score of the last scan.
    pub last: f64,
    /// Prediction for the last scan.
    pub predicted: (Pose, Matrix3<f64>),
    /// Squared deviations of the last fit from that prediction.
    pub off: f64,
    /// Pose and covariance from which the place is compared with odometry, and the way since.
    pub anchor: (Pose, Matrix3<f64>),
    pub since_anchor: DrivenPath,
    /// Way from the anchor to the last key scan.
    pub until_key: DrivenPath,
    /// Share of the way to the next key scan that the place moved on the map since the
    /// anchor, 0..=1.
    pub novelty: f64,
    /// Log odds of "nowhere" against this place by the last scan alone, and what speaks for it
    /// where they are positive.
    pub nowhere: f64,
    pub doubt: Option<TrackReason>,
}

/// Novelty of a place that moved.
const MOVED: f64 = 0.5;

/// Places so near each other are one answer.
const DISTINCT_M: f64 = 1.0;
const DISTINCT_RADIANS: f64 = 15.0 * std::f64::consts::PI / 180.0;

/// A mean is over this many key scans.
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

    /// Whether a pose of a map is so near, metres and radians.
    pub(super) fn is_within(&self, (map, pose): (u32, Pose), metres: f64, radians: f64) -> bool {
        self.map == map && self.pose.is_within(pose, metres, radians)
    }

    /// Whether a pose of a map is another answer.
    pub(super) fn is_apart_from(&self, at: (u32, Pose)) -> bool {
        !self.is_within(at, DISTINCT_M, DISTINCT_RADIANS)
    }

    /// Whether the robot may have gone from one of two places to the other by a transition.
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

    /// Counts the last score as that of a key scan.
    pub(super) fn grow(&mut self) {
        let before = f64::from(self.age.min(MEAN_OVER));
        self.mean = (self.mean * before + self.last) / (before + 1.0);
        self.age += 1;
        // A place that did not move goes on being compared from where it was.
        self.until_key = self.since_anchor;
        if self.novelty >= MOVED {
            self.anchor = (self.pose, self.covariance);
            self.until_key = DrivenPath::default();
        }
    }
}
