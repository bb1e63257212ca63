//! Errors that reject votes, and those that end the node.

use engine::EngineError;
use messages::{Pose2, Vote};
use transport::TransportError;

/// Votes or a map that are refused, or a failure of the graph.
#[derive(Debug, thiserror::Error)]
pub enum PeakError {
    /// The votes are of a map that never came, or came too long ago.
    #[error(
        "they are of map {found:016x}, which is not known; known are the newest map and the one \
         before: {known}"
    )]
    UnknownMap {
        /// By the votes.
        found: u64,
        /// The maps that are known.
        known: String,
    },
    /// The scan of the votes never came, or came too long ago.
    #[error("their scan is not known: it was not received, or too long ago")]
    UnknownScan,
    /// Of votes on several maps it is not known which are on which.
    #[error("which of them are on which map is not known: it was not received, or too long ago")]
    UnknownParts,
    /// The votes on each map are not all.
    #[error("{maps} maps have {parts} votes together, and {total} came")]
    Parts {
        /// How many maps there are.
        maps: usize,
        /// How many votes they have.
        parts: u64,
        /// How many votes there are.
        total: usize,
    },
    /// How a map's cells or a scan's beams were read cannot be.
    #[error("{field} is {found}: allowed are {allowed}")]
    Setting {
        /// Of the header.
        field: &'static str,
        /// By the header.
        found: f64,
        /// In words.
        allowed: &'static str,
    },
    /// The engine refused the map or the scan.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The set of maps is none.
    #[error(transparent)]
    MapSet(#[from] messages::InvalidMapSet),
    /// The map is not the one that its id says.
    #[error(transparent)]
    MapId(#[from] messages::WrongMapId),
    /// No search ends like this.
    #[error(
        "outcome is {found}: allowed are 0 (found), 1 (no votes), 2 (refused) and 3 (not asked)"
    )]
    Outcome {
        /// By the header.
        found: u32,
    },
    /// No turn has this many headings.
    #[error("headings is {found}: allowed are 1 to 65536")]
    Headings {
        /// By the header.
        found: u32,
    },
    /// The heading that was given is no number.
    #[error("known_heading is {found}: it must be finite, in radians")]
    KnownHeading {
        /// By the header.
        found: f64,
    },
    /// The laser's mount is no number.
    #[error(
        "base_from_laser is x {} m, y {} m, yaw {} rad: each must be finite",
        found.x, found.y, found.yaw
    )]
    Mount {
        /// By the header.
        found: Pose2,
    },
    /// The highest intensity is not that of the first vote, or not possible.
    #[error(
        "best is {best} of {highest_possible} possible, and the first vote has {first:?}: they \
         must be 1 or more, the first two rising and the last two equal"
    )]
    Best {
        /// By the header.
        best: u32,
        /// By the header.
        highest_possible: u32,
        /// Intensity of the first vote, if there is one.
        first: Option<u16>,
    },
    /// A vote is for a pose that the search does not know.
    #[error(
        "vote {index} is for cell {}, {} and heading {}: {width} x {height} cells were \
         searched at {headings} headings", vote.x, vote.y, vote.heading
    )]
    Pose {
        /// From 0.
        index: usize,
        /// As it came.
        vote: Vote,
        /// Cells that were searched along x.
        width: u32,
        /// Along y.
        height: u32,
        /// A turn.
        headings: u32,
    },
    /// The votes are not in order.
    #[error(
        "vote {index} is {vote:?}, after {previous:?}: intensities must fall, and equal \
         ones rise by heading, y and x"
    )]
    Order {
        /// From 0.
        index: usize,
        /// The one before.
        previous: Vote,
        /// As it came.
        vote: Vote,
    },
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] TransportError),
}
