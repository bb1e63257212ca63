//! A ring of eight sonars: wide beams, walls that reflect like mirrors, and cross-talk.
//!
//! A transducer returns the nearest surface in its cone that is met nearly head on; a wall met at a
//! flat angle reflects the sound away (Leonard and Durrant-Whyte, Directed Sonar Sensing for Mobile
//! Robot Navigation, 1992). Double reflections are not simulated, and all transducers are at one
//! point.

use std::f32::consts::PI;

use command_line::number;
use geometry::{Pose, angle_between};
use rand::RngExt;
use rand::rngs::Xoshiro256PlusPlus;

use crate::Bearings;
use crate::noise::Receiver;
use crate::scene::Scene;

/// Bearings of the transducers, degrees counter-clockwise from ahead: six ahead and two behind, as
/// on the AmigoBot of section IV of the paper.
pub const TRANSDUCERS_DEG: [i32; 8] = [-145, -90, -41, -15, 15, 41, 90, 145];

/// Number of rays per turn, two per degree.
const RAYS: usize = 720;

/// Number of neighbouring rays on each side that can belong to a surface.
const NEIGHBOURS: usize = 4;

/// Minimum number of points of a surface; fewer are an edge or a post, which reflect in all
/// directions.
const MIN_POINTS: usize = 3;

/// Settings of the sonar ring.
#[derive(Debug, Clone, Copy, PartialEq, clap::Args)]
#[command(next_help_heading = "Sonar")]
pub struct SonarConfig {
    /// Eight sonars in place of the laser, six ahead and two behind; other bearings of the scan are
    /// NaN.
    #[arg(long)]
    pub sonar: bool,
    /// Full width of a transducer's cone, degrees, 1..=90.
    #[arg(long, value_name = "DEGREES", default_value_t = 30.0, value_parser = number(1.0..=90.0, "degrees"), requires = "sonar")]
    pub beam_width: f64,
    /// Largest angle from head on at which walls return an echo, degrees, 0..=90.
    #[arg(long, value_name = "DEGREES", default_value_t = 15.0, value_parser = number(0.0..=90.0, "degrees"), requires = "sonar")]
    pub specular_limit: f64,
    /// Share of the readings that are another transducer's echo, 0..=1.
    #[arg(long, value_name = "SHARE", default_value_t = 0.02, value_parser = number(0.0..=1.0, "as a share"), requires = "sonar")]
    pub cross_talk: f64,
}

#[derive(Debug, Clone, Copy)]
struct Hit {
    range_m: f64,
    /// In the sensor's frame, metres.
    point: [f64; 2],
}

#[derive(Debug)]
pub(crate) struct Ring {
    config: SonarConfig,
    rng: Xoshiro256PlusPlus,
}

impl Ring {
    /// One bearing per degree, from the rear.
    pub(crate) const BEARINGS: Bearings = Bearings {
        angle_min: -PI,
        angle_increment: PI / 180.0,
        count: 360,
    };

    pub(crate) fn new(config: SonarConfig, rng: Xoshiro256PlusPlus) -> Self {
        Ring { config, rng }
    }

    /// Readings by bearing, in metres; NaN without a transducer.
    pub(crate) fn scan(
        &mut self,
        scene: &Scene,
        map_from_laser: Pose,
        receiver: &mut Receiver,
    ) -> Vec<f32> {
        let echoes = self.echoes(&surroundings(scene, map_from_laser, receiver.range_max_m));
        let mut ranges = vec![f32::NAN; Self::BEARINGS.count];
        for (i, degrees) in TRANSDUCERS_DEG.into_iter().enumerate() {
            let [is_other, other] = [self.rng.random::<f64>(), self.rng.random()];
            let received = match is_other < self.config.cross_talk {
                true => (i + 1 + (other * (echoes.len() - 1) as f64) as usize) % echoes.len(),
                false => i,
            };
            ranges[(degrees + 180) as usize] = receiver.reading(echoes[received]);
        }
        ranges
    }

    /// First echo of each transducer, in metres.
    fn echoes(&self, hits: &[Option<Hit>]) -> [Option<f64>; TRANSDUCERS_DEG.len()] {
        let answers: Vec<_> = (0..RAYS).map(|ray| self.answer(hits, ray)).collect();
        TRANSDUCERS_DEG.map(|degrees| {
            let axis = f64::from(degrees).to_radians();
            // The margin of a thousandth of a degree allows for rounding.
            let half_width = (self.config.beam_width / 2.0 + 1e-3).to_radians();
            let in_cone = |&ray: &usize| angle_between(bearing(ray), axis) <= half_width;
            let received = (0..RAYS).filter(in_cone).filter_map(|ray| answers[ray]);
            received.min_by(f64::total_cmp)
        })
    }

    /// Range of a ray's hit, if its surface reflects the sound back.
    fn answer(&self, hits: &[Option<Hit>], ray: usize) -> Option<f64> {
        let hit = hits[ray]?;
        let incidence = incidence(&surface(hits, ray), bearing(ray));
        (incidence <= self.config.specular_limit.to_radians()).then_some(hit.range_m)
    }
}

fn bearing(ray: usize) -> f64 {
    ray as f64 * std::f64::consts::TAU / RAYS as f64
}

