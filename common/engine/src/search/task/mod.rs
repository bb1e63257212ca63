//! Data that the threads of a search share, and the limits of its cost.
//!
//! A task does not change while it is searched, except for bounds and the best pose so far,
//! which only let threads skip work.

pub(crate) mod budget;
pub(crate) mod lead;

use std::sync::atomic::AtomicU16;

use crate::grid::Grid;
use crate::program::ScanProgram;
use crate::search::bounds::interval_bounds::IntervalProgram;
use crate::search::bounds::set_program::SetProgram;
use crate::search::index::SearchIndex;
use crate::search::leaves::block_ranges::View;
use crate::search::leaves::leaf::LeafProgram;
use crate::search::task::lead::Lead;
use crate::simd::Simd;
use crate::space::Space;
use crate::votes::{CollectConfig, VoteShare};

/// A scan to be searched on a map.
pub(crate) struct Task<'a> {
    pub index: &'a SearchIndex,
    pub grid: &'a Grid,
    pub program: &'a ScanProgram,
    pub space: &'a Space,
    pub config: CollectConfig,
    pub shared: &'a Shared,
    /// Best pose so far, found by any thread on any map.
    lead: &'a Lead,
    /// Votes of a pose with which every beam agrees fully.
    possible: u16,
    /// Cost of counting every pose with all beams on one thread.
    pub brute_force: f64,
}

/// End of a part of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    /// All poses that matter were found, except for those in blocks that were left when the
    /// work limit was reached.
    Done,
    /// It was asked to stop.
    Stopped,
    /// Counting every pose would take less than what is left.
    Hopeless,
}

/// A scan program laid out for each way in which blocks are bounded and counted, and the bounds of
/// coarse blocks; kept from scan to scan.
#[derive(Debug, Default)]
pub(crate) struct Shared {
    pub sets: SetProgram,
    pub interval: IntervalProgram,
    pub leaf: LeafProgram,
    pub simd: Simd,
    /// Bound of each coarse block in which poses are searched.
    pub coarse_bounds: Vec<AtomicU16>,
    /// Bound of each coarse block in each chunk of headings.
    by_chunk: Vec<AtomicU16>,
}

impl<'a> Task<'a> {
    pub(crate) fn new(
        shared: &'a mut Shared,
        simd: Simd,
        index: &'a SearchIndex,
        grid: &'a Grid,
        (program, space): (&'a ScanProgram, &'a Space),
        (config, lead): (CollectConfig, &'a Lead),
    ) -> Self {
        let (directions, bins) = (&space.directions, &index.bins);
        shared.simd = simd;
        shared.sets.make(program, directions, bins, simd);
        shared.leaf.make(program, directions, simd);
        let ordered = (program, shared.leaf.order());
        shared.interval.make(ordered, directions, bins, simd);
        let chunks = index.headings(directions.count()).count();
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
            program,
            space,
            config,
            shared,
            lead,
            possible: program.highest_possible() as u16,
            brute_force: budget::of_brute_force(grid, program, space),
        }
    }

    /// Returns the same task with another lead; it is never given up.
    #[cfg(all(test, loom))]
    pub(crate) fn led_by(&self, lead: &'a Lead) -> Self {
        Task {
            lead,
            brute_force: f64::INFINITY,
            ..*self
        }
    }

    /// Returns the votes of the best pose so far or, if that is on another map, the least
    /// number that is as good here.
    pub(crate) fn best(&self) -> u16 {
        self.lead.on(self.possible)
    }

    /// Takes the votes of a pose of this map.
    pub(crate) fn raise_best(&self, votes: u16) {
        self.lead.raise(VoteShare::new(votes, self.possible));
    }

    /// Returns the map and tables for following rays.
    pub(crate) fn view(&self) -> View<'a> {
        View {
            grid: self.grid,
            obstacles: &self.index.obstacles,
            bins: &self.index.bins,
            directions: &self.space.directions,
        }
    }

    /// Returns the bounds of a coarse block in each chunk of headings.
    pub(crate) fn by_chunk(&self, block: usize) -> &'a [AtomicU16] {
        let Shared {
            coarse_bounds,
            by_chunk,
            ..
        } = self.shared;
        let chunks = by_chunk.len() / coarse_bounds.len();
        &by_chunk[block * chunks..][..chunks]
    }

    /// Returns the headings that are searched.
    pub(crate) fn searched(&self) -> impl Iterator<Item = usize> + Clone {
        let limits = &self.index.limits;
        (0..self.space.directions.count()).filter(|&heading| limits.hold_heading(heading))
    }

    /// Returns a bit for each heading that is searched, a word for each chunk.
    pub(crate) fn headings(&self) -> impl Iterator<Item = u128> {
        self.index.headings(self.space.directions.count())
    }
}
