//! Counting every pose, where bounds do not tell blocks apart: few beams tell most
//! poses from the best one.
//!
//! In clutter most poses have half of the votes that are possible and some nine tenths,
//! but hardly one has nearly all of them, and that shows after few beams. So a sample of
//! the beams is swept at every heading, the poses with most of its votes are kept, and
//! the first of them is counted with all beams: at one heading that is the best pose.
//! What was not kept cannot reach the floor then, as a rule, whatever the other beams
//! say, and of what was kept little is left to count.
//!
//! Headings at which that is not certain are swept again with more beams, at last with
//! all of them.

use std::ops::Range;
use std::sync::atomic::Ordering;

use messages::Vote;

use super::intervals::SIDE;
use super::leaf::Count;
use super::outlook::Outlook;
use super::sectors;
use super::task::Task;
use crate::accumulator::Query;
use crate::program::ScanProgram;
use crate::sweep;
use crate::threads;
use crate::votes::{CollectConfig, Collector, VoteSet};

/// Beams of the first sample. After 20, more poses are as good as the best one, and
/// sweeping 40 takes longer.
const FIRST_BEAMS: usize = 30;

/// The samples after that, in quarters of all beams.
const QUARTERS: [usize; 3] = [1, 2, 3];

/// Of so many cells one pose is kept at a heading, and not less than so many poses.
const CELLS_A_KEPT: usize = 2048;
const LEAST_KEPT: usize = 64;

/// The least votes of what is kept rise by this part of the highest possible where it
/// is more, and fall where it is less than an eighth.
const STEP: u32 = 64;

/// Sweeping all beams over so many cells takes no longer than counting one pose by
/// itself. A few poses are counted on any map.
const CELLS_A_COUNT: usize = 8192;
const FEW_COUNTS: usize = 4;

/// Cells whose greatest votes are looked at together.
const STRETCH: usize = 1024;

/// What sifting takes as a share of brute force, where few beams are decisive.
const SHARE: f64 = 0.3;

/// Whether a sample of the beams tells the poses that are wanted from most others: it
/// must be a small part, and have twice the votes that those may lack of all.
fn is_decisive(program: &ScanProgram, config: &CollectConfig) -> bool {
    let (beams, sample) = (program.beams() as f64, FIRST_BEAMS as f64);
    sample <= 0.5 * beams && sample >= 2.0 * beams * (1.0 - config.floor_share)
}

/// What counting every pose takes at least, as a share of brute force.
pub(super) fn share(program: &ScanProgram, config: &CollectConfig) -> f64 {
    if is_decisive(program, config) {
        SHARE
    } else {
        1.0
    }
}

/// A scan program laid out for sifting, kept from scan to scan.
#[derive(Debug, Default)]
pub(super) struct Sift {
    /// Nothing votes in it where it would say little.
    first: ScanProgram,
    samples: [ScanProgram; QUARTERS.len()],
    /// The most votes of each sector and those after it; 0 at the end.
    rests: Vec<u16>,
}

/// What one thread sifts with and finds, kept from scan to scan.
#[derive(Debug, Default)]
pub(super) struct Share {
    sweep: sweep::Workspace,
    /// The votes of a sample at a heading.
    field: Vec<u16>,
    outlook: Outlook,
    /// The block in which the outlook is.
    entered: Option<usize>,
    /// The headings of this thread.
    seen: Vec<Seen>,
    /// Poses that have most votes of the first sample, heading by heading.
    kept: Vec<Pose>,
    /// They have so many or more.
    least: u16,
    /// Samples before this one leave too many poses.
    sample: usize,
    collector: Collector,
    poses_evaluated: u64,
}

/// What the first sample said of a heading.
#[derive(Debug, Clone, Copy)]
struct Seen {
    heading: usize,
    /// The end of its poses among those kept.
    end: usize,
    /// The others have fewer votes of the sample.
    below: u16,
}

/// A cell, and the votes that it has of a sample.
#[derive(Debug, Clone, Copy)]
struct Pose {
    votes: u16,
    cell: u32,
}

