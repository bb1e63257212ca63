//! Samples of the beams, which may tell the poses that are wanted from most others.

use super::super::task::Task;
use crate::program::ScanProgram;

/// Beams of the smallest sample. After 20, more poses are as good as the best one, and
/// sweeping 40 takes longer.
const LEAST_BEAMS: usize = 30;

/// The other samples, in eighths of all beams.
const EIGHTHS: [usize; 6] = [2, 3, 4, 5, 6, 7];

const SAMPLES: usize = 1 + EIGHTHS.len();

/// Votes of the best pose, as a share of the highest possible, in scans of a world that is
/// as the map says. Where a scan's best pose has fewer, too small a sample may be chosen.
const EXPECTED_BEST: f64 = 0.98;

/// A sample that tells enough has this many times the part of the best pose's votes that
/// the poses which are wanted may lack: then some ten poses at each heading are left.
const LACKED: f64 = 4.0;

/// What sweeping no beam at all would take, as a share of sweeping all.
const SHARE_OF_NONE: f64 = 0.15;

/// The sample that is swept at all headings.
#[derive(Debug)]
pub(super) struct First {
    /// Its number.
    pub sample: usize,
    /// The least votes of it that a pose likely needs.
    pub least: u16,
}

/// Programs of samples of a scan's beams, from few beams to most.
#[derive(Debug, Default)]
pub(super) struct Samples {
    programs: [ScanProgram; SAMPLES],
    used: usize,
}

impl Samples {
    /// Takes samples of the beams of a scan, as evenly as they go: none of so few that
    /// they would say little.
    pub(super) fn make(&mut self, program: &ScanProgram) {
        let beams = program.beams();
        let eighths = EIGHTHS.map(|eighths| beams * eighths / 8);
        let sizes = eighths.into_iter().filter(|&size| size > LEAST_BEAMS);
        self.used = 0;
        for size in [LEAST_BEAMS].into_iter().chain(sizes) {
            if size < beams {
                self.programs[self.used].take_some(program, |beam| beam * size % beams < size);
                self.used += 1;
            }
        }
    }

    /// From few beams to most.
    pub(super) fn all(&self) -> &[ScanProgram] {
        &self.programs[..self.used]
    }
}

/// The least votes that matter by the floor's share, where the best pose has as many as
/// expected.
pub(super) fn expected_floor(task: &Task<'_>, program: &ScanProgram) -> u16 {
    let best = EXPECTED_BEST * f64::from(program.highest_possible());
    (best * task.config.floor_share) as u16
}

/// Whether the smallest sample is taken untried: it has twice the votes that poses may lack
/// which are wanted. Where that fails, the next one costs little more.
pub(super) fn is_least_enough(task: &Task<'_>) -> bool {
    let (beams, least) = (task.programs.beams as f64, LEAST_BEAMS as f64);
    let lacked = beams * (1.0 - task.config.floor_share);
    2.0 * least <= beams && 2.0 * lacked <= least
}

/// What counting every pose likely takes, as a share of brute force.
pub(in super::super) fn likely_cost(task: &Task<'_>) -> f64 {
    let part = if is_least_enough(task) {
        LEAST_BEAMS as f64 / task.programs.beams as f64
    } else {
        LACKED * (1.0 - task.config.floor_share)
    };
    (SHARE_OF_NONE + (1.0 - SHARE_OF_NONE) * part).min(1.0)
}
