//! The innermost loops of a dense sweep.
//!
//! A batch of beams is moved a row on and votes there, a few vectors of cells
//! at a time: their votes stay in registers until all beams have voted. A
//! beam's row is kept in one place and rewritten one vector to the left, from
//! the left, and the next time back to the right, from the right: so cells are
//! read before they are overwritten, whichever way the direction shifts them.

use std::ops::{AddAssign, Range};

use super::bits::BitGrid;
use super::lanes::Lanes;
use super::line::{Bytes, Words};
use super::merge::{self, Plane};
use super::plan::{MOST_BEAMS, SweptBeam};

/// Where votes are added up: rows of bytes or of 16 bits.
pub(super) trait Sum: Copy + Default + From<u8> + AddAssign {
    /// Fills in a field as [`merge::merge`].
    ///
    /// # Panics
    /// As that.
    fn merge(bits: &BitGrid, rows: &Plane<'_, Self>, columns: &Plane<'_, Self>, field: &mut [u16]);

    /// Adds votes to the sums of as many cells, or sets those.
    ///
    /// # Safety
    /// As for [`Lanes`].
    unsafe fn take<L: Lanes, const ADD: bool>(votes: L, to: *mut Self);
}

impl Sum for u16 {
    fn merge(bits: &BitGrid, rows: &Plane<'_, u16>, columns: &Plane<'_, u16>, field: &mut [u16]) {
        merge::merge::<Words, 8>(bits, rows, columns, field);
    }

    #[inline(always)]
    unsafe fn take<L: Lanes, const ADD: bool>(votes: L, to: *mut u16) {
        unsafe { votes.widen::<ADD>(to) }
    }
}

impl Sum for u8 {
    fn merge(bits: &BitGrid, rows: &Plane<'_, u8>, columns: &Plane<'_, u8>, field: &mut [u16]) {
        merge::merge::<Bytes, 16>(bits, rows, columns, field);
    }

    #[inline(always)]
    unsafe fn take<L: Lanes, const ADD: bool>(votes: L, to: *mut u8) {
        unsafe {
            let sum = if ADD { L::load(to).add(votes) } else { votes };
            sum.store(to);
        }
    }
}

/// A batch's way through some rows of the grid.
pub(super) struct Stretch<'a, S> {
    pub bits: &'a BitGrid,
    /// Rows, counted from where the sweep begins.
    pub steps: Range<usize>,
    /// Sums of all cells, row by row.
    pub sums: &'a mut [S],
    /// From one row of sums to the next: the cells in whole words.
    pub stride: usize,
    /// Whether votes are added to the sums or set them.
    pub adds: bool,
    /// The rows of all beams, each at its place.
    pub store: *mut u8,
}

/// Sweeps a batch, `N` vectors at a time.
///
/// # Safety
/// The processor must have the instruction set of `L`, and the store must hold
/// the beams' rows.
#[inline(always)]
pub(super) unsafe fn sweep<L: Lanes, S: Sum, const N: usize>(
    stretch: &mut Stretch<'_, S>,
    beams: &[SweptBeam],
) {
    unsafe {
        match (stretch.bits.has_blocked(), beams[0].is_far) {
            (false, false) => stretch_on::<L, S, Near, N, false>(stretch, beams),
            (true, false) => stretch_on::<L, S, Near, N, true>(stretch, beams),
            (false, true) => stretch_on::<L, S, Far, N, false>(stretch, beams),
            (true, true) => stretch_on::<L, S, Far, N, true>(stretch, beams),
        }
    }
}

/// How many bits what is left takes.
trait Depth {
    /// Bytes of a cell in a beam's row.
    const BYTES: usize;

    /// What is left in `N` vectors of cells, read at `ahead` and kept at `here`.
    ///
    /// # Safety
    /// As for [`Lanes`].
    unsafe fn step<L: Lanes, const N: usize, const BLOCKED: bool>(
        ahead: *const u8,
        here: *mut u8,
        cells: &[L::Cells; N],
        end: u16,
    ) -> [L; N];
}

struct Near;
struct Far;

impl Depth for Near {
    const BYTES: usize = 1;

    #[inline(always)]
    unsafe fn step<L: Lanes, const N: usize, const BLOCKED: bool>(
        ahead: *const u8,
        here: *mut u8,
        cells: &[L::Cells; N],
        end: u16,
    ) -> [L; N] {
        unsafe {
            let end = L::splat(u32::from(end) * 0x0101_0101);
            let mut left = [L::zero(); N];
            for (i, left) in left.iter_mut().enumerate() {
                *left = L::load(ahead.add(i * L::WIDTH)).step::<BLOCKED>(cells[i], end);
            }
            for (i, left) in left.iter().enumerate() {
                left.store(here.add(i * L::WIDTH));
            }
            left
        }
    }
}

impl Depth for Far {
    const BYTES: usize = 2;

    #[inline(always)]
    unsafe fn step<L: Lanes, const N: usize, const BLOCKED: bool>(
        ahead: *const u8,
        here: *mut u8,
        cells: &[L::Cells; N],
        end: u16,
    ) -> [L; N] {
        unsafe {
            let end = L::splat_pair(u32::from(end) * 0x0001_0001);
            let (ahead, here) = (ahead.cast::<u16>(), here.cast::<u16>());
            let mut left = [L::splat_pair(0); N];
            for (i, left) in left.iter_mut().enumerate() {
                let pair = L::load_pair(ahead.add(i * L::WIDTH));
                *left = L::step_pair::<BLOCKED>(pair, cells[i], end);
            }
            let mut narrow = [L::zero(); N];
            for (i, (left, narrow)) in left.into_iter().zip(&mut narrow).enumerate() {
                L::store_pair(left, here.add(i * L::WIDTH));
                *narrow = L::narrow(left);
            }
            narrow
        }
    }
}

