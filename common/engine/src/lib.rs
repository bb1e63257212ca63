#![doc = include_str!("../README.md")]
//!
//! # Parts
//!
//! A scan flows through the modules like this:
//!
//! ```text
//! occupancy ─ grid ─┬─ search: index (prepared once) ─┐
//!     boundary ─────┴─ sweep ─────────────────┐       │
//! scan ─ beams ─ program (taper) ─────────────┴───────┴─ votes ─ peaks
//!                                     known heading   all headings
//! ```
//!
//! For a moving robot, or one with several lasers, `joined` carries the scans to one time by
//! odometry (`motion`), and an `observation` of carried scans is searched. `tracker` does so for
//! each scan of a drive, and `tracking` weighs the places from scan to scan. From the places found,
//! `particles` draws start poses for a particle filter. `docs/engine.md` of the repository explains
//! the method with drawings.

#![warn(missing_docs)]
#![cfg_attr(
    not(feature = "unstable"),
    allow(
        dead_code,
        unreachable_pub,
        unused_imports,
        reason = "the graph and the tools use parts that the interface does not"
    )
)]

mod config;
mod error;
mod simd;
mod tables;
#[cfg(test)]
mod testing;
mod threads;

/// The parts, public with feature `unstable` alone.
#[path = "."]
mod parts {
    pub mod accumulator;
    pub mod beams;
    pub mod boundary;
    pub mod chessboard;
    pub mod directions;
    pub mod fit;
    pub mod grid;
    pub mod heading;
    pub mod instruction_set;
    pub mod joined;
    pub mod limits;
    pub mod localizer;
    pub mod motion;
    pub mod observation;
    pub mod occupancy_map;
    pub mod particles;
    pub mod peaks;
    pub mod program;
    pub mod reference;
    pub mod scan;
    pub mod search;
    pub mod settings;
    pub mod space;
    pub mod sweep;
    pub mod taper;
    pub mod tracker;
    pub mod tracking;
    pub mod vote_search;
    pub mod votes;
}

#[cfg(not(feature = "unstable"))]
use parts::*;
#[cfg(feature = "unstable")]
pub use parts::*;

pub use error::EngineError;
pub use geometry::{Covariance, Pose};
pub use joined::{LeftOut, ScanStamp, TimedScan};
pub use localizer::{Answer, Localizer, PreparedMap, Settings, Workspace};
pub use messages::{TrackReason, TrackState, Verdict};
pub use occupancy_map::Map;
pub use scan::Scan;
pub use tracker::{TrackedPose, Tracker, TrackerSettings};
pub use tracking::{Report, Start};
