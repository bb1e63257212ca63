//! Data sent to viewers: the messages of the graph as JSON, and images as bytes. Pure: the time is
//! an argument.
//!
//! Lengths are metres, angles radians counter-clockwise, times seconds or, if the name says so,
//! milliseconds. NaN and infinity become `null`.

mod ages;
mod answer;
mod beams;
mod field;
mod history;
mod log;
mod map;
mod roster;
mod scan;
mod track;
mod tracked;

pub(crate) use ages::{Ages, Times};
pub(crate) use answer::Answer;
pub(crate) use beams::Beams;
pub(crate) use field::frame as field_frame;
pub(crate) use history::{History, Period, StateChange};
pub(crate) use log::{LogLine, MAX_LINES};
pub(crate) use map::{Map, MapInfo};
pub(crate) use roster::{NodeReport, Roster};
pub(crate) use scan::Scan;
pub(crate) use track::{Track, TrackPoint};
pub(crate) use tracked::Tracked;

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

/// A message to the viewers of a robot.
#[derive(Debug, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(crate) enum Message<'a> {
    /// Everything known, for a new viewer or one that missed messages.
    Snapshot(Snapshot<'a>),
    Map(&'a MapInfo),
    Answer(&'a Answer),
    Pose(&'a Tracked),
    State(Period<'a>),
    Beams(&'a Beams),
    /// End points of a laser's newest scan, ten times a second at most.
    Scan(&'a Scan),
    Node(&'a NodeReport),
    Log(&'a LogLine),
    Region(Region<'a>),
    Abilities(Abilities),
    Recording(&'a Recording),
    /// This many messages were lost, because the reader was too slow.
    Missed {
        messages: u64,
    },
    /// Reply to the reader's ping.
    Pong {
        /// The reader's own time stamp.
        t: f64,
    },
}

/// Requests that a node of the graph can receive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Abilities {
    /// An accumulator accepts search regions.
    pub region: bool,
    /// A recorder can save the last minutes.
    pub save: bool,
    /// A tracker accepts hints.
    pub hint: bool,
    /// A launcher restarts nodes.
    pub restart: bool,
}

/// Recording of the graph, as its launcher reports it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Recording {
    /// File that is being written; `None` while nothing is recorded.
    pub file: Option<String>,
    /// Its size so far, in megabytes (10^6 bytes).
    pub size_mb: Option<f64>,
    /// Reason why no recording can be started.
    pub refused: Option<String>,
}

#[derive(Debug, Serialize)]
pub(crate) struct Region<'a> {
    /// Corners in metres; empty if the whole map is searched.
    pub(crate) corners: &'a [[f64; 2]],
}

#[derive(Debug, Serialize)]
pub(crate) struct Snapshot<'a> {
    pub(crate) robot: &'a str,
    /// `None` if it is not known (a graph on another machine).
    pub(crate) graph: Option<&'a str>,
    pub(crate) map: Option<&'a MapInfo>,
    pub(crate) answer: Option<&'a Answer>,
    /// `None` if the graph has no tracker.
    pub(crate) pose: Option<&'a Tracked>,
    pub(crate) ages: Ages,
    /// States of the last hour, oldest first.
    pub(crate) states: Vec<Period<'a>>,
    pub(crate) beams: Option<&'a Beams>,
    pub(crate) nodes: Vec<&'a NodeReport>,
    pub(crate) track: Vec<&'a TrackPoint>,
    pub(crate) log: Vec<&'a LogLine>,
    pub(crate) region: &'a [[f64; 2]],
    pub(crate) abilities: Abilities,
    /// `None` without a launcher that records on request.
    pub(crate) recording: Option<&'a Recording>,
}

/// Adds an item at the end of a queue; drops the first one if there are more than `most`.
pub(crate) fn push_within<T>(most: usize, queue: &mut VecDeque<T>, item: T) {
    if queue.len() == most {
        queue.pop_front();
    }
    queue.push_back(item);
}

pub(crate) fn ms(ns: i64) -> f64 {
    ns as f64 / 1e6
}
