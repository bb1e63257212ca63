//! What `locate`, `evaluate` and `plot` share: the scans of a recording, each asked for
//! its place on a map, in this process and without a graph.
//!
//! The engine is the graph's, with the same settings, so the votes are the same
//! to the last one. Files are read and times are taken in here; nothing is
//! printed but by the commands.

mod accepted;
pub mod cpu;
mod error;
mod heading;
mod layout;
mod maps;
mod motion;
mod options;
mod scans;
mod session;
mod topics;
mod world;

pub use accepted::Accepted;
pub use error::OfflineError;
pub use heading::each_odometry;
pub use layout::{check_map, frame_of, sides_of};
pub use maps::map_in;
pub use options::{EngineOptions, NamedMap, Options};
pub use scans::TakenScan;
pub use session::{Reply, Session, View, damage_of};
pub use topics::TopicOptions;
pub use world::{Answer, BeamEnd, Field, KnownMap, ScanAt, World};
