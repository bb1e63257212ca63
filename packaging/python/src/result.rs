//! Result of a scan for Python.

use engine::localizer::Answer;
use engine::peaks::{Place, Target};
use geometry::{Covariance, Pose};
use numpy::{PyArray1, PyArray2, PyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::kept::{self, by_fields};
use crate::numbers::{self, PoseTuple, covariances, matrix, poses};

by_fields! {
    /// Places at which a scan may have been taken, best first, with a verdict.
    #[pyclass(frozen, get_all, module = "backcast", name = "Result")]
    struct LocateResult {
        /// Verdict on the places: "Unique", one place fits and no other comes near it;
        /// "Ambiguous", several fit about as well; "PoorFit", even the best fits badly, perhaps
        /// because it is another map; "NoScan", the scan has no usable information.
        verdict: String,
        /// Explanation of the verdict.
        why: String,
        /// Probability of the best place, 0 to 1.
        confidence: f64,
        /// Number of other places that fit about as well as the best.
        alternatives: u32,
        /// Frame of the poses: "base" if a mount was given, otherwise "laser".
        frame: String,
        /// Pose of the best place, (x, y, yaw) in the map, metres and radians; None if there is
        /// no place. It is the base's pose if a mount was given, otherwise the laser's.
        pose: Option<PoseTuple>,
        /// Covariance of pose, 3 × 3 over x, y and yaw in m², m·rad and rad²; None if there is
        /// no place.
        covariance: Option<Py<PyArray2<f64>>>,
        /// N × 3: x, y and yaw of each place in the map, metres and radians, best first; of the
        /// base if a mount was given, otherwise of the laser.
        poses: Py<PyArray2<f64>>,
        /// N × 3 × 3: covariance of each pose, over x, y and yaw in m², m·rad and rad².
        covariances: Py<PyArray3<f64>>,
        /// N: probability of each place, 0 to 1. The remainder to 1 is the probability that the
        /// robot is at none of them.
        probabilities: Py<PyArray1<f64>>,
        /// N: score of each place, at most 1: how well the scan fits the map there.
        scores: Py<PyArray1<f64>>,
        /// N: votes of the best pose that led to each place.
        votes: Py<PyArray1<u16>>,
        /// N × 3: poses, always of the laser.
        laser_poses: Py<PyArray2<f64>>,
        /// N × 3 × 3: covariances, always of the laser.
        laser_covariances: Py<PyArray3<f64>>,
        /// Number of beams that voted.
        beams_used: u32,
    }
}

/// Data of a result, before Python's lock is taken.
#[derive(Debug)]
pub(crate) struct Found {
    verdict: &'static str,
    why: String,
    confidence: f64,
    alternatives: u32,
    beams_used: u32,
    places: Vec<Place>,
}

impl Found {
    /// Copies an answer for this target, as places of the first laser.
    pub(crate) fn of(answer: Answer<'_>, target: Target) -> Self {
        let Answer {
            outcome, places, ..
        } = answer;
        let of_laser = places.places.iter().map(|place| place.of_laser(target));
        Found {
            verdict: places.verdict.as_str(),
            why: places.sentence(),
            confidence: places.confidence,
            alternatives: places.alternatives,
            beams_used: outcome.beams_used,
            places: of_laser.collect(),
        }
    }

    /// Makes the result for Python, for a laser with this mount.
    pub(crate) fn read(
        self,
        py: Python<'_>,
        base_from_laser: Option<Pose>,
    ) -> PyResult<LocateResult> {
        let target = Target::of(base_from_laser, false);
        let of_laser = || self.places.iter().map(|place| place.map_from_laser);
        let lasers: Vec<Pose> = of_laser().collect();
        let bases: Vec<Pose> = match base_from_laser {
            Some(_) => of_laser().map(|laser| target.base(laser)).collect(),
            None => lasers.clone(),
        };
        let laser_covariances: Vec<Covariance> =
            self.places.iter().map(|place| place.covariance).collect();
        let carried = laser_covariances.iter().zip(lasers.iter().zip(&bases));
        let base_covariances: Vec<Covariance> = carried
            .map(|(covariance, (&laser, &base))| covariance.carried(laser, base))
            .collect();
        let of_each = |read: fn(&Place) -> f64| {
            PyArray1::from_vec(py, self.places.iter().map(read).collect()).unbind()
        };
        let votes = self.places.iter().map(|place| place.intensity);
        let best = base_covariances.first();
        Ok(LocateResult {
            verdict: self.verdict.to_owned(),
            why: self.why,
            confidence: self.confidence,
            alternatives: self.alternatives,
            frame: match base_from_laser {
                Some(_) => "base",
                None => "laser",
            }
            .to_owned(),
            pose: bases.first().map(|&best| numbers::tuple(best)),
            covariance: best.map(|&best| matrix(py, best)).transpose()?,
            poses: poses(py, &bases)?,
            covariances: covariances(py, &base_covariances)?,
            probabilities: of_each(|place| place.probability),
            scores: of_each(|place| place.score),
            votes: PyArray1::from_vec(py, votes.collect()).unbind(),
            laser_poses: poses(py, &lasers)?,
            laser_covariances: covariances(py, &laser_covariances)?,
            beams_used: self.beams_used,
        })
    }
}

impl LocateResult {
    fn shown(&self) -> String {
        let what = format!("Result {}", self.verdict);
        kept::shown(&what, &self.frame, self.pose, &self.why)
    }
}
