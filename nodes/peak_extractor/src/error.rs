//! Errors that reject votes, and errors that end the node.

use engine::EngineError;
use messages::{Pose2, Vote};
use transport::TransportError;

#[derive(Debug, thiserror::Error)]
pub enum PeakError {
    #[error(
        "they are of map {found:016x}, which is not known; known are the newest map and the one \
         before: {known}"
    )]
    UnknownMap { found: u64, known: String },
    #[error("their scan is not known: it was not received, or too long ago")]
    UnknownScan,
    #[error("which of them are on which map is not known: it was not received, or too long ago")]
    UnknownParts,
    #[error("{maps} maps have {parts} votes together, and {total} came")]
    Parts {
        maps: usize,
        parts: u64,
        total: usize,
    },
    #[error("{field} is {found}: allowed are {allowed}")]
    Setting {
        field: &'static str,
        found: f64,
        allowed: &'static str,
    },
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error(transparent)]
    MapSet(#[from] messages::InvalidMapSet),
    #[error(transparent)]
    MapId(#[from] messages::WrongMapId),
    #[error(
        "outcome is {found}: allowed are 0 (found), 1 (no votes), 2 (refused) and 3 (not asked)"
    )]
    Outcome { found: u32 },
    #[error("headings is {found}: allowed are 1 to 65536")]
    Headings { found: u32 },
    #[error("known_heading is {found}: it must be finite, in radians")]
    KnownHeading { found: f64 },
    #[error(
        "base_from_laser is x {} m, y {} m, yaw {} rad: each must be finite",
        found.x, found.y, found.yaw
    )]
    Mount { found: Pose2 },
    #[error(
        "best is {best} of {highest_possible} possible, and the first vote has {first:?}: they \
         must be 1 or more, the first two rising and the last two equal"
    )]
    Best {
        best: u32,
        highest_possible: u32,
        first: Option<u16>,
    },
    #[error(
        "vote {index} is for cell {}, {} and heading {}: {width} x {height} cells were \
         searched at {headings} headings", vote.x, vote.y, vote.heading
    )]
    Pose {
        index: usize,
        vote: Vote,
        width: u32,
        height: u32,
        headings: u32,
    },
    #[error(
        "vote {index} is {vote:?}, after {previous:?}: intensities must fall, and equal \
         ones rise by heading, y and x"
    )]
    Order {
        index: usize,
        previous: Vote,
        vote: Vote,
    },
    #[error(transparent)]
    Transport(#[from] TransportError),
}
