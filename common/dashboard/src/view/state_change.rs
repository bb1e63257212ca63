//! That another state begins, as it is posted to a webhook.

use serde::Serialize;

use super::{Period, PoseJson};

/// The state that begins, of which robot, and what was before.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct StateChange<'a> {
    pub(crate) robot: &'a str,
    /// The graph's name; none where it is elsewhere.
    pub(crate) graph: Option<&'a str>,
    /// When it began, since 1970.
    pub(crate) since_s: f64,
    /// The state before; none where it is the first that is known.
    pub(crate) before: Option<&'static str>,
    /// The last pose in that.
    pub(crate) before_pose: Option<PoseJson>,
    /// The state that begins.
    #[serde(flatten)]
    pub(crate) period: Period<'a>,
}
