//! Buildings made of upright rectangles: the exact readings of a laser in them, and their map with
//! cells of any size.

use std::f64::consts::TAU;

use engine::Map;
use engine::grid::{CellRules, GridFrame};
use engine::localizer::{Localizer, Settings, Workspace};
use engine::peaks::Places;
use engine::scan::Scan;
use engine::vote_search::VoteSearchConfig;
use geometry::Pose;

/// Left, bottom, right and top, metres.
pub type Rectangle = [f64; 4];

/// Obstacles in open space.
#[derive(Debug, Clone)]
pub struct Building {
    /// Extent along x and y from the origin, metres.
    pub size_m: [f64; 2],
    /// Obstacles that a laser sees.
    pub obstacles: Vec<Rectangle>,
}

/// Beams, field of view and range of a laser.
#[derive(Debug, Clone, Copy)]
pub struct Laser {
    /// Number of readings of a scan.
    pub beams: usize,
    /// Angle from the first to the last bearing, radians; ahead is the middle.
    pub field_of_view: f64,
    /// Largest range that returns, metres.
    pub reach_m: f64,
}

impl Laser {
    /// All around, one beam per degree, up to 8 m.
    pub const AROUND: Laser = Laser {
        beams: 360,
        field_of_view: 359.0 / 360.0 * TAU,
        reach_m: 8.0,
    };

    /// Makes a scan of these readings.
    pub fn scan<'a>(&self, ranges: &'a [f32]) -> Scan<'a> {
        Scan {
            angle_min: -self.field_of_view / 2.0,
            angle_increment: self.field_of_view / (self.beams - 1) as f64,
            range_min_m: 0.0,
            range_max_m: self.reach_m as f32,
            ranges,
        }
    }
}

impl Building {
    /// Makes open space of this size, metres.
    pub fn new(width_m: f64, height_m: f64) -> Self {
        Building {
            size_m: [width_m, height_m],
            obstacles: Vec::new(),
        }
    }

    pub fn with(mut self, obstacle: Rectangle) -> Self {
        self.obstacles.push(obstacle);
        self
    }

    /// Adds the four walls of a room.
    pub fn room(self, [left, bottom, right, top]: Rectangle) -> Self {
        const THICK: f64 = 0.1;
        self.with([left, bottom, right, bottom + THICK])
            .with([left, top - THICK, right, top])
            .with([left, bottom, left + THICK, top])
            .with([right - THICK, bottom, right, top])
    }

    /// Returns the readings of a laser at a pose, exact to the last bit.
    pub fn ranges(&self, pose: Pose, laser: Laser) -> Vec<f32> {
        let scan = laser.scan(&[]);
        let range = |beam: usize| {
            let (dy, dx) = (pose.yaw + scan.bearing(beam)).sin_cos();
            let hits = self.obstacles.iter().filter_map(|obstacle| {
                let along_x = crossing(pose.x, dx, [obstacle[0], obstacle[2]]);
                let along_y = crossing(pose.y, dy, [obstacle[1], obstacle[3]]);
                let (enter, leave) = (along_x.0.max(along_y.0), along_x.1.min(along_y.1));
                (enter <= leave && enter > 0.0).then_some(enter)
            });
            let nearest = hits.fold(f64::INFINITY, f64::min);
            if nearest <= laser.reach_m {
                nearest as f32
            } else {
                f32::INFINITY
            }
        };
        (0..laser.beams).map(range).collect()
    }

    /// Makes the map with cells of this size, metres; a cell is occupied if an obstacle covers any
    /// part of it.
    pub fn map(&self, resolution_m: f64) -> BuildingMap {
        let cells = |metres: f64| (metres / resolution_m).ceil() as usize;
        let (width, height) = (cells(self.size_m[0]), cells(self.size_m[1]));
        let mut occupancy = vec![0; width * height];
        for &[left, bottom, right, top] in &self.obstacles {
            // Up to a rounding, a wall that ends with a cell does not touch the next.
            let first = |metres: f64| (metres / resolution_m + 1e-6) as usize;
            let end = |metres: f64| (metres / resolution_m - 1e-6).ceil() as usize;
            for y in first(bottom)..end(top).min(height) {
                occupancy[y * width + first(left)..y * width + end(right).min(width)].fill(100);
            }
        }
        BuildingMap {
            frame: GridFrame::new(resolution_m, Pose::IDENTITY),
            sides: (width, height),
            occupancy,
        }
    }
}

/// Returns the distances along a ray at which it enters and leaves a strip.
fn crossing(start: f64, slope: f64, [low, high]: [f64; 2]) -> (f64, f64) {
    if slope == 0.0 {
        return if (low..=high).contains(&start) {
            (f64::NEG_INFINITY, f64::INFINITY)
        } else {
            (f64::INFINITY, f64::NEG_INFINITY)
        };
    }
    let (a, b) = ((low - start) / slope, (high - start) / slope);
    (a.min(b), a.max(b))
}

#[derive(Debug, Clone)]
pub struct BuildingMap {
    /// Resolution and pose of its grid.
    pub frame: GridFrame,
    /// Number of cells along x and y.
    pub sides: (usize, usize),
    /// Occupancy in per cent, row by row from the lowest y.
    pub occupancy: Vec<u8>,
}

impl BuildingMap {
    pub fn localizer(&self, config: VoteSearchConfig) -> Localizer {
        let view = Map {
            frame: self.frame,
            sides: self.sides,
            occupancy: &self.occupancy,
            rules: CellRules::default(),
        };
        let settings = Settings {
            vote_search: config,
            ..Settings::default()
        };
        Localizer::new(view, settings).unwrap()
    }
}

/// Returns the places at which a scan may have been taken.
pub fn places(localizer: &Localizer, scan: &Scan<'_>) -> Places {
    let mut workspace = Workspace::default();
    localizer
        .locate(&mut workspace, scan)
        .unwrap()
        .places
        .clone()
}
