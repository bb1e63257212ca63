//! What each topic of the graph is called in messages of ROS.

pub use recording::{GROUND_TRUTH, MAP, ODOM, SCAN, TF_STATIC};

/// The frames, as they move.
pub const TF: &str = "/tf";
/// The best place of a scan.
pub const POSE: &str = "/pose";
/// All places of a scan.
pub const HYPOTHESES: &str = "/hypotheses";
/// Where a particle filter may start.
pub const PARTICLES: &str = "/particles";
/// How the nodes fare.
pub const DIAGNOSTICS: &str = "/diagnostics";
/// What the nodes log.
pub const ROSOUT: &str = "/rosout";
/// The intensity image.
pub const FIELD: &str = "/field";
/// Votes, lossless, with every field of the graph's header.
pub const OWN_VOTES: &str = "/backcast/votes";
/// Hypotheses, lossless, with every field of the graph's header.
pub const OWN_HYPOTHESES: &str = "/backcast/hypotheses";
/// Beams, lossless, with every field of the graph's header.
pub const OWN_BEAMS: &str = "/backcast/beams";
/// The tracker's pose at a scan, lossless, with every field of the graph's header.
pub const OWN_POSE: &str = "/backcast/pose";
