//! Sums of the windows of a group of beams, bit by bit side by side.
//!
//! Three rows of bits become a sum and a carry for the next plane, so that
//! adding a window to 512 numbers takes two operations and as much again for
//! its carries.

use super::bits::Row;
use super::rows::{BitRow, Several};
use super::spans::{Reader, SpansFrom, Window, Windows};

/// Beams whose bearings leave the same rest by eight.
#[derive(Debug, Clone)]
pub(super) struct Group {
    /// That rest.
    shift: u32,
    /// The windows with a share of `1 << i` units.
    planes: Vec<Plane>,
    /// The most units that the beams can give.
    pub possible: u16,
}

/// Windows by how many reads they take: nearly all take one to three.
#[derive(Debug, Clone, Default)]
struct Plane {
    two: Windows<2>,
    three: Windows<3>,
    most: Windows<{ Window::MOST }>,
}

/// A row in one line of the processor's cache.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(super) struct Aligned(pub Row);

impl Group {
    pub(super) fn new(shift: u32) -> Self {
        Group {
            shift,
            planes: Vec::new(),
            possible: 0,
        }
    }

    pub(super) fn shift(&self) -> u32 {
        self.shift
    }

    /// Lets go of all windows; their room stays.
    pub(super) fn clear(&mut self) {
        self.planes.iter_mut().for_each(Plane::clear);
        self.possible = 0;
    }

    pub(super) fn push(&mut self, plane: usize, window: Window) {
        self.possible += 1 << plane;
        if self.planes.len() <= plane {
            self.planes.resize_with(plane + 1, Plane::default);
        }
        self.planes[plane].push(window);
    }

    /// How many windows there are; each leaves at most one carry.
    pub(super) fn windows(&self) -> usize {
        self.planes.iter().map(Plane::len).sum()
    }

    /// Adds up what the windows see, plane by plane with carry-save adders, and
    /// adds that to the sums of all groups.
    #[inline(always)]
    pub(super) fn add<R: BitRow, const N: usize>(
        &self,
        spans: SpansFrom<'_>,
        [carries, next]: &mut [Vec<Aligned>; 2],
        total: &mut [Several<R, N>],
    ) {
        let (mut carries, mut next) = (&mut carries[..], &mut next[..]);
        let mut carried = 0;
        let mut windows = self.planes.iter();
        // What adding to the total carries over.
        let mut overflow = Several::empty();
        for total in total {
            let mut column = Column::new(next);
            if let Some(plane) = windows.next() {
                column.add_windows(plane.two.reader(spans));
                column.add_windows(plane.three.reader(spans));
                column.add_windows(plane.most.reader(spans));
            }
            column.add_rows(&carries[..carried * N]);
            let (sum, made) = (column.sum, column.made);
            (*total, overflow) = total.full_adder(sum.shift_down(self.shift), overflow);
            std::mem::swap(&mut carries, &mut next);
            carried = made;
        }
    }
}

impl Plane {
    fn clear(&mut self) {
        self.two.clear();
        self.three.clear();
        self.most.clear();
    }

    fn push(&mut self, window: Window) {
        match window.reads() {
            ..=2 => self.two.push(window),
            3 => self.three.push(window),
            _ => self.most.push(window),
        }
    }

    fn len(&self) -> usize {
        self.two.len() + self.three.len() + self.most.len()
    }
}

/// The sum of rows of bits, two by two, each pair with a carry.
struct Column<'a, R, const N: usize> {
    sum: Several<R, N>,
    carries: &'a mut [Aligned],
    made: usize,
}

impl<'a, R: BitRow, const N: usize> Column<'a, R, N> {
    #[inline(always)]
    fn new(carries: &'a mut [Aligned]) -> Self {
        Column {
            sum: Several::empty(),
            carries,
            made: 0,
        }
    }

    #[inline(always)]
    fn add_windows<const READS: usize>(&mut self, windows: Reader<'_, READS, N>) {
        let count = windows.len();
        for pair in 0..count / 2 {
            self.add_pair(windows.read(2 * pair), windows.read(2 * pair + 1));
        }
        if count % 2 == 1 {
            self.add_pair(windows.read(count - 1), Several::empty());
        }
    }

    #[inline(always)]
    fn add_rows(&mut self, rows: &[Aligned]) {
        let count = rows.len() / N;
        for pair in 0..count / 2 {
            self.add_pair(
                Aligned::read(rows, 2 * pair),
                Aligned::read(rows, 2 * pair + 1),
            );
        }
        if count % 2 == 1 {
            self.add_pair(Aligned::read(rows, count - 1), Several::empty());
        }
    }

    #[inline(always)]
    fn add_pair(&mut self, a: Several<R, N>, b: Several<R, N>) {
        let carry;
        (self.sum, carry) = self.sum.full_adder(a, b);
        let to = &mut self.carries[self.made * N..][..N];
        for (to, row) in to.iter_mut().zip(carry.0) {
            to.0 = row.to_row();
        }
        self.made += 1;
    }
}

impl Aligned {
    /// The rows of number `i` of several blocks.
    #[inline(always)]
    fn read<R: BitRow, const N: usize>(rows: &[Aligned], i: usize) -> Several<R, N> {
        let rows = &rows[i * N..][..N];
        let mut several = Several::empty();
        for (to, row) in several.0.iter_mut().zip(rows) {
            *to = R::from_row(&row.0);
        }
        several
    }
}
