//! Euclidean distance transform: the distance of every cell to the nearest marked one.
//!
//! Felzenszwalb and Huttenlocher, "Distance Transforms of Sampled Functions" (Theory of Computing
//! 8, 2012), section 2: squared distances are lower envelopes of parabolas, first along columns and
//! then along rows.

/// Squared distance if no cell is marked: larger than any map, and still exact in sums.
const FAR: f32 = 1e12;

/// Returns the distances between cell centres in cells, row by row: 0 in marked cells, 10⁶
/// everywhere if none is marked.
#[must_use]
pub fn transform(width: usize, height: usize, is_marked: impl Fn(usize) -> bool) -> Vec<f32> {
    let cells = 0..width * height;
    let mut field: Vec<f32> = cells
        .map(|i| if is_marked(i) { 0.0 } else { FAR })
        .collect();
    along_columns(width, height, &mut field);
    let mut envelope = Envelope::new(width);
    for row in field.chunks_exact_mut(width) {
        envelope.lower(row);
        row.iter_mut().for_each(|squared| *squared = squared.sqrt());
    }
    field
}

/// Computes squared distances within each column. Cells are 0 or [`FAR`], so that counting from the
/// last marked cell, in both directions, is enough.
fn along_columns(width: usize, height: usize, field: &mut [f32]) {
    let mut steps = vec![f32::INFINITY; width];
    let mut pass = |y: usize, field: &mut [f32]| {
        let row = &mut field[y * width..][..width];
        for (squared, steps) in row.iter_mut().zip(&mut steps) {
            *steps = if *squared == 0.0 { 0.0 } else { *steps + 1.0 };
            *squared = squared.min(*steps * *steps);
        }
    };
    (0..height).for_each(|y| pass(y, field));
    (0..height).rev().for_each(|y| pass(y, field));
}

/// The lower envelope of parabolas over one row.
struct Envelope {
    /// Original heights of the row.
    heights: Vec<f32>,
    /// Positions of the lowest points of the envelope's parabolas.
    centres: Vec<usize>,
    /// Position from which each of them is the lowest.
    starts: Vec<f64>,
}

impl Envelope {
    fn new(width: usize) -> Self {
        Envelope {
            heights: Vec::with_capacity(width),
            centres: Vec::with_capacity(width),
            starts: Vec::with_capacity(width),
        }
    }

    /// Replaces each height by that of the envelope.
    fn lower(&mut self, row: &mut [f32]) {
        self.heights.clear();
        self.heights.extend_from_slice(row);
        self.centres.clear();
        self.starts.clear();
        for centre in 0..row.len() {
            self.push(centre);
        }
        let mut at = 0;
        for (x, height) in row.iter_mut().enumerate() {
            while at + 1 < self.centres.len() && self.starts[at + 1] <= x as f64 {
                at += 1;
            }
            let off = x as f32 - self.centres[at] as f32;
            *height = off * off + self.heights[self.centres[at]];
        }
    }

    /// Adds the parabola of a cell to the right of all others.
    fn push(&mut self, centre: usize) {
        loop {
            let Some((&last, &start)) = self.centres.last().zip(self.starts.last()) else {
                self.centres.push(centre);
                self.starts.push(f64::NEG_INFINITY);
                return;
            };
            let height = |x: usize| f64::from(self.heights[x]) + (x * x) as f64;
            let crossing = (height(centre) - height(last)) / (2 * (centre - last)) as f64;
            if crossing > start {
                self.centres.push(centre);
                self.starts.push(crossing);
                return;
            }
            self.centres.pop();
            self.starts.pop();
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn distances_are_those_to_the_nearest_marked_cell(
            (width, marks) in (1usize..25, 1usize..25)
                .prop_flat_map(|(w, h)| (Just(w), vec(prop::bool::weighted(0.05), w * h))),
        ) {
            let height = marks.len() / width;
            let field = transform(width, height, |i| marks[i]);
            for (i, &distance) in field.iter().enumerate() {
                let to = |j: usize| {
                    let (dx, dy) = ((i % width).abs_diff(j % width), (i / width).abs_diff(j / width));
                    ((dx * dx + dy * dy) as f32).sqrt()
                };
                let nearest = (0..marks.len()).filter(|&j| marks[j]).map(to).min_by(f32::total_cmp);
                prop_assert_eq!(distance, nearest.unwrap_or(1e6));
            }
        }
    }
}
