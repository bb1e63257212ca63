//! A line of a node's log as ROS says it.

use messages::LogHeader;
use ros::{Log, Time};

pub(super) fn of(stamp: Time, header: &LogHeader, text: &str) -> Log {
    Log {
        stamp,
        // The numbers of the graph are those of ROS; one that does not fit is none.
        level: u8::try_from(header.level).unwrap_or_default(),
        name: header.node.as_str().to_owned(),
        msg: text.to_owned(),
        ..Log::default()
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
        let log = of(Time::default(), &header, "no map");
        assert_eq!(
            (log.level, &*log.name, &*log.msg),
            (30, "accumulator", "no map")
        );
        let foreign = LogHeader {
            level: 1 << 20,
            ..header
        };
        assert_eq!(of(Time::default(), &foreign, "").level, 0);
    }
}
