//! A state change, as posted to a webhook.

use messages::Pose2;
use serde::Serialize;

use super::Period;

/// A robot's new state, and the one before.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct StateChange<'a> {
    pub(crate) robot: &'a str,
    /// `None` if it is not known (a graph on another machine).
    pub(crate) graph: Option<&'a str>,
    /// Start of the new state, in seconds since 1970.
    pub(crate) since_s: f64,
    /// The state before; `None` for the first one.
    pub(crate) before: Option<&'static str>,
    /// The last pose in the state before.
    pub(crate) before_pose: Option<Pose2>,
    /// The new state.
    #[serde(flatten)]
    pub(crate) period: Period<'a>,
}
