//! Buffers of one thread's beam sampling, and what it keeps of what it swept.

use super::BeamSampling;
use crate::search::leaves::block_ranges::BlockRanges;
use crate::search::task::Task;
use crate::sweep;
use crate::votes::Collector;

/// Cells whose greatest votes are compared together.
const STRETCH: usize = 1024;

/// Buffers of one thread and what it finds, kept from scan to scan.
#[derive(Debug, Default)]
pub(in crate::search) struct Share {
    pub(super) sweep: sweep::Workspace,
    /// The votes of a sample at a heading.
    pub(super) field: Vec<u16>,
    pub(super) block_ranges: BlockRanges,
    /// The block of the ranges.
    pub(super) entered: Option<usize>,
    /// The headings of this thread.
    pub(super) sampled: Vec<SampledHeading>,
    /// Poses that have most votes of the sample, heading by heading.
    pub(super) kept: Vec<Pose>,
    /// They have this many or more.
    pub(super) least: u16,
    pub(super) collector: Collector,
    pub(super) poses_evaluated: u64,
}

impl Share {
    /// Starts with nothing.
    pub(super) fn start(&mut self, task: &Task<'_>, sampling: &BeamSampling) {
        self.block_ranges.prepare(task.grid, &task.space.directions);
        self.entered = None;
        self.sampled.clear();
        self.kept.clear();
        self.least = sampling.least.unwrap_or(1);
        self.collector.start(task.config);
        self.poses_evaluated = 0;
    }

    /// Records what was kept at a heading.
    pub(super) fn record_heading(&mut self, heading: usize) {
        self.sampled.push(SampledHeading {
            heading,
            end: self.kept.len(),
            below: self.least,
        });
    }

    /// Keeps the poses of the field that have the least votes or more; none if that
    /// would be more than this many.
    pub(super) fn keep(&mut self, most: usize) -> bool {
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

/// What the sample said of a heading.
#[derive(Debug, Clone, Copy)]
pub(super) struct SampledHeading {
    pub(super) heading: usize,
    /// The end of its poses among those kept.
    pub(super) end: usize,
    /// The others have fewer votes of the sample.
    pub(super) below: u16,
}

/// A cell, and the votes that it has of a sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pose {
    pub(super) votes: u16,
    pub(super) cell: u32,
}
