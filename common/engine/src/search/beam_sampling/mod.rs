//! Counting every pose, where bounds do not distinguish blocks: few beams separate most
//! poses from the best one.
//!
//! In clutter most poses have half of the votes that are possible, but hardly one has
//! nearly all of them, and that shows after few beams. So a sample of the beams is swept
//! at every heading, the poses with most of its votes are kept, and at each heading the
//! first of them is counted with all beams: one of these is the best pose of all. What
//! was not kept cannot reach the floor then, as a rule, whatever the other beams say, and
//! of what was kept little is left to count. The lower the floor, the larger the sample
//! must be: a few beams for the best pose alone, most of them for candidates.
//!
//! Headings at which that is not certain are swept again with all beams.

mod share;

use std::ops::Range;

use messages::Vote;

use crate::accumulator::Query;
use crate::program::ScanProgram;
use crate::search::bounds::sectors;
use crate::search::index::intervals::SIDE;
use crate::search::leaves::leaf::Count;
use crate::search::task::Task;
use crate::threads;
use crate::votes::VoteSet;
pub(in crate::search) use share::Share;
use share::{Pose, SampledHeading};

/// Beams of a sample where hardly more than the best pose is wanted. After 20, more poses
/// are as good as the best one, and sweeping 40 takes longer.
const FEW_BEAMS: usize = 30;

/// Beams of a sample, in quarters of all, where poses that lack some of the best one's
/// votes are wanted. Half of the beams say too little of a floor at 0.85, and what seven
/// eighths spare is not worth sweeping them.
const MAX_BEAMS_QUARTERS: usize = 3;

/// Votes of the best pose, as a share of the highest possible, in scans of a world that is
/// as the map says. Where a scan's best pose has fewer, the sample may say too little.
const EXPECTED_BEST: f64 = 0.98;

/// What sweeping no beam at all would take, as a share of sweeping all.
const SHARE_OF_NONE: f64 = 0.15;

/// One pose is kept for this number of cells at a heading, and at least this many poses.
const CELLS_A_KEPT: usize = 1024;
const MIN_KEPT: usize = 64;

/// The least votes of what is kept rise by this part of the highest possible where it
/// is more, and fall where it is less than an eighth.
const STEP: u32 = 64;

/// Sweeping all beams over this many cells takes no longer than counting one pose by
/// itself. A few poses are counted on any map.
const CELLS_A_COUNT: usize = 2048;
const FEW_COUNTS: usize = 4;

/// A sample of a scan program's beams, kept from scan to scan.
#[derive(Debug, Default)]
pub(in crate::search) struct BeamSampling {
    /// Some of the beams, as evenly as they go.
    sample: ScanProgram,
    /// The least votes of the sample that a pose likely needs; `None` where it says too
    /// little, and all beams are swept.
    least: Option<u16>,
    /// The most votes of each sector and those after it; 0 at the end.
    rests: Vec<u16>,
    /// All beams may vote.
    all: Vec<u64>,
}

