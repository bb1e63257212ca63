//! Draws start poses for a particle filter from the places of a scan.

use engine::EngineError;
use engine::particles::{self, Candidate};
use messages::{Particle, ParticlesHeader};

use crate::answer::Answer;

/// Number and seed of the particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::Args)]
pub struct ParticlesConfig {
    /// Send this many poses around the places of each scan on topic `particles`, as a start for a
    /// particle filter, 1..=1000000 [default: the topic is not sent]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub particles: Option<u32>,

    /// Seed of the particles' random numbers, the same for each scan.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub particles_seed: u64,
}

/// Returns header and items of the message; there are no items if the scan has no place.
pub fn draw(
    answer: &Answer<'_>,
    count: u32,
    seed: u64,
) -> Result<(ParticlesHeader, Vec<Particle>), EngineError> {
    let header = ParticlesHeader {
        stamp: answer.header.stamp,
        map_id: answer.header.map_id,
        mount_known: answer.header.mount_known,
    };
    let Some(frame) = answer.frame.filter(|_| !answer.places.is_empty()) else {
        return Ok((header, Vec::new()));
    };
    // Only on the map of the best place.
    let map = answer.places[0].map;
    let on_map = answer.places.iter().filter(|place| place.map == map);
    let candidates = on_map.map(Candidate::from);
    let poses = particles::draw(frame, candidates, count as usize, seed)?;
    let particle = |map_from_target| Particle {
        map_from_base: answer.target.base(map_from_target).into(),
    };
    Ok((header, poses.into_iter().map(particle).collect()))
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;
    use crate::answer::nothing;

    #[test]
    fn a_scan_without_a_place_has_no_particles() {
        let votes = messages::VotesHeader {
            map_id: 5,
            ..Zeroable::zeroed()
        };
        let (header, particles) = draw(&nothing(&votes), 100, 1).unwrap();
        assert_eq!((header.map_id, particles.len()), (5, 0));
    }
}
