//! Possible poses of the robot as a particle cloud, for tools that show one. Pure.
//!
//! The particles of a pose fill its covariance evenly. They come from a deterministic sequence, so
//! that equal results look equal.

use geometry::{Covariance, Pose};
use messages::{HypothesesHeader, Hypothesis, PoseHeader};
use nalgebra::{Matrix3, Vector3};
use ros::nav2_msgs::{Particle, ParticleCloud};
use ros::{Header, planar};

use crate::outgoing::LIKELY;

const POINTS: usize = 64;

const MOST: usize = 16;

type Place = (Pose, Covariance, f64);

pub(super) fn of_pose(header: Header, from: &PoseHeader) -> ParticleCloud {
    let covariance = Covariance::from_rows(from.base_covariance);
    let place = (from.map_from_base.into(), covariance, from.probability);
    cloud(header, [place].into_iter())
}

pub(super) fn of_hypotheses(
    header: Header,
    from: &HypothesesHeader,
    items: &[Hypothesis],
) -> ParticleCloud {
    let likely = from
        .on_map(items)
        .filter(|item| item.probability >= LIKELY)
        .take(MOST);
    let place = |item: &Hypothesis| {
        let robot = ros::poses::robot(from, item);
        let own = Covariance::from_rows(item.covariance);
        let covariance = own.carried(item.map_from_laser.into(), robot);
        (robot, covariance, f64::from(item.probability))
    };
    cloud(header, likely.map(place))
}

fn cloud(header: Header, places: impl Iterator<Item = Place>) -> ParticleCloud {
    let mut particles = Vec::new();
    for (pose, covariance, probability) in places {
        let weight = probability / POINTS as f64;
        let particle = |pose| Particle {
            pose: planar::pose(pose),
            weight,
        };
        match Matrix3::from(covariance).cholesky() {
            Some(root) => particles.extend((0..POINTS).map(|index| {
                let off = root.l() * Vector3::from(normal(index));
                particle(Pose::new(
                    pose.x + off[0],
                    pose.y + off[1],
                    pose.yaw + off[2],
                ))
            })),
            // The covariance has no Cholesky root, for example if it is zero: all particles are at
            // the pose.
            None => particles.extend((0..POINTS).map(|_| particle(pose))),
        }
    }
    ParticleCloud { header, particles }
}

/// Returns three numbers of a normal distribution: the Box-Muller transform of Halton's sequence.
fn normal(index: usize) -> [f64; 3] {
    let [a, b, c, d] = [2, 3, 5, 7].map(|base| halton(index + 1, base));
    let pair = |radius: f64, turn: f64| {
        let radius = (-2.0 * radius.ln()).sqrt();
        let (sin, cos) = (std::f64::consts::TAU * turn).sin_cos();
        (radius * cos, radius * sin)
    };
    let ((x, y), (yaw, _)) = (pair(a, b), pair(c, d));
    [x, y, yaw]
}

/// Halton's sequence: the digits of the index in this base, mirrored at the radix point; 0 to 1.
fn halton(mut index: usize, base: usize) -> f64 {
    let (mut result, mut digit) = (0.0, 1.0);
    while index > 0 {
        digit /= base as f64;
        result += digit * (index % base) as f64;
        index /= base;
    }
    result
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;

    #[test]
    fn the_points_have_the_mean_and_the_covariance_of_their_place() {
        let covariance = [0.04, 0.01, 0.0, 0.01, 0.09, 0.0, 0.0, 0.0, 0.01];
        let from = PoseHeader {
            map_from_base: Pose::new(3.0, -1.0, 0.5).into(),
            base_covariance: covariance,
            probability: 0.5,
            ..PoseHeader::zeroed()
        };
        let cloud = of_pose(Header::default(), &from);
        let places: Vec<Pose> = cloud
            .particles
            .iter()
            .map(|p| p.pose.planar().unwrap())
            .collect();
        let mean =
            |of: &dyn Fn(&Pose) -> f64| places.iter().map(of).sum::<f64>() / places.len() as f64;
        let (x, y) = (mean(&|p| p.x), mean(&|p| p.y));
        // 64 points: a tenth of a deviation, and a third of a variance.
        assert!((x - 3.0).abs() < 0.02 && (y + 1.0).abs() < 0.03, "{x} {y}");
        let xx = mean(&|p| (p.x - x) * (p.x - x));
        let yy = mean(&|p| (p.y - y) * (p.y - y));
        assert!(
            (xx / 0.04 - 1.0).abs() < 0.33 && (yy / 0.09 - 1.0).abs() < 0.33,
            "{xx} {yy}"
        );
        let sum: f64 = cloud.particles.iter().map(|p| p.weight).sum();
        assert!((sum - 0.5).abs() < 1e-12);
        assert_eq!(cloud, of_pose(Header::default(), &from));
    }

    #[test]
    fn hypotheses_have_their_weights_and_unlikely_ones_are_not_shown() {
        let item = |x: f64, probability| {
            let mut item = Hypothesis {
                probability,
                ..Hypothesis::zeroed()
            };
            item.map_from_base.x = x;
            item
        };
        let header = HypothesesHeader {
            mount_known: 1,
            ..HypothesesHeader::zeroed()
        };
        let items = [item(1.0, 0.5), item(2.0, 0.25), item(3.0, 0.001)];
        let cloud = of_hypotheses(Header::default(), &header, &items);
        assert_eq!(cloud.particles.len(), 2 * POINTS);
        // Without a covariance, all particles are at the pose.
        assert!(
            cloud.particles[..POINTS]
                .iter()
                .all(|p| p.pose.position.x == 1.0)
        );
        assert_eq!(cloud.particles[POINTS].weight, 0.25 / POINTS as f64);
        let many = vec![item(1.0, 0.5); 1000];
        let cloud = of_hypotheses(Header::default(), &header, &many);
        assert_eq!(cloud.particles.len(), MOST * POINTS);
    }
}
