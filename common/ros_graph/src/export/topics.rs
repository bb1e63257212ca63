//! Names of the graph's topics in ROS.

pub use recording::{GROUND_TRUTH, MAP, ODOM, SCAN, TF_STATIC};

pub const TF: &str = "/tf";
/// Pose of the robot: of the tracker, or of the best hypothesis if there is no tracker.
pub const POSE: &str = "/pose";
/// All hypotheses of a scan, as poses.
pub const HYPOTHESES: &str = "/hypotheses";
/// Initial particles for a particle filter.
pub const PARTICLES: &str = "/particles";
pub const DIAGNOSTICS: &str = "/diagnostics";
pub const ROSOUT: &str = "/rosout";
pub const FIELD: &str = "/field";
pub const OWN_VOTES: &str = "/backcast/votes";
pub const OWN_HYPOTHESES: &str = "/backcast/hypotheses";
pub const OWN_BEAMS: &str = "/backcast/beams";
/// The tracker's pose at a scan, lossless, with every field of the graph's header.
pub const OWN_POSE: &str = "/backcast/pose";
