//! Cells to draw a world on, with a running p/n.

use engine::grid::Cell;

/// A rectangle of cells; it may exceed the canvas.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rect {
    pub(super) x: usize,
    pub(super) y: usize,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl Rect {
    pub(super) fn new(x: usize, y: usize, width: usize, height: usize) -> Self {
        Rect {
            x,
            y,
            width,
            height,
        }
    }
}

/// Free and occupied cells, row by row.
#[derive(Debug, Clone)]
pub(super) struct Canvas {
    pub(super) width: usize,
    pub(super) height: usize,
    cells: Vec<Cell>,
    /// Number of open cells among the eight neighbours of each cell.
    open_neighbours: Vec<u8>,
    free: usize,
    boundary: usize,
}

impl Canvas {
    /// Open cells, surrounded by a wall one cell thick.
    pub(super) fn walled(width: usize, height: usize) -> Self {
        let mut canvas = Canvas {
            width,
            height,
            cells: vec![Cell::Open; width * height],
            open_neighbours: Vec::new(),
            free: width * height,
            boundary: 0,
        };
        canvas.open_neighbours = (0..width * height)
            .map(|i| canvas.neighbours(i).count() as u8)
            .collect();
        for (x, y) in [(0, 0), (width - 1, 0)] {
            canvas.fill(Rect::new(x, y, 1, height));
        }
        for (x, y) in [(0, 0), (0, height - 1)] {
            canvas.fill(Rect::new(x, y, width, 1));
        }
        canvas
    }

    pub(super) fn p_over_n(&self) -> f64 {
        self.boundary as f64 / self.free as f64
    }

    /// Number of boundary cells missing to a ratio; negative if there are too many.
    pub(super) fn missing(&self, p_over_n: f64) -> f64 {
        p_over_n * self.free as f64 - self.boundary as f64
    }

    pub(super) fn fill(&mut self, rect: Rect) {
        self.each(rect, Canvas::occupy);
    }

    /// Clears a rectangle, except for the wall around the world.
    pub(super) fn clear(&mut self, rect: Rect) {
        self.each(rect, Canvas::free);
    }

    fn each(&mut self, rect: Rect, change: impl Fn(&mut Canvas, usize)) {
        for y in rect.y..(rect.y + rect.height).min(self.height) {
            for x in rect.x..(rect.x + rect.width).min(self.width) {
                change(self, y * self.width + x);
            }
        }
    }

    pub(super) fn occupy(&mut self, i: usize) {
        if self.cells[i] == Cell::Occupied {
            return;
        }
        self.cells[i] = Cell::Occupied;
        self.free -= 1;
        self.boundary += usize::from(self.open_neighbours[i] > 0);
        for near in self.neighbours(i) {
            self.open_neighbours[near] -= 1;
            let hidden = self.cells[near] == Cell::Occupied && self.open_neighbours[near] == 0;
            self.boundary -= usize::from(hidden);
        }
    }

    fn free(&mut self, i: usize) {
        let (x, y) = (i % self.width, i / self.width);
        let is_edge = x == 0 || y == 0 || x + 1 == self.width || y + 1 == self.height;
        if is_edge || self.cells[i] == Cell::Open {
            return;
        }
        self.cells[i] = Cell::Open;
        self.free += 1;
        self.boundary -= usize::from(self.open_neighbours[i] > 0);
        for near in self.neighbours(i) {
            let shown = self.cells[near] == Cell::Occupied && self.open_neighbours[near] == 0;
            self.open_neighbours[near] += 1;
            self.boundary += usize::from(shown);
        }
    }

    /// The neighbours of a cell. The iterator borrows nothing.
    fn neighbours(&self, i: usize) -> impl Iterator<Item = usize> + use<> {
        let (width, height) = (self.width, self.height);
        let (x, y) = (i % width, i / width);
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let columns = x.saturating_sub(1)..(x + 2).min(width);
        rows.flat_map(move |y| columns.clone().map(move |x| y * width + x))
            .filter(move |&near| near != i)
    }

    /// Occupancy of each cell as in a map: 100 if occupied, else 0.
    pub(super) fn occupancy(&self) -> Vec<u8> {
        let value = |&cell| if cell == Cell::Occupied { 100 } else { 0 };
        self.cells.iter().map(value).collect()
    }
}

#[cfg(test)]
mod tests {
    use engine::boundary;
    use engine::grid::{CellRules, Grid};
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_ratio_is_that_of_the_engine(
            steps in vec((any::<bool>(), 0usize..20, 0usize..16, 1usize..8, 1usize..8), 0..30),
        ) {
            let mut canvas = Canvas::walled(20, 16);
            for (fills, x, y, width, height) in steps {
                let rect = Rect::new(x, y, width, height);
                if fills { canvas.fill(rect) } else { canvas.clear(rect) }
            }
            let grid = Grid::new(20, 16, &canvas.occupancy(), CellRules::default()).unwrap();
            prop_assert_eq!(canvas.free, grid.free_cells());
            prop_assert_eq!(canvas.boundary, boundary::extract(&grid).len());
        }
    }
}