impl Sift {
    /// Finds the poses with the most votes, on as many threads as there are shares;
    /// `None` if `stop` said so before the end.
    pub(super) fn count(
        &mut self,
        (task, program): (&Task<'_>, &ScanProgram),
        shares: &mut [Share],
        found: &mut VoteSet,
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        self.make(task, program);
        let (sift, threads) = (&*self, shares.len());
        let what = (task, program, sift);
        let sampled = threads::run(shares, stop, |thread, share, stop| {
            share.start(task, sift);
            let mut sifting = Sifting::new(what, share, stop);
            let headings = (thread..task.space.directions.count()).step_by(threads);
            let limits = &task.index.within.limits;
            let mut sought = headings.filter(|&heading| limits.hold_heading(heading));
            sought
                .try_for_each(|heading| sifting.look(heading))
                .ok_or(())
        });
        sampled.ok()?;
        let counted = threads::run(shares, stop, |_, share, stop| {
            Sifting::new(what, share, stop).count_seen().ok_or(())
        });
        counted.ok()?;
        let (own, others) = shares.split_first_mut().expect("a thread");
        for other in others {
            own.collector.merge(&other.collector);
            own.poses_evaluated += other.poses_evaluated;
        }
        own.collector.finish(own.poses_evaluated, found);
        Some(())
    }

    fn make(&mut self, task: &Task<'_>, program: &ScanProgram) {
        let beams = program.beams();
        // As evenly as they go.
        let is_decisive = is_decisive(program, &task.config);
        let is_first = |beam| is_decisive && beam * FIRST_BEAMS % beams < FIRST_BEAMS;
        self.first.take_some(program, is_first);
        for (sample, quarters) in self.samples.iter_mut().zip(QUARTERS) {
            sample.take_some(program, |beam| beam * quarters % 4 < quarters);
        }
        let (order, sectors) = (task.programs.leaf.order(), sectors::count(beams));
        self.rests.clear();
        self.rests.resize(sectors + 1, 0);
        for sector in (0..sectors).rev() {
            let sector_beams = order[sectors::beams(sector, beams)].iter();
            let votes: u16 = sector_beams.map(|&beam| program.peak(beam)).sum();
            self.rests[sector] = self.rests[sector + 1] + votes;
        }
    }
}

/// One thread at it.
struct Sifting<'a> {
    task: &'a Task<'a>,
    program: &'a ScanProgram,
    sift: &'a Sift,
    share: &'a mut Share,
    stop: &'a dyn Fn() -> bool,
}

impl<'a> Sifting<'a> {
    fn new(
        (task, program, sift): (&'a Task<'a>, &'a ScanProgram, &'a Sift),
        share: &'a mut Share,
        stop: &'a dyn Fn() -> bool,
    ) -> Self {
        Sifting {
            task,
            program,
            sift,
            share,
            stop,
        }
    }

    /// Keeps the poses that have most votes of the first sample at a heading, and
    /// counts the first of them.
    fn look(&mut self, heading: usize) -> Option<()> {
        let (task, first) = (self.task, &self.sift.first);
        let most = (task.grid.cells().len() / CELLS_A_KEPT).max(LEAST_KEPT);
        let step = (first.highest_possible() / STEP).max(1) as u16;
        let start = self.share.kept.len();
        if first.beams() > 0 {
            self.sweep(first, heading)?;
            while !self.share.keep(most) {
                self.share.least += step;
            }
        }
        self.share.seen.push(Seen {
            heading,
            end: self.share.kept.len(),
            below: self.share.least,
        });
        let kept = &self.share.kept[start..];
        if kept.len() < most / 8 {
            self.share.least = self.share.least.saturating_sub(step).max(1);
        }
        if let Some(&Pose { cell, .. }) = kept.iter().max_by_key(|pose| pose.votes) {
            let best = task.best.load(Ordering::Relaxed);
            let votes = self.count(cell, heading, best);
            task.best.fetch_max(votes, Ordering::Relaxed);
        }
        Some(())
    }

    /// Takes the poses that reach the floor, now that the best one is likely known.
    fn count_seen(&mut self) -> Option<()> {
        let first = &self.sift.first;
        let (rest, most) = (self.rest(first), self.most_counts(first));
        let mut start = 0;
        for i in 0..self.share.seen.len() {
            let Seen {
                heading,
                end,
                below,
            } = self.share.seen[i];
            let least = self.floor().saturating_sub(rest);
            let kept = self.share.kept[start..end].iter();
            if below <= least && kept.filter(|pose| pose.votes >= least).count() <= most {
                self.take_kept(start..end, least, heading);
            } else {
                self.take_anew(heading)?;
            }
            start = end;
        }
        Some(())
    }

