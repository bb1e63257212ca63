//! What the threads of a search share, and what it may cost.
//!
//! A task does not change while it is searched but for bounds and the best pose so far,
//! which only let threads skip work.

pub(in crate::search) mod budget;
pub(in crate::search) mod lead;

use std::sync::atomic::AtomicU16;

use crate::grid::Grid;
use crate::program::ScanProgram;
use crate::search::bounds::interval_program::IntervalProgram;
use crate::search::bounds::set_program::SetProgram;
use crate::search::index::SearchIndex;
use crate::search::leaves::block_ranges::View;
use crate::search::leaves::leaf::LeafProgram;
use crate::search::task::budget::Cost;
use crate::search::task::lead::Lead;
use crate::simd::Simd;
use crate::space::Space;
use crate::votes::{CollectConfig, VoteShare};

/// What is searched: a scan on a map.
pub(in crate::search) struct Task<'a> {
    pub index: &'a SearchIndex,
    pub grid: &'a Grid,
    pub space: &'a Space,
    pub config: CollectConfig,
    pub programs: &'a Programs,
    /// The bound of each coarse block in which poses are searched.
    pub coarse_bounds: &'a [AtomicU16],
    /// The same, chunk by chunk of headings.
    by_chunk: &'a [AtomicU16],
    /// The best pose so far, whoever found it, and on whichever map.
    lead: &'a Lead,
    /// What a pose would have if every beam agreed fully.
    possible: u16,
    /// What counting every pose with all beams would cost one thread.
    pub brute_force: Cost,
}

/// How a part of a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::search) enum End {
    /// With the poses that matter, but for those in blocks that were left where it took
    /// more work than it may.
    Done,
    /// It was asked to stop.
    Stopped,
    /// Counting every pose would take less than what is left.
    Hopeless,
}

/// What the threads of a search share, kept from scan to scan.
#[derive(Debug, Default)]
pub(in crate::search) struct Shared {
    pub programs: Programs,
    coarse_bounds: Vec<AtomicU16>,
    by_chunk: Vec<AtomicU16>,
}

/// A scan program laid out for each way in which blocks are bounded and counted.
#[derive(Debug, Default)]
pub(in crate::search) struct Programs {
    pub sets: SetProgram,
    pub interval: IntervalProgram,
    pub leaf: LeafProgram,
    pub beams: usize,
    pub simd: Simd,
}

impl Programs {
    fn make(&mut self, simd: Simd, index: &SearchIndex, program: &ScanProgram, space: &Space) {
        let (directions, steps) = (&space.directions, &index.steps);
        self.sets.make(program, directions, steps, simd);
        self.leaf.make(program, directions, simd);
        let (shifts, ordered) = (self.sets.shifts(), (program, self.leaf.order()));
        self.interval.make(ordered, directions, steps, shifts, simd);
        self.beams = program.beams();
        self.simd = simd;
    }
}

impl<'a> Task<'a> {
    pub(in crate::search) fn new(
        shared: &'a mut Shared,
        simd: Simd,
        index: &'a SearchIndex,
        grid: &'a Grid,
        (program, space): (&ScanProgram, &'a Space),
        (config, lead): (CollectConfig, &'a Lead),
    ) -> Self {
        shared.programs.make(simd, index, program, space);
        let chunks = index.within.headings(space.directions.count()).count();
        for (bounds, count) in [
            (&mut shared.coarse_bounds, index.coarse.blocks()),
            (&mut shared.by_chunk, index.coarse.blocks() * chunks),
        ] {
            bounds.clear();
            bounds.resize_with(count, AtomicU16::default);
        }
        Task {
            index,
            grid,
            space,
            config,
            programs: &shared.programs,
            coarse_bounds: &shared.coarse_bounds,
            by_chunk: &shared.by_chunk,
            lead,
            possible: program.highest_possible() as u16,
            brute_force: Cost::of_brute_force(simd.set(), grid, program, space),
        }
    }

    /// The same task, of which nothing was found so far, and which is not given up.
    #[cfg(all(test, loom))]
    pub(in crate::search) fn anew(&self, lead: &'a Lead) -> Self {
        Task {
            lead,
            brute_force: Cost(f64::INFINITY),
            ..*self
        }
    }

    /// The votes of the best pose so far; where that is one of another map, the least number
    /// that is as good here.
    pub(in crate::search) fn best(&self) -> u16 {
        self.lead.on(self.possible)
    }

    /// Takes the votes of a pose of this map.
    pub(in crate::search) fn raise_best(&self, votes: u16) {
        self.lead.raise(VoteShare::new(votes, self.possible));
    }

    /// What poses of the map see.
    pub(in crate::search) fn view(&self) -> View<'a> {
        View {
            grid: self.grid,
            obstacles: &self.index.obstacles,
            steps: &self.index.steps,
            directions: &self.space.directions,
        }
    }

    /// The bounds of a coarse block in each chunk of headings.
    pub(in crate::search) fn by_chunk(&self, block: usize) -> &'a [AtomicU16] {
        let chunks = self.by_chunk.len() / self.coarse_bounds.len();
        &self.by_chunk[block * chunks..][..chunks]
    }

    /// The headings that are searched.
    pub(in crate::search) fn searched(&self) -> impl Iterator<Item = usize> + Clone {
        let limits = &self.index.within.limits;
        (0..self.space.directions.count()).filter(|&heading| limits.hold_heading(heading))
    }

    /// The headings that are searched, a word a chunk.
    pub(in crate::search) fn headings(&self) -> impl Iterator<Item = u128> {
        self.index.within.headings(self.space.directions.count())
    }
}
