//! `backcast_msgs/msg/Votes`.

use super::Pose2D;
use crate::Header;

declare! {
    #[derive(Copy)]
    part Vote = "backcast_msgs/Vote" [] {
        x: u16,
        y: u16,
        heading: u16,
        intensity: u16,
    }

    /// Result of one search: topic `votes` of the graph.
    message Votes = "backcast_msgs/msg/Votes" with "\
# The outcome of one search: the poses that a scan votes for.
uint32 FOUND=0
uint32 NO_VOTES=1
uint32 REFUSED=2
" [Header, Pose2D, Vote] {
        header: Header,
        entered_ns: i64,
        counter: u64,
        map_id: u64,
        total: u64,
        engine_ns: u64,
        poses_evaluated: u64,
        outcome: u32,
        headings: u32,
        floor: u32,
        certified_floor: u32,
        best: u32,
        highest_possible: u32,
        truncated: bool,
        heading_known: bool,
        mount_known: bool,
        beams_used: u32,
        beams_silent: u32,
        known_heading: f64,
        bearing_rounding: f64,
        base_from_laser: Pose2D,
        occupied_from: u32,
        free_to: u32,
        max_beams: u32,
        pooling: u32,
        beam_arc_m: f64,
        votes: Vec<Vote>,
    }
}

impl Votes {
    /// Converts the votes of a scan of the graph; `map` gives the thresholds of occupancy.
    pub fn of(
        header: Header,
        (votes, items): (&messages::VotesHeader, &[messages::Vote]),
        map: Option<&messages::MapHeader>,
    ) -> Self {
        let vote = |vote: &messages::Vote| Vote {
            x: vote.x,
            y: vote.y,
            heading: vote.heading,
            intensity: vote.intensity,
        };
        Votes {
            header,
            entered_ns: votes.stamp.entered_ns,
            counter: votes.stamp.counter,
            map_id: votes.map_id,
            total: votes.total,
            engine_ns: votes.engine_ns,
            poses_evaluated: votes.poses_evaluated,
            outcome: votes.outcome,
            headings: votes.headings,
            floor: votes.floor,
            certified_floor: votes.certified_floor,
            best: votes.best,
            highest_possible: votes.highest_possible,
            truncated: votes.truncated != 0,
            heading_known: votes.heading_known != 0,
            mount_known: votes.mount_known != 0,
            beams_used: votes.beams_used,
            beams_silent: votes.beams_silent,
            known_heading: votes.known_heading,
            bearing_rounding: votes.bearing_rounding,
            base_from_laser: votes.base_from_laser.into(),
            occupied_from: map.map_or(0, |map| map.occupied_from),
            free_to: map.map_or(0, |map| map.free_to),
            max_beams: votes.max_beams,
            pooling: votes.pooling,
            beam_arc_m: votes.beam_arc_m,
            votes: items.iter().map(vote).collect(),
        }
    }
}
