//! One robot: what is known of it, and whoever watches it.
//!
//! It stands between the thread of a source, which passes it messages, and
//! the server, which asks. Both hold the lock for as long as it takes to copy.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use axum::body::Bytes;
use axum::extract::ws::Utf8Bytes;
use messages::{
    Beam, BeamsHeader, FieldHeader, HealthHeader, HypothesesHeader, Hypothesis, LogHeader,
    MapHeader, PoseHeader,
};
use tokio::sync::{broadcast, watch};
use transport::wall_ns;

use crate::view::{
    Abilities, Answer, Beams, History, Log, LogLine, Map, Message, Region, Roster, Snapshot,
    StateChange, Times, Track, Tracked, field_frame,
};
use crate::webhook::Webhook;

/// Messages that may wait for a slow reader; beyond, it loses the oldest.
const QUEUE: usize = 64;

/// Requests that may wait for the graph.
const MAX_REQUESTS: usize = 8;

/// What somebody with the token wants of the graph.
#[derive(Debug, Clone, PartialEq)]
pub enum Request {
    /// Poses be searched between these corners; everywhere where there are none.
    Region(Vec<[f64; 2]>),
    /// A black box be saved.
    Save,
}

/// A robot that can be watched.
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
    /// None if there is no tracker.
    pose: Option<Tracked>,
    times: Times,
    history: History,
    beams: Option<Beams>,
    roster: Roster,
    track: Track,
    log: Log,
    region: Vec<[f64; 2]>,
    abilities: Abilities,
}

/// Somebody who watches: all that is known, and what comes after it.
pub(crate) struct Watching {
    pub(crate) snapshot: Utf8Bytes,
    pub(crate) news: broadcast::Receiver<Utf8Bytes>,
}

/// A look at the field, which is computed as long as there is one.
pub(crate) struct FieldView {
    robot: Arc<Robot>,
    pub(crate) images: watch::Receiver<Option<Bytes>>,
}

/// Calls of a source.
impl Robot {
    /// A robot of which nothing is known yet, and the requests for it. The name stands in
    /// addresses.
    #[must_use]
    pub fn new(name: String) -> (Arc<Self>, Receiver<Request>) {
        Self::in_graph(name, None)
    }

