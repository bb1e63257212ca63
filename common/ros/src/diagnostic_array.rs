//! `diagnostic_msgs/msg/DiagnosticArray`.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{Header, RosMessage};

/// States of a robot's components.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DiagnosticArray {
    /// Time; the frame is not used.
    pub header: Header,
    pub status: Vec<DiagnosticStatus>,
}

/// `diagnostic_msgs/msg/DiagnosticStatus`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DiagnosticStatus {
    /// [`DiagnosticStatus::OK`], [`DiagnosticStatus::WARN`],
    /// [`DiagnosticStatus::ERROR`] or [`DiagnosticStatus::STALE`].
    pub level: u8,
    pub name: String,
    /// State in words.
    pub message: String,
    pub hardware_id: String,
    pub values: Vec<KeyValue>,
}

impl DiagnosticStatus {
    pub const OK: u8 = 0;
    pub const WARN: u8 = 1;
    pub const ERROR: u8 = 2;
    /// No data is received from the component.
    pub const STALE: u8 = 3;
}

/// `diagnostic_msgs/msg/KeyValue`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct KeyValue {
    pub key: String,
    pub value: String,
}

impl RosMessage for DiagnosticArray {
    const SCHEMA: &'static str = "diagnostic_msgs/msg/DiagnosticArray";
    const DEFINITION: &'static str = definition!(
        "\
std_msgs/Header header
diagnostic_msgs/DiagnosticStatus[] status
",
        Header,
        "\
diagnostic_msgs/DiagnosticStatus
byte OK=0
byte WARN=1
byte ERROR=2
byte STALE=3
byte level
string name
string message
string hardware_id
diagnostic_msgs/KeyValue[] values
",
        "\
diagnostic_msgs/KeyValue
string key
string value
",
    );
}
