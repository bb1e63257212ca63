//! From votes to hypotheses: distinct places, refined, with their spread and a
//! verdict.
//!
//! Votes of neighbouring poses make up one peak. The best vote names a place,
//! all votes near it are taken for the same place, and so on down the list. A
//! place is refined below the cell by the centre of its peak, and the peak's
//! shape is its covariance.

use geometry::{Covariance, Pose, angle_between, wrap_angle};
use messages::{Verdict, Vote};
use nalgebra::{Matrix3, Rotation2, Vector3};

use crate::grid::GridFrame;
use crate::localizer::Outcome;

/// When votes make up one place, and when a place stands alone.
#[derive(Debug, Clone, Copy, PartialEq, clap::Args)]
pub struct PeakConfig {
    /// Poses within this distance and `--same-place-deg` are one place,
    /// metres, 0..=2.
    #[arg(long, value_name = "METRES", default_value_t = 0.5, value_parser = crate::config::parse_length)]
    pub same_place_m: f64,
    /// Poses within this angle and `--same-place-m` are one place, degrees,
    /// 0..=180.
    #[arg(long, value_name = "DEGREES", default_value_t = 10.0, value_parser = crate::config::parse_degrees)]
    pub same_place_deg: f64,
    /// Most places that are reported, 1..=1000.
    #[arg(long, value_name = "COUNT", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub max_hypotheses: u32,
    /// Another place with at least this share of the best one's votes makes
    /// the answer ambiguous, 0..=1.
    #[arg(long, value_name = "SHARE", default_value_t = 0.92, value_parser = crate::config::parse_share)]
    pub ambiguous_share: f64,
    /// A best place with less than this share of the votes that are possible
    /// fits poorly, 0..=1.
    #[arg(long, value_name = "SHARE", default_value_t = 0.35, value_parser = crate::config::parse_share)]
    pub poor_fit_share: f64,
}

impl Default for PeakConfig {
    fn default() -> Self {
        PeakConfig {
            same_place_m: 0.5,
            same_place_deg: 10.0,
            max_hypotheses: 64,
            ambiguous_share: 0.92,
            poor_fit_share: 0.35,
        }
    }
}

/// Votes from this share of a peak's height up make up its shape: below, the
/// flanks of other peaks begin.
const PEAK_BASE_SHARE: f64 = 0.85;

/// The votes of one scan and what is needed to read them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeakInput<'a> {
    /// By falling intensity.
    pub votes: &'a [Vote],
    /// All poses at or above this intensity are among the votes.
    pub certified_floor: u32,
    /// What a pose would have if every beam agreed fully.
    pub highest_possible: u32,
    /// Headings a turn.
    pub headings: u32,
    /// The heading that was given, in the map frame, radians.
    pub known_heading: Option<f64>,
    /// Where the votes' grid lies in the map.
    pub frame: GridFrame,
}

impl<'a> PeakInput<'a> {
    /// The input for an outcome on a map.
    #[must_use]
    pub fn of(outcome: &'a Outcome, frame: GridFrame) -> Self {
        PeakInput {
            votes: &outcome.found.votes,
            certified_floor: u32::from(outcome.found.certified_floor),
            highest_possible: outcome.highest_possible,
            headings: outcome.headings,
            known_heading: outcome.known_heading,
            frame,
        }
    }

    fn heading_of(&self, vote: &Vote) -> f64 {
        f64::from(vote.heading) * std::f64::consts::TAU / f64::from(self.headings)
    }

    /// Whether the votes lie within the distance in cells and the angle.
    fn are_near(&self, a: &Vote, b: &Vote, cells: f64, angle: f64) -> bool {
        let (dx, dy) = (
            f64::from(a.x) - f64::from(b.x),
            f64::from(a.y) - f64::from(b.y),
        );
        dx * dx + dy * dy <= cells * cells
            && angle_between(self.heading_of(a), self.heading_of(b)) <= angle
    }
}