    /// The same, and the name of its graph, if that is known.
    #[must_use]
    pub fn in_graph(name: String, graph: Option<String>) -> (Arc<Self>, Receiver<Request>) {
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

    /// Takes a map; returns whether it could be used.
    pub fn on_map(&self, header: &MapHeader, cells: &[u8]) -> bool {
        let Some(map) = Map::new(header, cells) else {
            return false;
        };
        let mut known = self.known();
        self.broadcast(&Message::Map(&map.info));
        known.map = Some(Arc::new(map));
        true
    }

    /// Takes the answer to a scan, at a time of the host's clock.
    pub fn on_answer(&self, header: &HypothesesHeader, items: &[Hypothesis], now_ns: i64) {
        let answer = Answer::new(header, items, now_ns);
        let mut known = self.known();
        self.broadcast(&Message::Answer(&answer));
        known.times.on_answer(header);
        known.track.on_answer(&answer);
        if known.pose.is_none() && known.history.on_answer(&answer, now_ns) {
            self.broadcast_state(&known, now_ns);
        }
        known.answer = Some(answer);
    }

    /// Takes where the tracker has the robot, at a time of the host's clock.
    pub fn on_pose(&self, header: &PoseHeader, words: &[u8], now_ns: i64) {
        let pose = Tracked::new(header, words, now_ns);
        let mut known = self.known();
        self.broadcast(&Message::Pose(&pose));
        known.times.on_pose(header);
        known.track.on_pose(&pose);
        if known.history.on_pose(&pose, now_ns) {
            self.broadcast_state(&known, now_ns);
        }
        known.pose = Some(pose);
    }

    /// Takes what became of the beams of a scan.
    pub fn on_beams(&self, header: &BeamsHeader, items: &[Beam]) {
        let beams = Beams::new(header, items);
        let mut known = self.known();
        self.broadcast(&Message::Beams(&beams));
        known.beams = Some(beams);
    }

    /// Takes a report on a node; returns whether there was room for it.
    pub fn on_health(&self, header: &HealthHeader, error: &[u8]) -> bool {
        let mut known = self.known();
        let report = known.roster.receive(header, error);
        report
            .inspect(|report| self.broadcast(&Message::Node(report)))
            .is_some()
    }

    /// Takes a line of a node's log.
    pub fn on_log(&self, header: &LogHeader, text: &[u8]) {
        let line = LogLine::new(header, text);
        let mut known = self.known();
        self.broadcast(&Message::Log(&line));
        known.log.receive(line);
    }

    /// Takes an intensity image; returns whether it could be used.
    pub fn on_field(&self, header: &FieldHeader, items: &[u16]) -> bool {
        let frame = field_frame(header, items);
        let is_sound = frame.is_some();
        if let Some(frame) = frame {
            self.field.send_replace(Some(frame.into()));
        }
        is_sound
    }

    /// Takes the region in which poses are searched from now on.
    pub fn on_region(&self, corners: Vec<[f64; 2]>) {
        let mut known = self.known();
        self.broadcast(&Message::Region(Region { corners: &corners }));
        known.region = corners;
    }

    /// Takes who listens to requests.
    pub fn on_abilities(&self, abilities: Abilities) {
        let mut known = self.known();
        if known.abilities != abilities {
            known.abilities = abilities;
            self.broadcast(&Message::Abilities(abilities));
        }
    }

    /// Looks whether scans still come, and for nodes that have become silent.
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

    /// Whether anybody looks at the field.
    #[must_use]
    pub fn is_field_viewed(&self) -> bool {
        self.field_viewers.load(Ordering::Relaxed) > 0
    }

    fn broadcast_state(&self, known: &Known, now_ns: i64) {
        let Some(period) = known.history.newest(now_ns) else {
            return;
        };
        if let Some(webhook) = self.webhook.get() {
            let before = known.history.before(now_ns);
            webhook.post(json::object(&StateChange {
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

    /// Puts it into words once for all who watch, if there are any. The lock is
    /// held meanwhile, so that a new viewer misses nothing and receives nothing twice.
    fn broadcast(&self, message: &Message<'_>) {
        if self.news.receiver_count() > 0 {
            // Nobody may be left by now.
            let _ = self.news.send(text(message));
        }
    }
}

/// What the server asks.
impl Robot {
    /// States are posted there from now on.
    pub(crate) fn post_states_to(&self, webhook: &Webhook) {
        // One that it has already is the same.
        let _ = self.webhook.set(webhook.clone());
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// All that is known at a time of the host's clock, and all that comes from then on.
    pub(crate) fn watch(&self, now_ns: i64) -> Watching {
        let known = self.known();
        Watching {
            news: self.news.subscribe(),
            snapshot: self.snapshot_of(&known, now_ns),
        }
    }

    /// All that is known at a time of the host's clock.
    pub(crate) fn snapshot(&self, now_ns: i64) -> Utf8Bytes {
        self.snapshot_of(&self.known(), now_ns)
    }

    /// The map, if there is one.
    pub(crate) fn map(&self) -> Option<Arc<Map>> {
        self.known().map.clone()
    }

    pub(crate) fn abilities(&self) -> Abilities {
        self.known().abilities
    }

    /// Hands a request to the source; returns whether it has room for one.
    pub(crate) fn request(&self, request: Request) -> bool {
        self.requests.try_send(request).is_ok()
    }

    /// Looks at the field from now on.
    pub(crate) fn view_field(self: &Arc<Self>) -> FieldView {
        self.field_viewers.fetch_add(1, Ordering::Relaxed);
        let mut images = self.field.subscribe();
        // An image from before may be of another place.
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
            log: known.log.lines().collect(),
            region: &known.region,
            abilities: known.abilities,
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

/// A message as JSON.
pub(crate) fn text(message: &Message<'_>) -> Utf8Bytes {
    json::object(message).into()
}

#[cfg(test)]
mod tests;
