//! `diagnostic_msgs/msg/DiagnosticArray`, and a node's health as such a message.

use messages::{HealthHeader, NodeState};

use crate::definition::Byte;
use crate::{Header, Time};

declare! {
    part DiagnosticStatus = "diagnostic_msgs/DiagnosticStatus" with "\
byte OK=0
byte WARN=1
byte ERROR=2
byte STALE=3
" [] {
        /// One of the constants above.
        level: Byte,
        name: String,
        /// State in words.
        message: String,
        hardware_id: String,
        values: Vec<KeyValue>,
    }

    part KeyValue = "diagnostic_msgs/KeyValue" [] {
        key: String,
        value: String,
    }

    /// States of a robot's components.
    message DiagnosticArray = "diagnostic_msgs/msg/DiagnosticArray"
        [Header, DiagnosticStatus, KeyValue] {
        /// Time; the frame is not used.
        header: Header,
        status: Vec<DiagnosticStatus>,
    }
}

impl DiagnosticStatus {
    pub const OK: u8 = 0;
    pub const WARN: u8 = 1;
    pub const ERROR: u8 = 2;
    /// No data is received from the component.
    pub const STALE: u8 = 3;
}

/// Converts the health of a node and its last error; `stamp` is the time of the header.
pub fn of(stamp: Time, report: &HealthHeader, error: &str) -> DiagnosticArray {
    let state = NodeState::from_code(report.state);
    let name = state.map_or_else(|| format!("state {}", report.state), |s| format!("{s:?}"));
    let message = match error {
        "" => name,
        error => format!("{name}: {error}"),
    };
    let figure = |key: &str, value: u64| KeyValue {
        key: key.to_owned(),
        value: value.to_string(),
    };
    let status = DiagnosticStatus {
        level: level(state),
        name: format!("backcast: {}", report.node),
        message,
        hardware_id: String::new(),
        values: vec![
            figure("received", report.received),
            figure("sent", report.sent),
            figure("dropped", report.dropped),
            figure("refused", report.refused),
            figure("pid", report.pid.into()),
        ],
    };
    DiagnosticArray {
        header: Header::new(stamp, ""),
        status: vec![status],
    }
}

/// Level of a state; a node that waits for its map is not a warning yet.
fn level(state: Option<NodeState>) -> u8 {
    match state {
        Some(NodeState::Waiting | NodeState::Ready | NodeState::Busy) => DiagnosticStatus::OK,
        Some(NodeState::Degraded) => DiagnosticStatus::WARN,
        Some(NodeState::Stopped) => DiagnosticStatus::STALE,
        None => DiagnosticStatus::ERROR,
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::Name;

    use super::*;

    #[test]
    fn state_and_last_error_are_reported_in_words() {
        let report = HealthHeader {
            node: Name::new("accumulator"),
            state: NodeState::Degraded as u32,
            dropped: 3,
            ..HealthHeader::zeroed()
        };
        let status = of(Time::default(), &report, "no map").status.remove(0);
        assert_eq!(
            (&*status.name, &*status.message),
            ("backcast: accumulator", "Degraded: no map")
        );
        assert_eq!(status.level, DiagnosticStatus::WARN);
        assert_eq!(
            (&*status.values[2].key, &*status.values[2].value),
            ("dropped", "3")
        );
        let foreign = HealthHeader {
            state: 99,
            ..report
        };
        let status = of(Time::default(), &foreign, "").status.remove(0);
        assert_eq!(
            (status.level, &*status.message),
            (DiagnosticStatus::ERROR, "state 99")
        );
    }
}
