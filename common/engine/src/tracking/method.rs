//! How the robot is tracked: by places or by particles.

use geometry::{Covariance, Pose};
use messages::Transition;

use super::{Candidate, Need, ParticleTracker, Report, Seen, Tracker, TrackingConfig};
use crate::particles::ParticlesConfig;

/// A tracker by one method or the other.
#[derive(Debug, Clone)]
pub enum Follower {
    /// By a few places that are weighed against each other.
    Places(Box<Tracker>),
    /// By particles.
    Particles(Box<ParticleTracker>),
}

/// By what the robot is followed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct FollowConfig {
    /// When a place is believed.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub tracking: TrackingConfig,
    /// Track the robot with particles that start at the places that a search finds
    /// (Monte Carlo localization), for comparison.
    #[cfg_attr(feature = "clap", arg(long))]
    pub particles: bool,
    /// How many there are, and how a scan weighs them.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub of_particles: ParticlesConfig,
}

impl Follower {
    /// Nothing is known yet. Between several maps, places go where there are transitions;
    /// particles stay on the map on which they started.
    #[must_use]
    pub fn new(config: &FollowConfig, transitions: &[Transition]) -> Self {
        match config.particles {
            false => Follower::Places(Box::new(
                Tracker::new(config.tracking).with_transitions(transitions.to_vec()),
            )),
            true => Follower::Particles(Box::new(ParticleTracker::new(
                config.tracking,
                config.of_particles,
            ))),
        }
    }

    /// See [`Tracker::expect`].
    pub fn expect(&mut self, at: (u32, Pose), covariance: Covariance) {
        match self {
            Follower::Places(tracker) => tracker.expect(at, covariance),
            Follower::Particles(tracker) => tracker.expect(at, covariance),
        }
    }

    /// Starts from a pose that is believed, with its covariance; particles start there
    /// at the next scan, see [`Tracker::start_at`].
    pub fn start_at(&mut self, seen: &[Seen<'_>], at: (u32, Pose), covariance: Covariance) {
        match self {
            Follower::Places(tracker) => tracker.start_at(seen, at, covariance),
            Follower::Particles(tracker) => tracker.expect(at, covariance),
        }
    }

    /// See [`Tracker::begin`].
    pub fn begin(&mut self, seen: &[Seen<'_>], stamp_ns: i64, moved: Option<Pose>) -> Need {
        match self {
            Follower::Places(tracker) => tracker.begin(seen, stamp_ns, moved),
            Follower::Particles(tracker) => tracker.begin(seen, stamp_ns, moved),
        }
    }

    /// See [`Tracker::finish`].
    pub fn finish(&mut self, seen: &[Seen<'_>], found: Option<&[Candidate]>) {
        match self {
            Follower::Places(tracker) => tracker.finish(seen, found),
            Follower::Particles(tracker) => tracker.finish(seen, found),
        }
    }

    /// See [`Tracker::asks_ahead`]; particles never do.
    #[must_use]
    pub fn asks_ahead(&self) -> bool {
        match self {
            Follower::Places(tracker) => tracker.asks_ahead(),
            Follower::Particles(_) => false,
        }
    }

    /// Where the robot is, and how sure that is.
    #[must_use]
    pub fn report(&self) -> Report {
        match self {
            Follower::Places(tracker) => tracker.report(),
            Follower::Particles(tracker) => tracker.report(),
        }
    }
}
