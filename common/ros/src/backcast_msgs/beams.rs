//! `backcast_msgs/msg/Beams`.

use serde::{Deserialize, Serialize};

use super::Pose2D;
use crate::definition::definition;
use crate::{Header, RosMessage};

/// Result of each beam of a scan: topic `beams` of the graph.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Beams {
    /// Time of the scan, and the frame of the map.
    pub header: Header,
    /// The host's `CLOCK_MONOTONIC` in nanoseconds when the scan entered the graph.
    pub entered_ns: i64,
    /// Number of the scan.
    pub counter: u64,
    /// Id of the map that the beams were compared with; 0 if there was none.
    pub map_id: u64,
    /// Pose of the laser in the map at which they were compared.
    pub map_from_laser: Pose2D,
    /// Beams that voted, by bearing, followed by beams without a return.
    pub beams: Vec<Beam>,
}

/// `backcast_msgs/msg/Beam`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Beam {
    /// Counter-clockwise from ahead, in radians.
    pub bearing: f32,
    /// Metres; infinity if nothing returned.
    pub range_m: f32,
    /// Weight of its vote.
    pub weight: f32,
    /// A `messages::BeamFate`.
    pub fate: u32,
}

impl Beams {
    /// Converts the beams of a scan of the graph, without loss.
    #[must_use]
    pub fn of(header: Header, from: &messages::BeamsHeader, items: &[messages::Beam]) -> Self {
        let beam = |beam: &messages::Beam| Beam {
            bearing: beam.bearing,
            range_m: beam.range_m,
            weight: beam.weight,
            fate: beam.fate,
        };
        Beams {
            header,
            entered_ns: from.stamp.entered_ns,
            counter: from.stamp.counter,
            map_id: from.map_id,
            map_from_laser: from.map_from_laser.into(),
            beams: items.iter().map(beam).collect(),
        }
    }
}

impl RosMessage for Beams {
    const SCHEMA: &'static str = "backcast_msgs/msg/Beams";
    const DEFINITION: &'static str = definition!(
        "\
# What became of each beam of a scan at the best pose.
std_msgs/Header header
int64 entered_ns
uint64 counter
uint64 map_id
geometry_msgs/Pose2D map_from_laser
backcast_msgs/Beam[] beams
",
        Header,
        Pose2D,
        "\
backcast_msgs/Beam
uint32 HIT=0
uint32 SHORT=1
uint32 THROUGH=2
uint32 UNKNOWN=3
uint32 NO_RETURN=4
float32 bearing
float32 range_m
float32 weight
uint32 fate
",
    );
}
