//! Initial particles for a particle filter: seeded poses around the hypotheses of a scan. Pure.

use std::fmt::Write as _;

use engine::particles::{self, Candidate};
use geometry::Pose;
use offline::{Reply, TakenScan};
use schemars::JsonSchema;
use serde::Serialize;

#[derive(Debug, Clone, Copy, clap::Args)]
pub(super) struct ParticlesOptions {
    /// Draw this many poses around the places of each scan, as a start for a particle filter: poses
    /// of the base if the laser's mount is known, 1..=1000000
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    particles: Option<u32>,

    /// Seed of the particles' random numbers, the same for each scan
    #[arg(
        long,
        value_name = "NUMBER",
        default_value_t = 1,
        requires = "particles"
    )]
    particles_seed: u64,
}

/// Particles of a scan; empty if the scan has no place.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(super) struct Particles {
    /// Frame of the poses: `base`, or `laser` if the mount is not known.
    of: &'static str,
    /// In the map, metres and radians; all have the same weight.
    #[schemars(with = "Vec<json::schema::Pose>")]
    poses: Vec<Pose>,
}

impl Particles {
    /// Draws the requested number of particles; `None` without `--particles`.
    ///
    /// # Errors
    /// The hypotheses are not finite.
    pub(super) fn draw(
        options: &ParticlesOptions,
        scan: &TakenScan,
        reply: &Reply<'_>,
    ) -> anyhow::Result<Option<Self>> {
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
            poses = particles::draw(answer.frame, candidates, count, options.particles_seed)?;
        }
        for pose in &mut poses {
            *pose = laser_from_base.map_or(*pose, |base| pose.then(base));
        }
        Ok(Some(Particles { of, poses }))
    }

    /// Formats one line per particle, to follow the scan's line.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        for pose in &self.poses {
            let degrees = pose.yaw.to_degrees();
            // Writing to a string cannot fail.
            let _ = write!(
                text,
                "\n  particle of the {}  {:>10.3} {:>10.3} {degrees:>9.2}",
                self.of, pose.x, pose.y
            );
        }
        text
    }
}
