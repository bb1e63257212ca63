//! Monte Carlo localization of a robot that stands still: the pose as a set of weighted particles,
//! which are scattered, weighted by a scan and resampled.
//!
//! Dellaert, Fox, Burgard and Thrun, "Monte Carlo Localization for Mobile Robots" (ICRA 1999);
//! Thrun, Burgard and Fox, "Probabilistic Robotics" (2005), chapter 8. A search finds possible
//! poses of one scan; particles continue from there (the paper: the votes say "those places where
//! particles need to be initialized"). From a uniform start they are the paper's baseline.
//!
//! ```text
//! places of the votes ─┐               ┌── scatter
//!                      ├─ start ─ particles ─ weigh ◄── ends of a scan, distance field
//! free cells ──────────┘               └── resample (KLD) ── estimate
//! ```
//!
//! Poses of the interface are those of the target frame (laser or base) in the map, in metres and
//! radians; particles are in cells of the grid. The filter is deterministic: the same calls with
//! the same seed give bit-identical particles on one machine. It does not allocate between scans
//! once the buffers fit the largest number of particles and bins.
//!
//! The filter does not detect that it is lost: no random particles are added (unlike in table 8.3
//! of the book). A search of the whole map does that better, and its places start another filter
//! ([`ParticleFilter::seeded`]).

mod beams;
mod config;
#[cfg(test)]
mod drawn;
mod estimate;
mod filter;
mod kld;
mod resample;
mod sensor;
mod start;
#[cfg(test)]
mod tests;

pub use config::ParticlesConfig;
use engine::fit::GridPose;
pub use estimate::Estimate;
pub use filter::ParticleFilter;
pub use start::StartHeadings;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particle {
    /// In cells of the grid.
    pub pose: GridPose,
    /// Relative likelihood; the weights have a positive sum, which need not be 1.
    pub weight: f64,
}
