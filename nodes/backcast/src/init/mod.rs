//! `backcast init`: writes a commented descriptor for a laser, a ROS 2 robot or a recording, after
//! checking all in it. `live` records such a robot for `backcast doctor`.

mod command;
mod descriptor;
mod live;
mod robot;

pub(crate) use command::{Config, NOTES, run};
pub(crate) use live::record;
