//! `backcast init`: a commented descriptor for a laser, a ROS 2 robot or a recording, and
//! its map. What it names is looked at before: the laser is asked how it speaks, the robot's
//! topics are listed, the map is read. `live` records such a robot for `backcast doctor`.

mod command;
mod descriptor;
mod error;
mod live;
mod robot;

pub use command::{Config, NOTES, run};
pub use error::InitError;
pub use live::{Recorded, record};
