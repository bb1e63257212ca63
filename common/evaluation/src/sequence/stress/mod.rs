//! `backcast evaluate --sequence --stress`: drives with something changed, made in memory.
//! For each variant the map, the scans, the odometry or the motion differ from the
//! recording's, and what the tracker says is judged as on the drive itself. The same seed
//! gives the same variants.

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
pub(super) use variants::Stress;
