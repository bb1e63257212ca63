//! Drawn buildings in which a robot drives.

use super::*;

const BEAMS: usize = 180;

/// A building in which scans are simulated and searched.
pub(super) struct Building {
    grid: Grid,
    distance_field: DistanceField,
    vote_search: VoteSearch,
    space: Space,
}

/// Makes a building. Its walls must be ragged, so that its map does not count as drawn.
pub(super) fn building(rows: &[&str]) -> Building {
    let (width, height, cells) = crate::grid::drawn::occupancy(rows);
    let frame = GridFrame {
        resolution_m: RESOLUTION_M,
        map_from_grid: Pose::IDENTITY,
    };
    let rules = CellRules::default();
    let grid = Grid::new(width, height, &cells, rules).unwrap();
    let config = VoteSearchConfig {
        search_cell: 0.0,
        ..VoteSearchConfig::default()
    };
    Building {
        distance_field: DistanceField::new(frame, (width, height), &cells, rules).unwrap(),
        vote_search: VoteSearch::new(frame, grid.clone(), config, Prior::None).unwrap(),
        space: Space::new(360, RESOLUTION_M, width, height).unwrap(),
        grid,
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

    pub(super) fn ends(&self, pose: Pose) -> Ends {
        self.ends_of(&self.ranges(pose))
    }

    pub(super) fn ends_of(&self, ranges: &[f32]) -> Ends {
        Ends::new(&scan(ranges), &self.space, &BeamConfig::default()).unwrap()
    }

    pub(super) fn found(&self, pose: Pose) -> Vec<Candidate> {
        self.found_of(&self.ranges(pose))
    }

    pub(super) fn found_of(&self, ranges: &[f32]) -> Vec<Candidate> {
        let outcome = self.vote_search.search(&scan(ranges), &|| false);
        let outcome = outcome.unwrap().unwrap();
        let input = PeakInput::of(&outcome, self.vote_search.frame());
        let mut workspace = peaks::Workspace::default();
        let beams = BeamConfig::default();
        let find = |ends: &mut Ends| ends.find(&scan(ranges), &self.space, &beams);
        let config = PeakConfig::default();
        let judged = workspace.judge(&input, &self.distance_field, &config, find);
        let places = judged.unwrap().places;
        let target = Target::of(None, false);
        Candidate::of_places(places, target, target)
    }

    pub(super) fn seen<'a>(&'a self, ends: &'a Ends, fit: &'a FitConfig) -> Seen<'a> {
        Seen {
            distance_field: &self.distance_field,
            ends,
            fit,
        }
    }

    /// Gives a tracker a scan, and what a search finds, by the one that was needed, which is
    /// returned.
    pub(super) fn see(
        &self,
        tracker: &mut PlaceTracker,
        ends: &Ends,
        moved: Option<Pose>,
        find: impl FnOnce(Need) -> Option<Vec<Candidate>>,
    ) -> Need {
        let fit = FitConfig::default();
        let seen = [self.seen(ends, &fit)];
        let need = tracker.begin(&seen, 1, moved);
        tracker.finish(&seen, find(need).as_deref());
        need
    }

    /// Gives a tracker the scan at a pose; returns the search that was needed.
    pub(super) fn step(
        &self,
        tracker: &mut PlaceTracker,
        truth: Pose,
        moved: Option<Pose>,
    ) -> Need {
        self.see(tracker, &self.ends(truth), moved, |need| {
            (need == Need::ThisScan).then(|| self.found(truth))
        })
    }

    /// A tracker that started at the trusted pose [`START`] and followed the robot, and the last pose.
    pub(super) fn followed(&self, steps: usize) -> (PlaceTracker, Pose) {
        let (ends, fit) = (self.ends(START), FitConfig::default());
        let mut tracker = PlaceTracker::new(TrackingConfig::default());
        let covariance = Covariance::from_deviations(0.1, 0.1, 0.1);
        tracker.start_at(&[self.seen(&ends, &fit)], (0, START), covariance);
        self.step(&mut tracker, START, Some(Pose::IDENTITY));
        let end = self.drive(&mut tracker, START, steps);
        assert_eq!(tracker.report().state, Unique);
        (tracker, end)
    }

    /// A tracker that found the robot at [`START`] by itself and followed it, and the last pose.
    pub(super) fn tracked(&self, steps: usize) -> (PlaceTracker, Pose) {
        let mut tracker = PlaceTracker::new(TrackingConfig::default());
        self.step(&mut tracker, START, None);
        let end = self.drive(&mut tracker, START, steps);
        (tracker, end)
    }

    /// Drives straight on by steps of 0.3 m.
    pub(super) fn drive(&self, tracker: &mut PlaceTracker, from: Pose, steps: usize) -> Pose {
        let step = Pose::new(0.3, 0.0, 0.0);
        let mut pose = from;
        for _ in 0..steps {
            pose = pose.then(step);
            self.step(tracker, pose, Some(step));
        }
        pose
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
