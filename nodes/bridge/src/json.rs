//! Poses and health as JSON, for programs without a postcard decoder.

use std::borrow::Cow;

use messages::{HealthHeader, NodeState, Pose2, PoseHeader, TrackState};
use serde::Serialize;

/// Pose in the map, metres and radians.
#[derive(Debug, Clone, Copy, Serialize)]
struct Placed {
    x: f64,
    y: f64,
    yaw: f64,
}

#[derive(Debug, Serialize)]
struct Pose<'a> {
    stamp_ns: i64,
    state: &'a str,
    says: Cow<'a, str>,
    /// Map id in hexadecimal, because JSON numbers do not hold 64 bits safely.
    map_id: String,
    probability: Option<f64>,
    from_scan: bool,
    base: Option<Placed>,
    base_covariance: Option<[f64; 9]>,
    laser: Option<Placed>,
    laser_covariance: Option<[f64; 9]>,
}

#[derive(Debug, Serialize)]
struct Health<'a> {
    node: Cow<'a, str>,
    state: &'a str,
    received: u64,
    sent: u64,
    dropped: u64,
    refused: u64,
    last_error: Cow<'a, str>,
}

impl From<Pose2> for Placed {
    fn from(Pose2 { x, y, yaw }: Pose2) -> Self {
        Placed { x, y, yaw }
    }
}

/// Returns a message of topic `pose` as a JSON object.
pub(crate) fn pose(header: &PoseHeader, words: &[u8]) -> String {
    let (laser, base) = (header.laser(), header.base());
    let state = TrackState::from_code(header.state);
    json::object(&Pose {
        stamp_ns: header.stamp.measured_ns,
        state: state.map_or("?", TrackState::as_str),
        says: String::from_utf8_lossy(words),
        map_id: format!("{:016x}", header.map_id),
        probability: laser.map(|_| header.probability),
        from_scan: header.from_scan == 1,
        base: base.map(Placed::from),
        base_covariance: base.map(|_| header.base_covariance),
        laser: laser.map(Placed::from),
        laser_covariance: laser.map(|_| header.laser_covariance),
    })
}

/// Returns a message of topic `health` as a JSON object.
pub(crate) fn health(header: &HealthHeader, error: &[u8]) -> String {
    json::object(&Health {
        node: Cow::Borrowed(header.node.as_str()),
        state: NodeState::from_code(header.state).map_or("?", NodeState::as_str),
        received: header.received,
        sent: header.sent,
        dropped: header.dropped,
        refused: header.refused,
        last_error: String::from_utf8_lossy(error),
    })
}
