//! Topics of the graph: their names, types and quality of service.

use bytemuck::Pod;

use crate::{
    AttentionHeader, Beam, BeamsHeader, BoundaryCell, BoundaryHeader, Corner, FieldHeader,
    GroundTruth, HealthHeader, HypothesesHeader, Hypothesis, InitialPose, LogHeader, MapHeader,
    MapsHeader, Odometry, Particle, ParticlesHeader, PoseHeader, Reading, ReadingsHeader,
    RegionHeader, SaveHeader, ScanHeader, Vote, VotesByMapHeader, VotesHeader,
};

#[cfg(feature = "iceoryx2")]
use iceoryx2_bb_elementary_traits::zero_copy_send::ZeroCopySend as Shareable;

/// Trait of types in shared memory, required by iceoryx2; empty without that feature.
#[cfg(not(feature = "iceoryx2"))]
pub trait Shareable {}

#[cfg(not(feature = "iceoryx2"))]
impl<T> Shareable for T {}

/// Plain data that one process may write and another may read in place.
pub trait Message: Pod + Shareable + std::fmt::Debug {}

impl<T: Pod + Shareable + std::fmt::Debug> Message for T {}

/// A topic: a header and a slice of items under one name.
///
/// A message of fixed size is a header with an empty slice of bytes.
pub trait Topic: 'static {
    /// Name in the graph, and of the port in `dataflow.yaml`.
    const NAME: &'static str;
    /// Header of each sample.
    type Header: Message;
    /// Items of each sample.
    type Item: Message;
    /// True if the newest sample is kept for late joiners.
    const LATCHED: bool = false;
    /// Number of samples of a publisher that are kept for late joiners.
    const HISTORY: usize = if Self::LATCHED { 1 } else { 0 };
    /// Number of samples queued for a slow subscriber before the oldest is dropped; the transport
    /// counts dropped samples.
    const DEPTH: usize = 4;
    /// Largest number of processes that may publish at the same time.
    const MAX_PUBLISHERS: usize = 2;
    /// Largest number of processes that may subscribe at the same time.
    const MAX_SUBSCRIBERS: usize = 8;
}

macro_rules! topics {
    ($($(#[$doc:meta])* $topic:ident = $name:literal, $header:ty, [$item:ty] $({ $($const:ident: $value:expr),+ })?;)+) => {
        $(
            $(#[$doc])*
            #[derive(Debug)]
            pub struct $topic;
            impl Topic for $topic {
                const NAME: &'static str = $name;
                type Header = $header;
                type Item = $item;
                $($(topics!(@const $const $value);)+)?
            }
        )+
        /// Names of all topics, for use in `dataflow.yaml`.
        pub const NAMES: &[&str] = &[$($name),+];
    };
    (@const latched $value:expr) => { const LATCHED: bool = $value; };
    (@const history $value:expr) => { const HISTORY: usize = $value; };
    (@const depth $value:expr) => { const DEPTH: usize = $value; };
    (@const publishers $value:expr) => { const MAX_PUBLISHERS: usize = $value; };
    (@const subscribers $value:expr) => { const MAX_SUBSCRIBERS: usize = $value; };
}

topics! {
    /// Ranges in metres, in the order of the beams; infinity without a return. The queue is deeper
    /// than that of other topics, as a player sends the scans of all lasers.
    Scan = "scan", ScanHeader, [f32] { depth: 8, publishers: 8 };
    /// Pose and twist from wheel odometry; no items.
    OdometryTopic = "odometry", Odometry, [u8] { depth: 16 };
    /// Occupancy, row by row from the lowest y: 0 free to 100 occupied, 255 unknown.
    Map = "map", MapHeader, [u8] { latched: true, depth: 1 };
    /// Occupied cells that a ray can hit first.
    Boundary = "boundary", BoundaryHeader, [BoundaryCell] { latched: true, depth: 1 };
    /// All maps of a set, which are searched together.
    Maps = "maps", MapsHeader, [u8] { latched: true, depth: 1 };
    /// Assignment of a scan's votes to maps, if several are searched.
    VotesByMap = "votes_by_map", VotesByMapHeader, [VotesHeader];
    /// Poses at or above the floor, most votes first.
    Votes = "votes", VotesHeader, [Vote];
    /// Readings for the second stage, of a scan that was joined or motion-corrected.
    Readings = "readings", ReadingsHeader, [Reading];
    /// Intensity image, row by row from the lowest y.
    Field = "field", FieldHeader, [u16] { depth: 1 };
    /// Candidate poses of the robot, best first.
    Hypotheses = "hypotheses", HypothesesHeader, [Hypothesis] { depth: 16 };
    /// Initial particles for a particle filter, around the hypotheses of a scan.
    Particles = "particles", ParticlesHeader, [Particle];
    /// Pose from the tracker; the items are the reason in words, as UTF-8.
    Tracked = "pose", PoseHeader, [u8] { depth: 16 };
    /// Scans that the tracker requests to be searched; no items.
    Attention = "attention", AttentionHeader, [u8] { depth: 16 };
    /// Initial pose of the robot from outside; no items.
    InitialPoseTopic = "initial_pose", InitialPose, [u8] { publishers: 4 };
    /// Comparison of each beam with the map at the best pose.
    Beams = "beams", BeamsHeader, [Beam];
    /// True pose of a scan, from a recording; no items.
    GroundTruthTopic = "ground_truth", GroundTruth, [u8] { depth: 16 };
    /// Region of all following searches; without items, everywhere.
    Region = "region", RegionHeader, [Corner] { latched: true, depth: 1 };
    /// Request to the recorder to save the last minutes; no items.
    Save = "save", SaveHeader, [u8];
    /// State of each node; the items are its last error as UTF-8.
    Health = "health", HealthHeader, [u8] { latched: true, depth: 8, publishers: 24, subscribers: 8 };
    /// Log of each node; the items are one line as UTF-8.
    Log = "log", LogHeader, [u8] { latched: true, history: 16, depth: 64, publishers: 24, subscribers: 8 };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_usable_as_ports() {
        let mut names = NAMES.to_vec();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), NAMES.len());
        for name in names {
            assert!(
                name.bytes().all(|b| b.is_ascii_lowercase() || b == b'_'),
                "{name}"
            );
        }
    }
}
