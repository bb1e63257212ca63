//! Which part of the map is shown.

use engine::grid::CellRules;
use geometry::Pose;
use map::OccupancyGrid;

/// A rectangle along the map's axes, metres. Empty until a point is included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    min: (f64, f64),
    max: (f64, f64),
}

impl Extent {
    pub(super) const EMPTY: Extent = Extent {
        min: (f64::INFINITY, f64::INFINITY),
        max: (f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    pub(super) fn of(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let mut extent = Extent::EMPTY;
        extent.include(points);
        extent
    }

    pub(super) fn of_map(map: &OccupancyGrid) -> Self {
        let width = f64::from(map.width) * map.resolution_m;
        let height = f64::from(map.height) * map.resolution_m;
        let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
        Extent::of(corners.map(|(x, y)| map.map_from_grid.transform(x, y)))
    }

    /// What holds all cells that are known; the whole map where none is.
    pub(super) fn of_known(map: &OccupancyGrid, rules: CellRules) -> Self {
        let (width, resolution) = (map.width as usize, map.resolution_m);
        let mut extent = Extent::EMPTY;
        for (y, row) in map.cells.chunks(width.max(1)).enumerate() {
            let is_known = |&cell: &u8| rules.is_free(cell) || rules.is_occupied(cell);
            let first = row.iter().position(is_known);
            let last = row.iter().rposition(is_known);
            let (Some(first), Some(last)) = (first, last) else {
                continue;
            };
            for (x, y) in [(first, y), (last + 1, y), (first, y + 1), (last + 1, y + 1)] {
                let (x, y) = (x as f64 * resolution, y as f64 * resolution);
                extent.include([map.map_from_grid.transform(x, y)]);
            }
        }
        match extent == Extent::EMPTY {
            true => Extent::of_map(map),
            false => extent,
        }
    }

    /// What lies within this many metres of a pose, along each axis.
    pub(super) fn around(pose: Pose, reach_m: f64) -> Self {
        Extent {
            min: (pose.x - reach_m, pose.y - reach_m),
            max: (pose.x + reach_m, pose.y + reach_m),
        }
    }

    /// Grows until it holds the points; those that are not finite are left out.
    pub(super) fn include(&mut self, points: impl IntoIterator<Item = (f64, f64)>) {
        for (x, y) in points {
            if x.is_finite() && y.is_finite() {
                self.min = (self.min.0.min(x), self.min.1.min(y));
                self.max = (self.max.0.max(x), self.max.1.max(y));
            }
        }
    }

    pub(super) fn include_all(&mut self, other: Extent) {
        self.include([other.min, other.max]);
    }

    /// What both hold; `other` where they have nothing in common.
    pub(super) fn within(self, other: Extent) -> Self {
        let min = (self.min.0.max(other.min.0), self.min.1.max(other.min.1));
        let max = (self.max.0.min(other.max.0), self.max.1.min(other.max.1));
        if min.0 < max.0 && min.1 < max.1 {
            return Extent { min, max };
        }
        other
    }

    /// With a rim of a share of its longer side, and at least `least_m` along each axis.
    pub(super) fn with_rim(self, share: f64, least_m: f64) -> Self {
        let rim = share * self.width().max(self.height());
        let (x, y) = self.center();
        let half = |length: f64| (length / 2.0 + rim).max(least_m / 2.0);
        let (half_x, half_y) = (half(self.width()), half(self.height()));
        Extent {
            min: (x - half_x, y - half_y),
            max: (x + half_x, y + half_y),
        }
    }

    pub(super) fn width(&self) -> f64 {
        self.max.0 - self.min.0
    }

    pub(super) fn height(&self) -> f64 {
        self.max.1 - self.min.1
    }

    pub(super) fn center(&self) -> (f64, f64) {
        (
            (self.min.0 + self.max.0) / 2.0,
            (self.min.1 + self.max.1) / 2.0,
        )
    }
}

#[cfg(test)]
mod tests {
    use map::UNKNOWN;

    use super::*;

    #[test]
    fn points_without_a_place_are_left_out() {
        let extent = Extent::of([(1.0, 2.0), (f64::NAN, 50.0), (4.0, 3.0)]);
        assert_eq!((extent.width(), extent.height()), (3.0, 1.0));
        assert_eq!(extent.center(), (2.5, 2.5));
    }

    #[test]
    fn only_what_is_known_of_a_map_is_held() {
        let mut cells = vec![UNKNOWN; 12];
        let map = |cells: &[u8]| {
            // Four by three cells of half a metre, turned by a quarter.
            let turned = Pose::new(1.0, 0.0, std::f64::consts::FRAC_PI_2);
            OccupancyGrid::from_parts(4, 3, 0.5, turned, cells.to_vec()).unwrap()
        };
        let known = |cells: &[u8]| Extent::of_known(&map(cells), CellRules::default());
        cells[11] = 50;
        assert_eq!(
            known(&cells),
            Extent::of_map(&map(&cells)),
            "neither free nor occupied"
        );
        cells[5] = 0;
        cells[6] = 100;
        let known = known(&cells);
        // Columns 1 and 2 of row 1: the grid's x runs up, and its y to the left.
        let off = (known.center().0 - 0.25).abs() + (known.center().1 - 1.0).abs();
        assert!(off < 1e-9, "{known:?}");
        assert!((known.width() - 0.5).abs() + (known.height() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_rim_goes_around_and_little_is_not_blown_up() {
        let extent = Extent::of([(0.0, 0.0), (10.0, 2.0)]).with_rim(0.1, 6.0);
        assert_eq!((extent.width(), extent.height()), (12.0, 6.0));
        assert_eq!(extent.center(), (5.0, 1.0));
    }

    #[test]
    fn what_both_hold_is_cut_out() {
        let one = Extent::of([(0.0, 0.0), (4.0, 4.0)]);
        let other = Extent::of([(2.0, -1.0), (9.0, 3.0)]);
        assert_eq!(one.within(other), Extent::of([(2.0, 0.0), (4.0, 3.0)]));
        let far = Extent::of([(20.0, 20.0), (21.0, 21.0)]);
        assert_eq!(one.within(far), far);
    }
}
