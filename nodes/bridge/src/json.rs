//! Poses and health as JSON, for programs without a postcard decoder.

use std::borrow::Cow;

use answers::TrackedPose;
use messages::{HealthHeader, NodeState, PoseHeader};
use serde::Serialize;

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

pub(crate) fn pose(header: &PoseHeader, words: &[u8]) -> String {
    command_line::json::object(&TrackedPose::new(header, words))
}

pub(crate) fn health(header: &HealthHeader, error: &[u8]) -> String {
    command_line::json::object(&Health {
        node: Cow::Borrowed(header.node.as_str()),
        state: NodeState::from_code(header.state).map_or("?", NodeState::as_str),
        received: header.received,
        sent: header.sent,
        dropped: header.dropped,
        refused: header.refused,
        last_error: String::from_utf8_lossy(error),
    })
}
