//! Drawn maps and the node's neighbours: publishers of maps, scans and odometry, and a searcher.

use std::cell::Cell;
use std::f64::consts::PI;
use std::time::Duration;

use bytemuck::Zeroable;
use engine::beams::BeamConfig;
use engine::fit::FitConfig;
use engine::joined::JoinConfig;
use engine::settings::{fit_id, reading_id};
use geometry::{Covariance, Pose};
use messages::{
    FrameName, HypothesesHeader, Hypothesis, InitialPose, InitialPoseKind, MapName, MapSet,
    Odometry, PoseHeader, ScanHeader, Stamp, searched_id, topic,
};
use tests::drawn_map::DrawnMap;
use tests::drawn_room::{self, FRAME, occupancy};
use transport::testing::{Isolated, NodeProcess, wait_until_ready};
use transport::{Flow, Graph, Publisher, Subscriber, TransportError, stamp_now};

/// A hall in which no two places look alike.
pub(crate) const HALL: [&str; 14] = [
    "########################################",
    "#......................................#",
    "##.....##...........................#..#",
    "#.......#..............................#",
    "#...................####...............#",
    "#...................#..#...............#",
    "##..................####..............##",
    "#......................................#",
    "#......................................#",
    "#......................................#",
    "##............................##.......#",
    "#......###.....................#......##",
    "#......................................#",
    "########################################",
];
const CELL_M: f64 = FRAME.resolution_m;
/// Row along which the robot drives, counted from below.
const ROW: usize = 6;

/// Makes the map of a drawing; without a name, it is served alone.
pub(crate) fn drawn(name: &str, rows: &[&str]) -> DrawnMap {
    let mut map = DrawnMap::new(rows[0].len() as u32, CELL_M, occupancy(rows));
    map.header.name = MapName::new(name);
    map.header.map_id = map.header.id_of(&map.cells);
    map
}

pub(crate) fn with_a_box() -> [&'static str; 14] {
    let mut rows = HALL;
    rows[1] = "#....................................###";
    rows
}

pub(crate) fn ids(maps: &[DrawnMap]) -> Vec<u64> {
    maps.iter().map(|map| map.header.map_id).collect()
}

pub(crate) fn searched(maps: &[DrawnMap]) -> u64 {
    searched_id(ids(maps))
}

pub(crate) struct Step {
    pub(crate) pose: PoseHeader,
    /// Poses before it that were extrapolated by odometry.
    pub(crate) carried: Vec<PoseHeader>,
    /// True if a search of the scan was requested.
    pub(crate) was_asked: bool,
}

pub(crate) struct World {
    sets: Option<Publisher<topic::Maps>>,
    maps: Publisher<topic::Map>,
    scans: Publisher<topic::Scan>,
    odometry: Publisher<topic::OdometryTopic>,
    hypotheses: Publisher<topic::Hypotheses>,
    initial_poses: Publisher<topic::InitialPoseTopic>,
    poses: Subscriber<topic::Tracked>,
    requests: Subscriber<topic::Attention>,
    counter: Cell<u64>,
    graph: Graph,
}

impl World {
    fn new(isolated: &Isolated, is_set: bool) -> Self {
        let graph = isolated.join("test");
        World {
            sets: is_set.then(|| graph.publisher().unwrap()),
            maps: graph.publisher().unwrap(),
            scans: graph.publisher().unwrap(),
            odometry: graph.publisher().unwrap(),
            hypotheses: graph.publisher().unwrap(),
            initial_poses: graph.publisher().unwrap(),
            poses: graph.subscriber().unwrap(),
            requests: graph.subscriber().unwrap(),
            counter: Cell::new(1),
            graph,
        }
    }

    pub(crate) fn of_map(isolated: &Isolated, map: &DrawnMap) -> Self {
        let world = World::new(isolated, false);
        world.serve_map(map);
        world
    }

    /// Creates a world with a set whose first map is displayed.
    pub(crate) fn of_set(isolated: &Isolated, maps: &[DrawnMap]) -> Self {
        let world = World::new(isolated, true);
        world.serve_set(maps);
        world.serve_map(&maps[0]);
        world
    }

    pub(crate) fn serve_map(&self, map: &DrawnMap) {
        map.send(&self.maps);
    }

    pub(crate) fn serve_set(&self, maps: &[DrawnMap]) {
        let maps = maps.iter().map(|map| (map.header, &map.cells[..]));
        let set = MapSet {
            maps: maps.collect(),
            transitions: Vec::new(),
        };
        let mut loan = self.sets.as_ref().unwrap().loan(set.bytes()).unwrap();
        let header = set.write(Stamp::default(), loan.items_mut());
        *loan.header_mut() = header;
        loan.send().unwrap();
    }

