//! `backcast init`: writes a commented descriptor for a laser, a ROS 2 robot or a recording, and
//! its map. Everything in it is checked before: the laser's protocol is detected, the robot's
//! topics are listed, the map is loaded. `live` records such a robot for `backcast doctor`.

mod command;
mod descriptor;
mod live;
mod robot;

pub(crate) use command::{Config, NOTES, run};
pub(crate) use live::record;
