//! The start of a particle filter: poses around the places of a scan, seeded. Pure.

use std::fmt::Write as _;

use engine::particles::{self, Candidate};
use geometry::Pose;
use offline::{OfflineError, Reply, TakenScan};
use serde::Serialize;

use crate::EvaluationError;

/// How many, and from which random numbers.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(super) struct ParticlesOptions {
    /// Draw this many poses around the places of each scan, as a start for a particle
    /// filter: poses of the base if the laser's mount is known, 1..=1000000
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    particles: Option<u32>,

    /// Seed of their random numbers, the same for each scan
    #[arg(
        long,
        value_name = "NUMBER",
        default_value_t = 1,
        requires = "particles"
    )]
    particles_seed: u64,
}

/// The particles of a scan; none where the scan has no place.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Particles {
    /// Whose poses they are: `base`, or `laser` where no mount is known.
    of: &'static str,
    /// In the map, metres and radians; all weigh the same.
    poses: Vec<Pose>,
}

impl Particles {
    /// Draws what is asked for; `None` where nothing is.
    ///
    /// # Errors
    /// If the places are not finite.
    pub(super) fn draw(
        options: &ParticlesOptions,
        scan: &TakenScan,
        reply: &Reply<'_>,
    ) -> Result<Option<Self>, EvaluationError> {
        let Some(count) = options.particles else {
            return Ok(None);
        };
        let laser_from_base = scan.base_from_laser.map(Pose::inverse);
        let of = match laser_from_base {
            Some(_) => "base",
            None => "laser",
        };
        let mut poses = Vec::new();
        if let Ok(answer) = &reply.answer
            && !answer.places.places.is_empty()
        {
            let candidates = answer.places.places.iter().map(Candidate::from);
            let count = count as usize;
            poses = particles::draw(answer.frame, candidates, count, options.particles_seed)
                .map_err(OfflineError::Refused)?;
        }
        for pose in &mut poses {
            *pose = laser_from_base.map_or(*pose, |base| pose.then(base));
        }
        Ok(Some(Particles { of, poses }))
    }

    /// A line for each below the scan's.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        for pose in &self.poses {
            let degrees = pose.yaw.to_degrees();
            // Writing to a string does not fail.
            let _ = write!(
                text,
                "\n  particle of the {}  {:>10.3} {:>10.3} {degrees:>9.2}",
                self.of, pose.x, pose.y
            );
        }
        text
    }
}
