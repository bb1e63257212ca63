//! Scan for the baselines: bearings on the heading grid, and readings with standard deviations.

use engine::program::VoteConfig;
use engine::scan::Scan;
use engine::space::Space;

/// Error in standard deviations at which a reading's penalty saturates: the flat part of a sensor
/// model, for objects that are not on the map.
pub(super) const MAX_DEVIATIONS: f32 = 3.0;
pub(super) const MAX_PENALTY: f32 = MAX_DEVIATIONS * MAX_DEVIATIONS;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Index on the heading grid.
    pub bearing: usize,
    pub cells: f64,
    /// Standard deviation of the range, at least one cell.
    pub sigma_cells: f64,
}

/// A reading to be compared with ranges along a direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Expected {
    /// Standard deviations per step of range.
    scale: f32,
    /// The reading in standard deviations.
    reading: f32,
}

impl Reading {
    pub(super) fn along(&self, steps_per_cell: f64) -> Expected {
        Expected {
            scale: (1.0 / (steps_per_cell * self.sigma_cells)) as f32,
            reading: (self.cells / self.sigma_cells) as f32,
        }
    }
}

impl Expected {
    /// Squared deviation of a range in steps, up to the highest penalty.
    #[inline(always)]
    pub(super) fn penalty(self, steps: f32) -> f32 {
        let deviations = steps * self.scale - self.reading;
        (deviations * deviations).min(MAX_PENALTY)
    }
}

#[derive(Debug, Clone, PartialEq)]
pub struct Readings {
    /// In the order of the scan.
    pub beams: Vec<Reading>,
}

impl Readings {
    /// Converts all readings, with the standard deviations of the votes.
    pub fn new(scan: &Scan<'_>, space: &Space, votes: &VoteConfig) -> anyhow::Result<Self> {
        scan.check()?;
        let reading = |i| {
            let range_m = scan.reading(i).filter(|&m| m <= space.longest_m)?;
            let sigma_m = votes.sigma_m + votes.sigma_per_m * range_m;
            Some(Reading {
                bearing: space.directions.nearest(scan.bearing(i)).0,
                cells: range_m / space.resolution_m,
                sigma_cells: (sigma_m / space.resolution_m).max(1.0),
            })
        };
        Ok(Readings {
            beams: (0..scan.ranges.len()).filter_map(reading).collect(),
        })
    }

    /// Median standard deviation, for methods with a single one; 1 without beams.
    pub fn median_sigma_cells(&self) -> f64 {
        let sigmas = self.beams.iter().map(|beam| beam.sigma_cells).collect();
        let median = crate::timing::median(sigmas);
        if median.is_nan() { 1.0 } else { median }
    }
}
