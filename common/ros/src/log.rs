//! `rcl_interfaces/msg/Log`.

use messages::LogHeader;

use super::Time;

declare! {
    /// A line of a node's log.
    message Log = "rcl_interfaces/msg/Log" with "\
byte DEBUG=10
byte INFO=20
byte WARN=30
byte ERROR=40
byte FATAL=50
" [Time] {
        stamp: Time,
        /// Severity: 10 debug, 20 info, 30 warning, 40 error, 50 fatal.
        level: u8,
        /// Name of the node.
        name: String,
        msg: String,
        /// Source file, if known.
        file: String,
        /// Function, if known.
        function: String,
        /// Source line; 0 if unknown.
        line: u32,
    }
}

impl Log {
    /// Converts a log line of the graph; `stamp` is the time of the message.
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
