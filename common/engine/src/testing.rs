//! Random worlds for the tests of this crate.

use std::f64::consts::PI;
use std::ops::Range;

use geometry::{Covariance, Pose};
use messages::{UNKNOWN, Vote};
use proptest::collection::vec;
use proptest::option::of;
use proptest::prelude::*;

use crate::grid::{Cell, CellRules, Grid, GridFrame};
use crate::limits::{HeadingInterval, Limits, LimitsConfig, Region};
use crate::peaks::Place;
use crate::program::{ScanProgram, VoteConfig};
use crate::reference;
use crate::scan::Scan;
use crate::space::Space;
use crate::taper::TaperShape;
use crate::votes::{CollectConfig, Collector, VoteSet};

/// Side of a cell in tests, metres.
pub(crate) const RESOLUTION_M: f64 = 0.1;

/// Largest number of cells along a side of test grids; smaller under Miri, which interprets every
/// step.
const SIDE: usize = if cfg!(miri) { 9 } else { 40 };

/// Upper bound (exclusive) on the number of beams of test scans.
const BEAMS: usize = if cfg!(miri) { 5 } else { 24 };

/// Number of cells along the longer side of long grids: more steps than a byte can count.
const LONG: Range<usize> = if cfg!(miri) { 260..270 } else { 400..900 };

/// Ranges of a laser with one beam per degree all around, at the cell and heading (degrees) of a
/// grid.
pub(crate) fn ranges_at(
    grid: &Grid,
    resolution_m: f64,
    (x, y, heading): (i64, i64, usize),
) -> Vec<f32> {
    let space = Space::new(360, resolution_m, grid.width(), grid.height()).unwrap();
    let beams = (0..360).map(|beam| {
        let direction = space.directions.get(heading + 180 + beam);
        reference::range(grid, x, y, direction).map_or(f32::INFINITY, |steps| {
            (f64::from(steps) / direction.steps_per_cell * resolution_m) as f32
        })
    });
    beams.collect()
}

/// Scan with one beam per degree, all around if there are 360.
pub(crate) fn scan_around(ranges: &[f32]) -> Scan<'_> {
    Scan {
        angle_min: -PI,
        angle_increment: 1f64.to_radians(),
        range_min_m: 0.0,
        range_max_m: 30.0,
        ranges,
    }
}

/// Scan with the first beam and the next ones at these angles, in radians.
pub(crate) fn scan_from(angle_min: f64, angle_increment: f64, ranges: &[f32]) -> Scan<'_> {
    Scan {
        angle_min,
        angle_increment,
        range_min_m: 0.0,
        range_max_m: 100.0,
        ranges,
    }
}

pub(crate) fn vote(x: u16, y: u16, heading: u16, intensity: u16) -> Vote {
    Vote {
        x,
        y,
        heading,
        intensity,
    }
}

/// Place with a score and votes, of 100 possible ones, on the map with this number.
pub(crate) fn place(map: u32, score: f64, intensity: u16) -> Place {
    Place {
        map,
        map_from_laser: Pose::new(score, f64::from(intensity), 0.0),
        covariance: Covariance::from_deviations(0.1, 0.1, 0.01),
        score,
        probability: 0.0,
        intensity,
        possible: 100,
        drawn_doubt: 0.0,
        support: 1,
    }
}

/// Grid of occupancies by column, row and a byte of noise, always the same.
pub(crate) fn grid_of(
    (width, height): (usize, usize),
    occupancy: impl Fn(usize, usize, u8) -> u8,
) -> Grid {
    let mut state = 1u32;
    let cells = (0..width * height).map(|i| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        occupancy(i % width, i / width, (state >> 24) as u8)
    });
    let cells: Vec<u8> = cells.collect();
    Grid::new(width, height, &cells, CellRules::default()).expect("sides are in range")
}

/// Grids of 1 to [`SIDE`] cells a side, from empty to cluttered, with unknown cells that may block
/// and are often in one large piece.
pub(crate) fn any_grid() -> impl Strategy<Value = Grid> {
    let cells = |count: usize| {
        (1u32..60, 0u32..30).prop_flat_map(move |(occupied, unknown)| {
            let cell = prop_oneof![
                occupied => Just(100u8),
                unknown => Just(UNKNOWN),
                120 => Just(0u8),
            ];
            vec(cell, count)
        })
    };
    let ends = || (0..SIDE, 0..SIDE + SIDE / 2);
    (1..=SIDE, 1..=SIDE, any::<bool>(), ends(), ends()).prop_flat_map(
        move |(width, height, unknown_blocks, (left, right), (bottom, top))| {
            cells(width * height).prop_map(move |mut occupancy| {
                for y in bottom..top.min(height) {
                    for cell in occupancy[y * width..][..width]
                        .iter_mut()
                        .take(right)
                        .skip(left)
                    {
                        *cell = if *cell == 100 { 100 } else { UNKNOWN };
                    }
                }
                let rules = CellRules {
                    unknown_blocks,
                    ..CellRules::default()
                };
                Grid::new(width, height, &occupancy, rules).expect("sides are in range")
            })
        },
    )
}

/// Long and narrow grids with few obstacles, on which far readings need more than a byte of steps.
pub(crate) fn any_long_grid() -> impl Strategy<Value = Grid> {
    let cell = prop_oneof![1 => Just(100u8), 300 => Just(0u8)];
    (LONG, 1usize..4, any::<bool>()).prop_flat_map(move |(length, breadth, upright)| {
        let (width, height) = if upright {
            (breadth, length)
        } else {
            (length, breadth)
        };
        vec(cell.clone(), length * breadth).prop_map(move |occupancy| {
            Grid::new(width, height, &occupancy, CellRules::default()).expect("sides are in range")
        })
    })
}

