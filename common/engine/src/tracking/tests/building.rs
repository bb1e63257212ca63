//! Drawn buildings, and a robot that drives in them.

use super::*;

const BEAMS: usize = 180;

/// A building in which scans are simulated and searched.
pub(super) struct Building {
    grid: Grid,
    localizer: Localizer,
}

/// Makes a building. Its walls must be ragged, so that its map does not count as drawn.
fn building(rows: &[&str]) -> Building {
    let (width, height, cells) = crate::grid::drawn::occupancy(rows);
    let map = Map::new(RESOLUTION_M, Pose::IDENTITY, (width, height), &cells);
    let settings = Settings {
        vote_search: VoteSearchConfig {
            search_cell: 0.0,
            ..VoteSearchConfig::default()
        },
        ..Settings::default()
    };
    Building {
        grid: Grid::new(width, height, &cells, map.rules).unwrap(),
        localizer: Localizer::new(map, settings).unwrap(),
    }
}

fn scan(ranges: &[f32]) -> Scan<'_> {
    scan_from(-PI, 2.0 * PI / BEAMS as f64, ranges)
}

impl Building {
    /// Ranges of a laser at a pose, all around, to a centimetre.
    pub(super) fn ranges(&self, pose: Pose) -> Vec<f32> {
        let read = |beam: usize| {
            let bearing = -PI + 2.0 * PI * beam as f64 / BEAMS as f64;
            let (sin, cos) = (pose.yaw + bearing).sin_cos();
            let is_wall = |range: &f64| {
                let (x, y) = (pose.x + range * cos, pose.y + range * sin);
                let (x, y) = (x / RESOLUTION_M, y / RESOLUTION_M);
                let i = y as usize * self.grid.width() + x as usize;
                self.grid.cells()[i] == crate::grid::Cell::Occupied
            };
            let mut ranges = (0..3000).map(|step| 0.01 * f64::from(step));
            ranges
                .find(is_wall)
                .map_or(f32::INFINITY, |range| range as f32)
        };
        (0..BEAMS).map(read).collect()
    }

    fn map(&self) -> &PreparedMap {
        &self.localizer.maps()[0]
    }

    pub(super) fn ends(&self, ranges: &[f32]) -> Ends {
        self.map().ends(&scan(ranges)).unwrap()
    }

    pub(super) fn found(&self, ranges: &[f32]) -> Vec<Candidate> {
        let mut workspace = Workspace::default();
        let answer = self.localizer.locate(&mut workspace, &scan(ranges));
        let target = Target::of(None, false);
        Candidate::of_places(answer.unwrap().places, target, target)
    }

    pub(super) fn seen<'a>(&'a self, ends: &'a Ends, fit: &'a FitConfig) -> Seen<'a> {
        Seen {
            distance_field: self.map().distance_field(),
            ends,
            fit,
        }
    }
}

/// A robot in a building with one or several maps, and its tracker.
pub(super) struct Robot {
    pub(super) maps: Vec<Building>,
    /// Number of the map on which the robot is.
    pub(super) map: usize,
    pub(super) pose: Pose,
    pub(super) tracker: PlaceTracker,
    pub(super) fit: FitConfig,
}

impl Robot {
    /// A robot at [`START`] on the first map; its tracker knows nothing.
    pub(super) fn on(maps: &[&[&str]]) -> Self {
        Robot {
            maps: maps.iter().map(|rows| building(rows)).collect(),
            map: 0,
            pose: START,
            tracker: PlaceTracker::new(TrackingConfig::default()),
            fit: FitConfig::default(),
        }
    }

    /// A robot that its tracker found and followed for some steps.
    pub(super) fn tracked(rows: &[&str], steps: usize) -> Self {
        let mut robot = Robot::on(&[rows]);
        robot.scan(None);
        robot.drive(steps);
        robot
    }

    /// A robot in [`UNLIKE`] that its tracker followed from a trusted pose for some steps.
    pub(super) fn followed(steps: usize) -> Self {
        let mut robot = Robot::on(&[&UNLIKE]);
        robot.start();
        robot.drive(steps);
        assert_eq!(robot.state(), Unique);
        robot
    }

