//! Searches of a prepared map, by bounds or by counting.

use super::attempt::Attempt;
use super::{alternatives, descent};
use crate::grid::Grid;
use crate::instruction_set::InstructionSet;
use crate::program::ScanProgram;
use crate::search::counting;
use crate::search::index::SearchIndex;
use crate::search::task::lead::Lead;
use crate::search::task::{Shared, Task};
use crate::simd::Simd;
use crate::space::Space;
use crate::votes::{CollectConfig, VoteSet};

/// Buffers for searches, kept from scan to scan: once they are large enough, nothing is
/// allocated any more. They may serve any map.
#[derive(Debug, Default)]
pub struct Workspace {
    pub(super) shared: Shared,
    /// One for each thread.
    scratches: Vec<descent::Scratch>,
    pub(super) alternatives: alternatives::Scratch,
    /// Buffers for counting every pose, one for each thread.
    shares: Vec<counting::Share>,
}

impl SearchIndex {
    /// Returns the poses with the most votes, with an instruction set on a number of threads.
    #[cfg(test)]
    pub(crate) fn search(
        &self,
        how: (InstructionSet, usize),
        grid: &Grid,
        scan: (&ScanProgram, &Space),
        config: CollectConfig,
    ) -> VoteSet {
        let (mut workspace, mut found) = (Workspace::default(), VoteSet::default());
        let collect = (config, &mut found);
        let end = self.search_in(&mut workspace, how, grid, scan, collect, &|| false);
        end.expect("it comes to an end");
        found
    }

    /// Fills in the poses with the most votes, with an instruction set on a number of threads, in a
    /// workspace that may have served other scans and maps; `None` if `stop` returned true before
    /// the end.
    ///
    /// The outcome is the same with any instruction set and number of threads, except for the
    /// number of poses that were counted. If bounds cannot distinguish blocks, all poses are
    /// counted.
    ///
    /// # Panics
    /// If the processor does not have the instruction set, or there is no
    /// thread.
    pub fn search_in(
        &self,
        workspace: &mut Workspace,
        how: (InstructionSet, usize),
        grid: &Grid,
        scan: (&ScanProgram, &Space),
        (config, found): (CollectConfig, &mut VoteSet),
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        let lead = Lead::default();
        let mut attempt = self.attempt(workspace, how, grid, scan, config, (&lead, stop));
        attempt.find(found)
    }

