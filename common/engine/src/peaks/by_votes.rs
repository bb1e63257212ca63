//! Places by votes alone: a peak is refined by its centroid, and its shape gives the covariance.

use geometry::{Covariance, wrap_angle};
use nalgebra::{Matrix3, Vector3};

use super::summits::{self, Reach, Summit};
use super::{PeakConfig, PeakInput, Place, Places, Workspace, in_map};

/// Share of a peak's height above which votes belong to its shape: below it, the flanks of other
/// peaks begin.
const PEAK_BASE_SHARE: f64 = 0.85;

impl Workspace {
    /// Finds the places from the votes of a scan, by the paper's method.
    pub fn by_votes(&mut self, input: &PeakInput<'_>, config: &PeakConfig) -> &Places {
        let reach = Reach::new(input, config.same_place_m, config.same_place_deg);
        let (summits, found) = (&mut self.summits, &mut self.places);
        let most = config.max_hypotheses as usize;
        summits::find(input, reach, (most, most), summits);
        found.clear();
        let places = summits.iter().map(|summit| place(input, summit, reach));
        found.places.extend(places);
        if let Some(best) = found.places.first().copied() {
            let next = f64::from(input.certified_floor.saturating_sub(1));
            let may_lack = input.may_lack(config.ambiguous_share);
            found.judge_by_votes(best, may_lack, next, config);
            found.inlier_share = best.score;
        }
        found
    }
}

/// Makes the place of a summit: the centroid and the spread of the votes around it.
fn place(input: &PeakInput<'_>, summit: &Summit, reach: Reach) -> Place {
    let summit = &summit.vote;
    let base = f64::from(summit.intensity) * PEAK_BASE_SHARE;
    let mut moments = Moments::default();
    for vote in input.votes {
        let height = f64::from(vote.intensity) - base;
        if height <= 0.0 {
            break;
        }
        if input.are_near(summit, vote, reach) {
            let turn = wrap_angle(input.heading_of(vote) - input.heading_of(summit));
            let (dx, dy) = (
                f64::from(vote.x) - f64::from(summit.x),
                f64::from(vote.y) - f64::from(summit.y),
            );
            moments.add(height, Vector3::new(dx, dy, turn));
        }
    }
    let centre = moments.mean();
    let grid_heading = input.heading_of(summit) + centre.z;
    let (x, y) = (
        f64::from(summit.x) + 0.5 + centre.x,
        f64::from(summit.y) + 0.5 + centre.y,
    );
    let mut map_from_laser = input.frame.map_from_cells(x, y, grid_heading);
    if let Some(heading) = input.known_heading {
        map_from_laser.yaw = wrap_angle(heading);
    }
    Place {
        map: 0,
        map_from_laser,
        covariance: spread_in_map(input, moments.covariance()),
        probability: 0.0,
        score: f64::from(summit.intensity) / f64::from(input.highest_possible.max(1)),
        intensity: summit.intensity,
        possible: input.highest_possible as u16,
        drawn_doubt: 0.0,
        support: moments.count,
    }
}

/// Adds the covariance of rounding to the search grid to one over cells and radians, and converts
/// it to metres along the map's axes.
fn spread_in_map(input: &PeakInput<'_>, in_cells: Matrix3<f64>) -> Covariance {
    // A value rounded to steps of width w has the variance w²/12.
    let step = std::f64::consts::TAU / f64::from(input.headings);
    let heading_rounding = if input.known_heading.is_some() {
        0.0
    } else {
        step * step / 12.0
    };
    let rounding = Vector3::new(1.0 / 12.0, 1.0 / 12.0, heading_rounding);
    in_map(input.frame, in_cells + Matrix3::from_diagonal(&rounding))
}

/// Weighted moments of offsets from a summit.
#[derive(Debug, Default)]
struct Moments {
    count: u64,
    weight: f64,
    sum: Vector3<f64>,
    squares: Matrix3<f64>,
}

impl Moments {
    fn add(&mut self, weight: f64, offset: Vector3<f64>) {
        self.count += 1;
        self.weight += weight;
        self.sum += weight * offset;
        self.squares += weight * offset * offset.transpose();
    }

    fn mean(&self) -> Vector3<f64> {
        if self.weight > 0.0 {
            self.sum / self.weight
        } else {
            Vector3::zeros()
        }
    }

    fn covariance(&self) -> Matrix3<f64> {
        let mean = self.mean();
        if self.weight > 0.0 {
            self.squares / self.weight - mean * mean.transpose()
        } else {
            Matrix3::zeros()
        }
    }
}
