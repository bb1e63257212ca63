//! `rosgraph_msgs/msg/Clock`.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{RosMessage, Time};

/// Time of a simulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Clock {
    pub clock: Time,
}

impl RosMessage for Clock {
    const SCHEMA: &'static str = "rosgraph_msgs/msg/Clock";
    const DEFINITION: &'static str = definition!("builtin_interfaces/Time clock\n", Time);
}
