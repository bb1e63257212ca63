//! State received from the monitor, and its age, at times that are passed in.

use std::collections::{BTreeMap, VecDeque};
use std::time::{Duration, Instant};

use geometry::{Covariance, Pose};
use serde::Deserialize;

/// Age after which data counts as missing; scans and poses are more frequent.
const SILENT_AFTER: Duration = Duration::from_secs(2);

/// Number of latencies kept, which fill a line.
const LATENCIES: usize = 120;

/// Message of the monitor, with the fields shown here.
#[derive(Debug, Clone, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(super) enum Message {
    Snapshot(Box<Snapshot>),
    Answer(Answer),
    Pose(Box<Tracked>),
    Map(Map),
    Node(Node),
    #[serde(other)]
    Other,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(super) struct Snapshot {
    robot: String,
    map: Option<Map>,
    answer: Option<Answer>,
    pose: Option<Tracked>,
    ages: Ages,
    nodes: Vec<Node>,
}

/// Ages of the monitor's data in seconds; `None` without data.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(default)]
struct Ages {
    scan_s: Option<f64>,
    pose_s: Option<f64>,
}

/// The map that is shown; its name is empty if it is the only one.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(super) struct Map {
    map_id: String,
    name: String,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(super) struct Answer {
    map_id: String,
    pub(super) counter: u64,
    pub(super) verdict: String,
    pub(super) says: String,
    pub(super) latency_ms: f64,
    pub(super) search_cpu_ms: f64,
    pub(super) extract_cpu_ms: f64,
    pub(super) age_ms: f64,
    pub(super) hypotheses: Vec<Place>,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(super) struct Tracked {
    map_id: String,
    pub(super) counter: u64,
    pub(super) from_scan: bool,
    pub(super) state: String,
    pub(super) says: String,
    pub(super) laser: Option<Pose>,
    pub(super) base: Option<Pose>,
    laser_covariance: Option<[f64; 9]>,
    base_covariance: Option<[f64; 9]>,
    pub(super) probability: Option<f64>,
    pub(super) score: Option<f64>,
    pub(super) latency_ms: f64,
    pub(super) age_ms: f64,
    pub(super) sent_age_ms: f64,
}

/// Candidate pose: metres and radians in the map.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(super) struct Place {
    pub(super) laser: Pose,
    /// `None` if the laser's mount is not known.
    pub(super) base: Option<Pose>,
    pub(super) score: f64,
    pub(super) probability: f64,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(super) struct Node {
    pub(super) name: String,
    pub(super) state: String,
    pub(super) received_hz: f64,
    pub(super) sent_hz: f64,
    pub(super) dropped: u64,
    pub(super) refused: u64,
    pub(super) restarts: u32,
    pub(super) last_error: String,
}

impl Tracked {
    pub(super) fn covariance(&self) -> Option<Covariance> {
        let rows = match self.base {
            Some(_) => self.base_covariance,
            None => self.laser_covariance,
        };
        rows.map(Covariance::from_rows)
    }
}

/// Age of data: its age when it was received, plus the time since.
#[derive(Debug, Clone, Copy)]
struct Age {
    received: Instant,
    then: Duration,
}

impl Age {
    fn of(seconds: f64, received: Instant) -> Self {
        let then = Duration::try_from_secs_f64(seconds.max(0.0));
        Age {
            received,
            then: then.unwrap_or(Duration::MAX),
        }
    }

    fn at(self, now: Instant) -> Duration {
        let since = now.saturating_duration_since(self.received);
        self.then.saturating_add(since)
    }
}

#[derive(Debug, Default)]
pub(super) struct Known {
    pub(super) robot: String,
    map: Option<Map>,
    pub(super) answer: Option<Answer>,
    /// `None` if the graph has no tracker.
    pub(super) pose: Option<Tracked>,
    /// Age of the newest answered scan since it entered the graph.
    scan_age: Option<Age>,
    /// Age of the tracker's newest pose since it was sent.
    pose_age: Option<Age>,
    pub(super) nodes: BTreeMap<String, Node>,
    pub(super) latencies_ms: VecDeque<f64>,
    pub(super) lost: Option<String>,
}

impl Known {
    pub(super) fn receive(&mut self, message: Message, now: Instant) {
        let age = |seconds: f64| Age::of(seconds, now);
        self.lost = None;
        match message {
            Message::Snapshot(all) => {
                self.robot = all.robot;
                self.map = all.map;
                self.answer = all.answer;
                self.pose = all.pose;
                self.scan_age = all.ages.scan_s.map(age);
                self.pose_age = all.ages.pose_s.map(age);
                let nodes = all.nodes.into_iter();
                self.nodes = nodes.map(|node| (node.name.clone(), node)).collect();
            }
            Message::Answer(answer) => {
                self.scan_age = Some(age(answer.age_ms / 1e3));
                if self.pose.is_none() {
                    self.took(answer.latency_ms);
                }
                self.answer = Some(answer);
            }
            Message::Pose(pose) => {
                if pose.from_scan {
                    self.scan_age = Some(age(pose.age_ms / 1e3));
                    self.took(pose.latency_ms);
                }
                self.pose_age = Some(age(pose.sent_age_ms / 1e3));
                self.pose = Some(*pose);
            }
            Message::Map(map) => self.map = Some(map),
            Message::Node(node) => {
                self.nodes.insert(node.name.clone(), node);
            }
            Message::Other => {}
        }
    }

    pub(super) fn silence(&self, now: Instant) -> Option<String> {
        let quiet = |age: Option<Age>, what: &str| {
            let age = age?.at(now);
            let seconds = age.as_secs();
            (age > SILENT_AFTER).then(|| format!("no {what} for {seconds} s"))
        };
        quiet(self.scan_age, "data").or_else(|| quiet(self.pose_age, "pose"))
    }

    /// Returns the name of the map of the pose, if there are several and it is the one shown.
    pub(super) fn map_name(&self) -> Option<&str> {
        let tracked = self.pose.as_ref().map(|pose| &pose.map_id);
        let map_id = tracked.or(self.answer.as_ref().map(|answer| &answer.map_id))?;
        let map = self.map.as_ref().filter(|map| map.map_id == *map_id)?;
        Some(&*map.name).filter(|name| !name.is_empty())
    }

    /// True if the state shown is a scan's; between scans the tracker counts odometry.
    pub(super) fn is_of_scan(&self) -> bool {
        self.pose.as_ref().is_none_or(|pose| pose.from_scan)
    }

    fn took(&mut self, latency_ms: f64) {
        if self.latencies_ms.len() == LATENCIES {
            self.latencies_ms.pop_front();
        }
        self.latencies_ms.push_back(latency_ms);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_add_up_and_unknown_ones_are_left_out() {
        let mut known = Known::default();
        for text in [
            r#"{"type":"snapshot","robot":"r","answer":null,"nodes":[{"name":"a","state":"ready"}],"new":1}"#,
            r#"{"type":"node","name":"b","state":"silent","quiet_s":3.0}"#,
            r#"{"type":"beams","fate":"hh"}"#,
            r#"{"type":"answer","counter":7,"verdict":"Unique","latency_ms":20.5,"hypotheses":[]}"#,
        ] {
            known.receive(serde_json::from_str(text).unwrap(), Instant::now());
        }
        assert_eq!(known.robot, "r");
        assert_eq!(known.nodes.keys().collect::<Vec<_>>(), ["a", "b"]);
        assert_eq!(known.answer.unwrap().counter, 7);
        assert_eq!(known.latencies_ms, [20.5]);
    }

    #[test]
    fn what_is_old_is_said_to_be() {
        let start = Instant::now();
        let after = |seconds: u64| start + Duration::from_secs(seconds);
        let mut known = Known::default();
        let mut receive = |text: &str, at: u64| {
            known.receive(serde_json::from_str(text).unwrap(), after(at));
            known.silence(after(at))
        };
        // Nothing came yet.
        assert_eq!(receive(r#"{"type":"snapshot","ages":{}}"#, 0), None);
        // A viewer who connects a minute after the laser died gets this snapshot.
        let old = r#"{"type":"snapshot","ages":{"scan_s":61.5},"answer":{"verdict":"Unique"}}"#;
        assert_eq!(receive(old, 0).unwrap(), "no data for 61 s");
        let answer = r#"{"type":"answer","age_ms":30.0}"#;
        assert_eq!(receive(answer, 1), None);
        // Then only odometry comes.
        let odometry = r#"{"type":"pose","from_scan":false,"age_ms":9.0}"#;
        assert_eq!(receive(odometry, 2), None);
        assert_eq!(receive(odometry, 4).unwrap(), "no data for 3 s");
        // The tracker ends.
        assert_eq!(receive(answer, 5), None);
        assert_eq!(receive(answer, 7).unwrap(), "no pose for 3 s");
    }
}
