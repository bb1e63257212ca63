//! `diagnostic_msgs/msg/DiagnosticArray`.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{Header, RosMessage};

/// How parts of a robot fare.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DiagnosticArray {
    /// When; the frame is not used.
    pub header: Header,
    /// One entry a part.
    pub status: Vec<DiagnosticStatus>,
}

/// `diagnostic_msgs/msg/DiagnosticStatus`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DiagnosticStatus {
    /// [`DiagnosticStatus::OK`], [`DiagnosticStatus::WARN`],
    /// [`DiagnosticStatus::ERROR`] or [`DiagnosticStatus::STALE`].
    pub level: u8,
    /// The part.
    pub name: String,
    /// The state in words.
    pub message: String,
    /// Which device it is.
    pub hardware_id: String,
    /// Figures.
    pub values: Vec<KeyValue>,
}

impl DiagnosticStatus {
    /// All is well.
    pub const OK: u8 = 0;
    /// Something is not as it should be.
    pub const WARN: u8 = 1;
    /// It does not work.
    pub const ERROR: u8 = 2;
    /// Nothing is received from it.
    pub const STALE: u8 = 3;
}

/// `diagnostic_msgs/msg/KeyValue`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct KeyValue {
    /// What the figure is.
    pub key: String,
    /// The figure.
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