    pub(crate) fn start(&self, arguments: &[&str]) -> NodeProcess {
        let node = NodeProcess::start(env!("CARGO_BIN_EXE_tracker"), &self.graph, arguments);
        wait_until_ready(&self.graph, "tracker");
        node
    }

    pub(crate) fn pose_at(&self, x: usize) -> Pose {
        let metres = |cell: usize| CELL_M * (cell as f64 + 0.5);
        Pose::new(metres(x), metres(ROW), 0.0)
    }

    pub(crate) fn say(&self, kind: InitialPoseKind, x: usize) {
        let header = InitialPose {
            kind: kind as u64,
            map_from_base: self.pose_at(x).into(),
            covariance: Covariance::from_deviations(0.1, 0.1, 0.05).to_rows(),
            ..InitialPose::zeroed()
        };
        self.initial_poses.send(header, &[]).unwrap();
    }

    /// Returns a stamp this long after the last scan; the next scan is a second later.
    fn stamp(&self, later_ns: i64) -> Stamp {
        stamp_now(
            1_000_000_000 * self.counter.get() as i64 + later_ns,
            self.counter.get(),
        )
    }

    /// Publishes odometry with the robot in this column, this long after the last scan.
    pub(crate) fn send_odometry(&self, x: usize, later_ns: i64) {
        let header = Odometry {
            stamp: self.stamp(later_ns),
            odom_from_child: self.pose_at(x).into(),
            frame: FrameName::new("odom"),
            child_frame: FrameName::new("base_link"),
            ..Odometry::zeroed()
        };
        self.odometry.send(header, &[]).unwrap();
    }

    fn send_scan(&self, x: usize) -> Stamp {
        let ranges = drawn_room::ranges(&HALL, x as i64, ROW as i64, 0);
        let stamp = self.stamp(0);
        let header = ScanHeader {
            stamp,
            angle_min: -PI,
            angle_increment: 1f64.to_radians(),
            range_max_m: 30.0,
            frame: FrameName::new("laser"),
            ..ScanHeader::zeroed()
        };
        self.scans.send(header, &ranges).unwrap();
        stamp
    }

    /// Publishes odometry and the scan in a column; a search gets id `searched` and this place.
    pub(crate) fn step(&self, x: usize, searched: u64, found_on: Option<u64>) -> Step {
        self.counter.set(self.counter.get() + 1);
        self.send_odometry(x, 0);
        let scan = self.send_scan(x);
        let (mut pose, mut carried, mut was_asked) = (None, Vec::new(), false);
        let inputs: [&dyn transport::Input; 2] = [&self.poses, &self.requests];
        let done = self.graph.run(&inputs, Duration::from_millis(20), |_| {
            while let Some(request) = self.requests.receive()? {
                if request.header().stamp == scan {
                    was_asked = true;
                    self.answer(scan, searched, found_on.map(|map_id| (x, map_id)))?;
                }
            }
            while let Some(sample) = self.poses.receive()? {
                let header = *sample.header();
                match header.from_scan == 1 && header.stamp == scan {
                    true => pose = Some(header),
                    false => carried.push(header),
                }
            }
            Ok::<_, TransportError>(match pose {
                Some(_) => Flow::Stop,
                None => Flow::Continue,
            })
        });
        done.unwrap();
        Step {
            pose: pose.unwrap(),
            carried,
            was_asked,
        }
    }

    /// Takes a step in each column; returns true if the last pose is Unique.
    pub(crate) fn is_found(&self, xs: &[usize], searched: u64, found_on: Option<u64>) -> bool {
        let step = |&x| self.step(x, searched, found_on).pose.is_unique();
        xs.iter().fold(false, |_, x| step(x))
    }

    fn answer(
        &self,
        stamp: Stamp,
        searched: u64,
        found: Option<(usize, u64)>,
    ) -> Result<(), TransportError> {
        let found = found.map(|(x, map_id)| Hypothesis {
            map_from_laser: self.pose_at(x).into(),
            map_from_base: self.pose_at(x).into(),
            covariance: Covariance::from_deviations(0.1, 0.1, 0.02).to_rows(),
            intensity: 100,
            map_id,
            ..Hypothesis::zeroed()
        });
        let header = HypothesesHeader {
            stamp,
            searched,
            map_id: found.map_or(0, |found| found.map_id),
            settings: fit_id(
                reading_id(&JoinConfig::default(), &BeamConfig::default()),
                &FitConfig::default(),
            ),
            ..HypothesesHeader::zeroed()
        };
        self.hypotheses.send(header, found.as_slice())
    }
}
