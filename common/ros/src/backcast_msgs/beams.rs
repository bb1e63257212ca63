//! `backcast_msgs/msg/Beams`.

use serde::{Deserialize, Serialize};

use super::Pose2D;
use crate::definition::definition;
use crate::{Header, RosMessage};

/// What became of each beam of a scan: topic `beams` of the graph.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Beams {
    /// When the scan was measured, and the frame of the map.
    pub header: Header,
    /// The host's `CLOCK_MONOTONIC` in nanoseconds when the scan entered the graph.
    pub entered_ns: i64,
    /// Counts the scans.
    pub counter: u64,
    /// The map that the beams were compared with; 0 where there was none.
    pub map_id: u64,
    /// The pose of the laser at which they were.
    pub map_from_laser: Pose2D,
    /// Those that voted by bearing, then those of which nothing returned.
    pub beams: Vec<Beam>,
}

/// `backcast_msgs/msg/Beam`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Beam {
    /// Counter-clockwise from ahead, radians.
    pub bearing: f32,
    /// Metres; infinity where nothing returned.
    pub range_m: f32,
    /// How much it counted.
    pub weight: f32,
    /// What became of it.
    pub fate: u32,
}

impl Beams {
    /// The beams of a scan as the graph has them, without loss.
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
