//! A place in a map, with the same fields in every JSON object that has one. Pure.

use geometry::Covariance;
use messages::{HypothesesHeader, Hypothesis, Pose2, PoseHeader, Verdict};
use schemars::JsonSchema;
use serde::Serialize;

/// The base, or the laser where its mount is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Frame {
    Base,
    #[default]
    Laser,
}

impl Frame {
    pub fn of(mount_is_known: bool) -> Self {
        match mount_is_known {
            true => Frame::Base,
            false => Frame::Laser,
        }
    }

    pub(super) fn columns(self) -> [&'static str; 2] {
        match self {
            Frame::Base => ["base x m", "base y m"],
            Frame::Laser => ["laser x m", "laser y m"],
        }
    }
}

/// Poses and likelihood of the robot. Poses are in the map, in metres and radians, and covariances
/// over x, y and yaw, row by row: m², m·rad, rad².
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct Place {
    /// Id of the map in hexadecimal, as JSON numbers cannot hold 64 bits safely.
    pub map_id: String,
    /// Name of the map, if it is one of several and its name is known.
    pub map: Option<String>,
    /// Frame whose pose is shown where there is room for one.
    #[serde(skip)]
    pub frame: Frame,
    /// Pose of the laser; `None` without a place.
    #[schemars(with = "Option<command_line::json::schema::Pose>")]
    pub laser: Option<Pose2>,
    /// Pose of the base; `None` also if the laser's mount is not known.
    #[schemars(with = "Option<command_line::json::schema::Pose>")]
    pub base: Option<Pose2>,
    /// Covariance of the laser's pose.
    pub laser_covariance: Option<[f64; 9]>,
    /// Covariance of the base's pose.
    pub base_covariance: Option<[f64; 9]>,
    /// Fit of the scan to the map at the pose, at most 1.
    pub score: Option<f64>,
    /// Probability of the pose, 0..=1.
    pub probability: Option<f64>,
}

/// One of the places that a search found.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Candidate {
    #[serde(flatten)]
    pub place: Place,
    /// Votes of the best pose that led there.
    pub intensity: u64,
    /// Votes of all poses that led there.
    pub support: u64,
}

pub fn map_id(id: u64) -> String {
    format!("{id:016x}")
}

impl Place {
    /// Creates a place from the pose of the laser with its covariance, and from that of the base
    /// if the laser's mount is known.
    pub fn new(id: u64, laser: Pose2, covariance: [f64; 9], base: Option<Pose2>) -> Self {
        let laser_covariance = finite(covariance);
        let of_base = |rows, base: Pose2| {
            let carried = Covariance::from_rows(rows).carried(laser.into(), base.into());
            finite(carried.to_rows())
        };
        Place {
            map_id: map_id(id),
            frame: Frame::of(base.is_some()),
            laser: Some(laser),
            base: base.filter(|&base| is_finite(base)),
            base_covariance: laser_covariance.zip(base).and_then(|(c, b)| of_base(c, b)),
            laser_covariance,
            ..Place::default()
        }
    }

    pub fn of_pose(header: &PoseHeader) -> Self {
        let (laser, base) = (header.laser(), header.base());
        Place {
            map_id: map_id(header.map_id),
            map: None,
            frame: Frame::of(header.mount_known == 1),
            laser,
            base,
            laser_covariance: laser.and_then(|_| finite(header.laser_covariance)),
            base_covariance: base.and_then(|_| finite(header.base_covariance)),
            score: laser.map(|_| header.score),
            probability: laser.map(|_| header.probability),
        }
    }

    pub fn pose(&self) -> Option<Pose2> {
        match self.frame {
            Frame::Base => self.base,
            Frame::Laser => self.laser,
        }
    }

    pub(super) fn covariance(&self) -> Option<Covariance> {
        let rows = match self.frame {
            Frame::Base => self.base_covariance,
            Frame::Laser => self.laser_covariance,
        };
        rows.map(Covariance::from_rows)
    }
}

impl Candidate {
    /// Converts the places of an answer, best first. Poses that are not finite are left out; with
    /// `NoScan` there is no place.
    pub fn all<'a>(
        header: &HypothesesHeader,
        found: &'a [Hypothesis],
        name_of: &'a dyn Fn(u64) -> Option<String>,
    ) -> impl Iterator<Item = Candidate> + use<'a> {
        let mount_known = header.mount_known == 1;
        let found = match Verdict::from_code(header.verdict) {
            Some(Verdict::NoScan) => &[],
            _ => found,
        };
        let found = found.iter().filter(|h| is_finite(h.map_from_laser));
        found.map(move |h| Candidate {
            place: Place {
                map: name_of(h.map_id),
                score: Some(h.score.into()),
                probability: Some(h.probability.into()),
                ..Place::new(
                    h.map_id,
                    h.map_from_laser,
                    h.covariance,
                    mount_known.then_some(h.map_from_base),
                )
            },
            intensity: h.intensity,
            support: h.support,
        })
    }
}

fn is_finite(pose: Pose2) -> bool {
    geometry::Pose::from(pose).is_finite()
}

fn finite(rows: [f64; 9]) -> Option<[f64; 9]> {
    rows.iter().all(|value| value.is_finite()).then_some(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::message;

    const NAMELESS: &dyn Fn(u64) -> Option<String> = &|_| None;

    #[test]
    fn the_base_behind_a_laser_is_less_certain_across() {
        let (mut header, mut found) = message(1, 0, Verdict::Unique as u32);
        header.mount_known = 1;
        // The laser looks along x, two metres ahead of the base: 0.06 m per sigma of yaw.
        found[0].map_from_laser = geometry::Pose::new(1.0, 2.0, 0.0).into();
        found[0].map_from_base = geometry::Pose::new(-1.0, 2.0, 0.0).into();
        found[0].covariance = [1e-4, 0.0, 0.0, 0.0, 1e-4, 0.0, 0.0, 0.0, 0.0009];
        let place = |found: &[Hypothesis]| Candidate::all(&header, found, NAMELESS).next();
        let ellipse = place(&found).unwrap().place.covariance().unwrap().ellipse();
        // The tolerance covers a few products and roots.
        assert!((ellipse.major_m - 0.0037f64.sqrt()).abs() < 1e-9);
        assert!((ellipse.minor_m - 0.01).abs() < 1e-9);
        found[0].map_from_base.x = f64::NAN;
        let place = place(&found).unwrap().place;
        assert_eq!((place.pose(), place.base_covariance), (None, None));
        assert!(place.laser_covariance.is_some());
    }

    #[test]
    fn what_is_not_finite_is_left_out() {
        let (mut header, [place]) = message(1, 0, Verdict::Unique as u32);
        let (mut nowhere, mut spread) = (place, place);
        nowhere.map_from_laser.x = f64::INFINITY;
        spread.covariance[0] = f64::NAN;
        let found = [nowhere, spread];
        let found: Vec<_> = Candidate::all(&header, &found, NAMELESS).collect();
        assert_eq!((found.len(), found[0].place.laser_covariance), (1, None));
        header.verdict = Verdict::NoScan as u32;
        assert_eq!(Candidate::all(&header, &[place], NAMELESS).count(), 0);
    }
}