fn surroundings(scene: &Scene, map_from_laser: Pose, reach_m: f64) -> Vec<Option<Hit>> {
    let Pose { x, y, yaw } = map_from_laser;
    let hit = |ray| {
        let range_m = scene.range(x, y, yaw + bearing(ray), reach_m)?;
        let (sin, cos) = bearing(ray).sin_cos();
        let point = [range_m * cos, range_m * sin];
        Some(Hit { range_m, point })
    };
    (0..RAYS).map(hit).collect()
}

/// Points of the surface that a ray hits: hits of its neighbours up to the first jump in range.
fn surface(hits: &[Option<Hit>], ray: usize) -> Vec<[f64; 2]> {
    let mut points: Vec<_> = hits[ray].iter().map(|hit| hit.point).collect();
    for step in [1, RAYS - 1] {
        let mut last = hits[ray];
        for i in 1..=NEIGHBOURS {
            let next = hits[(ray + i * step) % RAYS];
            let (Some(from), Some(to)) = (last, next) else {
                break;
            };
            // Half a degree farther, a wall met at 80 degrees is 5 % farther; cells cause steps of
            // some centimetres.
            if (to.range_m - from.range_m).abs() > 0.05 + 0.05 * from.range_m {
                break;
            }
            points.push(to.point);
            last = next;
        }
    }
    points
}

/// Angle between a ray and the normal of the line through points, in radians; 0 if they are too few
/// for a surface.
fn incidence(points: &[[f64; 2]], angle: f64) -> f64 {
    if points.len() < MIN_POINTS {
        return 0.0;
    }
    let count = points.len() as f64;
    let mean = [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / count);
    let [mut xx, mut xy, mut yy] = [0.0; 3];
    for [x, y] in points {
        let [dx, dy] = [x - mean[0], y - mean[1]];
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
    }
    // Direction of the largest spread.
    let tangent = 0.5 * (2.0 * xy).atan2(xx - yy);
    (angle - tangent).cos().abs().asin()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{config, room};
    use crate::{Drive, Snapshot};

    fn drive(path: &str, options: &str) -> Vec<Snapshot> {
        let options = config(&format!("--sonar --noise 0 {options}"));
        let drive = Drive::new(&room(), &path.parse().unwrap(), &options).unwrap();
        drive.collect()
    }

    fn reading(snapshot: &Snapshot, degrees: i32) -> f32 {
        snapshot.ranges[(degrees + 180) as usize]
    }

    #[test]
    fn eight_bearings_have_readings_and_the_others_nan() {
        for snapshot in drive("1,1 9,1 9,7", "") {
            let is_transducer = |i| TRANSDUCERS_DEG.contains(&(i as i32 - 180));
            for (i, range) in snapshot.ranges.iter().enumerate() {
                assert_eq!(range.is_nan(), !is_transducer(i), "{i}");
            }
        }
    }

    #[test]
    fn a_wall_answers_at_its_foot_and_a_flat_one_not() {
        // 1.9 m from the wall below, and more than 5 m from all others.
        let first = &drive("5,2 6,2", "--cross-talk 0 --range-max 2.5")[0];
        let millimetre = |a: f32, b: f32| (a - b).abs() < 0.0011;
        assert!(millimetre(reading(first, -90), 1.9), "the axis is the foot");
        // The cone ends 49 degrees from the foot, and the wall reflects up to 15.
        assert!(reading(first, -41).is_infinite());
        assert!(reading(first, 90).is_infinite(), "out of range");
        // With a wide limit the near edge of the cone returns: 1.9 / cos 34°.
        let options = "--cross-talk 0 --range-max 2.5 --specular-limit 80";
        let first = &drive("5,2 6,2", options)[0];
        assert!(millimetre(
            reading(first, -41),
            1.9 / 34f32.to_radians().cos()
        ));
    }

    #[test]
    fn cross_talk_is_another_transducers_echo_as_often_as_asked_for() {
        let options = "--rate 25 --range-max 9 --speed 0.2 --specular-limit 90 --cross-talk";
        let path = "1,3 9,3 9,7";
        let (alone, with) = (
            drive(path, &format!("{options} 0")),
            drive(path, &format!("{options} 0.1")),
        );
        let (mut total, mut others) = (0.0, 0.0);
        for (alone, with) in alone.iter().zip(&with) {
            let echoes = TRANSDUCERS_DEG.map(|degrees| reading(alone, degrees));
            for (own, degrees) in echoes.into_iter().zip(TRANSDUCERS_DEG) {
                let received = reading(with, degrees);
                assert!(echoes.contains(&received));
                total += 1.0;
                others += f64::from(u8::from(received != own));
            }
        }
        // With 14,600 readings a share of 0.1 is known to 0.0025: four of those to each side, and 2
        // % fewer because two echoes may be equal by chance.
        let share: f64 = others / total;
        assert!((0.088..0.11).contains(&share), "{share}");
    }

    #[test]
    fn the_line_through_points_says_how_flat_a_wall_is_met() {
        let wall = |x: f64| [x, 1.0 - x];
        let points = [0.0, 0.1, 0.2, 0.3].map(wall);
        // The normal of that line points along 45 degrees.
        for (degrees, expected) in [(45.0, 0.0), (60.0, 15.0), (0.0, 45.0), (225.0, 0.0)] {
            let incidence = incidence(&points, f64::to_radians(degrees)).to_degrees();
            // Near head on, the arc sine is accurate only to the root of a rounding error.
            assert!(
                (incidence - expected).abs() < 1e-5,
                "{degrees}: {incidence}"
            );
        }
        assert_eq!(incidence(&points[..2], 0.0), 0.0);
    }
}
