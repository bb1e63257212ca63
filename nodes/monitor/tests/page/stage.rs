//! A graph in any state that a test needs, with the monitor and a browser.

use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use bytemuck::Zeroable;
use messages::{
    Beam, BeamFate, BeamsHeader, HypothesesHeader, Hypothesis, NodeState, Pose2, PoseHeader, Stamp,
    TrackState, Verdict, topic,
};
use tests::drawn_map::DrawnMap;
use tests::http::Site;
use transport::testing::{Isolated, NodeProcess, StoppedAtEnd, wait_until_ready};
use transport::{Flow, Graph, GraphName, Publisher, TransportError, monotonic_ns, stamp_now};

/// Places that fit, as poses of the laser.
pub(crate) const PLACES: [Pose2; 3] = [place(50.0), place(5.0), place(95.0)];

/// Distance of the base behind the laser, metres.
pub(crate) const BEHIND_M: f64 = 0.5;

const fn place(x: f64) -> Pose2 {
    let (y, yaw) = (5.0, 0.0);
    Pose2 { x, y, yaw }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scene {
    /// Several places fit, and there is no tracker.
    Ambiguous,
    Tracked(TrackState),
    /// No scans, because the laser cannot be reached.
    Silent,
}

pub(crate) struct Stage {
    _node: StoppedAtEnd,
    pub(crate) site: Site,
    scenes: Option<Sender<Scene>>,
    feed: Option<JoinHandle<()>>,
    pub(crate) graph: GraphName,
    _test: Graph,
    _isolated: Isolated,
}

impl Stage {
    pub(crate) fn new(test: &str) -> Self {
        let isolated = Isolated::new(test);
        let graph = isolated.join("test");
        let site = Site::free();
        let address = site.0.to_string();
        let arguments = ["--listen", &address, "--robot", "r7"];
        let node = NodeProcess::start(env!("CARGO_BIN_EXE_monitor"), &graph, arguments);
        wait_until_ready(&graph, "monitor");
        let (scenes, wanted) = channel();
        let name = isolated.name().clone();
        let feed = std::thread::spawn(move || feed(&name, &wanted));
        Stage {
            _node: node.into(),
            site,
            scenes: Some(scenes),
            feed: Some(feed),
            graph: isolated.name().clone(),
            _test: graph,
            _isolated: isolated,
        }
    }

    pub(crate) fn show(&self, scene: Scene) {
        self.scenes.as_ref().unwrap().send(scene).unwrap();
    }

    pub(crate) fn url(&self) -> String {
        format!("http://{}/", self.site.0)
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        drop(self.scenes.take());
        let fed = self.feed.take().map(JoinHandle::join);
        let has_ended_well = fed.is_some_and(|fed| fed.is_ok());
        assert!(has_ended_well || std::thread::panicking());
    }
}

/// Publishes the messages of a graph twenty times per second, until the stage is dropped.
fn feed(graph: &GraphName, wanted: &Receiver<Scene>) {
    let graph = Graph::join_named("lms_reader", graph).unwrap();
    let mut health = graph.health().unwrap();
    let source = Source::new(&graph);
    let (mut scene, mut counter) = (Scene::Silent, 0);
    let step = |_| {
        match wanted.try_recv() {
            Err(TryRecvError::Empty) => {}
            Err(TryRecvError::Disconnected) => return Ok(Flow::Stop),
            Ok(next) => {
                scene = next;
                if scene == Scene::Silent {
                    health.error("cannot connect to 192.168.0.1:2112")?;
                    health.state(NodeState::Degraded)?;
                } else {
                    health.state(NodeState::Ready)?;
                }
            }
        }
        counter += 1;
        source.play(scene, counter)?;
        health.tick()?;
        Ok::<_, TransportError>(Flow::Continue)
    };
    graph.run(&[], Duration::from_millis(50), step).unwrap();
}

struct Source {
    map_id: u64,
    _map: Publisher<topic::Map>,
    hypotheses: Publisher<topic::Hypotheses>,
    poses: Publisher<topic::Tracked>,
    beams: Publisher<topic::Beams>,
}

impl Source {
    /// Publishes the map of a corridor of 100 by 10 metres.
    fn new(graph: &Graph) -> Self {
        let is_free = |i: usize| (1..999).contains(&(i % 1000)) && (1..99).contains(&(i / 1000));
        let cells = (0..100_000).map(|i| if is_free(i) { 0 } else { 100 });
        let drawn = DrawnMap::new(1000, 0.1, cells.collect());
        let map = graph.publisher::<topic::Map>().unwrap();
        drawn.send(&map);
        Source {
            map_id: drawn.header.map_id,
            _map: map,
            hypotheses: graph.publisher().unwrap(),
            poses: graph.publisher().unwrap(),
            beams: graph.publisher().unwrap(),
        }
    }

    fn play(&self, scene: Scene, counter: u64) -> Result<(), TransportError> {
        let stamp = stamp_now(
            1_600_000_000_000_000_000 + i64::try_from(counter).unwrap() * 50_000_000,
            counter,
        );
        match scene {
            Scene::Silent => return Ok(()),
            Scene::Ambiguous => self.answer(stamp, Verdict::Ambiguous)?,
            Scene::Tracked(state) => {
                self.answer(stamp, Verdict::Unique)?;
                self.track(stamp, state)?;
            }
        }
        self.reflect(stamp)
    }

    fn answer(&self, stamp: Stamp, verdict: Verdict) -> Result<(), TransportError> {
        let is_unique = verdict == Verdict::Unique;
        let header = HypothesesHeader {
            stamp,
            map_id: self.map_id,
            sent_ns: monotonic_ns(),
            verdict: verdict as u32,
            alternatives: if is_unique { 0 } else { 2 },
            mount_known: 1,
            ..HypothesesHeader::zeroed()
        };
        let probabilities = match is_unique {
            true => [0.98, 0.005, 0.005],
            false => [0.5, 0.3, 0.15],
        };
        let place = |i: usize| Hypothesis {
            map_from_laser: PLACES[i],
            map_from_base: behind(PLACES[i]),
            covariance: COVARIANCE,
            score: 0.9,
            probability: probabilities[i],
            ..Hypothesis::zeroed()
        };
        self.hypotheses.send(header, &[0, 1, 2].map(place))
    }

    fn track(&self, stamp: Stamp, state: TrackState) -> Result<(), TransportError> {
        let words: &[u8] = match state {
            TrackState::Unique => b"one place, fit 0.90, since 3 m",
            _ => b"only fit 0.14: drive a few metres, or mark a region",
        };
        let header = PoseHeader {
            stamp,
            map_id: self.map_id,
            sent_ns: monotonic_ns(),
            map_from_laser: PLACES[0],
            map_from_base: behind(PLACES[0]),
            laser_covariance: COVARIANCE,
            base_covariance: COVARIANCE,
            probability: 0.87,
            state: state as u32,
            places: 3,
            from_scan: 1,
            pose_known: 1,
            mount_known: 1,
            ..PoseHeader::zeroed()
        };
        self.poses.send(header, words)
    }

    /// Publishes the beams of two walls, four metres away.
    fn reflect(&self, stamp: Stamp) -> Result<(), TransportError> {
        let bearings = [std::f32::consts::FRAC_PI_2, -std::f32::consts::FRAC_PI_2];
        let header = BeamsHeader {
            stamp,
            map_id: self.map_id,
            map_from_laser: PLACES[0],
        };
        let beam = |bearing| Beam {
            bearing,
            range_m: 4.0,
            weight: 1.0,
            fate: BeamFate::Hit as u32,
        };
        self.beams.send(header, &bearings.map(beam))
    }
}

/// Deviations of 2 cm along either axis, and 0.01 radians.
const COVARIANCE: [f64; 9] = [4e-4, 0.0, 0.0, 0.0, 4e-4, 0.0, 0.0, 0.0, 1e-4];

fn behind(laser: Pose2) -> Pose2 {
    Pose2 {
        x: laser.x - BEHIND_M,
        ..laser
    }
}
