//! Where in a recording each topic of the graph stands.

pub(crate) use recording::{GROUND_TRUTH, MAP, ODOM, SCAN, TF_STATIC};

pub(crate) const TF: &str = "/tf";
pub(crate) const POSE: &str = "/pose";
pub(crate) const HYPOTHESES: &str = "/hypotheses";
pub(crate) const DIAGNOSTICS: &str = "/diagnostics";
pub(crate) const ROSOUT: &str = "/rosout";
pub(crate) const FIELD: &str = "/field";
/// Lossless, with every field of the graph's header.
pub(crate) const OWN_VOTES: &str = "/backcast/votes";
/// Lossless, with every field of the graph's header.
pub(crate) const OWN_HYPOTHESES: &str = "/backcast/hypotheses";
/// Lossless, with every field of the graph's header.
pub(crate) const OWN_BEAMS: &str = "/backcast/beams";
