//! The intensity field at one heading, by sweeps over the whole grid.

use super::bits::BitGrid;
use super::kernel::{self, Stretch, Sum};
use super::lanes::{self, Lanes};
use super::merge;
use super::plan::{GROUPS, Plan};
use super::wide::{self, Rows};
use crate::accumulator::{Accumulator, Query};
use crate::grid::Grid;
use crate::instruction_set::InstructionSet;

/// Rows that all batches pass before the next ones: their sums stay in the
/// second cache meanwhile.
const TILE_ROWS: usize = 32;

/// What a sweep needs beside the field; kept from scan to scan, of any map, so
/// that nothing is allocated but once.
#[derive(Debug, Default)]
pub struct Workspace {
    plan: Plan,
    room: Room,
    bytes: Sums<u8>,
    words: Sums<u16>,
}

/// Rows of cells under way: those of a batch of beams, and of a wide beam.
#[derive(Debug, Default)]
struct Room {
    store: Vec<Line>,
    wide: Rows,
}

/// A cache line, which is read and written through pointers only.
#[derive(Debug, Clone, Copy)]
#[expect(dead_code, reason = "it is the size and the alignment that matter")]
#[repr(align(64))]
struct Line([u8; 64]);

/// The sums of votes: along y and, lying on its side, along x.
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

    /// An accumulator on the grid with the best instruction set.
    #[must_use]
    pub fn accumulator(&self) -> Sweep<'_> {
        self.accumulator_with(InstructionSet::best())
    }

    /// The same with a certain instruction set.
    ///
    /// # Panics
    /// If this processor does not have it.
    #[must_use]
    pub fn accumulator_with(&self, instruction_set: InstructionSet) -> Sweep<'_> {
        Sweep {
            sweeps: self,
            instruction_set: instruction_set.checked(),
            workspace: Workspace::default(),
        }
    }

    /// Fills in the intensities of all cells like [`Accumulator::fill`], in a
    /// workspace that may have served another grid.
    ///
    /// # Panics
    /// If this processor does not have the instruction set.
    pub fn fill(
        &self,
        instruction_set: InstructionSet,
        query: Query<'_>,
        workspace: &mut Workspace,
        field: &mut Vec<u16>,
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        let sweeps = self;
        let job = Job {
            sweeps,
            query,
            stop,
        };
        match instruction_set.checked() {
            // SAFETY: the instruction set was checked.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => unsafe { job.run_avx512(workspace, field) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => unsafe { job.run_avx2(workspace, field) },
            // SAFETY: every processor has it.
            _ => unsafe { job.run_with::<lanes::Portable, 1>(workspace, field) },
        }
    }

    /// Bytes that the prepared grid takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.along_y.bytes() + self.along_x.bytes()
    }
}

/// Counts votes by one line sweep for each beam, whatever the boundary.
#[derive(Debug)]
pub struct Sweep<'a> {
    sweeps: &'a FieldSweep,
    instruction_set: InstructionSet,
    workspace: Workspace,
}

impl Accumulator for Sweep<'_> {
    fn fill(
        &mut self,
        query: Query<'_>,
        field: &mut Vec<u16>,
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        let (set, workspace) = (self.instruction_set, &mut self.workspace);
        self.sweeps.fill(set, query, workspace, field, stop)
    }
}

/// One scan at one heading.
struct Job<'a> {
    sweeps: &'a FieldSweep,
    query: Query<'a>,
    stop: &'a dyn Fn() -> bool,
}

impl Job<'_> {
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
    unsafe fn run_avx512(&self, workspace: &mut Workspace, field: &mut Vec<u16>) -> Option<()> {
        unsafe { self.run_with::<lanes::Avx512, 5>(workspace, field) }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    unsafe fn run_avx2(&self, workspace: &mut Workspace, field: &mut Vec<u16>) -> Option<()> {
        unsafe { self.run_with::<lanes::Avx2, 3>(workspace, field) }
    }

    #[inline(always)]
    unsafe fn run_with<L: Lanes, const N: usize>(
        &self,
        workspace: &mut Workspace,
        field: &mut Vec<u16>,
    ) -> Option<()> {
        let Workspace {
            plan,
            room,
            bytes,
            words,
        } = workspace;
        let sides = (self.sweeps.along_y.columns, self.sweeps.along_y.rows);
        plan.make::<L>(self.query, sides);
        room.store.clear();
        room.store.resize(plan.lines, Line([0; 64]));
        field.resize(sides.0 * sides.1, 0);
        // Few beams have so few votes that bytes hold their sums.
        if self.query.program.highest_possible() <= 255 && plan.wide.is_empty() {
            unsafe { self.fill::<L, u8, N>(plan, room, bytes, field) }
        } else {
            unsafe { self.fill::<L, u16, N>(plan, room, words, field) }
        }
    }

    #[inline(always)]
    unsafe fn fill<L: Lanes, S: Sum, const N: usize>(
        &self,
        plan: &Plan,
        room: &mut Room,
        sums: &mut Sums<S>,
        field: &mut [u16],
    ) -> Option<()> {
        let Sums { rows, columns } = sums;
        for (sums, bits) in [
            (&mut *rows, &self.sweeps.along_y),
            (columns, &self.sweeps.along_x),
        ] {
            // Whole squares are merged.
            let rows = bits.rows.next_multiple_of(merge::SQUARE);
            sums.resize(rows * stride(bits), S::default());
        }
        unsafe {
            self.sweep_axis::<L, S, N>(plan, room, columns, 2)?;
            self.sweep_axis::<L, S, N>(plan, room, rows, 0)?;
        }
        let rows = merge::Plane {
            sums: rows,
            stride: stride(&self.sweeps.along_y),
        };
        let columns = merge::Plane {
            sums: columns,
            stride: stride(&self.sweeps.along_x),
        };
        S::merge(&self.sweeps.along_y, &rows, &columns, field);
        Some(())
    }

    /// Sums up the votes along one axis: those of a group and the next.
    #[inline(always)]
    unsafe fn sweep_axis<L: Lanes, S: Sum, const N: usize>(
        &self,
        plan: &Plan,
        Room { store, wide }: &mut Room,
        sums: &mut [S],
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
                        store: store.as_mut_ptr().cast(),
                    };
                    unsafe {
                        kernel::sweep::<L, S, N>(&mut stretch, &plan.beams[batch.beams.clone()]);
                    }
                }
            }
            adds |= !batches.is_empty();
        }
        if !adds {
            sums.fill(S::default());
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

/// Cells from one row of sums to the next.
pub(super) fn stride(bits: &BitGrid) -> usize {
    bits.columns.next_multiple_of(64)
}