    /// Starts the tracker at the true pose.
    pub(super) fn start(&mut self) {
        let ends = self.maps[0].ends(&self.ranges());
        let seen: Vec<_> = self
            .maps
            .iter()
            .map(|map| map.seen(&ends, &self.fit))
            .collect();
        let covariance = Covariance::from_deviations(0.1, 0.1, 0.1);
        self.tracker.start_at(&seen, (0, self.pose), covariance);
        self.scan(Some(Pose::IDENTITY));
    }

    /// Gives the tracker the scan at the pose, and what a search for it finds; returns the search
    /// that was needed.
    pub(super) fn scan(&mut self, moved: Option<Pose>) -> Need {
        self.see(&self.ranges(), moved, |need| need == Need::ThisScan)
    }

    /// Does the same without answers to searches.
    pub(super) fn scan_unanswered(&mut self, moved: Option<Pose>) -> Need {
        self.see(&self.ranges(), moved, |_| false)
    }

    /// Gives the tracker a scan and, if it is searched, what a search of all maps finds.
    pub(super) fn see(
        &mut self,
        ranges: &[f32],
        moved: Option<Pose>,
        is_searched: fn(Need) -> bool,
    ) -> Need {
        let ends = self.maps[0].ends(ranges);
        self.see_ends(&ends, moved, |maps, need| {
            let on_maps = (0..).zip(maps).flat_map(|(map, on)| {
                let found = on.found(ranges).into_iter();
                found.map(move |candidate| Candidate { map, ..candidate })
            });
            is_searched(need).then(|| on_maps.collect())
        })
    }

    /// Gives the tracker the ends of a scan, and what is found by the search that was needed, which
    /// is returned.
    pub(super) fn see_ends(
        &mut self,
        ends: &Ends,
        moved: Option<Pose>,
        find: impl FnOnce(&[Building], Need) -> Option<Vec<Candidate>>,
    ) -> Need {
        let seen: Vec<_> = self
            .maps
            .iter()
            .map(|map| map.seen(ends, &self.fit))
            .collect();
        let tracker = &mut self.tracker;
        let need = tracker.begin(&seen, 1, moved);
        tracker.finish(&seen, find(&self.maps, need).as_deref());
        need
    }

    /// Moves the robot by a step that odometry measures; returns the search that was needed.
    pub(super) fn step(&mut self, step: Pose) -> Need {
        self.pose = self.pose.then(step);
        self.scan(Some(step))
    }

    /// Drives straight on by steps of 0.3 m.
    pub(super) fn drive(&mut self, steps: usize) {
        for _ in 0..steps {
            self.step(AHEAD);
        }
    }

    /// Ranges of the laser at the pose.
    pub(super) fn ranges(&self) -> Vec<f32> {
        self.maps[self.map].ranges(self.pose)
    }

    pub(super) fn state(&self) -> TrackState {
        self.tracker.report().state
    }

    /// State of the tracker and its reason.
    pub(super) fn said(&self) -> (TrackState, TrackReason) {
        let report = self.tracker.report();
        (report.state, report.reason)
    }

    pub(super) fn is_at(&self, pose: Pose) -> bool {
        let reported = self.tracker.report().pose;
        reported.is_some_and(|reported| reported.is_within(pose, 0.1, 0.05))
    }

    /// Checks that the tracker is sure of the true pose.
    pub(super) fn check_found(&self) {
        let report = self.tracker.report();
        assert!(
            report.state == Unique && self.is_at(self.pose),
            "{report:?}"
        );
    }
}

/// A corridor with a niche, in which no two places look alike.
pub(super) const UNLIKE: [&str; 22] = [
    "##################################################",
    "#................................................#",
    "##...............................................#",
    "#.......................#........................#",
    "##.....................##.......................##",
    "#.......................#........................#",
    "##..............................................##",
    "#................................................#",
    "##..................................######......##",
    "#...................................#....#.......#",
    "##......#...........................#....#......##",
    "#......###..........................#....#.......#",
    "##......#...........................######......##",
    "#................................................#",
    "##..............................................##",
    "#.............####...............................#",
    "##............#..#..............................##",
    "#.............####...............................#",
    "##..............................................##",
    "#................................................#",
    "##..............................................##",
    "##################################################",
];

/// A building that looks the same when turned by half a turn.
pub(super) const ALIKE: [&str; 12] = [
    "########################################",
    "#......................................#",
    "#......................................#",
    "#......................................#",
    "#.....##...............................#",
    "#......................................#",
    "#......................................#",
    "#...............................##.....#",
    "#......................................#",
    "#......................................#",
    "#......................................#",
    "########################################",
];
