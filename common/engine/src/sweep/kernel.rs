//! The innermost loops of a dense sweep.
//!
//! A batch of beams is moved a row on and votes there, a few vectors of cells
//! at a time: their votes stay in registers until all beams have voted. A
//! beam's row is kept in one place and rewritten one vector to the left, from
//! the left, and the next time back to the right, from the right: so cells are
//! read before they are overwritten, whichever way the direction shifts them.

use std::ops::{AddAssign, Range};

use super::bits::BitGrid;
use super::line::{Bytes, Words};
use super::merge::{self, Plane};
use super::plan::{MAX_BEAMS, SweptBeam};
use crate::simd::Set;
use crate::simd::bytes::Lanes;

/// Type of the sums of votes: bytes or 16 bits.
pub(super) trait Sum: Copy + Default + From<u8> + AddAssign {
    /// Fills in a field like [`merge::merge`].
    ///
    /// # Panics
    /// Like [`merge::merge`].
    fn merge(bits: &BitGrid, rows: &Plane<'_, Self>, columns: &Plane<'_, Self>, field: &mut [u16]);

    /// Adds votes to the sums of as many cells if `ADD`, else overwrites those.
    fn take<S: Set, const ADD: bool>(set: S, votes: S::Bytes, to: &mut [Self]);
}

impl Sum for u16 {
    fn merge(bits: &BitGrid, rows: &Plane<'_, u16>, columns: &Plane<'_, u16>, field: &mut [u16]) {
        merge::merge::<Words, 8>(bits, rows, columns, field);
    }

    #[inline(always)]
    fn take<S: Set, const ADD: bool>(_: S, votes: S::Bytes, to: &mut [u16]) {
        votes.widen::<ADD>(to);
    }
}

impl Sum for u8 {
    fn merge(bits: &BitGrid, rows: &Plane<'_, u8>, columns: &Plane<'_, u8>, field: &mut [u16]) {
        merge::merge::<Bytes, 16>(bits, rows, columns, field);
    }

    #[inline(always)]
    fn take<S: Set, const ADD: bool>(set: S, votes: S::Bytes, to: &mut [u8]) {
        let sum = if ADD {
            S::Bytes::load(set, to).add(votes)
        } else {
            votes
        };
        sum.store(to);
    }
}

/// The way of a batch through some rows of the grid.
pub(super) struct Stretch<'a, N> {
    pub bits: &'a BitGrid,
    /// Rows, counted from the start of the sweep.
    pub steps: Range<usize>,
    /// Sums of all cells, row by row.
    pub sums: &'a mut [N],
    /// Cells from one row of sums to the next, in whole words.
    pub stride: usize,
    /// True if votes are added to the sums, false if they overwrite them.
    pub adds: bool,
    /// Rows of all beams, each at its place.
    pub store: &'a mut [u8],
}

/// Sweeps a batch, `N` vectors at a time.
#[inline(always)]
pub(super) fn sweep<S: Set, M: Sum, const N: usize>(
    set: S,
    stretch: &mut Stretch<'_, M>,
    beams: &[SweptBeam],
) {
    match (stretch.bits.has_blocked(), beams[0].is_far) {
        (false, false) => stretch_on::<S, M, Near, N, false>(set, stretch, beams),
        (true, false) => stretch_on::<S, M, Near, N, true>(set, stretch, beams),
        (false, true) => stretch_on::<S, M, Far, N, false>(set, stretch, beams),
        (true, true) => stretch_on::<S, M, Far, N, true>(set, stretch, beams),
    }
}

type Cells<S> = <<S as Set>::Bytes as Lanes>::Cells;

/// Number of bits that hold the steps left.
trait Depth {
    /// Bytes of a cell in a beam's row.
    const BYTES: usize;

    /// Returns the steps left in `N` vectors of cells of a beam's row, read from byte `ahead`
    /// on and stored from `here` on.
    fn step<S: Set, const N: usize, const BLOCKED: bool>(
        set: S,
        row: &mut [u8],
        places: (usize, usize),
        cells: &[Cells<S>; N],
        end: u16,
    ) -> [S::Bytes; N];
}

struct Near;
struct Far;

impl Depth for Near {
    const BYTES: usize = 1;

    #[inline(always)]
    fn step<S: Set, const N: usize, const BLOCKED: bool>(
        set: S,
        row: &mut [u8],
        (ahead, here): (usize, usize),
        cells: &[Cells<S>; N],
        end: u16,
    ) -> [S::Bytes; N] {
        let (width, end) = (S::Bytes::WIDTH, S::Bytes::splat(set, end as u8));
        let ahead = &row[ahead..][..N * width];
        let mut left = [end; N];
        for (i, left) in left.iter_mut().enumerate() {
            let ahead = S::Bytes::load(set, &ahead[i * width..]);
            *left = ahead.step::<BLOCKED>(cells[i], end);
        }
        let here = &mut row[here..][..N * width];
        for (i, left) in left.iter().enumerate() {
            left.store(&mut here[i * width..]);
        }
        left
    }
}

impl Depth for Far {
    const BYTES: usize = 2;

    #[inline(always)]
    fn step<S: Set, const N: usize, const BLOCKED: bool>(
        set: S,
        row: &mut [u8],
        (ahead, here): (usize, usize),
        cells: &[Cells<S>; N],
        end: u16,
    ) -> [S::Bytes; N] {
        let bytes = Self::BYTES * S::Bytes::WIDTH;
        let end = S::Bytes::splat_pair(set, end);
        let ahead = &row[ahead..][..N * bytes];
        let mut left = [end; N];
        for (i, left) in left.iter_mut().enumerate() {
            let pair = S::Bytes::load_pair(set, &ahead[i * bytes..]);
            *left = S::Bytes::step_pair::<BLOCKED>(set, pair, cells[i], end);
        }
        let here = &mut row[here..][..N * bytes];
        let mut narrow = [S::Bytes::splat(set, 0); N];
        for (i, (left, narrow)) in left.into_iter().zip(&mut narrow).enumerate() {
            S::Bytes::store_pair(set, left, &mut here[i * bytes..]);
            *narrow = S::Bytes::narrow(set, left);
        }
        narrow
    }
}

