//! Sums of the windows of a group of beams, bit by bit side by side.
//!
//! Three rows of bits become a sum and a carry for the next plane, so that
//! adding a window to 512 numbers takes two operations and as much again for
//! its carries.

use super::bits::Row;
use super::rows::BitRow;
use super::spans::Window;

/// Beams whose bearings leave the same rest by eight.
#[derive(Debug, Clone)]
pub(super) struct Group {
    /// That rest.
    shift: u32,
    /// The windows with a share of `1 << i` units, narrow ones and wide ones.
    planes: Vec<[Vec<Window>; 2]>,
    /// The most units that the beams can give.
    pub possible: u16,
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
        self.planes.iter_mut().flatten().for_each(Vec::clear);
        self.possible = 0;
    }

    pub(super) fn push(&mut self, plane: usize, window: Window) {
        self.possible += 1 << plane;
        if self.planes.len() <= plane {
            self.planes
                .resize_with(plane + 1, || [Vec::new(), Vec::new()]);
        }
        self.planes[plane][usize::from(!window.is_narrow())].push(window);
    }

    /// How many windows there are; each leaves at most one carry.
    pub(super) fn windows(&self) -> usize {
        self.planes.iter().flatten().map(Vec::len).sum()
    }

    /// Adds up what the windows see, plane by plane with carry-save adders, and
    /// adds that to the sums of all groups.
    #[inline(always)]
    pub(super) fn add<R: BitRow>(
        &self,
        spans: &[u8],
        [carries, next]: &mut [Vec<Aligned>; 2],
        total: &mut [R],
    ) {
        let (mut carries, mut next) = (&mut carries[..], &mut next[..]);
        let mut carried = 0;
        let mut windows = self.planes.iter();
        // What adding to the total carries over.
        let mut overflow = R::empty();
        for total in total {
            let (mut sum, mut made) = (R::empty(), 0);
            if let Some([narrow, wide]) = windows.next() {
                made = add_windows::<R, { Window::NARROW }>(narrow, spans, &mut sum, next);
                let next = &mut next[made..];
                made += add_windows::<R, { Window::WIDE }>(wide, spans, &mut sum, next);
            }
            made += add_carries(&carries[..carried], &mut sum, &mut next[made..]);
            (*total, overflow) = total.full_adder(sum.shift_down(self.shift), overflow);
            std::mem::swap(&mut carries, &mut next);
            carried = made;
        }
    }
}

/// Adds windows that take `READS` reads to a plane, two by two; how many carries
/// that made.
#[inline(always)]
fn add_windows<R: BitRow, const READS: usize>(
    windows: &[Window],
    spans: &[u8],
    sum: &mut R,
    carries: &mut [Aligned],
) -> usize {
    let read = |window: &Window| window.read::<R, READS>(spans);
    let mut pairs = windows.chunks_exact(2);
    for (pair, carry) in (&mut pairs).zip(&mut *carries) {
        carry.add(sum, read(&pair[0]), read(&pair[1]));
    }
    if let [last] = pairs.remainder() {
        carries[windows.len() / 2].add(sum, read(last), R::empty());
    }
    windows.len().div_ceil(2)
}

/// Adds the rows carried over from the plane below; how many carries that made.
#[inline(always)]
fn add_carries<R: BitRow>(rows: &[Aligned], sum: &mut R, carries: &mut [Aligned]) -> usize {
    let mut pairs = rows.chunks_exact(2);
    for (pair, carry) in (&mut pairs).zip(&mut *carries) {
        carry.add(sum, R::from_row(&pair[0].0), R::from_row(&pair[1].0));
    }
    if let [last] = pairs.remainder() {
        carries[rows.len() / 2].add(sum, R::from_row(&last.0), R::empty());
    }
    rows.len().div_ceil(2)
}

impl Aligned {
    /// Adds two rows to a sum and becomes their carry.
    #[inline(always)]
    fn add<R: BitRow>(&mut self, sum: &mut R, a: R, b: R) {
        let carry;
        (*sum, carry) = sum.full_adder(a, b);
        self.0 = carry.to_row();
    }
}
