//! Searches the scans of a recording on a map, in this process and without a graph; shared by
//! `locate`, `evaluate` and `plot`.
//!
//! It uses the engine of the graph with the same settings, so the votes are exactly equal. This
//! crate reads files and measures times; printing is left to the commands, but for their progress
//! bar.

mod accepted;
pub mod cpu;
mod error;
mod heading;
mod maps;
mod motion;
mod options;
mod progress;
mod scans;
mod session;
mod topics;
mod world;

pub use accepted::Accepted;
pub use error::{NoUsableMap, no_truth_taken, no_truths};
pub use heading::each_odometry;
pub use maps::{frame_of, map_in, searchable, sides_of};
pub use options::{EngineOptions, NamedMap, Options};
pub use progress::Progress;
pub use scans::{Scans, TakenScan, as_measured};
pub use session::{Reply, Session, View};
pub use topics::TopicOptions;
pub use world::{Answer, BeamEnd, Field, KnownMap, ScanAt, World};
