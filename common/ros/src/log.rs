//! `rcl_interfaces/msg/Log`.

use messages::LogHeader;
use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{RosMessage, Time};

/// A line of a node's log.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Log {
    pub stamp: Time,
    /// Severity: 10 debug, 20 info, 30 warning, 40 error, 50 fatal.
    pub level: u8,
    /// Name of the node.
    pub name: String,
    pub msg: String,
    /// Source file, if known.
    pub file: String,
    /// Function, if known.
    pub function: String,
    /// Source line; 0 if unknown.
    pub line: u32,
}

impl Log {
    /// Converts a log line of the graph; `stamp` is the time of the message.
    #[must_use]
    pub fn of(stamp: Time, header: &LogHeader, text: &str) -> Self {
        Log {
            stamp,
            // The graph uses the level numbers of ROS; one that does not fit becomes 0.
            level: u8::try_from(header.level).unwrap_or_default(),
            name: header.node.as_str().to_owned(),
            msg: text.to_owned(),
            ..Log::default()
        }
    }
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

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{LogLevel, Name};

    use super::*;

    #[test]
    fn level_name_and_line_are_kept() {
        let header = LogHeader {
            node: Name::new("accumulator"),
            level: LogLevel::Warn as u32,
            ..LogHeader::zeroed()
        };
        let log = Log::of(Time::default(), &header, "no map");
        assert_eq!(
            (log.level, &*log.name, &*log.msg),
            (30, "accumulator", "no map")
        );
        let foreign = LogHeader {
            level: 1 << 20,
            ..header
        };
        assert_eq!(Log::of(Time::default(), &foreign, "").level, 0);
    }
}