/// One place where the robot may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Pose of the laser.
    pub map_from_laser: Pose,
    /// The peak's spread, in the map frame.
    pub covariance: Covariance,
    /// Share of the votes that the pose could have at most, 0..=1.
    pub score: f64,
    /// Votes of the peak's highest pose.
    pub intensity: u16,
    /// Votes that make up the peak.
    pub support: u64,
}

/// What a scan's votes say.
#[derive(Debug, Clone, PartialEq)]
pub struct Places {
    /// Distinct places, best first.
    pub places: Vec<Place>,
    /// What they allow to say about the pose.
    pub verdict: Verdict,
    /// Other places that fit about as well as the best.
    pub alternatives: u32,
    /// How far the best place stands above the next, as a share of its votes;
    /// where none was collected, above the floor below which none was sought.
    pub confidence: f64,
}

/// Reads the places from the votes of a scan.
#[must_use]
pub fn extract(input: &PeakInput<'_>, config: &PeakConfig) -> Places {
    let summits = distinct(input, config);
    let places: Vec<Place> = summits
        .iter()
        .map(|summit| place(input, summit, config))
        .collect();
    let Some(best) = places.first() else {
        return Places {
            places,
            verdict: Verdict::NoScan,
            alternatives: 0,
            confidence: 0.0,
        };
    };
    let rival = f64::from(best.intensity) * config.ambiguous_share;
    let alternatives = places[1..]
        .iter()
        .filter(|place| f64::from(place.intensity) >= rival)
        .count() as u32;
    let next = places.get(1).map_or_else(
        || input.certified_floor.saturating_sub(1),
        |next| u32::from(next.intensity),
    );
    let confidence = (1.0 - f64::from(next) / f64::from(best.intensity)).clamp(0.0, 1.0);
    let verdict = match () {
        () if best.score < config.poor_fit_share => Verdict::PoorFit,
        () if alternatives > 0 => Verdict::Ambiguous,
        () => Verdict::Unique,
    };
    Places {
        verdict,
        alternatives,
        confidence,
        places,
    }
}

/// The best vote of each place, best first.
fn distinct(input: &PeakInput<'_>, config: &PeakConfig) -> Vec<Vote> {
    let cells = config.same_place_m / input.frame.resolution_m;
    let angle = config.same_place_deg.to_radians();
    let mut summits: Vec<Vote> = Vec::new();
    for vote in input.votes {
        if summits.len() == config.max_hypotheses as usize {
            break;
        }
        if !summits
            .iter()
            .any(|summit| input.are_near(summit, vote, cells, angle))
        {
            summits.push(*vote);
        }
    }
    summits
}

