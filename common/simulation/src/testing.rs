//! Worlds for the tests of this crate.

use clap::Parser;
use geometry::Pose;
use map::OccupancyGrid;

use crate::DriveConfig;

/// A room of 10 m by 8 m with walls of 0.1 m, and a pillar.
pub(crate) fn room() -> OccupancyGrid {
    let (width, height) = (100, 80);
    let is_wall = |x, y| x == 0 || y == 0 || x == width - 1 || y == height - 1;
    let is_pillar = |x, y| (60..64).contains(&x) && (50..54).contains(&y);
    let cells = (0..width * height).map(|i| (i % width, i / width));
    let cells = cells.map(|(x, y)| 100 * u8::from(is_wall(x, y) || is_pillar(x, y)));
    OccupancyGrid::from_parts(width, height, 0.1, Pose::IDENTITY, cells.collect()).unwrap()
}

#[derive(Parser)]
struct Line {
    #[command(flatten)]
    config: DriveConfig,
}

/// Parses settings as on the command line.
pub(crate) fn config(options: &str) -> DriveConfig {
    let words = std::iter::once("drive").chain(options.split_whitespace());
    Line::try_parse_from(words).unwrap().config
}