impl BeamSampling {
    /// Finds the poses with the most votes, on as many threads as there are shares;
    /// `None` if `stop` said so before the end.
    pub(in crate::search) fn count(
        &mut self,
        (task, program): (&Task<'_>, &ScanProgram),
        shares: &mut [Share],
        found: &mut VoteSet,
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        self.make(task, program);
        let (sampling, threads) = (&*self, shares.len());
        let what = (task, program, sampling);
        let sampled = threads::run(shares, stop, |thread, share, stop| {
            share.start(task, sampling);
            let mut sampler = SamplingThread::new(what, share, stop);
            let mut own = task.searched().skip(thread).step_by(threads);
            own.try_for_each(|heading| sampler.sample(heading))
                .ok_or(())
        });
        sampled.ok()?;
        let counted = threads::run(shares, stop, |_, share, stop| {
            SamplingThread::new(what, share, stop)
                .count_sampled()
                .ok_or(())
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
        let size = sample_beams(task);
        self.sample
            .take_some(program, |beam| beam * size % beams < size);
        self.least = self.least_of_sample(task, program);
        self.all.clear();
        self.all.resize(beams, 1);
        let (order, sectors) = (task.programs.leaf.order(), sectors::count(beams));
        self.rests.clear();
        self.rests.resize(sectors + 1, 0);
        for sector in (0..sectors).rev() {
            let sector_beams = order[sectors::beams(sector, beams)].iter();
            let votes: u16 = sector_beams.map(|&beam| program.peak(beam)).sum();
            self.rests[sector] = self.rests[sector + 1] + votes;
        }
    }

    fn least_of_sample(&self, task: &Task<'_>, program: &ScanProgram) -> Option<u16> {
        let (all, some) = (program.highest_possible(), self.sample.highest_possible());
        if is_best_enough(task) {
            return Some((some * 3 / 4) as u16);
        }
        let floor = EXPECTED_BEST * f64::from(all) * task.config.floor_share;
        let rest = program.most_votes() - some;
        let least = (floor as u32).saturating_sub(rest);
        // In clutter most poses have about half of the votes.
        (least > some / 2).then_some(least as u16)
    }
}

/// Whether poses that are wanted lack hardly any of the best one's votes: at most half of
/// what few beams have, of at least twice as many.
fn is_best_enough(task: &Task<'_>) -> bool {
    let (beams, few) = (task.programs.beams as f64, FEW_BEAMS as f64);
    let lacked = beams * (1.0 - task.config.floor_share);
    2.0 * few <= beams && 2.0 * lacked <= few
}

fn sample_beams(task: &Task<'_>) -> usize {
    match is_best_enough(task) {
        true => FEW_BEAMS,
        false => task.programs.beams * MAX_BEAMS_QUARTERS / 4,
    }
}

/// What counting every pose likely takes, as a share of brute force.
pub(in crate::search) fn likely_cost(task: &Task<'_>) -> f64 {
    let part = sample_beams(task) as f64 / task.programs.beams.max(1) as f64;
    SHARE_OF_NONE + (1.0 - SHARE_OF_NONE) * part
}

/// One thread of it.
struct SamplingThread<'a> {
    task: &'a Task<'a>,
    program: &'a ScanProgram,
    sampling: &'a BeamSampling,
    share: &'a mut Share,
    stop: &'a dyn Fn() -> bool,
}

impl<'a> SamplingThread<'a> {
    fn new(
        (task, program, sampling): (&'a Task<'a>, &'a ScanProgram, &'a BeamSampling),
        share: &'a mut Share,
        stop: &'a dyn Fn() -> bool,
    ) -> Self {
        SamplingThread {
            task,
            program,
            sampling,
            share,
            stop,
        }
    }

    /// Keeps the poses that have most votes of the sample at a heading, and
    /// counts the first of them.
    fn sample(&mut self, heading: usize) -> Option<()> {
        let task = self.task;
        let most = (task.grid.cells().len() / CELLS_A_KEPT).max(MIN_KEPT);
        let start = self.share.kept.len();
        if self.sampling.least.is_none() {
            self.share.record_heading(heading);
            return Some(());
        }
        let sample = &self.sampling.sample;
        let step = (sample.highest_possible() / STEP).max(1) as u16;
        self.sweep(sample, heading)?;
        while !self.share.keep(most) {
            self.share.least += step;
        }
        self.share.record_heading(heading);
        let kept = &self.share.kept[start..];
        if kept.len() < most / 8 {
            self.share.least = self.share.least.saturating_sub(step).max(1);
        }
        if let Some(&Pose { cell, .. }) = kept.iter().max_by_key(|pose| pose.votes) {
            let floor = task.best();
            let intensity = self.count(cell, heading, floor);
            task.raise_best(intensity);
        }
        Some(())
    }

    /// Takes the poses that reach the floor, now that the best one is likely known.
    fn count_sampled(&mut self) -> Option<()> {
        // What the beams give at most that are not in the sample.
        let sampled = self.sampling.sample.highest_possible();
        let rest = (self.program.most_votes() - sampled) as u16;
        let rest = self.sampling.least.map_or(u16::MAX, |_| rest);
        let most = self.most_counts();
        let mut start = 0;
        for i in 0..self.share.sampled.len() {
            let SampledHeading {
                heading,
                end,
                below,
            } = self.share.sampled[i];
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

    /// Takes the poses of a heading that reach the floor, by all beams.
    fn take_anew(&mut self, heading: usize) -> Option<()> {
        self.sweep(self.program, heading)?;
        self.floor();
        let Share {
            field, collector, ..
        } = &mut *self.share;
        collector.take_field(field, self.task.grid.width(), heading as u16);
        let best = collector.best_taken();
        self.task.raise_best(best);
        self.share.poses_evaluated += self.share.field.len() as u64;
        Some(())
    }

    /// Takes the poses that reach the floor of those kept, which have this many votes of
    /// a sample.
    fn take_kept(&mut self, kept: Range<usize>, least: u16, heading: usize) {
        for i in kept {
            let Pose { votes, cell } = self.share.kept[i];
            if votes < least {
                continue;
            }
            let floor = self.floor();
            let vote = self.vote(cell, heading, floor);
            self.share.collector.take(vote);
            self.task.raise_best(vote.intensity);
        }
    }

    /// Fills in the votes of some beams for all poses that are searched at a heading.
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
        let simd = programs.simd;
        let sweeps = index.sweeps(self.task.grid);
        sweeps.fill(simd, query, sweep, field, self.stop)?;
        index.within.limits.clear(field, heading);
        Some(())
    }

    /// A pose and its votes, or 0 if they do not reach a floor.
    fn vote(&mut self, cell: u32, heading: usize, floor: u16) -> Vote {
        let (x, y) = self.place(cell);
        Vote {
            x: x as u16,
            y: y as u16,
            heading: heading as u16,
            intensity: self.count(cell, heading, floor),
        }
    }

    /// The votes of a pose, or 0 if they do not reach a floor.
    fn count(&mut self, cell: u32, heading: usize, floor: u16) -> u16 {
        let (task, rests) = (self.task, &self.sampling.rests);
        let (x, y) = self.place(cell);
        let Share {
            block_ranges,
            entered,
            poses_evaluated,
            ..
        } = &mut *self.share;
        let (view, intervals) = (task.view(), &task.index.intervals);
        let block = y / SIDE * intervals.columns + x / SIDE;
        // Of an index that was read from a file nobody knows that blocks hold all cells in
        // which poses are searched.
        if !intervals.ids.holds(block) {
            return 0;
        }
        if *entered != Some(block) {
            block_ranges.enter((&view, &task.index.within.limits), intervals, block);
            *entered = Some(block);
        }
        *poses_evaluated += 1;
        let place = y % SIDE * SIDE + x % SIDE;
        let mut counts = [Count::default()];
        for (sector, rest) in rests[1..].iter().enumerate() {
            let program = &task.programs.leaf;
            let beams = (sector, &self.sampling.all[..]);
            program.add((block_ranges, &view), beams, (heading, 1), &mut counts);
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
        self.share.collector.raise_best(self.task.best());
        self.share.collector.floor()
    }

    /// Counting more poses of a heading one by one would take longer than sweeping
    /// all beams.
    fn most_counts(&self) -> usize {
        (self.task.grid.cells().len() / CELLS_A_COUNT).max(FEW_COUNTS)
    }
}

#[cfg(test)]
mod tests;
