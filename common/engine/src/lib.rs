//! Global localization by reverse projection: where on a map could this scan
//! have been taken? Exact, pure, and the same in the graph and in the tools.
//!
//! It follows "Global Localization of Mobile Robots by Reverse Projection of
//! Sensor Readings" (the paper): each reading is projected from every boundary
//! cell of the obstacles back into the open space that sees it, and where the
//! votes meet is the robot. All votes are integers, so that every fast way of
//! counting them equals the plain one to the last bit.
//!
//! How a scan flows through the modules:
//!
//! ```text
//! occupancy ─ grid ─┬─ search: index (prepared once) ─┐
//!                   ├─ boundary ─ scatter ──┐         │
//!                   └─ sweep ───────────────┤         │
//! scan ─ beams ─ program (taper) ───────────┴─────────┴─ votes ─ peaks
//!                                     known heading   all headings
//! ```
//!
//! Where a robot moves, or has several lasers, `joined` brings the scans to one time by
//! odometry (`motion`), and what is searched is an `observation` of carried scans.
//! Where the robot may be, `particles` draws poses for the start of a particle filter.
//!
//! A [`locator::Locator`] is all of it in one call: start there, its example compiles. A
//! [`map_set::MapSet`] is the same for several maps at once.
//! `docs/engine.md` explains the method with drawings.
//!
//! The crate knows no process, socket, clock or file.

#![warn(missing_docs)]

pub mod accumulator;
pub mod beams;
pub mod boundary;
pub mod chessboard;
mod config;
pub mod directions;
mod error;
pub mod exhaustive;
pub mod fit;
pub mod grid;
pub mod heading;
pub mod instruction_set;
pub mod joined;
pub mod limits;
pub mod localizer;
pub mod locator;
pub mod map_set;
pub mod motion;
pub mod observation;
pub mod particles;
pub mod peaks;
pub mod program;
pub mod reference;
pub mod regions;
pub mod scan;
pub mod scatter;
pub mod search;
mod simd;
pub mod space;
pub mod sweep;
mod tables;
pub mod taper;
#[cfg(test)]
mod testing;
mod threads;
pub mod tracking;
pub mod votes;

pub use error::EngineError;
