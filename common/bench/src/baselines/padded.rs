//! An image with a margin of zeros, so that its rows can be read with an offset.

/// Number of bytes that the widest instruction processes.
pub(super) const BLOCK: usize = 64;

/// An image with a margin: a row shifted by less than its width reads zeros there.
#[derive(Debug, Clone)]
pub(super) struct Padded {
    pub(super) height: usize,
    pub(super) width: usize,
    /// Width rounded up to whole blocks.
    pub(super) row: usize,
    stride: usize,
    bytes: Vec<u8>,
}

impl Padded {
    /// Copies an image, row by row.
    pub(super) fn new(width: usize, pixels: impl ExactSizeIterator<Item = u8>) -> Self {
        let height = pixels.len() / width;
        let row = width.next_multiple_of(BLOCK);
        // Neighbouring rows share the margin between them.
        let stride = 2 * row;
        let mut padded = Padded {
            height,
            width,
            row,
            stride,
            bytes: vec![0; stride * height + row],
        };
        for (i, pixel) in pixels.enumerate() {
            padded.bytes[row + i / width * stride + i % width] = pixel;
        }
        padded
    }

    pub(super) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Offset of row `y` shifted by (dx, dy); `None` if none of its pixels remain.
    #[inline]
    pub(super) fn shifted(&self, y: usize, (dx, dy): (i32, i32)) -> Option<usize> {
        let source = y as i64 + i64::from(dy);
        let meets =
            (0..self.height as i64).contains(&source) && dx.unsigned_abs() < self.width as u32;
        meets.then(|| (self.row as i64 + source * self.stride as i64 + i64::from(dx)) as usize)
    }
}
