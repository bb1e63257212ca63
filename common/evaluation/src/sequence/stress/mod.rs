//! `backcast evaluate --sequence --stress`: drives with a change made in memory. Each variant
//! changes the map, the scans, the odometry or the motion of the recording, and the tracker is
//! judged as on the drive itself. The same seed gives the same variants.

mod command;
mod drawn;
mod figures;
mod laser;
mod map;
mod material;
mod motion;
mod odometry;
mod trial;
mod variants;
mod world;

#[cfg(test)]
mod tests;

pub(super) use command::evaluate;
pub(crate) use figures::Figures;
pub(super) use variants::Stress;
