//! What those who watch are told: the messages of the graph as JSON, and images
//! as bytes. Pure: told the time, and knowing no clock.
//!
//! Lengths are metres, angles radians counter-clockwise, times seconds or, where
//! the name says so, milliseconds. What is no number is `null`.

mod answer;
mod beams;
mod field;
mod log;
mod map;
mod roster;
mod track;

pub(crate) use answer::Answer;
pub(crate) use beams::Beams;
pub(crate) use field::frame as field_frame;
pub(crate) use log::{Log, LogLine};
pub(crate) use map::{Map, MapInfo};
pub(crate) use roster::{NodeReport, Roster};
pub(crate) use track::{Track, TrackPoint};

use messages::Pose2;
use serde::Serialize;

use crate::robot::Abilities;

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
    /// What became of its beams.
    Beams(&'a Beams),
    /// How a node fares.
    Node(&'a NodeReport),
    /// What a node logs.
    Log(&'a LogLine),
    /// Where poses are sought.
    Region(Region<'a>),
    /// Who listens to wishes.
    Abilities(Abilities),
    /// So many messages were not sent, because the reader was too slow.
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

/// A region of the map, or all of it.
#[derive(Debug, Serialize)]
pub(crate) struct Region<'a> {
    /// The corners; none where poses are sought everywhere.
    pub(crate) corners: &'a [[f64; 2]],
}

/// All that is known of a robot.
#[derive(Debug, Serialize)]
pub(crate) struct Snapshot<'a> {
    pub(crate) robot: &'a str,
    pub(crate) map: Option<&'a MapInfo>,
    pub(crate) answer: Option<&'a Answer>,
    pub(crate) beams: Option<&'a Beams>,
    pub(crate) nodes: Vec<&'a NodeReport>,
    pub(crate) track: Vec<&'a TrackPoint>,
    pub(crate) log: Vec<&'a LogLine>,
    pub(crate) region: &'a [[f64; 2]],
    pub(crate) abilities: Abilities,
}

/// A pose: metres and radians in the map.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct PoseTold {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) yaw: f64,
}

impl From<Pose2> for PoseTold {
    fn from(Pose2 { x, y, yaw }: Pose2) -> Self {
        PoseTold { x, y, yaw }
    }
}

/// Nanoseconds in milliseconds.
pub(crate) fn ms(ns: i64) -> f64 {
    ns as f64 / 1e6
}
