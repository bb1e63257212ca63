//! Where the map's metres lie in the picture.

use crate::drawing::Rect;
use geometry::Pose;

use super::extent::Extent;

/// A part of the map shown in a part of the picture, x to the right and y up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    pub(super) area: Rect,
    pub(super) pixels_per_m: f64,
    /// Of the area, metres.
    center: (f64, f64),
}

impl View {
    /// Shows an extent as large as fits an area, which is taken to whole pixels.
    pub(super) fn fitting(extent: Extent, area: Rect) -> Self {
        let (left, top) = (area.x.round(), area.y.round());
        let area = Rect::new(
            left,
            top,
            (area.right().round() - left).max(1.0),
            (area.bottom().round() - top).max(1.0),
        );
        let scale = (area.width / extent.width()).min(area.height / extent.height());
        View {
            area,
            pixels_per_m: scale,
            center: extent.center(),
        }
    }

    /// Where a point of the map, metres, lies in the picture.
    pub(super) fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (left, top) = self.area.center();
        (
            left + (x - self.center.0) * self.pixels_per_m,
            top - (y - self.center.1) * self.pixels_per_m,
        )
    }

    /// The point of the map, metres, that lies at a point of the picture.
    pub(super) fn metres_at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (left, top) = self.area.center();
        (
            self.center.0 + (x - left) / self.pixels_per_m,
            self.center.1 - (y - top) / self.pixels_per_m,
        )
    }

    /// The inverse of [`View::at`] as a pose: of a frame whose x axis runs to
    /// the right and whose y axis runs up, in pixels from the area's upper left
    /// corner and divided by the scale.
    pub(super) fn map_from_corner(&self) -> Pose {
        let half_x = self.area.width / 2.0 / self.pixels_per_m;
        let half_y = self.area.height / 2.0 / self.pixels_per_m;
        Pose::new(self.center.0 - half_x, self.center.1 + half_y, 0.0)
    }

    pub(super) fn shows(&self, at: (f64, f64)) -> bool {
        let (x, y) = self.at(at);
        (self.area.x..self.area.right()).contains(&x)
            && (self.area.y..self.area.bottom()).contains(&y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extent_lies_in_the_middle_with_y_upwards() {
        let extent = Extent::of([(10.0, 20.0), (14.0, 21.0)]);
        let view = View::fitting(extent, Rect::new(100.0, 50.0, 400.0, 300.0));
        assert_eq!(view.pixels_per_m, 100.0);
        assert_eq!(view.at((10.0, 20.5)), (100.0, 200.0));
        assert_eq!(view.at((14.0, 21.5)), (500.0, 100.0), "up is less");
        assert!(view.shows((13.9, 20.0)) && !view.shows((14.1, 20.0)));
        assert_eq!(view.map_from_corner(), Pose::new(10.0, 22.0, 0.0));
    }
}
