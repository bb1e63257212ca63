use proptest::collection::vec;
use proptest::prelude::*;

use super::*;
use crate::grid::{CellRules, Grid};
use crate::instruction_set::InstructionSet;
use crate::reference;
use crate::scan::Scan;
use crate::search::index::SearchIndex;
use crate::search::task::Shared;
use crate::search::task::lead::Lead;
use crate::simd::Simd;
use crate::space::Space;
use crate::testing::{any_dense_scan, any_limited_grid, any_scan, plain_votes_within, space_of};
use crate::votes::CollectConfig;

/// Always uses sampling.
#[derive(Default)]
struct Sampler {
    shared: Shared,
    sampling: BeamSampling,
    shares: Vec<Share>,
    found: VoteSet,
}

impl Sampler {
    /// The outcome where some pose is known to have `best` votes.
    fn count(
        &mut self,
        (instruction_set, threads): (InstructionSet, usize),
        (index, grid): (&SearchIndex, &Grid),
        scan: (&ScanProgram, &Space),
        (config, best): (CollectConfig, u16),
    ) -> &VoteSet {
        let (shared, lead) = (&mut self.shared, Lead::default());
        let task = Task::new(
            shared,
            Simd::new(instruction_set),
            index,
            grid,
            scan,
            (config, &lead),
        );
        task.raise_best(best);
        self.shares.resize_with(threads, Share::default);
        let scan = (&task, scan.0);
        let counted = self
            .sampling
            .count(scan, &mut self.shares, &mut self.found, &|| false);
        assert!(counted.is_some());
        &self.found
    }
}

proptest! {
    #[test]
    fn sampling_finds_what_the_reference_finds_whatever_was_searched_before(
        worlds in vec((any_limited_grid(4), prop_oneof![2 => any_dense_scan(), 1 => any_scan()], 1usize..4), 1..4),
        floor_share in prop_oneof![1 => Just(1.0), 2 => 0.6..1.0f64], max_votes in 1u32..400, is_known: bool,
    ) {
        let config = CollectConfig { floor_share, max_votes, ..CollectConfig::exact() };
        let mut sampler = Sampler::default();
        for ((grid, limits, headings), scan, threads) in worlds {
            let space = space_of(&grid, headings);
            let program = scan.program(&space);
            let plain = plain_votes_within(&limits, &grid, &program, &space, config);
            let index = SearchIndex::within(&grid, &space, limits);
            let best = if is_known { plain.best } else { 0 };
            for instruction_set in InstructionSet::available() {
                let how = (instruction_set, threads);
                let found = sampler.count(how, (&index, &grid), (&program, &space), (config, best));
                let found = VoteSet { poses_evaluated: 0, ..found.clone() };
                prop_assert_eq!(&found, &plain, "{:?}", how);
            }
        }
    }
}

/// A third of the cells are occupied, here and there.
fn clutter() -> Grid {
    let mut state = 1u32;
    let mut occupancy = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        100 * u8::from(state >> 24 < 85)
    };
    let occupancy: Vec<u8> = (0..96 * 96).map(|_| occupancy()).collect();
    Grid::new(96, 96, &occupancy, CellRules::default()).expect("a small map")
}

#[test]
fn few_poses_are_counted_where_a_sample_of_the_beams_shows_the_best_one() {
    let (grid, beams) = (clutter(), 120);
    let space = space_of(&grid, beams);
    let pose = grid
        .places(|cell| cell == crate::grid::Cell::Open)
        .nth(3000);
    let (x, y) = pose.expect("most cells are open");
    let directions = space.directions.all().iter();
    let ranges: Vec<f32> = directions
        .map(|direction| {
            let steps = reference::range(&grid, x as i64, y as i64, direction);
            let steps_per_cell = space.directions.steps_per_cell(direction.class);
            let cells = steps.map(|steps| f64::from(steps) / steps_per_cell);
            cells.map_or(f32::INFINITY, |cells| (cells * space.resolution_m) as f32)
        })
        .collect();
    let scan = Scan {
        angle_min: 0.0,
        angle_increment: std::f64::consts::TAU / f64::from(beams),
        range_min_m: 0.0,
        range_max_m: 100.0,
        ranges: &ranges,
    };
    let votes = crate::program::VoteConfig {
        sigma_m: 0.0,
        ..Default::default()
    };
    let program = ScanProgram::new(&scan, 0.0, &space, &votes).expect("a sound scan");
    let index = SearchIndex::new(&grid, &space);
    let how = (InstructionSet::best(), 1);
    let mut sampler = Sampler::default();
    // Hardly more than one at each heading; where poses lack more of the best one's
    // votes, the cells of some headings, too.
    for (floor_share, most) in [(1.0, 1000), (0.85, 4 * 96 * 96)] {
        let config = CollectConfig {
            floor_share,
            ..CollectConfig::default()
        };
        let wanted = (config, 0);
        let found = sampler.count(how, (&index, &grid), (&program, &space), wanted);
        let best = found.votes[0];
        assert_eq!((usize::from(best.x), usize::from(best.y)), (x, y));
        assert_eq!(best.heading, 0);
        let counted = found.poses_evaluated;
        assert!(counted < most, "{counted} poses of 96 · 96 · 120");
    }
}
