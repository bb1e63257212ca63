//! The intensity field at one heading, by sweeps over the whole grid.

use super::bits::BitGrid;
use super::kernel::{self, Stretch, Sum};
use super::merge;
use super::plan::{GROUPS, Plan};
use super::wide::{self, Rows};
use crate::accumulator::{Accumulator, Query};
use crate::grid::Grid;
use crate::instruction_set::InstructionSet;
use crate::simd::bytes::Lanes;
use crate::simd::{Kernel, Set, Simd};

/// Number of rows that all batches pass before the next ones, so that their sums stay in
/// the second-level cache meanwhile.
const TILE_ROWS: usize = 32;

/// Buffers of a sweep other than the field; kept from scan to scan, for any map, so that
/// they are allocated only once.
#[derive(Debug, Default)]
pub struct Workspace {
    plan: Plan,
    scratch: Scratch,
    bytes: Sums<u8>,
    words: Sums<u16>,
}

/// Rows of cells in work: those of a batch of beams, and of a wide beam.
#[derive(Debug, Default)]
struct Scratch {
    store: Vec<Line>,
    wide: Rows,
}

/// A cache line.
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
struct Line([u8; 64]);

/// Sums of votes: along y and, transposed, along x.
#[derive(Debug, Default)]
struct Sums<S> {
    rows: Vec<S>,
    columns: Vec<S>,
}

/// A grid prepared for sweeps that vote.
#[derive(Debug, Clone)]
pub struct FieldSweep {
    along_y: BitGrid,
    along_x: BitGrid,
}

impl FieldSweep {
    /// Prepares a grid.
    #[must_use]
    pub fn new(grid: &Grid) -> Self {
        FieldSweep {
            along_y: BitGrid::new(grid, false),
            along_x: BitGrid::new(grid, true),
        }
    }

    /// Returns an accumulator on the grid with the best instruction set.
    #[must_use]
    pub fn accumulator(&self) -> Sweep<'_> {
        self.accumulator_with(InstructionSet::best())
    }

    /// Does the same with a given instruction set.
    ///
    /// # Panics
    /// If this processor does not have it.
    #[must_use]
    pub fn accumulator_with(&self, instruction_set: InstructionSet) -> Sweep<'_> {
        Sweep {
            sweeps: self,
            simd: Simd::new(instruction_set),
            workspace: Workspace::default(),
        }
    }

    /// Fills in the intensities of all cells like [`Accumulator::fill`], in a
    /// workspace that may have served another grid.
    pub(crate) fn fill(
        &self,
        simd: Simd,
        query: Query<'_>,
        workspace: &mut Workspace,
        field: &mut Vec<u16>,
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        simd.run(Filling {
            job: Job {
                sweeps: self,
                query,
                stop,
            },
            workspace,
            field,
        })
    }

    /// Size of the prepared grid in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.along_y.bytes() + self.along_x.bytes()
    }
}

/// Counts votes by one line sweep for each beam, at the same cost for any boundary.
#[derive(Debug)]
pub struct Sweep<'a> {
    sweeps: &'a FieldSweep,
    simd: Simd,
    workspace: Workspace,
}

impl Accumulator for Sweep<'_> {
    fn fill(
        &mut self,
        query: Query<'_>,
        field: &mut Vec<u16>,
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        let workspace = &mut self.workspace;
        self.sweeps.fill(self.simd, query, workspace, field, stop)
    }
}

/// One scan at one heading.
struct Job<'a> {
    sweeps: &'a FieldSweep,
    query: Query<'a>,
    stop: &'a dyn Fn() -> bool,
}

/// Kernel that fills in the field of a job.
struct Filling<'a> {
    job: Job<'a>,
    workspace: &'a mut Workspace,
    field: &'a mut Vec<u16>,
}

impl Kernel for Filling<'_> {
    type Result = Option<()>;

    #[inline(always)]
    fn run<S: Set>(self, set: S) -> Option<()> {
        self.job.fill(set, self.workspace, self.field)
    }
}

impl Job<'_> {
    #[inline(always)]
    fn fill<S: Set>(&self, set: S, workspace: &mut Workspace, field: &mut Vec<u16>) -> Option<()> {
        let Workspace {
            plan,
            scratch,
            bytes,
            words,
        } = workspace;
        let sides = (self.sweeps.along_y.columns, self.sweeps.along_y.rows);
        plan.make(set, self.query, sides);
        scratch.store.clear();
        scratch.store.resize(plan.lines, Line([0; 64]));
        field.resize(sides.0 * sides.1, 0);
        // Few beams have so few votes that bytes hold their sums.
        if self.query.program.highest_possible() <= 255 && plan.wide.is_empty() {
            self.sum_up(set, plan, scratch, bytes, field)
        } else {
            self.sum_up(set, plan, scratch, words, field)
        }
    }

    #[inline(always)]
    fn sum_up<S: Set, M: Sum>(
        &self,
        set: S,
        plan: &Plan,
        scratch: &mut Scratch,
        sums: &mut Sums<M>,
        field: &mut [u16],
    ) -> Option<()> {
        let Sums { rows, columns } = sums;
        for (sums, bits) in [
            (&mut *rows, &self.sweeps.along_y),
            (columns, &self.sweeps.along_x),
        ] {
            // Whole squares are merged.
            let rows = bits.rows.next_multiple_of(merge::SQUARE);
            sums.resize(rows * stride(bits), M::default());
        }
        self.sweep_axis(set, plan, scratch, columns, 2)?;
        self.sweep_axis(set, plan, scratch, rows, 0)?;
        let rows = merge::Plane {
            sums: rows,
            stride: stride(&self.sweeps.along_y),
        };
        let columns = merge::Plane {
            sums: columns,
            stride: stride(&self.sweeps.along_x),
        };
        M::merge(&self.sweeps.along_y, &rows, &columns, field);
        Some(())
    }

    /// Sums up the votes along one axis: those of group `first_group` and the next.
    #[inline(always)]
    fn sweep_axis<S: Set, M: Sum>(
        &self,
        set: S,
        plan: &Plan,
        Scratch { store, wide }: &mut Scratch,
        sums: &mut [M],
        first_group: usize,
    ) -> Option<()> {
        let bits = if first_group == 0 {
            &self.sweeps.along_y
        } else {
            &self.sweeps.along_x
        };
        let mut adds = false;
        for batches in &plan.batches[first_group..first_group + GROUPS / 2] {
            for start in (0..bits.rows).step_by(TILE_ROWS) {
                if (self.stop)() {
                    return None;
                }
                for (i, batch) in batches.iter().enumerate() {
                    let mut stretch = Stretch {
                        bits,
                        steps: start..(start + TILE_ROWS).min(bits.rows),
                        sums,
                        stride: stride(bits),
                        adds: adds || i > 0,
                        store: bytemuck::cast_slice_mut(store),
                    };
                    let beams = &plan.beams[batch.beams.clone()];
                    match S::Bytes::AT_A_TIME {
                        3 => kernel::sweep::<S, M, 3>(set, &mut stretch, beams),
                        _ => kernel::sweep::<S, M, 1>(set, &mut stretch, beams),
                    }
                }
            }
            adds |= !batches.is_empty();
        }
        if !adds {
            sums.fill(M::default());
        }
        for &beam in &plan.wide {
            let (direction, taper) = self.query.beam(beam);
            if direction.x_major == (first_group != 0) {
                wide::add(bits, direction, &taper, sums, stride(bits), wide);
            }
        }
        Some(())
    }
}

/// Number of cells from one row of sums to the next.
pub(super) fn stride(bits: &BitGrid) -> usize {
    bits.columns.next_multiple_of(64)
}
