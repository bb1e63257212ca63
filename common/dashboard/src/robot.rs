//! State of one robot, and its viewers: a source and the server hold the lock only while they copy.

use std::collections::{BTreeMap, VecDeque};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use axum::body::Bytes;
use axum::extract::ws::Utf8Bytes;
use geometry::Covariance;
use messages::{
    Beam, BeamsHeader, FieldHeader, HealthHeader, HypothesesHeader, Hypothesis, InitialPose,
    InitialPoseKind, LogHeader, MapHeader, Pose2, PoseHeader, ScanHeader, Stamp,
};
use tokio::sync::{broadcast, watch};
use transport::wall_ns;

use crate::view::{
    Abilities, Answer, Beams, History, LogLine, MAX_LINES, Map, Message, Recording, Region, Roster,
    Scan, Snapshot, StateChange, Times, Track, Tracked, field_frame, push_within,
};
use crate::webhook::Webhook;

/// Queue of messages per viewer; a slow viewer loses the oldest.
const QUEUE: usize = 64;

/// Minimum time between two scans of a laser that are sent.
const SCAN_NS: i64 = 95_000_000;

/// Limit of requests that wait for the graph.
const MAX_REQUESTS: usize = 8;

/// Request of a user with the token.
#[derive(Debug, Clone, PartialEq)]
pub enum Request {
    /// Search only between these corners; an empty list searches the whole map.
    Region(Vec<[f64; 2]>),
    Save,
    /// The robot is probably at this pose in the map.
    Hint(Pose2),
    Restart(String),
    Record(bool),
}

/// Standard deviations of a hint: a user points at a map that is some pixels per metre.
const HINT_M: f64 = 0.5;
const HINT_YAW: f64 = 0.26;

pub fn hint(map_from_base: Pose2, stamp: Stamp) -> InitialPose {
    InitialPose {
        stamp,
        kind: InitialPoseKind::Hint as u64,
        map_from_base,
        covariance: Covariance::from_deviations(HINT_M, HINT_M, HINT_YAW).to_rows(),
    }
}

#[derive(Debug)]
pub struct Robot {
    name: String,
    graph: Option<String>,
    known: Mutex<Known>,
    news: broadcast::Sender<Utf8Bytes>,
    webhook: OnceLock<Webhook>,
    field: watch::Sender<Option<Bytes>>,
    field_viewers: AtomicUsize,
    requests: SyncSender<Request>,
}

#[derive(Debug, Default)]
struct Known {
    map: Option<Arc<Map>>,
    answer: Option<Answer>,
    /// `None` without a tracker.
    pose: Option<Tracked>,
    times: Times,
    /// When a scan was last sent, for each laser.
    scans_sent: BTreeMap<String, i64>,
    history: History,
    beams: Option<Beams>,
    roster: Roster,
    track: Track,
    log: VecDeque<LogLine>,
    region: Vec<[f64; 2]>,
    abilities: Abilities,
    recording: Option<Recording>,
}

impl Known {
    /// Returns the name of the map that is shown, if it is this one of several.
    fn name_of(&self, map_id: u64) -> Option<String> {
        let map = &self.map.as_ref()?.info;
        let is_named = !map.name.is_empty() && map.map_id == answers::map_id(map_id);
        is_named.then(|| map.name.clone())
    }
}

/// A new viewer's snapshot, and the messages that follow it.
pub(crate) struct Watching {
    pub(crate) snapshot: Utf8Bytes,
    pub(crate) news: broadcast::Receiver<Utf8Bytes>,
}

/// A viewer of the intensity field, which is computed only while there is one.
pub(crate) struct FieldView {
    robot: Arc<Robot>,
    pub(crate) images: watch::Receiver<Option<Bytes>>,
}

impl Robot {
    /// Returns a robot without data, and the receiver of its requests. The name is part of URLs;
    /// that of the graph is not known on another machine.
    pub fn new(name: String, graph: Option<String>) -> (Arc<Self>, Receiver<Request>) {
        let (requests, requested) = sync_channel(MAX_REQUESTS);
        let robot = Robot {
            name,
            graph,
            known: Mutex::default(),
            news: broadcast::Sender::new(QUEUE),
            webhook: OnceLock::new(),
            field: watch::Sender::new(None),
            field_viewers: AtomicUsize::new(0),
            requests,
        };
        (Arc::new(robot), requested)
    }