/// Where a beam stands.
#[derive(Clone, Copy)]
struct Place {
    /// What is left in the cells that the beam looks at from this row's first.
    ahead: *const u8,
    /// This row's first cell.
    here: *mut u8,
    /// The next row's place on the minor axis.
    minor: i64,
}

#[inline(always)]
unsafe fn stretch_on<L: Lanes, S: Sum, D: Depth, const N: usize, const BLOCKED: bool>(
    stretch: &mut Stretch<'_, S>,
    beams: &[SweptBeam],
) {
    unsafe {
        let vectors = stretch.bits.columns.div_ceil(L::WIDTH);
        let vector = (L::WIDTH * D::BYTES) as isize;
        let forward = beams[0].direction.step > 0;
        let major = |step: usize| {
            if forward {
                stretch.bits.rows - 1 - step
            } else {
                step
            }
        };
        let mut places = [Place {
            ahead: std::ptr::null(),
            here: std::ptr::null_mut(),
            minor: 0,
        }; MOST_BEAMS];
        let first = major(stretch.steps.start) as i64;
        for (beam, place) in beams.iter().zip(&mut places) {
            place.minor = beam.direction.minor(first + beam.direction.step);
        }
        for step in stretch.steps.clone() {
            let major = major(step);
            // Rows begin behind a margin, every other one a vector farther.
            let leftward = step % 2 == 0;
            let (from, to) = if leftward { (2, 1) } else { (1, 2) };
            for (beam, place) in beams.iter().zip(&mut places) {
                let row = stretch.store.add(beam.row);
                let minor = beam.direction.minor(major as i64);
                let shift = (place.minor - minor) as isize * D::BYTES as isize;
                place.minor = minor;
                place.ahead = row.offset(from * vector + shift);
                place.here = row.offset(to * vector);
            }
            let (occupied, blocked) = stretch.bits.row(major);
            let row = Row {
                occupied: occupied.as_ptr(),
                blocked: blocked.as_ptr(),
                sums: stretch.sums[major * stretch.stride..][..stretch.stride].as_mut_ptr(),
                adds: stretch.adds,
            };
            let blocks = vectors / N;
            if leftward {
                for block in 0..blocks {
                    row.block::<L, D, N, BLOCKED>(beams, &places, block * N);
                }
                row.rest::<L, D, N, BLOCKED>(beams, &places, vectors);
            } else {
                row.rest::<L, D, N, BLOCKED>(beams, &places, vectors);
                for block in (0..blocks).rev() {
                    row.block::<L, D, N, BLOCKED>(beams, &places, block * N);
                }
            }
            // What the last row leaves beside this one must not be taken for
            // cells of it.
            for (_, place) in beams.iter().zip(&places) {
                let beside = if leftward { vectors as isize } else { -1 };
                let beside = place.here.offset(beside * vector);
                for i in 0..D::BYTES {
                    L::zero().store(beside.add(i * L::WIDTH));
                }
            }
        }
    }
}

/// A row of cells.
struct Row<S> {
    occupied: *const u64,
    blocked: *const u64,
    sums: *mut S,
    adds: bool,
}

impl<S: Sum> Row<S> {
    /// The vectors that do not fill a block.
    #[inline(always)]
    unsafe fn rest<L: Lanes, D: Depth, const N: usize, const BLOCKED: bool>(
        &self,
        beams: &[SweptBeam],
        places: &[Place; MOST_BEAMS],
        vectors: usize,
    ) {
        let start = vectors / N * N;
        unsafe {
            match vectors - start {
                0 => {}
                1 => self.block::<L, D, 1, BLOCKED>(beams, places, start),
                2 => self.block::<L, D, 2, BLOCKED>(beams, places, start),
                3 => self.block::<L, D, 3, BLOCKED>(beams, places, start),
                _ => self.block::<L, D, 4, BLOCKED>(beams, places, start),
            }
        }
    }

    /// Moves `N` vectors from `start` on and lets the beams vote in them.
    #[inline(always)]
    unsafe fn block<L: Lanes, D: Depth, const N: usize, const BLOCKED: bool>(
        &self,
        beams: &[SweptBeam],
        places: &[Place; MOST_BEAMS],
        start: usize,
    ) {
        unsafe {
            let mut cells = [L::cells::<BLOCKED>(self.occupied, self.blocked, start); N];
            for (i, cells) in cells.iter_mut().enumerate().skip(1) {
                *cells = L::cells::<BLOCKED>(self.occupied, self.blocked, start + i);
            }
            let mut votes = [L::zero(); N];
            let offset = start * L::WIDTH * D::BYTES;
            for (beam, place) in beams.iter().zip(places) {
                let (ahead, here) = (place.ahead.add(offset), place.here.add(offset));
                let left = D::step::<L, N, BLOCKED>(ahead, here, &cells, beam.end);
                L::vote(&mut votes, &left, &beam.lookup);
            }
            for (i, votes) in votes.into_iter().enumerate() {
                let sums = self.sums.add((start + i) * L::WIDTH);
                if self.adds {
                    S::take::<L, true>(votes, sums);
                } else {
                    S::take::<L, false>(votes, sums);
                }
            }
        }
    }
}
