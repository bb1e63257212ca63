//! State received from the monitor, as it wrote it in JSON, and its age, at times that are passed
//! in. A field that is missing counts as 0 or empty.

use std::collections::{BTreeMap, VecDeque};
use std::time::{Duration, Instant};

use serde_json::Value;

/// Age after which data counts as missing; scans and poses are more frequent.
const SILENT_AFTER: Duration = Duration::from_secs(2);

/// Number of latencies kept, which fill a line.
const LATENCIES: usize = 120;

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
    /// The map that is shown; its name is empty if it is the only one.
    map: Option<Value>,
    pub(super) answer: Option<Value>,
    /// `None` if the graph has no tracker.
    pub(super) pose: Option<Value>,
    /// Age of the newest answered scan since it entered the graph.
    scan_age: Option<Age>,
    /// Age of the tracker's newest pose since it was sent.
    pose_age: Option<Age>,
    pub(super) nodes: BTreeMap<String, Value>,
    pub(super) latencies_ms: VecDeque<f64>,
    pub(super) lost: Option<String>,
}

pub(super) fn number(of: &Value, key: &str) -> f64 {
    of[key].as_f64().unwrap_or_default()
}

pub(super) fn text<'v>(of: &'v Value, key: &str) -> &'v str {
    of[key].as_str().unwrap_or_default()
}

/// True if a pose of the tracker is that of a scan; between scans it counts odometry.
pub(super) fn is_from_scan(pose: &Value) -> bool {
    pose["from_scan"] == true
}

impl Known {
    pub(super) fn receive(&mut self, message: Value, now: Instant) {
        let age = |key: &str| Some(Age::of(number(&message, key) / 1e3, now));
        self.lost = None;
        match text(&message, "type") {
            "snapshot" => {
                let part = |key: &str| Some(message[key].clone()).filter(|part| !part.is_null());
                self.robot = text(&message, "robot").to_owned();
                (self.map, self.answer, self.pose) = (part("map"), part("answer"), part("pose"));
                let age = |key: &str| Some(Age::of(message["ages"][key].as_f64()?, now));
                (self.scan_age, self.pose_age) = (age("scan_s"), age("pose_s"));
                let nodes = message["nodes"].as_array().into_iter().flatten().cloned();
                self.nodes = nodes.map(named).collect();
            }
            "answer" => {
                self.scan_age = age("age_ms");
                if self.pose.is_none() {
                    self.took(number(&message, "latency_ms"));
                }
                self.answer = Some(message);
            }
            "pose" => {
                if is_from_scan(&message) {
                    self.scan_age = age("age_ms");
                    self.took(number(&message, "latency_ms"));
                }
                self.pose_age = age("sent_age_ms");
                self.pose = Some(message);
            }
            "map" => self.map = Some(message),
            "node" => {
                let (name, node) = named(message);
                self.nodes.insert(name, node);
            }
            _ => {}
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
        let shown = self.pose.as_ref().or(self.answer.as_ref())?;
        let map = self.map.as_ref()?;
        let name = text(map, "name");
        (map["map_id"] == shown["map_id"] && !name.is_empty()).then_some(name)
    }

    fn took(&mut self, latency_ms: f64) {
        if self.latencies_ms.len() == LATENCIES {
            self.latencies_ms.pop_front();
        }
        self.latencies_ms.push_back(latency_ms);
    }
}

fn named(node: Value) -> (String, Value) {
    (text(&node, "name").to_owned(), node)
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
        assert_eq!(known.answer.unwrap()["counter"], 7);
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
