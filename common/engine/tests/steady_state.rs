//! Nothing is allocated from scan to scan: once the buffers of workspaces are large enough for all
//! scans, searching and fitting them again allocates no memory.
//!
//! Allocations are counted per thread, so tests may run in parallel. Starting a thread allocates in
//! the standard library: a search on two threads is compared with a bare start of as many.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use std::f64::consts::{FRAC_PI_2, TAU};

use allocation_counter::measure;
use engine::Map;
use engine::fit::{DistanceField, Ends};
use engine::grid::{CellRules, GridFrame};
use engine::instruction_set::InstructionSet;
use engine::peaks::{self, PeakConfig, PeakInput};
use engine::reference;
use engine::scan::Scan;
use engine::vote_search::{Outcome, Preparation, Prior, VoteSearch, VoteSearchConfig, Workspace};
use geometry::Pose;
use messages::Verdict;

const FRAME: GridFrame = GridFrame::new(0.1, Pose::new(-3.0, 2.0, 0.4));

/// Number of passes over all scans before counting. Results alternate between two buffers: with an
/// odd number of scans, each buffer has held each scan's results after two passes.
const WARM_UP: usize = 2;

/// Reproducible pseudo-random numbers from 0 to 1.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        // Knuth's MMIX generator; its high bits are the better ones.
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = self.0.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Occupancies of a map, and scans on it.
struct World {
    sides: (usize, usize),
    occupancy: Vec<u8>,
    scans: Vec<Vec<f32>>,
}

impl World {
    /// Rooms with random pillars, and a scan at each of some places.
    fn rooms() -> World {
        let (width, height) = (230, 170);
        let mut noise = Noise(1);
        let is_wall = |x: usize, y: usize| {
            let on_wall =
                x.is_multiple_of(46) || y.is_multiple_of(34) || x == width - 1 || y == height - 1;
            let in_door = x % 46 > 18 && x % 46 < 28 || y % 34 > 12 && y % 34 < 22;
            let is_outer = x == 0 || y == 0 || x == width - 1 || y == height - 1;
            on_wall && (is_outer || !in_door)
        };
        let cells = (0..width * height).map(|i| {
            let is_pillar = noise.next() < 0.004;
            if is_pillar || is_wall(i % width, i / width) {
                100
            } else {
                0
            }
        });
        let mut world = World {
            sides: (width, height),
            occupancy: cells.collect(),
            scans: Vec::new(),
        };
        let poses = [
            (20, 15, 10),
            (70, 20, 100),
            (120, 80, 200),
            (200, 150, 300),
            (60, 120, 45),
        ];
        world.scans = poses.map(|pose| world.scan(pose, &mut noise)).to_vec();
        world
    }

    /// Random single cells, and scans that fit nowhere.
    fn clutter() -> World {
        let sides = (120, 120);
        let mut noise = Noise(7);
        let cells = (0..sides.0 * sides.1).map(|_| if noise.next() < 0.06 { 100 } else { 0 });
        let occupancy = cells.collect();
        let mut scan = || (0..361).map(|_| 2.5 * noise.next() as f32).collect();
        World {
            sides,
            occupancy,
            scans: vec![scan(), scan(), scan()],
        }
    }

    fn vote_search(&self, threads: u8, prior: Prior) -> VoteSearch {
        let config = VoteSearchConfig {
            threads,
            search_cell: 0.0,
            ..VoteSearchConfig::default()
        };
        let map = Map {
            frame: FRAME,
            sides: self.sides,
            occupancy: &self.occupancy,
            rules: CellRules::default(),
        };
        let preparation = Preparation::of_map(map, config, prior);
        preparation.and_then(Preparation::finish).unwrap()
    }

    fn distance_field(&self) -> DistanceField {
        DistanceField::new(FRAME, self.sides, &self.occupancy, CellRules::default()).unwrap()
    }

    /// Ranges of a laser with a view of half a turn at a pose of the grid, within 3 cm; one beam in
    /// twenty does not return.
    fn scan(&self, (x, y, heading): (i64, i64, usize), noise: &mut Noise) -> Vec<f32> {
        let vote_search = self.vote_search(1, Prior::Heading);
        let (grid, directions) = (vote_search.grid(), &vote_search.space().directions);
        let beams = (0..361).map(|beam| {
            let direction = directions.get(heading + 270 + beam / 2);
            let steps = reference::range(grid, x, y, direction);
            let error_m = 0.06 * noise.next() - 0.03;
            match steps {
                Some(steps) if noise.next() > 0.05 => {
                    (f64::from(steps) / direction.steps_per_cell * FRAME.resolution_m + error_m)
                        as f32
                }
                _ => f32::INFINITY,
            }
        });
        beams.collect()
    }

