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

/// Particles of a scan; empty if the scan has no place. They are poses in the map, in metres and
/// radians, and all have the same weight.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(super) struct Particles {
    /// Poses of the laser; `None` if its mount is known.
    #[schemars(with = "Option<Vec<command_line::json::schema::Pose>>")]
    laser: Option<Vec<Pose>>,
    /// Poses of the base; `None` if the laser's mount is not known.
    #[schemars(with = "Option<Vec<command_line::json::schema::Pose>>")]
    base: Option<Vec<Pose>>,
}

impl Particles {
    /// Draws the requested number of particles; `None` without `--particles`.
    pub(super) fn draw(
        options: &ParticlesOptions,
        scan: &TakenScan,
        reply: &Reply<'_>,
    ) -> anyhow::Result<Option<Self>> {
        let Some(count) = options.particles else {
            return Ok(None);
        };
        let laser_from_base = scan.base_from_laser.map(Pose::inverse);
        let mut poses = Vec::new();
        if let Ok(answer) = &reply.answer
            && !answer.places.places.is_empty()
        {
            let candidates = answer.places.places.iter().map(Candidate::from);
            let count = count as usize;
            poses = particles::draw(answer.frame, candidates, count, options.particles_seed)?;
        }
        Ok(Some(match laser_from_base {
            Some(base) => Particles {
                laser: None,
                base: Some(poses.iter().map(|pose| pose.then(base)).collect()),
            },
            None => Particles {
                laser: Some(poses),
                base: None,
            },
        }))
    }

    /// Formats one line per particle, to follow the scan's line.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        let of = if self.base.is_some() { "base" } else { "laser" };
        for pose in self.base.iter().chain(&self.laser).flatten() {
            let degrees = pose.yaw.to_degrees();
            // Writing to a string cannot fail.
            let _ = write!(
                text,
                "\n  particle of the {of}  {:>10.3} {:>10.3} {degrees:>9.2}",
                pose.x, pose.y
            );
        }
        text
    }
}
