//! What viewers are sent: the messages of the graph as JSON, and images
//! as bytes. Pure: the time is an argument.
//!
//! Lengths are metres, angles radians counter-clockwise, times seconds or, where
//! the name says so, milliseconds. What is no number is `null`.

mod ages;
mod answer;
mod beams;
mod field;
mod history;
mod log;
mod map;
mod roster;
mod state_change;
mod track;
mod tracked;

pub(crate) use ages::{Ages, Times};
pub(crate) use answer::Answer;
pub(crate) use beams::Beams;
pub(crate) use field::frame as field_frame;
pub(crate) use history::{History, Period};
pub(crate) use log::{Log, LogLine};
pub(crate) use map::{Map, MapInfo};
pub(crate) use roster::{NodeReport, Roster};
pub(crate) use state_change::StateChange;
pub(crate) use track::{Track, TrackPoint};
pub(crate) use tracked::Tracked;

use geometry::Covariance;
use messages::Pose2;
use serde::Serialize;

/// A message to those who watch a robot.
#[derive(Debug, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(crate) enum Message<'a> {
    /// All that is known, to whoever comes or has missed something.
    Snapshot(Snapshot<'a>),
    /// Another map is served.
    Map(&'a MapInfo),
    /// What a scan says of the pose.
    Answer(&'a Answer),
    /// Where the tracker has the robot.
    Pose(&'a Tracked),
    /// Another state begins.
    State(Period<'a>),
    /// What became of its beams.
    Beams(&'a Beams),
    /// The state of a node.
    Node(&'a NodeReport),
    /// What a node logs.
    Log(&'a LogLine),
    /// Where poses are searched.
    Region(Region<'a>),
    /// Who listens to requests.
    Abilities(Abilities),
    /// This many messages were not sent, because the reader was too slow.
    Missed {
        /// Their number.
        messages: u64,
    },
    /// What the reader has sent, back to it.
    Pong {
        /// Its clock.
        t: f64,
    },
}

/// Whether a node listens to requests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Abilities {
    /// An accumulator takes regions.
    pub region: bool,
    /// A recorder saves its black box.
    pub save: bool,
}

/// A region of the map, or all of it.
#[derive(Debug, Serialize)]
pub(crate) struct Region<'a> {
    /// The corners; none where poses are searched everywhere.
    pub(crate) corners: &'a [[f64; 2]],
}

/// All that is known of a robot.
#[derive(Debug, Serialize)]
pub(crate) struct Snapshot<'a> {
    pub(crate) robot: &'a str,
    /// The graph's name; none where it is elsewhere.
    pub(crate) graph: Option<&'a str>,
    pub(crate) map: Option<&'a MapInfo>,
    pub(crate) answer: Option<&'a Answer>,
    /// None where the graph has no tracker.
    pub(crate) pose: Option<&'a Tracked>,
    pub(crate) ages: Ages,
    /// The states of the last hour, oldest first.
    pub(crate) states: Vec<Period<'a>>,
    pub(crate) beams: Option<&'a Beams>,
    pub(crate) nodes: Vec<&'a NodeReport>,
    pub(crate) track: Vec<&'a TrackPoint>,
    pub(crate) log: Vec<&'a LogLine>,
    pub(crate) region: &'a [[f64; 2]],
    pub(crate) abilities: Abilities,
}

/// A pose: metres and radians in the map.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct PoseJson {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) yaw: f64,
}

impl From<Pose2> for PoseJson {
    fn from(Pose2 { x, y, yaw }: Pose2) -> Self {
        PoseJson { x, y, yaw }
    }
}

/// The ellipse of one standard deviation, of a covariance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Ellipse {
    /// Half of the long axis.
    pub(crate) major_m: f64,
    /// Half of the short one.
    pub(crate) minor_m: f64,
    /// Of the long axis to the map's x.
    pub(crate) angle: f64,
    /// Standard deviation of the heading.
    pub(crate) yaw: f64,
}

impl Ellipse {
    /// Of a covariance row by row over x, y and yaw, as far as it is one.
    pub(crate) fn new(rows: [f64; 9]) -> Option<Self> {
        let is_finite = rows.iter().all(|value| value.is_finite());
        let ellipse = is_finite.then(|| Covariance::from_rows(rows).ellipse())?;
        let [.., yaw_variance] = rows;
        Some(Ellipse {
            major_m: ellipse.major_m,
            minor_m: ellipse.minor_m,
            angle: ellipse.angle,
            yaw: yaw_variance.max(0.0).sqrt(),
        })
    }
}

/// Nanoseconds in milliseconds.
pub(crate) fn ms(ns: i64) -> f64 {
    ns as f64 / 1e6
}
