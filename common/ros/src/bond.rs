//! `bond/msg/Status`.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{Header, RosMessage};

/// Heartbeat by which two nodes monitor each other.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BondStatus {
    pub header: Header,
    /// Id of the bond, the same for both nodes.
    pub id: String,
    /// Id of the sending node.
    pub instance_id: String,
    /// False if the bond ends.
    pub active: bool,
    /// Seconds without a heartbeat after which the bond is broken.
    pub heartbeat_timeout: f32,
    /// Seconds between heartbeats.
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
