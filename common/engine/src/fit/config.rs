//! Settings of the second stage, which compares beams with the map.

#[cfg(feature = "clap")]
use crate::config::{parse_length, parse_share, within};

/// Scores of end points by their distance to obstacles.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct FitConfig {
    /// Standard deviation of an end point around the obstacle that it belongs
    /// to, map errors included, metres, 0..=2; at least `--fit-sigma-cells`.
    #[cfg_attr(feature = "clap", arg(long, value_name = "METRES", default_value_t = 0.10, value_parser = parse_length))]
    pub fit_sigma_m: f64,
    /// Lower limit of `--fit-sigma-m` in cells of the map, 0.1..=10, since coarse maps are
    /// less exact.
    #[cfg_attr(feature = "clap", arg(long, value_name = "CELLS", default_value_t = 2.0, value_parser = within(0.1..=10.0, "cells")))]
    pub fit_sigma_cells: f64,
    /// Penalty for a beam that passes through an obstacle, as a share of its full
    /// score, 0..=1. A beam passes through if its reading is longer than the distance
    /// to the first obstacle by three standard deviations.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SHARE", default_value_t = 0.15, value_parser = parse_share))]
    pub through_penalty: f64,
    /// Score of a beam that ends behind unknown space, 0..=1; half of it if the beam also passes
    /// through an obstacle.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SHARE", default_value_t = 0.3, value_parser = parse_share))]
    pub unknown_score: f64,
    /// Tolerance for drawn maps, which leave out what their author did not know: the
    /// true place may score this much worse than another, 0..=1. A map counts as drawn
    /// if its walls are very straight.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.15, value_parser = parse_share))]
    pub drawn_doubt: f64,
}

impl Default for FitConfig {
    fn default() -> Self {
        FitConfig {
            fit_sigma_m: 0.10,
            fit_sigma_cells: 2.0,
            through_penalty: 0.15,
            unknown_score: 0.3,
            drawn_doubt: 0.15,
        }
    }
}

impl FitConfig {
    /// Returns the standard deviation in cells of a map.
    pub(crate) fn sigma_cells(&self, resolution_m: f64) -> f64 {
        (self.fit_sigma_m / resolution_m).max(self.fit_sigma_cells)
    }
}
