//! What `locate`, `evaluate` and `plot` share: the scans of a recording, each asked for
//! its place on a map, in this process and without a graph.
//!
//! The engine is the graph's, with the same settings, so the votes are the same
//! to the last one. Files are read and times are taken in here; nothing is
//! printed but by the commands.

mod accepted;
pub(crate) mod cpu;
mod heading;
mod layout;
mod maps;
mod motion;
mod options;
mod progress;
mod scans;
mod session;
mod topics;
mod world;

pub(crate) use accepted::Accepted;
pub(crate) use heading::each_odometry;
pub(crate) use layout::{check_map, frame_of, sides_of};
pub(crate) use options::{EngineOptions, Options};
pub(crate) use progress::{Progress, say};
pub(crate) use scans::TakenScan;
pub(crate) use session::{Reply, Session, View, damage_of, map_in};
pub(crate) use topics::TopicOptions;
pub(crate) use world::{Answer, BeamEnd, Field, ScanAt, World};
