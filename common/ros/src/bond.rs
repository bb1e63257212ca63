//! `bond/msg/Status`.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{Header, RosMessage};

/// A sign of life, by which two nodes know that the other is there.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BondStatus {
    /// When.
    pub header: Header,
    /// The bond that both have.
    pub id: String,
    /// One of the two.
    pub instance_id: String,
    /// False where the bond ends.
    pub active: bool,
    /// Without a sign for so long it is broken, seconds.
    pub heartbeat_timeout: f32,
    /// From one sign to the next, seconds.
    pub heartbeat_period: f32,
}

impl RosMessage for BondStatus {
    const SCHEMA: &'static str = "bond/msg/Status";
    const DEFINITION: &'static str = definition!(
        "\
std_msgs/Header header
string id
string instance_id
bool active
float32 heartbeat_timeout
float32 heartbeat_period
",
        Header,
    );
}
