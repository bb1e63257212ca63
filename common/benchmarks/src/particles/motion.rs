//! Motion model of the particles.
//!
//! Each particle moves by the measured odometry step in its own frame, with an independent error:
//! sampling from a motion model as in Probabilistic Robotics (Thrun, Burgard and Fox, 2005),
//! section 5.4. It differs from table 5.6. The errors are normal on the step itself, not on a turn,
//! a distance and another turn, because a robot that stands still or drives sideways has no first
//! turn that could be determined. And their variances grow with the distance, not with its square,
//! as errors do that are independent from step to step, so that two half steps scatter like one.

use geometry::{Pose, wrap_angle};
use rand_distr::{Distribution, StandardNormal};

use super::Particle;
use engine::fit::GridPose;
use engine::particles::Rng;

/// Errors of a step: normal, along x, y and the heading independently.
///
/// The emulator's odometry has the same kind of noise, with half the deviations: particles that
/// scatter too much lose weight at the next scan, but particles that scatter too little miss the
/// robot's pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OdometryNoise {
    /// Standard deviation after one metre: of x and y in metres and of the heading in radians,
    /// 0..=2. It grows with the square root of the distance.
    pub particles_noise_per_metre: f64,
    /// Standard deviation of the heading after turning by one radian, radians, 0..=2.
    /// It grows with the square root of the angle.
    pub particles_noise_per_radian: f64,
    /// Minimum standard deviation of x and y per step, metres, 0..=2: copies of a particle spread
    /// even if the robot stands still. The default is a fifth of a cell of 5 cm.
    pub particles_noise_least_m: f64,
    /// Minimum standard deviation of the heading per step, degrees, 0..=180.
    pub particles_noise_least_deg: f64,
}

impl Default for OdometryNoise {
    fn default() -> Self {
        OdometryNoise {
            particles_noise_per_metre: 0.06,
            particles_noise_per_radian: 0.06,
            particles_noise_least_m: 0.01,
            particles_noise_least_deg: 0.2,
        }
    }
}

impl OdometryNoise {
    /// Standard deviations of a step: of x and y in metres, and of the heading in radians.
    #[must_use]
    pub fn deviations(&self, step: Pose) -> (f64, f64) {
        let (way, turn) = (step.x.hypot(step.y), step.yaw.abs());
        let by_way = self.particles_noise_per_metre.powi(2) * way;
        let by_turn = self.particles_noise_per_radian.powi(2) * turn;
        let least_m = self.particles_noise_least_m.powi(2);
        let least_turn = self.particles_noise_least_deg.to_radians().powi(2);
        (
            (by_way + least_m).sqrt(),
            (by_way + by_turn + least_turn).sqrt(),
        )
    }
}

/// Moves each particle by the step, given in its own frame in metres and radians.
pub(super) fn advance(
    particles: &mut [Particle],
    step: Pose,
    noise: &OdometryNoise,
    resolution_m: f64,
    rng: &mut Rng,
) {
    let (way_m, turn) = noise.deviations(step);
    let way = way_m / resolution_m;
    let (ahead, left) = (step.x / resolution_m, step.y / resolution_m);
    for particle in particles {
        let mut error = || -> f64 { StandardNormal.sample(rng) };
        let ahead = ahead + way * error();
        let left = left + way * error();
        let turned = step.yaw + turn * error();
        let GridPose { x, y, heading } = particle.pose;
        let (sin, cos) = heading.sin_cos();
        particle.pose = GridPose {
            x: x + cos * ahead - sin * left,
            y: y + sin * ahead + cos * left,
            heading: wrap_angle(heading + turned),
        };
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;

    const COUNT: usize = 20_000;
    const NOISE: OdometryNoise = OdometryNoise {
        particles_noise_per_metre: 0.1,
        particles_noise_per_radian: 0.2,
        particles_noise_least_m: 0.0,
        particles_noise_least_deg: 0.0,
    };

    const START: GridPose = GridPose {
        x: 100.0,
        y: 50.0,
        heading: std::f64::consts::FRAC_PI_2,
    };

    /// Particles after steps on cells of 0.1 m.
    fn moved(steps: &[Pose], noise: &OdometryNoise) -> Vec<Particle> {
        let start = Particle {
            pose: START,
            weight: 1.0,
        };
        let mut particles = vec![start; COUNT];
        let mut rng = Rng::seed_from_u64(7);
        for &step in steps {
            advance(&mut particles, step, noise, 0.1, &mut rng);
        }
        particles
    }

    /// Means and standard deviations of x, y and heading after steps.
    fn moments(steps: &[Pose], noise: &OdometryNoise) -> [(f64, f64); 3] {
        let particles = moved(steps, noise);
        let moment = |of: fn(&GridPose) -> f64| {
            let values = || particles.iter().map(|particle| of(&particle.pose));
            let mean = values().sum::<f64>() / COUNT as f64;
            let variance = values().map(|value| (value - mean).powi(2)).sum::<f64>();
            (mean, (variance / COUNT as f64).sqrt())
        };
        [moment(|p| p.x), moment(|p| p.y), moment(|p| p.heading)]
    }

    /// Checks means within four of their standard errors, and deviations within 3 %: four of their
    /// standard errors of 1 / √(2 · 20000).
    #[track_caller]
    fn check(found: [(f64, f64); 3], expected: [(f64, f64); 3]) {
        for ((mean, deviation), (true_mean, true_deviation)) in found.into_iter().zip(expected) {
            let mean_error = 4.0 * true_deviation / (COUNT as f64).sqrt() + 1e-9;
            assert!((mean - true_mean).abs() <= mean_error, "{found:?}");
            let error = 0.03 * true_deviation + 1e-9;
            assert!((deviation - true_deviation).abs() <= error, "{found:?}");
        }
    }

    #[test]
    fn a_step_has_the_mean_and_the_deviations_that_are_asked_for() {
        let found = moments(&[Pose::new(4.0, 0.0, 0.5)], &NOISE);
        // 4 m ahead, along y; 2 cells are 0.1 m times the root of 4.
        let turn = (0.1f64.powi(2) * 4.0 + 0.2f64.powi(2) * 0.5).sqrt();
        let heading = std::f64::consts::FRAC_PI_2 + 0.5;
        check(found, [(100.0, 2.0), (90.0, 2.0), (heading, turn)]);
    }

    #[test]
    fn a_step_in_two_halves_scatters_as_one_does() {
        let straight = OdometryNoise {
            particles_noise_per_radian: 0.0,
            ..NOISE
        };
        let (whole, half) = (Pose::new(0.4, 0.0, 0.0), Pose::new(0.2, 0.0, 0.0));
        check(
            moments(&[half, half], &straight),
            moments(&[whole], &straight),
        );
    }

    #[test]
    fn a_heading_that_does_not_err_stays_to_the_last_bit() {
        let level = OdometryNoise {
            particles_noise_per_metre: 0.0,
            particles_noise_per_radian: 0.0,
            particles_noise_least_m: 0.3,
            particles_noise_least_deg: 0.0,
        };
        let mut particles = moved(&[Pose::IDENTITY], &level);
        assert!(particles.iter().all(|p| p.pose.heading == START.heading));
        particles.dedup();
        assert_eq!(particles.len(), COUNT, "no two stay at one place");
    }
}
