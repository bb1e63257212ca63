//! Pose of a grid in the map, read and checked from a map's header.

use geometry::Pose;
use messages::MapHeader;
use messages::limits::origin_is_allowed;
use nalgebra::{Matrix3, Rotation2, Vector3};

use super::{check_resolution, check_sides};
use crate::EngineError;

/// Cell size and pose of a grid in the map frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridFrame {
    /// Side of a cell, in metres.
    pub resolution_m: f64,
    /// Pose of the lower left corner of cell (0, 0) and of the grid's axes in the map.
    pub map_from_grid: Pose,
}

impl GridFrame {
    /// Makes a frame from the side of a cell, in metres, and the pose of the grid in the map.
    #[must_use]
    pub const fn new(resolution_m: f64, map_from_grid: Pose) -> Self {
        GridFrame {
            resolution_m,
            map_from_grid,
        }
    }

    /// Reads the frame of a map's grid. The whole header is checked, since it comes from another
    /// process.
    ///
    /// # Errors
    /// If the sides, their product, the resolution or the origin are out of range or not finite.
    pub fn of(map: &MapHeader) -> Result<Self, EngineError> {
        check_sides(map.width as usize, map.height as usize)?;
        check_resolution(map.resolution_m)?;
        let map_from_grid = Pose::from(map.map_from_grid);
        if !origin_is_allowed(map_from_grid) {
            return Err(EngineError::Origin(map_from_grid));
        }
        Ok(GridFrame::new(map.resolution_m, map_from_grid))
    }

    /// Converts a position in cells and a heading in the grid's frame (radians) to a pose in the
    /// map. The centre of cell (0, 0) is (0.5, 0.5).
    #[must_use]
    pub fn map_from_cells(&self, x: f64, y: f64, heading: f64) -> Pose {
        self.map_from_grid.then(Pose::new(
            x * self.resolution_m,
            y * self.resolution_m,
            heading,
        ))
    }

    /// Matrix that converts a pose difference from cells and radians of the grid to metres and
    /// radians along the map's axes.
    pub fn metres_from_cells(&self) -> Matrix3<f64> {
        let side = self.resolution_m;
        let scale = Matrix3::from_diagonal(&Vector3::new(side, side, 1.0));
        Rotation2::new(self.map_from_grid.yaw).to_homogeneous() * scale
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use messages::Pose2;

    use super::*;
    use crate::fit::GridPose;

    fn header() -> MapHeader {
        MapHeader {
            width: 30,
            height: 20,
            resolution_m: 0.05,
            map_from_grid: Pose2::new(-1.0, 2.0, 0.5),
            ..MapHeader::default()
        }
    }

    #[test]
    fn the_frame_of_a_sound_header_is_what_it_says() {
        let expected = GridFrame::new(0.05, Pose::new(-1.0, 2.0, 0.5));
        assert_eq!(GridFrame::of(&header()), Ok(expected));
    }

    #[test]
    fn a_header_out_of_range_is_refused_by_what_is_wrong() {
        let refused = |change: fn(&mut MapHeader)| {
            let mut header = header();
            change(&mut header);
            GridFrame::of(&header).unwrap_err()
        };
        let sides = |width, height| EngineError::GridSides { width, height };
        assert_eq!(refused(|map| map.width = 0), sides(0, 20));
        let most = u32::MAX as usize;
        assert_eq!(refused(|map| map.height = u32::MAX), sides(30, most));
        let (width, height) = (32_767, 32_767);
        let found = refused(|map| (map.width, map.height) = (32_767, 32_767));
        assert_eq!(found, EngineError::GridSize { width, height });
        let found = refused(|map| map.resolution_m = 0.0);
        assert_eq!(found, EngineError::Resolution(0.0));
        let found = refused(|map| map.map_from_grid.x = 1.1e8);
        assert!(matches!(found, EngineError::Origin(_)));
    }

    proptest::proptest! {
        #[test]
        fn map_and_cells_round_trip(
            ox in -100.0..100.0f64, oy in -100.0..100.0f64, turn in -3.0..3.0f64,
            resolution_m in 0.01..0.5f64, x in 0.0..3e4f64, y in 0.0..3e4f64, heading in -3.0..3.0f64,
        ) {
            let frame = GridFrame { resolution_m, map_from_grid: Pose::new(ox, oy, turn) };
            let back = GridPose::of(frame, frame.map_from_cells(x, y, heading));
            // Positions up to 15 km at 1 cm cells: a rounding is 1e-10 of a cell there.
            proptest::prop_assert!((back.x - x).abs() < 1e-7 && (back.y - y).abs() < 1e-7);
            proptest::prop_assert!(geometry::angle_between(back.heading, heading) < 1e-12);
        }
    }

    #[test]
    fn a_turned_grid_turns_its_poses() {
        let frame = GridFrame::new(0.5, Pose::new(10.0, 20.0, FRAC_PI_2));
        let pose = frame.map_from_cells(2.0, 0.0, 0.0);
        assert!(pose.is_within(Pose::new(10.0, 21.0, FRAC_PI_2), 1e-12, 1e-12));
    }
}