    /// Takes the poses of a heading that reach the floor, by more beams.
    fn take_anew(&mut self, heading: usize) -> Option<()> {
        let samples = &self.sift.samples;
        let start = self.share.kept.len();
        for (i, sample) in samples.iter().enumerate().skip(self.share.sample) {
            self.share.least = self.floor().saturating_sub(self.rest(sample));
            if self.share.least == 0 {
                continue;
            }
            self.sweep(sample, heading)?;
            if self.share.keep(self.most_counts(sample)) {
                self.take_kept(start..self.share.kept.len(), 0, heading);
                self.share.kept.truncate(start);
                return Some(());
            }
            // Headings are alike.
            self.share.sample = i + 1;
        }
        self.sweep(self.program, heading)?;
        self.floor();
        let Share {
            field, collector, ..
        } = &mut *self.share;
        collector.take_field(field, self.task.grid.width(), heading as u16);
        let best = collector.best();
        self.task.best.fetch_max(best, Ordering::Relaxed);
        self.share.poses_evaluated += self.share.field.len() as u64;
        Some(())
    }

    /// Takes the poses that reach the floor of those kept, which have so many votes of
    /// a sample.
    fn take_kept(&mut self, kept: Range<usize>, least: u16, heading: usize) {
        for i in kept {
            let Pose { votes, cell } = self.share.kept[i];
            if votes < least {
                continue;
            }
            let floor = self.floor();
            let intensity = self.count(cell, heading, floor);
            if intensity >= floor {
                let (x, y) = self.place(cell);
                self.share.collector.take(Vote {
                    x: x as u16,
                    y: y as u16,
                    heading: heading as u16,
                    intensity,
                });
                self.task.best.fetch_max(intensity, Ordering::Relaxed);
            }
        }
    }

    /// Fills in the votes of some beams for all poses that are sought at a heading.
    fn sweep(&mut self, program: &ScanProgram, heading: usize) -> Option<()> {
        let Task {
            index,
            space,
            programs,
            ..
        } = self.task;
        let query = Query {
            program,
            space,
            heading,
        };
        let Share { sweep, field, .. } = &mut *self.share;
        let set = programs.instruction_set;
        index.sweeps.fill(set, query, sweep, field, self.stop)?;
        index.within.limits.clear(field, heading);
        Some(())
    }

    /// The votes of a pose, or 0 if they do not reach a floor.
    fn count(&mut self, cell: u32, heading: usize, floor: u16) -> u16 {
        let (task, rests) = (self.task, &self.sift.rests);
        let (x, y) = self.place(cell);
        let Share {
            outlook,
            entered,
            poses_evaluated,
            ..
        } = &mut *self.share;
        let (view, intervals) = (task.view(), &task.index.intervals);
        let block = y / SIDE * intervals.columns + x / SIDE;
        if *entered != Some(block) {
            outlook.enter((&view, &task.index.within.limits), intervals, block);
            *entered = Some(block);
        }
        *poses_evaluated += 1;
        let place = y % SIDE * SIDE + x % SIDE;
        let mut counts = [Count::default()];
        for (sector, rest) in rests[1..].iter().enumerate() {
            let program = &task.programs.leaf;
            program.add((outlook, &view), sector, (heading, 1), &mut counts);
            if counts[0].votes[place] + rest < floor {
                return 0;
            }
        }
        counts[0].votes[place]
    }

    /// Column and row of a cell.
    fn place(&self, cell: u32) -> (usize, usize) {
        let (cell, width) = (cell as usize, self.task.grid.width());
        (cell % width, cell / width)
    }

    /// The least votes that matter.
    fn floor(&mut self) -> u16 {
        let best = self.task.best.load(Ordering::Relaxed);
        self.share.collector.hear_of(best);
        self.share.collector.floor()
    }

    /// The most votes of the beams that are not in a sample.
    fn rest(&self, sample: &ScanProgram) -> u16 {
        (self.program.highest_possible() - sample.highest_possible()) as u16
    }

    /// Counting more poses of a heading one by one would take longer than sweeping
    /// the beams that are not in a sample.
    fn most_counts(&self, sample: &ScanProgram) -> usize {
        let (beams, cells) = (self.program.beams(), self.task.grid.cells().len());
        let cells = cells * (beams - sample.beams()) / beams.max(1);
        (cells / CELLS_A_COUNT).max(FEW_COUNTS)
    }
}