/// Place of a beam in its row, in bytes.
#[derive(Debug, Clone, Copy, Default)]
struct Place {
    /// Start of the cells that the beam looks at from this row's first cell.
    ahead: usize,
    /// Start of this row's cells.
    here: usize,
    /// Position of the next row on the minor axis, in cells.
    minor: i64,
}

#[inline(always)]
fn stretch_on<S: Set, M: Sum, D: Depth, const N: usize, const BLOCKED: bool>(
    set: S,
    stretch: &mut Stretch<'_, M>,
    beams: &[SweptBeam],
) {
    let vectors = stretch.bits.columns.div_ceil(S::Bytes::WIDTH);
    let vector = S::Bytes::WIDTH * D::BYTES;
    let forward = beams[0].direction.step > 0;
    let major = |step: usize| {
        if forward {
            stretch.bits.rows - 1 - step
        } else {
            step
        }
    };
    let mut places = [Place::default(); MAX_BEAMS];
    let first = major(stretch.steps.start) as i64;
    for (beam, place) in beams.iter().zip(&mut places) {
        place.minor = beam.direction.minor(first + beam.direction.step);
    }
    for step in stretch.steps.clone() {
        let major = major(step);
        // Rows begin after a margin, every other one a vector farther.
        let leftward = step % 2 == 0;
        let (from, to) = if leftward { (2, 1) } else { (1, 2) };
        for (beam, place) in beams.iter().zip(&mut places) {
            let minor = beam.direction.minor(major as i64);
            let shift = (place.minor - minor) as isize * D::BYTES as isize;
            place.minor = minor;
            place.ahead = (beam.row + from * vector).wrapping_add_signed(shift);
            place.here = beam.row + to * vector;
        }
        let (occupied, blocked) = stretch.bits.row(major);
        let mut row = Row {
            set,
            occupied,
            blocked,
            sums: &mut stretch.sums[major * stretch.stride..][..stretch.stride],
            adds: stretch.adds,
            store: &mut *stretch.store,
        };
        let blocks = vectors / N;
        if leftward {
            for block in 0..blocks {
                row.block::<D, N, BLOCKED>(beams, &places, block * N);
            }
            row.rest::<D, N, BLOCKED>(beams, &places, vectors);
        } else {
            row.rest::<D, N, BLOCKED>(beams, &places, vectors);
            for block in (0..blocks).rev() {
                row.block::<D, N, BLOCKED>(beams, &places, block * N);
            }
        }
        // Remains of the last row next to this one must not be taken for cells of it.
        for (_, place) in beams.iter().zip(&places) {
            let beside = if leftward {
                place.here + vectors * vector
            } else {
                place.here - vector
            };
            row.store[beside..][..vector].fill(0);
        }
    }
}

/// A row of cells.
struct Row<'a, S, M> {
    set: S,
    occupied: &'a [u64],
    blocked: &'a [u64],
    sums: &'a mut [M],
    adds: bool,
    /// Rows of all beams.
    store: &'a mut [u8],
}

impl<S: Set, M: Sum> Row<'_, S, M> {
    /// Processes the vectors that do not fill a block.
    #[inline(always)]
    fn rest<D: Depth, const N: usize, const BLOCKED: bool>(
        &mut self,
        beams: &[SweptBeam],
        places: &[Place; MAX_BEAMS],
        vectors: usize,
    ) {
        let start = vectors / N * N;
        match vectors - start {
            0 => {}
            1 => self.block::<D, 1, BLOCKED>(beams, places, start),
            // At most three are swept at a time.
            _ => self.block::<D, 2, BLOCKED>(beams, places, start),
        }
    }

    /// Moves `N` vectors from `start` on and lets the beams vote in them.
    #[inline(always)]
    fn block<D: Depth, const N: usize, const BLOCKED: bool>(
        &mut self,
        beams: &[SweptBeam],
        places: &[Place; MAX_BEAMS],
        start: usize,
    ) {
        let set = self.set;
        let mut cells = [S::Bytes::cells::<BLOCKED>(set, 0, 0); N];
        for (i, cells) in cells.iter_mut().enumerate() {
            let first = (start + i) * S::Bytes::WIDTH;
            let bits = |row: &[u64]| row[first / 64] >> (first % 64);
            let blocked = if BLOCKED { bits(self.blocked) } else { 0 };
            *cells = S::Bytes::cells::<BLOCKED>(set, bits(self.occupied), blocked);
        }
        let mut votes = [S::Bytes::splat(set, 0); N];
        let offset = start * S::Bytes::WIDTH * D::BYTES;
        for (beam, place) in beams.iter().zip(places) {
            let places = (place.ahead + offset, place.here + offset);
            let left = D::step::<S, N, BLOCKED>(set, self.store, places, &cells, beam.end);
            S::Bytes::vote(set, &mut votes, &left, &beam.lookup);
        }
        let width = S::Bytes::WIDTH;
        let sums = &mut self.sums[start * width..][..N * width];
        for (votes, sums) in votes.into_iter().zip(sums.chunks_exact_mut(width)) {
            if self.adds {
                M::take::<S, true>(set, votes, sums);
            } else {
                M::take::<S, false>(set, votes, sums);
            }
        }
    }
}
