//! Monte Carlo localization: the pose as a set of weighted particles, which move with
//! the robot, are weighed by its scans and drawn again by their weights.
//!
//! Dellaert, Fox, Burgard and Thrun, "Monte Carlo Localization for Mobile Robots" (ICRA
//! 1999); Thrun, Burgard and Fox, "Probabilistic Robotics" (2005), chapter 8. A search
//! finds where one scan may have been taken; particles go on from there, scan by scan
//! (the paper: the votes say "those places where particles need to be initialized").
//! From a uniform start they are the baseline that the paper compares with.
//!
//! ```text
//! places of the votes ─┐               ┌── predict ◄── step of the odometry
//!                      ├─ start ─ particles ─ weigh ◄── ends of a scan, distance field
//! free cells ──────────┘               └── resample (KLD) ── estimate
//! ```
//!
//! Poses of the interface are those of the target frame (laser, or base) in the
//! map, metres and radians; particles are kept in cells of the grid. All is
//! deterministic: the same calls with the same seed give the same particles to the last
//! bit on one machine. Nothing is allocated from scan to scan once the buffers are large enough
//! for the most particles that there have been, and for their bins.
//!
//! It does not notice that it is lost: no random particles are added (as in table 8.3 of
//! the book). A search of the whole map does that better, and its places start it again
//! ([`ParticleFilter::seed`]).

mod beams;
mod config;
#[cfg(test)]
mod drawn;
mod estimate;
mod filter;
mod kld;
mod motion;
mod resample;
mod sensor;
mod start;
#[cfg(test)]
mod tests;

pub use config::ParticlesConfig;
use engine::fit::GridPose;
pub use estimate::Estimate;
pub use filter::ParticleFilter;
pub use motion::OdometryNoise;
pub use start::StartHeadings;

/// A pose that the robot may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particle {
    /// In cells of the grid.
    pub pose: GridPose,
    /// How likely it is, against the others: of all the sum is above 0, not 1.
    pub weight: f64,
}