impl Share {
    /// Starts with nothing.
    fn start(&mut self, task: &Task<'_>, sift: &Sift) {
        self.outlook.prepare(task.grid, &task.space.directions);
        self.entered = None;
        self.seen.clear();
        self.kept.clear();
        self.least = (sift.first.highest_possible() * 3 / 4).max(1) as u16;
        self.sample = 0;
        self.collector.start(task.config);
        self.poses_evaluated = 0;
    }

    /// Keeps the poses of the field that have the least votes or more; none if that
    /// would be more than so many.
    fn keep(&mut self, most: usize) -> bool {
        let start = self.kept.len();
        for (first, cells) in (0..).step_by(STRETCH).zip(self.field.chunks(STRETCH)) {
            // Few stretches hold any, and a maximum is quick.
            if cells.iter().copied().fold(0, u16::max) < self.least {
                continue;
            }
            let poses = (first..).zip(cells);
            let poses = poses.map(|(cell, &votes)| Pose { votes, cell });
            let least = self.least;
            self.kept.extend(poses.filter(|pose| pose.votes >= least));
            if self.kept.len() - start > most {
                self.kept.truncate(start);
                return false;
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::super::SearchIndex;
    use super::super::task::Shared;
    use super::*;
    use crate::grid::{CellRules, Grid};
    use crate::instruction_set::InstructionSet;
    use crate::reference;
    use crate::scan::Scan;
    use crate::space::Space;
    use crate::testing::{
        any_dense_scan, any_limited_grid, any_scan, plain_votes_within, space_of,
    };

    /// Where everything is sifted, be there need or not.
    #[derive(Default)]
    struct Sifter {
        shared: Shared,
        sift: Sift,
        shares: Vec<Share>,
        found: VoteSet,
    }

    impl Sifter {
        /// The outcome where some pose is known to have `best` votes.
        fn count(
            &mut self,
            (instruction_set, threads): (InstructionSet, usize),
            (index, grid): (&SearchIndex, &Grid),
            scan: (&ScanProgram, &Space),
            (config, best): (CollectConfig, u16),
        ) -> &VoteSet {
            let shared = &mut self.shared;
            let task = Task::new(shared, instruction_set, index, grid, scan, config);
            task.best.store(best, Ordering::Relaxed);
            self.shares.resize_with(threads, Share::default);
            let scan = (&task, scan.0);
            let counted = self
                .sift
                .count(scan, &mut self.shares, &mut self.found, &|| false);
            assert!(counted.is_some());
            &self.found
        }
    }

    proptest! {
        #[test]
        fn what_is_sifted_is_what_the_reference_finds_whatever_was_sifted_before(
            worlds in vec((any_limited_grid(4), prop_oneof![2 => any_dense_scan(), 1 => any_scan()], 1usize..4), 1..4),
            floor_share in prop_oneof![1 => Just(1.0), 2 => 0.6..1.0f64], max_votes in 1u32..400, is_known: bool,
        ) {
            let config = CollectConfig { floor_share, max_votes, candidates: 0 };
            let mut sifter = Sifter::default();
            for ((grid, limits, headings), scan, threads) in worlds {
                let space = space_of(&grid, headings);
                let program = scan.program(&space);
                let plain = plain_votes_within(&limits, &grid, &program, &space, config);
                let index = SearchIndex::new(&grid, &space).within(limits);
                let best = if is_known { plain.best } else { 0 };
                for instruction_set in InstructionSet::available() {
                    let how = (instruction_set, threads);
                    let found = sifter.count(how, (&index, &grid), (&program, &space), (config, best));
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
    fn few_poses_are_counted_where_a_sample_of_the_beams_tells_the_best_one() {
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
        let config = CollectConfig {
            floor_share: 1.0,
            ..CollectConfig::default()
        };
        let how = (InstructionSet::best(), 1);
        let mut sifter = Sifter::default();
        let found = sifter.count(how, (&index, &grid), (&program, &space), (config, 0));
        let best = found.votes[0];
        assert_eq!((usize::from(best.x), usize::from(best.y)), (x, y));
        assert_eq!(best.heading, 0);
        // Hardly more than one at each heading.
        let counted = found.poses_evaluated;
        assert!(counted < 1000, "{counted} poses of 96 · 96 · 120");
    }
}