/// Search space of a test grid.
pub(crate) fn space_of(grid: &Grid, headings: u32) -> Space {
    Space::new(headings, RESOLUTION_M, grid.width(), grid.height()).expect("headings are allowed")
}

/// Limits of a test grid: distance from free cells, region, radius, headings, or any combination.
pub(crate) fn any_limits(grid: &Grid, headings: u32) -> impl Strategy<Value = Limits> + use<> {
    let (grid, space) = (grid.clone(), space_of(grid, headings));
    let frame = GridFrame::new(RESOLUTION_M, Pose::new(1.0, -2.0, 0.3));
    let corner = || (-4.0..5.0f64, -4.0..4.0f64).prop_map(|(x, y)| [x, y]);
    let region = vec(corner(), 2..6).prop_map(|corners| Region::new(&corners).expect("corners"));
    let within = (0.0..6.3f64, 0.0..6.3f64).prop_map(|(from, to)| HeadingInterval { from, to });
    let radius = prop_oneof![Just(0.0), 0.05..0.3f64];
    let reach = prop_oneof![Just(0.0), 0.1..0.5f64, Just(1.0), Just(1000.0)];
    let config = (reach, radius, of(region), of(within));
    config.prop_map(
        move |(unknown_reach, robot_radius, region, headings_within)| {
            let config = LimitsConfig {
                unknown_reach,
                robot_radius,
                region,
                headings_within,
            };
            let limits = Limits::new(&config, frame, &grid, &space.directions);
            limits.unwrap_or_else(|_| Limits::none(grid.width()))
        },
    )
}

/// Occupancies of a grid.
pub(crate) fn occupancy_of(grid: &Grid) -> Vec<u8> {
    let occupancy = |cell: &Cell| match cell {
        Cell::Occupied => 100,
        Cell::Open => 0,
        Cell::Blocked => UNKNOWN,
    };
    grid.cells().iter().map(occupancy).collect()
}

/// Collects all poses by the reference implementation, as the search does.
pub(crate) fn plain_votes(
    grid: &Grid,
    program: &ScanProgram,
    space: &Space,
    config: CollectConfig,
) -> VoteSet {
    let limits = Limits::none(grid.width());
    plain_votes_within(&limits, grid, program, space, config)
}

/// Collects the poses within limits.
pub(crate) fn plain_votes_within(
    limits: &Limits,
    grid: &Grid,
    program: &ScanProgram,
    space: &Space,
    config: CollectConfig,
) -> VoteSet {
    let mut collector = Collector::new(config);
    for heading in 0..space.directions.count() {
        let field = reference::field(grid, program, space, heading);
        for (i, &intensity) in field.iter().enumerate() {
            let (x, y) = (i % grid.width(), i / grid.width());
            let is_held = limits.hold_cell(x, y) && limits.hold_heading(heading);
            let intensity = if is_held { intensity } else { 0 };
            collector.take(vote(x as u16, y as u16, heading as u16, intensity));
        }
    }
    collector.finished()
}

/// An arbitrary scan: readings from nothing to beyond the grid, any taper.
#[derive(Debug, Clone)]
pub(crate) struct AnyScan {
    ranges: Vec<f32>,
    angle_min: f64,
    config: VoteConfig,
}

impl AnyScan {
    /// The scan with all readings this many times as long.
    pub(crate) fn stretched(mut self, by: f32) -> Self {
        self.ranges.iter_mut().for_each(|range| *range *= by);
        self
    }

    pub(crate) fn scan(&self) -> Scan<'_> {
        let increment = 0.9 * std::f64::consts::TAU / self.ranges.len() as f64;
        scan_from(self.angle_min, increment, &self.ranges)
    }

    pub(crate) fn config(&self) -> VoteConfig {
        self.config
    }

    pub(crate) fn program(&self, space: &Space) -> ScanProgram {
        ScanProgram::new(&self.scan(), 0.0, space, &self.config).expect("the scan is sound")
    }
}

/// Test grids with limits and a number of headings, a multiple of 8 below `8 · eights`.
pub(crate) fn any_limited_grid(eights: u32) -> impl Strategy<Value = (Grid, Limits, u32)> {
    (any_grid(), 1..eights).prop_flat_map(|(grid, eights)| {
        let limits = any_limits(&grid, 8 * eights);
        (Just(grid), limits, Just(8 * eights))
    })
}

/// Scans of fewer than [`BEAMS`] beams with any taper, narrow or wide.
pub(crate) fn any_scan() -> impl Strategy<Value = AnyScan> {
    let reading = prop_oneof![8 => 0.05f32..4.5, 1 => Just(f32::INFINITY), 1 => Just(f32::NAN)];
    let taper = prop_oneof![
        Just(TaperShape::Gaussian),
        Just(TaperShape::Linear),
        Just(TaperShape::Trapezoid),
        Just(TaperShape::Box),
    ];
    let sigma_m = prop_oneof![4 => 0.0..0.4f64, 1 => 0.0..2.0f64];
    let sigma_per_m = prop_oneof![4 => Just(0.01), 1 => 0.0..0.25f64];
    (
        vec(reading, 1..BEAMS),
        -4.0..4.0f64,
        taper,
        sigma_m,
        sigma_per_m,
    )
        .prop_map(|(ranges, angle_min, taper, sigma_m, sigma_per_m)| AnyScan {
            ranges,
            angle_min,
            config: VoteConfig {
                taper,
                sigma_m,
                sigma_per_m,
                ..VoteConfig::default()
            },
        })
}
