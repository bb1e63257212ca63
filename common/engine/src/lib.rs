//! Global localization by reverse projection: finds the poses on a map at which a laser scan could
//! have been taken. The crate is exact and pure, and the same code runs in the graph and in the
//! tools.
//!
//! It follows "Global Localization of Mobile Robots by Reverse Projection of Sensor Readings" (the
//! paper): each reading is projected from every boundary cell of the obstacles back into the open
//! space that sees it, and the robot is where the votes meet. All votes are integers, so that every
//! fast way of counting equals the reference to the last bit.
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
//! odometry (`motion`), and an `observation` of carried scans is searched. From the places found,
//! `particles` draws start poses for a particle filter.
//!
//! A [`Localizer`] does all of it in one call, on one map or on several: start there, its example
//! compiles. `docs/engine.md` explains the method with drawings.
//!
//! The crate uses no process, socket, clock or file.

#![warn(missing_docs)]

pub mod accumulator;
pub mod beams;
pub mod boundary;
pub mod chessboard;
mod config;
pub mod directions;
mod error;
pub mod fit;
pub mod grid;
pub mod heading;
pub mod instruction_set;
pub mod joined;
pub mod limits;
pub mod localizer;
pub mod motion;
pub mod observation;
pub mod particles;
pub mod peaks;
pub mod program;
pub mod reference;
pub mod scan;
pub mod search;
pub mod settings;
mod simd;
pub mod space;
pub mod sweep;
mod tables;
pub mod taper;
#[cfg(test)]
mod testing;
mod threads;
pub mod tracking;
pub mod vote_search;
pub mod votes;

pub use error::EngineError;
pub use geometry::Pose;
pub use localizer::{Answer, Localizer, Map, Settings, Workspace};
pub use messages::Verdict;
pub use scan::Scan;
