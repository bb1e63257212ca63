//! The topics of the graph: their names, types and quality of service.

use bytemuck::Pod;

use crate::{
    AttentionHeader, Beam, BeamsHeader, BoundaryCell, BoundaryHeader, Corner, FieldHeader,
    GroundTruth, HealthHeader, HypothesesHeader, Hypothesis, InitialPose, LogHeader, MapHeader,
    MapsHeader, Odometry, Particle, ParticlesHeader, PoseHeader, Reading, ReadingsHeader,
    RegionHeader, SaveHeader, ScanHeader, Vote, VotesByMapHeader, VotesHeader,
};

#[cfg(feature = "iceoryx2")]
use iceoryx2_bb_elementary_traits::zero_copy_send::ZeroCopySend as Shareable;

/// What iceoryx2 asks of what lies in shared memory; without it, nothing.
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
    /// The name in the graph, and of the port in `dataflow.yaml`.
    const NAME: &'static str;
    /// The header of each sample.
    type Header: Message;
    /// What the slice holds.
    type Item: Message;
    /// Whether the newest sample is kept for those who join later.
    const LATCHED: bool = false;
    /// How many samples of a publisher are kept for them.
    const HISTORY: usize = if Self::LATCHED { 1 } else { 0 };
    /// Samples that a slow subscriber may lag behind before the oldest is
    /// dropped; the transport counts what it drops.
    const DEPTH: usize = 4;
    /// Most processes that may publish at the same time.
    const MAX_PUBLISHERS: usize = 2;
    /// Most processes that may subscribe at the same time.
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
        /// The names of all topics, as `dataflow.yaml` may use them.
        pub const NAMES: &[&str] = &[$($name),+];
    };
    (@const latched $value:expr) => { const LATCHED: bool = $value; };
    (@const history $value:expr) => { const HISTORY: usize = $value; };
    (@const depth $value:expr) => { const DEPTH: usize = $value; };
    (@const publishers $value:expr) => { const MAX_PUBLISHERS: usize = $value; };
    (@const subscribers $value:expr) => { const MAX_SUBSCRIBERS: usize = $value; };
}

topics! {
    /// Ranges in metres, in the order of the beams; infinity where nothing came back.
    /// Deeper than other topics, for a player sends the scans of all lasers.
    Scan = "scan", ScanHeader, [f32] { depth: 8, publishers: 8 };
    /// The pose that wheels report, with twist; no items.
    OdometryTopic = "odometry", Odometry, [u8] { depth: 16 };
    /// Occupancy, row by row from the lowest y: 0 free to 100 occupied, 255 unknown.
    Map = "map", MapHeader, [u8] { latched: true, depth: 1 };
    /// The occupied cells that a ray can meet first.
    Boundary = "boundary", BoundaryHeader, [BoundaryCell] { latched: true, depth: 1 };
    /// All maps of a set, which are searched together.
    Maps = "maps", MapsHeader, [u8] { latched: true, depth: 1 };
    /// Which of the votes of a scan are on which map, where several are searched.
    VotesByMap = "votes_by_map", VotesByMapHeader, [VotesHeader];
    /// The poses at or above the floor, most votes first.
    Votes = "votes", VotesHeader, [Vote];
    /// What the second stage judges of a scan that was joined or moved.
    Readings = "readings", ReadingsHeader, [Reading];
    /// The intensity image, row by row from the lowest y.
    Field = "field", FieldHeader, [u16] { depth: 1 };
    /// Where the robot may be, best first.
    Hypotheses = "hypotheses", HypothesesHeader, [Hypothesis] { depth: 16 };
    /// Where a particle filter may start, around the hypotheses of a scan.
    Particles = "particles", ParticlesHeader, [Particle];
    /// Where the tracker has the robot; the items are why, in words, as UTF-8.
    Tracked = "pose", PoseHeader, [u8] { depth: 16 };
    /// Scans that the tracker wants searched; no items.
    Attention = "attention", AttentionHeader, [u8] { depth: 16 };
    /// Where the robot is said to be; no items.
    InitialPoseTopic = "initial_pose", InitialPose, [u8];
    /// What became of each beam at the best pose.
    Beams = "beams", BeamsHeader, [Beam];
    /// The true pose of a scan, where a recording holds it; no items.
    GroundTruthTopic = "ground_truth", GroundTruth, [u8] { depth: 16 };
    /// Where poses are to be searched from now on; no items where everywhere.
    Region = "region", RegionHeader, [Corner] { latched: true, depth: 1 };
    /// A request that the recorder save the last minutes; no items.
    Save = "save", SaveHeader, [u8];
    /// The state of each node; the items are its last error as UTF-8.
    Health = "health", HealthHeader, [u8] { latched: true, depth: 8, publishers: 24, subscribers: 8 };
    /// What each node logs, a line at a time; the items are the line as UTF-8.
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