    /// Stores and sends a map; false if it is not valid.
    pub fn on_map(&self, header: &MapHeader, cells: &[u8]) -> bool {
        let Some(map) = Map::new(header, cells) else {
            return false;
        };
        let mut known = self.known();
        self.broadcast(&Message::Map(&map.info));
        known.map = Some(Arc::new(map));
        true
    }

    /// Stores and sends the result of a scan. `now_ns`: monotonic clock of the host.
    pub fn on_answer(&self, header: &HypothesesHeader, items: &[Hypothesis], now_ns: i64) {
        let mut known = self.known();
        let answer = Answer::new(header, items, &|map_id| known.name_of(map_id), now_ns);
        self.broadcast(&Message::Answer(&answer));
        known.times.on_answer(header);
        known.track.on_answer(&answer);
        if known.pose.is_none() && known.history.on_answer(&answer, now_ns) {
            self.broadcast_state(&known, now_ns);
        }
        known.answer = Some(answer);
    }

    /// Stores and sends the tracker's pose. `now_ns`: monotonic clock of the host.
    pub fn on_pose(&self, header: &PoseHeader, words: &[u8], now_ns: i64) {
        let mut known = self.known();
        let pose = Tracked::new(header, words, &|map_id| known.name_of(map_id), now_ns);
        self.broadcast(&Message::Pose(&pose));
        known.times.on_pose(header);
        known.track.on_pose(&pose);
        if known.history.on_pose(&pose, now_ns) {
            self.broadcast_state(&known, now_ns);
        }
        known.pose = Some(pose);
    }

    pub fn on_beams(&self, header: &BeamsHeader, items: &[Beam]) {
        let beams = Beams::new(header, items);
        let mut known = self.known();
        self.broadcast(&Message::Beams(&beams));
        known.beams = Some(beams);
    }

    /// Sends the end points of a scan to the viewers, if there are any, at a limited rate.
    pub fn on_scan(&self, header: &ScanHeader, ranges: &[f32], now_ns: i64) {
        if self.news.receiver_count() == 0 {
            return;
        }
        let mut known = self.known();
        let sent_ns = known.scans_sent.get(header.laser.as_str());
        if sent_ns.is_some_and(|sent_ns| now_ns.saturating_sub(*sent_ns) < SCAN_NS) {
            return;
        }
        known
            .scans_sent
            .insert(header.laser.as_str().to_owned(), now_ns);
        self.broadcast(&Message::Scan(&Scan::new(header, ranges)));
    }

    /// Stores and sends a node's health report; false if there are too many nodes.
    pub fn on_health(&self, header: &HealthHeader, error: &[u8]) -> bool {
        let mut known = self.known();
        let report = known.roster.receive(header, error);
        report
            .inspect(|report| self.broadcast(&Message::Node(report)))
            .is_some()
    }

    pub fn on_log(&self, header: &LogHeader, text: &[u8]) {
        let line = LogLine::new(header, text);
        let mut known = self.known();
        self.broadcast(&Message::Log(&line));
        push_within(MAX_LINES, &mut known.log, line);
    }

    /// Sends an intensity image to viewers of the field; false if it is not valid.
    pub fn on_field(&self, header: &FieldHeader, items: &[u16]) -> bool {
        let frame = field_frame(header, items);
        frame
            .map(|frame| self.field.send_replace(Some(frame.into())))
            .is_some()
    }

    pub fn on_region(&self, corners: Vec<[f64; 2]>) {
        let mut known = self.known();
        self.broadcast(&Message::Region(Region { corners: &corners }));
        known.region = corners;
    }

    pub fn on_abilities(&self, abilities: Abilities) {
        let mut known = self.known();
        if known.abilities != abilities {
            known.abilities = abilities;
            self.broadcast(&Message::Abilities(abilities));
        }
    }

    /// Stores and sends what is recorded, or why nothing can be.
    pub fn on_recording(&self, recording: Recording) {
        let mut known = self.known();
        if known.recording.as_ref() != Some(&recording) {
            self.broadcast(&Message::Recording(&recording));
            known.recording = Some(recording);
        }
    }

