//! `backcast_msgs/msg/Votes`.

use serde::{Deserialize, Serialize};

use super::Pose2D;
use crate::definition::definition;
use crate::{Header, RosMessage};

/// Result of one search: topic `votes` of the graph.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Votes {
    /// Time of the scan, and the frame of the map.
    pub header: Header,
    /// The host's `CLOCK_MONOTONIC` in nanoseconds when the scan entered the graph.
    pub entered_ns: i64,
    /// Number of the scan.
    pub counter: u64,
    /// Id of the map that was searched; 0 if there was none.
    pub map_id: u64,
    /// Number of votes.
    pub total: u64,
    /// Computing time, in nanoseconds.
    pub engine_ns: u64,
    /// Number of poses whose intensity was computed individually.
    pub poses_evaluated: u64,
    /// A `messages::SearchOutcome`.
    pub outcome: u32,
    /// Number of headings in a full turn.
    pub headings: u32,
    /// Lowest intensity among the votes.
    pub floor: u32,
    /// Intensity from which the votes are complete.
    pub certified_floor: u32,
    /// Highest intensity of any pose.
    pub best: u32,
    /// Intensity of a pose that every beam agrees with fully.
    pub highest_possible: u32,
    /// True if the floor was raised to limit the number of votes, or the search was cut off by its
    /// limit of work.
    pub truncated: bool,
    /// True if the heading was given.
    pub heading_known: bool,
    /// True if the laser's mount was given.
    pub mount_known: bool,
    /// Number of beams that voted.
    pub beams_used: u32,
    /// Number of beams without a usable range.
    pub beams_silent: u32,
    /// Given heading in the map frame, in radians.
    pub known_heading: f64,
    /// Largest rounding of a bearing to the heading grid, in radians.
    pub bearing_rounding: f64,
    /// Pose of the laser on the robot.
    pub base_from_laser: Pose2D,
    /// Occupancy from which a cell counts as occupied, in percent.
    pub occupied_from: u32,
    /// Occupancy up to which a cell counts as free, in percent.
    pub free_to: u32,
    /// Largest number of beams of a scan that vote.
    pub max_beams: u32,
    /// Downsampling factor: map cells per search cell and axis.
    pub pooling: u32,
    /// Arc at the measured range from which a beam has full weight, in metres.
    pub beam_arc_m: f64,
    /// Votes by falling intensity.
    pub votes: Vec<Vote>,
}

/// `backcast_msgs/msg/Vote`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Vote {
    /// Index of the search cell along x from the grid's origin.
    pub x: u16,
    /// Index of the search cell along y from the grid's origin.
    pub y: u16,
    /// Index of the heading.
    pub heading: u16,
    /// Sum of the tapers of all beams.
    pub intensity: u16,
}

impl Votes {
    /// Converts the votes of a scan of the graph; `map` gives the thresholds of occupancy.
    #[must_use]
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

impl RosMessage for Votes {
    const SCHEMA: &'static str = "backcast_msgs/msg/Votes";
    const DEFINITION: &'static str = definition!(
        "\
# The outcome of one search: the poses that a scan votes for.
uint32 FOUND=0
uint32 NO_VOTES=1
uint32 REFUSED=2
std_msgs/Header header
int64 entered_ns
uint64 counter
uint64 map_id
uint64 total
uint64 engine_ns
uint64 poses_evaluated
uint32 outcome
uint32 headings
uint32 floor
uint32 certified_floor
uint32 best
uint32 highest_possible
bool truncated
bool heading_known
bool mount_known
uint32 beams_used
uint32 beams_silent
float64 known_heading
float64 bearing_rounding
geometry_msgs/Pose2D base_from_laser
uint32 occupied_from
uint32 free_to
uint32 max_beams
uint32 pooling
float64 beam_arc_m
backcast_msgs/Vote[] votes
",
        Header,
        Pose2D,
        "\
backcast_msgs/Vote
uint16 x
uint16 y
uint16 heading
uint16 intensity
",
    );
}