    /// Prepares a search.
    pub(crate) fn attempt<'a>(
        &'a self,
        workspace: &'a mut Workspace,
        (instruction_set, threads): (InstructionSet, usize),
        grid: &'a Grid,
        scan: (&'a ScanProgram, &'a Space),
        config: CollectConfig,
        (lead, stop): (&'a Lead, &'a dyn Fn() -> bool),
    ) -> Attempt<'a> {
        let Workspace {
            shared,
            scratches,
            alternatives,
            shares,
            ..
        } = workspace;
        let simd = Simd::new(instruction_set);
        let task = Task::new(shared, simd, self, grid, scan, (config, lead));
        scratches.resize_with(threads, descent::Scratch::default);
        shares.resize_with(threads, counting::Share::default);
        Attempt {
            task,
            scratches,
            alternatives,
            shares,
            stop,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::beams::BeamConfig;
    use crate::grid::CellRules;
    use crate::program::VoteConfig;
    use crate::reference;
    use crate::scan::MAX_RANGES;
    use crate::testing::{
        any_grid, any_limited_grid, any_long_grid, any_scan, plain_votes, plain_votes_within,
        scan_from, space_of,
    };
    use crate::votes::{is_close, most_candidates};

    fn check(
        grid: &Grid,
        (program, space): (&ScanProgram, &Space),
        config: CollectConfig,
    ) -> Result<(), TestCaseError> {
        let index = SearchIndex::new(grid, space);
        let plain = plain_votes(grid, program, space, config);
        for instruction_set in InstructionSet::available() {
            for threads in 1..4 {
                let how = (instruction_set, threads);
                let found = VoteSet {
                    poses_evaluated: 0,
                    ..index.search(how, grid, (program, space), config)
                };
                prop_assert_eq!(&found, &plain, "{:?}", how);
            }
        }
        Ok(())
    }

    proptest! {
        /// Headings of a part of a chunk, of several chunks, and of a chunk and a part.
        #[test]
        fn the_search_equals_the_reference_however_it_is_done(
            grid in any_grid(), scan in any_scan(),
            headings in prop_oneof![(1u32..8).prop_map(|eights| 8 * eights), Just(360), Just(128), Just(488)],
            floor_share in 0.5..=1.0f64, max_votes in prop_oneof![1u32..400, Just(65_536)],
        ) {
            let space = space_of(&grid, headings);
            let config = CollectConfig { floor_share, max_votes, ..CollectConfig::exact() };
            check(&grid, (&scan.program(&space), &space), config)?;
        }

        #[test]
        fn the_search_finds_far_readings_and_wide_tapers(
            grid in any_long_grid(), scan in any_scan(), floor_share in 0.5..=1.0f64,
        ) {
            let space = space_of(&grid, 16);
            let config = CollectConfig { floor_share, candidates: 0, ..CollectConfig::default() };
            check(&grid, (&scan.stretched(18.0).program(&space), &space), config)?;
        }

        #[test]
        fn candidates_are_poses_below_the_floor_and_the_same_however_it_is_done(
            (grid, limits, headings) in any_limited_grid(8), scan in any_scan(),
            floor_share in prop_oneof![0.3..=1.0f64, Just(1.0)], candidates in 0u32..20,
        ) {
            let space = space_of(&grid, headings);
            let program = scan.program(&space);
            let config = CollectConfig { floor_share, candidates, ..CollectConfig::default() };
            let index = SearchIndex::within(&grid, &space, limits.clone());
            let plain = plain_votes_within(&limits, &grid, &program, &space, config);
            let mut first = None;
            for instruction_set in InstructionSet::available() {
                for threads in 1..3 {
                    let how = (instruction_set, threads);
                    let found = index.search(how, &grid, (&program, &space), config);
                    let found = VoteSet { poses_evaluated: 0, ..found };
                    let (above, below) = found.votes.split_at(plain.votes.len());
                    prop_assert_eq!(above, &plain.votes);
                    let wanted = candidates as usize;
                    prop_assert!(below.len() <= most_candidates(wanted, space.resolution_m));
                    let mut beyond = below.iter().skip(wanted);
                    prop_assert!(beyond.all(|vote| is_close(vote.intensity, found.best)));
                    for vote in below {
                        let (x, y, heading) = (vote.x.into(), vote.y.into(), vote.heading.into());
                        prop_assert!(limits.hold_cell(x, y) && limits.hold_heading(heading));
                        let (x, y) = (x as i64, y as i64);
                        let intensity = reference::intensity(&grid, &program, &space, x, y, heading);
                        prop_assert_eq!(vote.intensity, intensity);
                        prop_assert!(grid.is_open(x, y) && intensity < found.certified_floor && intensity > 0);
                    }
                    prop_assert_eq!(first.get_or_insert(found.clone()), &found, "{:?}", how);
                }
            }
        }

        #[test]
        fn a_search_that_is_cut_says_what_it_may_have_missed(
            grid in any_grid(), scan in any_scan(), headings in 1u32..8, floor_share in 0.3..=1.0f64,
            work_limit in prop_oneof![Just(1e-9), 1e-6..0.1f64], candidates in 0u32..9,
        ) {
            let space = space_of(&grid, headings * 8);
            let program = scan.program(&space);
            let config = CollectConfig { floor_share, ..CollectConfig::exact() };
            let plain = plain_votes(&grid, &program, &space, config);
            let index = SearchIndex::new(&grid, &space);
            let config = CollectConfig { work_limit: Some(work_limit), candidates, ..config };
            let mut first = None;
            for instruction_set in InstructionSet::available() {
                for threads in 1..4 {
                    let how = (instruction_set, threads);
                    let found = index.search(how, &grid, (&program, &space), config);
                    if threads == 1 {
                        prop_assert_eq!(first.get_or_insert(found.clone()), &found);
                    }
                    let certain = |set: &VoteSet| {
                        let floor = plain.certified_floor.max(found.certified_floor);
                        set.votes.iter().copied().filter(|vote| vote.intensity >= floor).collect::<Vec<_>>()
                    };
                    prop_assert_eq!(certain(&found), certain(&plain));
                    prop_assert!(found.cut || found.certified_floor == plain.certified_floor);
                    prop_assert!(found.best <= plain.best && (found.best > 0) == (plain.best > 0));
                    prop_assert!(found.votes.is_sorted_by_key(|vote| std::cmp::Reverse(vote.intensity)));
                    prop_assert_eq!(found.votes.first().map_or(0, |vote| vote.intensity), found.best);
                    for vote in &found.votes {
                        let (x, y) = (i64::from(vote.x), i64::from(vote.y));
                        let intensity = reference::intensity(&grid, &program, &space, x, y, vote.heading.into());
                        prop_assert_eq!(vote.intensity, intensity);
                    }
                }
            }
        }

        #[test]
        fn a_limit_that_is_not_reached_changes_nothing(
            grid in any_grid(), scan in any_scan(), headings in 1u32..8, candidates in 0u32..9,
        ) {
            let space = space_of(&grid, headings * 8);
            let program = scan.program(&space);
            let index = SearchIndex::new(&grid, &space);
            let [none, zero, large] = [None, Some(0.0), Some(1e9)].map(|work_limit| {
                let config = CollectConfig { work_limit, candidates, ..CollectConfig::default() };
                index.search((InstructionSet::best(), 1), &grid, (&program, &space), config)
            });
            prop_assert!(!none.cut);
            prop_assert_eq!(&none, &zero);
            prop_assert_eq!(&none, &large);
        }
    }

    #[test]
    fn a_search_that_is_asked_to_stop_has_no_outcome() {
        let grid = crate::grid::drawn::grid(&["####", "#..#", "####"]);
        let space = space_of(&grid, 8);
        let scan = scan_from(0.0, 1.0, &[0.1, 0.1]);
        let program = ScanProgram::new(&scan, 0.0, &space, &Default::default()).unwrap();
        let index = SearchIndex::new(&grid, &space);
        let search = |stop| {
            let (mut workspace, mut found) = (Workspace::default(), VoteSet::default());
            let (how, scan) = ((InstructionSet::best(), 1), (&program, &space));
            let collect = (CollectConfig::default(), &mut found);
            index.search_in(&mut workspace, how, &grid, scan, collect, &|| stop)
        };
        assert!(search(true).is_none());
        assert!(search(false).is_some());
    }

    /// With as many beams as a scan can have, the votes still fit 16 bits.
    #[test]
    fn the_search_equals_the_reference_with_the_most_beams() {
        let (width, height) = (9, 7);
        let is_wall = |i: usize| [0, 8].contains(&(i % width)) || [0, 6].contains(&(i / width));
        let occupancy: Vec<u8> = (0..width * height)
            .map(|i| if is_wall(i) { 100 } else { 0 })
            .collect();
        let grid = Grid::new(width, height, &occupancy, CellRules::default()).unwrap();
        let space = space_of(&grid, 16);
        let ranges: Vec<f32> = (0..MAX_RANGES)
            .map(|i| 0.1 + 0.3 * (i as f32 / 9000.0).sin().abs())
            .collect();
        let scan = scan_from(-3.0, std::f64::consts::TAU / MAX_RANGES as f64, &ranges);
        let beams = BeamConfig {
            max_beams: u16::MAX.into(),
            beam_arc_m: 0.0,
        };
        let config = VoteConfig {
            beams,
            ..VoteConfig::default()
        };
        let program = ScanProgram::new(&scan, 0.0, &space, &config).unwrap();
        assert_eq!(program.beams(), usize::from(u16::MAX));
        check(&grid, (&program, &space), CollectConfig::exact()).unwrap();
    }
}
