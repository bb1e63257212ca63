//! `rcl_interfaces/msg/Log`.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{RosMessage, Time};

/// A line of a node's log.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Log {
    /// When it was written.
    pub stamp: Time,
    /// How grave it is: 10 debug, 20 info, 30 warning, 40 error, 50 fatal.
    pub level: u8,
    /// Who wrote it.
    pub name: String,
    /// The line.
    pub msg: String,
    /// Where in the source, if that is known.
    pub file: String,
    /// Where in the source, if that is known.
    pub function: String,
    /// Where in the source; 0 where that is not known.
    pub line: u32,
}

impl RosMessage for Log {
    const SCHEMA: &'static str = "rcl_interfaces/msg/Log";
    const DEFINITION: &'static str = definition!(
        "\
byte DEBUG=10
byte INFO=20
byte WARN=30
byte ERROR=40
byte FATAL=50
builtin_interfaces/Time stamp
uint8 level
string name
string msg
string file
string function
uint32 line
",
        Time,
    );
}
