//! `backcast_msgs/msg/Beams`.

use super::Pose2D;
use crate::Header;

declare! {
    #[derive(Copy)]
    part Beam = "backcast_msgs/Beam" with "\
uint32 HIT=0
uint32 SHORT=1
uint32 THROUGH=2
uint32 UNKNOWN=3
uint32 NO_RETURN=4
" [] {
        bearing: f32,
        range_m: f32,
        weight: f32,
        fate: u32,
    }

    /// Result of each beam of a scan: topic `beams` of the graph.
    message Beams = "backcast_msgs/msg/Beams" with "\
# What became of each beam of a scan at the best pose.
" [Header, Pose2D, Beam] {
        header: Header,
        entered_ns: i64,
        counter: u64,
        map_id: u64,
        map_from_laser: Pose2D,
        beams: Vec<Beam>,
    }
}

impl Beams {
    /// Converts the beams of a scan of the graph, without loss.
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