/// The place of a summit: the centre and the spread of the votes around it.
fn place(input: &PeakInput<'_>, summit: &Vote, config: &PeakConfig) -> Place {
    let cells = config.same_place_m / input.frame.resolution_m;
    let angle = config.same_place_deg.to_radians();
    let base = f64::from(summit.intensity) * PEAK_BASE_SHARE;
    let mut moments = Moments::default();
    for vote in input.votes {
        let height = f64::from(vote.intensity) - base;
        if height <= 0.0 {
            break;
        }
        if input.are_near(summit, vote, cells, angle) {
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
        map_from_laser,
        covariance: spread_in_map(input, moments.covariance()),
        score: f64::from(summit.intensity) / f64::from(input.highest_possible.max(1)),
        intensity: summit.intensity,
        support: moments.count,
    }
}

/// A covariance over cells and radians, with that of rounding to the search
/// grid, in metres along the map's axes.
fn spread_in_map(input: &PeakInput<'_>, in_cells: Matrix3<f64>) -> Covariance {
    // A value rounded to steps of width w varies by w²/12 around it.
    let step = std::f64::consts::TAU / f64::from(input.headings);
    let heading_rounding = if input.known_heading.is_some() {
        0.0
    } else {
        step * step / 12.0
    };
    let rounding = Vector3::new(1.0 / 12.0, 1.0 / 12.0, heading_rounding);
    let in_cells = in_cells + Matrix3::from_diagonal(&rounding);
    let scale = Matrix3::from_diagonal(&Vector3::new(
        input.frame.resolution_m,
        input.frame.resolution_m,
        1.0,
    ));
    let turn = Rotation2::new(input.frame.map_from_grid.yaw).to_homogeneous() * scale;
    Covariance(turn * in_cells * turn.transpose())
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

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    fn vote(x: u16, y: u16, heading: u16, intensity: u16) -> Vote {
        Vote {
            x,
            y,
            heading,
            intensity,
        }
    }

    fn input(votes: &[Vote]) -> PeakInput<'_> {
        PeakInput {
            votes,
            certified_floor: 85,
            highest_possible: 200,
            headings: 360,
            known_heading: None,
            frame: GridFrame {
                resolution_m: 0.1,
                map_from_grid: Pose::new(0.0, 0.0, FRAC_PI_2),
            },
        }
    }

    #[test]
    fn no_votes_are_no_scan() {
        let places = extract(&input(&[]), &PeakConfig::default());
        assert_eq!((places.verdict, places.places.len()), (Verdict::NoScan, 0));
    }

    #[test]
    fn votes_close_by_are_one_place_refined_to_its_centre() {
        let votes = [
            vote(10, 20, 359, 100),
            vote(11, 20, 1, 100),
            vote(10, 20, 1, 99),
            vote(11, 20, 359, 99),
        ];
        let places = extract(&input(&votes), &PeakConfig::default());
        assert_eq!(
            (places.verdict, places.places.len(), places.alternatives),
            (Verdict::Unique, 1, 0)
        );
        let best = places.places[0];
        // Cells (11, 20.5) of a grid that is turned by a quarter: x is -y, y is x.
        let centre = Pose::new(-2.05, 1.1, FRAC_PI_2);
        assert!(
            best.map_from_laser.is_within(centre, 1e-9, 1e-9),
            "{:?}",
            best.map_from_laser
        );
        assert_eq!((best.score, best.support), (0.5, 4));
        // Nothing else was found down to 85: the lead is at least 16 of 100.
        assert!((places.confidence - 0.16).abs() < 1e-12);
    }

    #[test]
    fn the_covariance_lies_as_the_peak_does() {
        let votes: Vec<Vote> = (8..=12).map(|x| vote(x, 20, 0, 100)).collect();
        let places = extract(&input(&votes), &PeakConfig::default());
        let ellipse = places.places[0].covariance.ellipse();
        // Five cells in a row have variance 2, and rounding adds 1/12.
        assert!((ellipse.major_m - 0.1 * (2.0f64 + 1.0 / 12.0).sqrt()).abs() < 1e-9);
        assert!((ellipse.minor_m - 0.1 * (1.0f64 / 12.0).sqrt()).abs() < 1e-9);
        assert!(
            (ellipse.angle.sin().abs() - 1.0).abs() < 1e-9,
            "the grid's x is the map's y"
        );
    }

    #[test]
    fn equal_places_are_ambiguous_and_weak_ones_fit_poorly() {
        let votes = [
            vote(10, 20, 0, 100),
            vote(40, 20, 0, 95),
            vote(10, 20, 180, 93),
            vote(70, 70, 0, 86),
        ];
        let places = extract(&input(&votes), &PeakConfig::default());
        assert_eq!(
            (places.verdict, places.alternatives, places.places.len()),
            (Verdict::Ambiguous, 2, 4)
        );
        assert!((places.confidence - 0.05).abs() < 1e-12);
        let weak = PeakInput {
            highest_possible: 1000,
            ..input(&votes)
        };
        assert_eq!(
            extract(&weak, &PeakConfig::default()).verdict,
            Verdict::PoorFit
        );
    }

    #[test]
    fn a_known_heading_is_kept_as_given() {
        let votes = [vote(10, 20, 30, 100)];
        let known = PeakInput {
            known_heading: Some(0.123),
            ..input(&votes)
        };
        let best = extract(&known, &PeakConfig::default()).places[0];
        assert_eq!(best.map_from_laser.yaw, 0.123);
        assert_eq!(best.covariance.0[(2, 2)], 0.0);
    }
}
