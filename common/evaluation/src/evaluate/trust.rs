//! Whether what an answer says of itself is true: its probabilities and its
//! ellipses. Pure.

use engine::peaks::Place;
use geometry::Pose;
use serde::Serialize;

/// Where one range of probabilities ends and the next begins: closer where a user
/// decides, near 1.
const ENDS: [f64; 8] = [0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.99, 1.0];

/// Answers whose best place had a probability in one range.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct Said {
    /// The range; its upper end belongs to it.
    pub(super) from: f64,
    pub(super) to: f64,
    /// This many answers.
    pub(super) answers: u64,
    /// Those of them within 0.5 m and 10°.
    pub(super) right: u64,
    /// The mean of their probabilities.
    pub(super) mean: Option<f64>,
}

/// Collects what answers say of themselves, and how it turned out.
#[derive(Debug, Clone, Default)]
pub(super) struct Trust {
    answers: [u64; ENDS.len()],
    right: [u64; ENDS.len()],
    /// Sums of probabilities.
    said: [f64; ENDS.len()],
}

impl Trust {
    /// Takes note of an answer's best place.
    pub(super) fn add(&mut self, probability: f64, is_right: bool) {
        // Rounded sums may be a trifle more than 1.
        let i = ENDS.iter().position(|&end| probability <= end);
        let i = i.unwrap_or(ENDS.len() - 1);
        self.answers[i] += 1;
        self.right[i] += u64::from(is_right);
        self.said[i] += probability;
    }

    /// Takes over what another has collected.
    pub(super) fn merge(&mut self, other: &Trust) {
        for i in 0..ENDS.len() {
            self.answers[i] += other.answers[i];
            self.right[i] += other.right[i];
            self.said[i] += other.said[i];
        }
    }

    /// What was said in each range, the lowest first.
    pub(super) fn said(&self) -> [Said; ENDS.len()] {
        std::array::from_fn(|i| {
            let answers = self.answers[i];
            Said {
                from: if i == 0 { 0.0 } else { ENDS[i - 1] },
                to: ENDS[i],
                answers,
                right: self.right[i],
                mean: (answers > 0).then(|| self.said[i] / answers as f64),
            }
        })
    }
}

/// Whether a position lies in the ellipse that is to hold 95 % of the truths.
pub(super) fn is_in_ellipse(place: &Place, truth: Pose) -> bool {
    let pose = place.map_from_laser;
    let off = (truth.x - pose.x, truth.y - pose.y);
    statistics::holds(place.covariance, off)
}