    /// Reports nodes that have become silent, and the state `NoData` if scans stay away.
    pub fn look_for_silence(&self, now_ns: i64) {
        let mut known = self.known();
        for report in known.roster.newly_silent(now_ns) {
            self.broadcast(&Message::Node(report));
        }
        let newest_ns = known.times.newest_ns();
        if known.history.look_for_silence(newest_ns, now_ns) {
            self.broadcast_state(&known, now_ns);
        }
    }

    /// True if a viewer has the intensity field open.
    pub fn is_field_viewed(&self) -> bool {
        self.field_viewers.load(Ordering::Relaxed) > 0
    }

    fn broadcast_state(&self, known: &Known, now_ns: i64) {
        let mut periods = known.history.periods(now_ns).rev();
        let Some(period) = periods.next() else {
            return;
        };
        if let Some(webhook) = self.webhook.get() {
            let before = periods.next();
            webhook.post(command_line::json::object(&StateChange {
                robot: &self.name,
                graph: self.graph.as_deref(),
                since_s: wall_ns() as f64 / 1e9 - period.ago_s,
                before: before.as_ref().map(|before| before.state),
                before_pose: before.and_then(|before| before.last),
                period: period.clone(),
            }));
        }
        self.broadcast(&Message::State(period));
    }

    /// Serializes the message once for all viewers, if there are any. The caller holds the lock, so
    /// that a new viewer misses nothing and receives nothing twice.
    fn broadcast(&self, message: &Message<'_>) {
        if self.news.receiver_count() > 0 {
            // The last viewer may have left by now.
            let _ = self.news.send(text(message));
        }
    }
}

impl Robot {
    /// Posts every following state change to the webhook.
    pub(crate) fn post_states_to(&self, webhook: &Webhook) {
        // There is one webhook per server: if set, it is the same.
        let _ = self.webhook.set(webhook.clone());
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    /// Snapshot at `now_ns`, and a subscription to all that follows.
    pub(crate) fn watch(&self, now_ns: i64) -> Watching {
        let known = self.known();
        Watching {
            news: self.news.subscribe(),
            snapshot: self.snapshot_of(&known, now_ns),
        }
    }

    pub(crate) fn snapshot(&self, now_ns: i64) -> Utf8Bytes {
        self.snapshot_of(&self.known(), now_ns)
    }

    pub(crate) fn map(&self) -> Option<Arc<Map>> {
        self.known().map.clone()
    }

    /// True if a node of this name has reported.
    pub(crate) fn has_node(&self, name: &str) -> bool {
        let known = self.known();
        known.roster.reports().any(|report| report.name == name)
    }

    pub(crate) fn abilities(&self) -> Abilities {
        self.known().abilities
    }

    pub(crate) fn recording(&self) -> Option<Recording> {
        self.known().recording.clone()
    }

    /// Queues a request for the source; false if the queue is full.
    pub(crate) fn request(&self, request: Request) -> bool {
        self.requests.try_send(request).is_ok()
    }

    pub(crate) fn view_field(self: &Arc<Self>) -> FieldView {
        self.field_viewers.fetch_add(1, Ordering::Relaxed);
        let mut images = self.field.subscribe();
        // An earlier image may show another place.
        images.mark_unchanged();
        FieldView {
            robot: Arc::clone(self),
            images,
        }
    }

    fn snapshot_of(&self, known: &Known, now_ns: i64) -> Utf8Bytes {
        text(&Message::Snapshot(Snapshot {
            robot: &self.name,
            graph: self.graph.as_deref(),
            map: known.map.as_ref().map(|map| &map.info),
            answer: known.answer.as_ref(),
            pose: known.pose.as_ref(),
            ages: known.times.ages(now_ns),
            states: known.history.periods(now_ns).collect(),
            beams: known.beams.as_ref(),
            nodes: known.roster.reports().collect(),
            track: known.track.points().collect(),
            log: known.log.iter().collect(),
            region: &known.region,
            abilities: known.abilities,
            recording: known.recording.as_ref(),
        }))
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for FieldView {
    fn drop(&mut self) {
        self.robot.field_viewers.fetch_sub(1, Ordering::Relaxed);
    }
}

pub(crate) fn text(message: &Message<'_>) -> Utf8Bytes {
    command_line::json::object(message).into()
}

#[cfg(test)]
mod tests;
