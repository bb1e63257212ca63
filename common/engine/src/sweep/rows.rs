//! The rows of a sweep: steps left in cells, and the votes for them.
//!
//! All loops are plain: the compiler vectorizes them for the instruction set of the kernel.

use crate::grid::Cell;
use crate::simd::{LANES, Set, TABLE};

/// Steps left in a row of cells and in the row ahead of it, of all beams along a sense of an axis.
/// Before and after each row is a cell off the map, which sees nothing.
#[derive(Debug, Default)]
pub(super) struct Rows<N>([Vec<N>; 2]);

impl<N: Steps> Rows<N> {
    /// Starts at cells that see nothing.
    pub(super) fn start(&mut self, cells: usize) {
        for row in &mut self.0 {
            row.clear();
            row.resize(cells, N::NONE);
        }
    }

    /// Moves a beam's row a step on and adds the beam's votes. The row begins at `row` in those of all
    /// beams, `end` steps are left in an obstacle, and `used` entries of the profile count.
    #[inline(always)]
    pub(super) fn move_on<S: Set>(
        &mut self,
        set: S,
        (row, step, shift): (usize, usize, i64),
        (cells, end): (&[Cell], u16),
        (profile, used): (&[u8], usize),
        votes: &mut [u8],
    ) {
        let [here, ahead] = &mut self.0;
        let (here, ahead) = if step.is_multiple_of(2) {
            (here, ahead)
        } else {
            (ahead, here)
        };
        let here = &mut here[row + 1..][..cells.len()];
        let ahead = &ahead[row.wrapping_add_signed(1 + shift as isize)..][..cells.len()];
        let end = N::of(end);
        for ((here, &ahead), &cell) in here.iter_mut().zip(ahead).zip(cells) {
            *here = ahead.moved_on(cell, end);
        }
        let reach = N::of(used as u16);
        match profile.first_chunk() {
            Some(short) if used <= TABLE => vote(set, (short, used), (here, reach), votes),
            _ => {
                for (vote, &left) in votes.iter_mut().zip(&*here) {
                    let off = left.off(reach).index();
                    *vote += profile[..used].get(off).copied().unwrap_or(0);
                }
            }
        }
    }
}

/// Adds the votes for the steps that are left where `reach` are left at the reading, by a profile of
/// which `used` entries count.
#[inline(always)]
fn vote<S: Set, N: Steps>(
    set: S,
    (profile, used): (&[u8; TABLE], usize),
    (left, reach): (&[N], N),
    votes: &mut [u8],
) {
    let (left, votes) = (
        left.as_chunks::<LANES>().0,
        votes.as_chunks_mut::<LANES>().0,
    );
    for (left, votes) in left.iter().zip(votes) {
        let mut off = [0; LANES];
        for (off, left) in off.iter_mut().zip(left) {
            *off = left.off(reach).byte();
        }
        for (vote, found) in votes.iter_mut().zip(set.look_up(profile, used, off)) {
            *vote += found;
        }
    }
}

/// A number of steps.
pub(super) trait Steps: Copy {
    const NONE: Self;

    fn of(steps: u16) -> Self;
    /// Returns the steps left in a cell, from those left in the next one on its line.
    fn moved_on(self, cell: Cell, end: Self) -> Self;
    /// Returns the distance from another number.
    fn off(self, other: Self) -> Self;
    /// Returns a byte that is the same up to 254, and 255 for more.
    fn byte(self) -> u8;
    fn index(self) -> usize;
}

macro_rules! steps {
    ($($number:ty),*) => {
        $(
            impl Steps for $number {
                const NONE: Self = 0;

                #[inline(always)]
                fn of(steps: u16) -> Self {
                    steps as $number
                }

                #[inline(always)]
                fn moved_on(self, cell: Cell, end: Self) -> Self {
                    let next = if cell == Cell::Open { self.saturating_sub(1) } else { 0 };
                    next | if cell == Cell::Occupied { end } else { 0 }
                }

                #[inline(always)]
                fn off(self, other: Self) -> Self {
                    self.saturating_sub(other) | other.saturating_sub(self)
                }

                #[inline(always)]
                fn byte(self) -> u8 {
                    self.min(255) as u8
                }

                #[inline(always)]
                fn index(self) -> usize {
                    self.into()
                }
            }
        )*
    };
}

steps!(u8, u16);