    fn scans(&self) -> impl Iterator<Item = Scan<'_>> {
        self.scans.iter().map(|ranges| Scan {
            angle_min: -FRAC_PI_2,
            angle_increment: TAU / 720.0,
            range_min_m: 0.0,
            range_max_m: 30.0,
            ranges,
        })
    }
}

/// Number of allocations while all scans are processed, after a warm-up.
fn allocations(world: &World, mut work: impl FnMut(&Scan<'_>)) -> u64 {
    for _ in 0..WARM_UP {
        world.scans().for_each(|scan| work(&scan));
    }
    measure(|| world.scans().for_each(|scan| work(&scan))).count_total
}

#[test]
fn a_search_of_all_headings_allocates_nothing() {
    let world = World::rooms();
    let vote_search = world.vote_search(1, Prior::None);
    let mut workspace = Workspace::default();
    let mut best = 0;
    let count = allocations(&world, |scan| {
        let outcome = vote_search.search_in(&mut workspace, scan, None, &|| false);
        best = outcome.unwrap().unwrap().found.best;
    });
    assert!(best > 0, "something is found");
    assert_eq!(count, 0);
    let count = allocations(&world, |scan| {
        vote_search.block_bounds(&mut workspace, scan).unwrap();
    });
    assert_eq!(count, 0);
}

#[test]
fn a_search_that_counts_every_pose_allocates_nothing() {
    let world = World::clutter();
    let vote_search = world.vote_search(1, Prior::None);
    let all = (vote_search.grid().cells().len() * vote_search.space().directions.count()) as u64;
    let mut workspace = Workspace::default();
    let mut counted = 0;
    let count = allocations(&world, |scan| {
        let outcome = vote_search.search_in(&mut workspace, scan, None, &|| false);
        counted = outcome.unwrap().unwrap().found.poses_evaluated;
    });
    // Without wide vectors, counting is so slow that bounds help even here.
    if InstructionSet::best() > InstructionSet::Portable {
        assert!(
            counted >= all,
            "bounds do not help here: {counted} of {all}"
        );
    }
    assert_eq!(count, 0);
}

#[test]
fn the_second_stage_allocates_nothing() {
    let world = World::rooms();
    let (vote_search, distance_field) = (world.vote_search(1, Prior::None), world.distance_field());
    let space = vote_search.space();
    let search = |scan: Scan<'_>| vote_search.search(&scan, &|| false).unwrap().unwrap();
    let outcomes: Vec<Outcome> = world.scans().map(search).collect();
    let mut workspace = peaks::Workspace::default();
    let (config, mut next, mut candidates) = (PeakConfig::default(), 0, 0);
    let count = allocations(&world, |scan| {
        let outcome = &outcomes[next % outcomes.len()];
        next += 1;
        let input = PeakInput::of(outcome, FRAME);
        let beams = &vote_search.config().votes.beams;
        let find = |ends: &mut Ends| ends.find(scan, space, beams);
        let judged = workspace.judge(&input, &distance_field, &config, find);
        let places = judged.unwrap().places;
        assert_ne!(places.verdict, Verdict::NoScan);
        candidates = candidates.max(places.places.len());
    });
    assert!(candidates > 32, "there is something to sort: {candidates}");
    assert_eq!(count, 0);
}

#[test]
fn a_search_on_two_threads_allocates_no_more_than_their_start() {
    let world = World::rooms();
    let vote_search = world.vote_search(2, Prior::None);
    let mut workspace = Workspace::default();
    // The buffer sizes of each thread depend on which of them finds the best pose first, so that
    // buffers still grow now and then for a while.
    let searches = (0..16).map(|_| {
        allocations(&world, |scan| {
            let outcome = vote_search.search_in(&mut workspace, scan, None, &|| false);
            assert!(outcome.unwrap().unwrap().found.best > 0);
        })
    });
    let start = || {
        std::thread::scope(|scope| {
            let threads: Vec<_> = (1..2).map(|thread| scope.spawn(move || thread)).collect();
            let joined = threads.into_iter().map(|thread| thread.join().unwrap());
            joined.sum::<usize>()
        })
    };
    let starts = allocations(&world, |_| assert_eq!(start(), 1));
    assert_eq!(searches.min(), Some(starts));
}

#[test]
fn a_search_at_a_heading_on_one_map_after_the_other_allocates_nothing() {
    let (large, small) = (World::rooms(), World::clutter());
    let localizers = [&large, &small].map(|world| world.vote_search(1, Prior::Heading));
    let mut workspace = Workspace::default();
    let mut best = 0;
    let mut work = || {
        for (world, vote_search) in [&large, &small].into_iter().zip(&localizers) {
            for scan in world.scans() {
                let outcome = vote_search.search_in(&mut workspace, &scan, Some(0.0), &|| false);
                best = best.max(outcome.unwrap().unwrap().found.best);
            }
        }
    };
    (0..WARM_UP).for_each(|_| work());
    assert_eq!(measure(work).count_total, 0);
    assert!(best > 0, "something is found");
}
