//! Simulated scans: rays cast by the engine's definition of a range, from random free poses on the
//! heading grid, with normal noise.

use std::f64::consts::TAU;

use answers::statistics::SUCCESS;
use anyhow::anyhow;
use engine::program::VoteConfig;
use engine::reference;
use engine::scan::Scan;
use engine::space::Space;
use engine::taper::TaperShape;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

use crate::baselines::Estimate;
use crate::worlds::World;

/// Share of the beams that must have a return.
const MIN_RETURNS: f64 = 0.9;

/// Maximum number of random poses tried per scan.
const TRIES: usize = 10_000;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScanConfig {
    /// Number of beams, evenly over a full turn; it must divide the number of headings.
    pub beams: usize,
    /// Standard deviation of a reading, per cent of its range.
    pub noise_percent: f64,
}

impl ScanConfig {
    pub const fn new(beams: usize, noise_percent: f64) -> Self {
        ScanConfig {
            beams,
            noise_percent,
        }
    }

    /// Settings of the votes to match: the same standard deviation, and equal weights.
    pub fn votes(&self, taper: TaperShape) -> VoteConfig {
        let mut votes = VoteConfig {
            taper,
            sigma_m: 0.0,
            sigma_per_m: self.noise_percent / 100.0,
            ..VoteConfig::default()
        };
        votes.beams.max_beams = self.beams as u32;
        votes.beams.beam_arc_m = 0.0;
        votes
    }
}

/// Number of bearings of a ring scan: one per degree.
const RING_BEARINGS: usize = 360;

/// Separates the random numbers of bearings from those of poses and readings.
const BEARING_ERRORS: u64 = 0x5f0b_3a91;

/// A ring of few rangefinders, each reading along its axis only: the eight sonars of the paper,
/// which neglects σ_θ (section II A).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingConfig<'a> {
    /// Bearings of the rangefinders, whole degrees counter-clockwise from ahead.
    pub bearings_deg: &'a [i32],
    /// Standard deviation of a reading, per cent of its range.
    pub noise_percent: f64,
    /// Standard deviation of the true bearing of a reading, degrees; bearings are rounded to whole
    /// degrees.
    pub bearing_sigma_deg: f64,
}

impl RingConfig<'_> {
    /// Settings of the votes to match: one taper per rangefinder, and equal weights.
    pub fn votes(&self, taper: TaperShape) -> VoteConfig {
        let all = ScanConfig::new(RING_BEARINGS, self.noise_percent);
        all.votes(taper)
    }
}

/// Simulates `count` scans of a ring at random poses: 360 readings a degree apart, NaN without a
/// rangefinder. Headings are those of a grid of 360.
/// Fails if the space has other headings, or no pose has enough returns.
pub fn simulate_ring(
    world: &World,
    space: &Space,
    ring: &RingConfig<'_>,
    count: usize,
    seed: u64,
) -> anyhow::Result<Vec<SimulatedScan>> {
    let headings = space.directions.count();
    if headings != RING_BEARINGS {
        return Err(misfit(RING_BEARINGS, headings));
    }
    // Simulates all bearings and drops those in between, so that each reading is equal to that of a
    // full scan with the same seed.
    let config = ScanConfig::new(RING_BEARINGS, ring.noise_percent);
    let mut scans = simulate(world, space, &config, count, seed)?;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed ^ BEARING_ERRORS);
    for scan in &mut scans {
        scan.ranges = looked_at(&scan.ranges, ring, &mut rng);
    }
    Ok(scans)
}

/// Selects the readings of a ring from a full scan.
fn looked_at(full: &[f32], ring: &RingConfig<'_>, rng: &mut Xoshiro256PlusPlus) -> Vec<f32> {
    let turn = RING_BEARINGS as i32;
    let mut ranges = vec![f32::NAN; RING_BEARINGS];
    for &degrees in ring.bearings_deg {
        let error: f64 = StandardNormal.sample(rng);
        let truly = degrees + (ring.bearing_sigma_deg * error).round() as i32;
        let at = |degrees: i32| degrees.rem_euclid(turn) as usize;
        ranges[at(degrees)] = full[at(truly)];
    }
    ranges
}

#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedScan {
    /// Column of the cell.
    pub x: usize,
    /// Row of the cell.
    pub y: usize,
    /// Index on the heading grid.
    pub heading: usize,
    /// In metres; infinite without a return.
    pub ranges: Vec<f32>,
}

impl SimulatedScan {
    /// Returns true if a pose is within 0.5 m and 10° of the true one.
    pub fn is_found_at(&self, at: &Estimate, space: &Space) -> bool {
        let (dx, dy) = (at.x.abs_diff(self.x) as f64, at.y.abs_diff(self.y) as f64);
        let turned = (at.heading as f64 - self.heading as f64) * space.directions.spacing();
        dx.hypot(dy) * space.resolution_m <= SUCCESS.0
            && geometry::wrap_angle(turned).abs() <= SUCCESS.1.to_radians()
    }

    pub fn scan(&self) -> Scan<'_> {
        Scan {
            angle_min: 0.0,
            angle_increment: TAU / self.ranges.len() as f64,
            range_min_m: 0.0,
            range_max_m: f32::MAX,
            ranges: &self.ranges,
        }
    }
}

/// Simulates `count` scans at random poses.
/// Fails if the number of beams does not divide the headings, or no pose has enough returns.
pub fn simulate(
    world: &World,
    space: &Space,
    config: &ScanConfig,
    count: usize,
    seed: u64,
) -> anyhow::Result<Vec<SimulatedScan>> {
    let headings = space.directions.count();
    if config.beams == 0 || !headings.is_multiple_of(config.beams) {
        return Err(misfit(config.beams, headings));
    }
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    (0..count)
        .map(|_| simulate_one(world, space, config, &mut rng))
        .collect()
}

fn simulate_one(
    world: &World,
    space: &Space,
    config: &ScanConfig,
    rng: &mut Xoshiro256PlusPlus,
) -> anyhow::Result<SimulatedScan> {
    for _ in 0..TRIES {
        let (x, y) = (
            rng.random_range(0..world.grid.width()),
            rng.random_range(0..world.grid.height()),
        );
        let heading = rng.random_range(0..space.directions.count());
        if !world.grid.is_open(x as i64, y as i64) {
            continue;
        }
        let ranges = look_out(world, space, config, (x, y, heading), rng);
        let returns = ranges.iter().filter(|range| range.is_finite()).count();
        if returns as f64 >= MIN_RETURNS * config.beams as f64 {
            return Ok(SimulatedScan {
                x,
                y,
                heading,
                ranges,
            });
        }
    }
    Err(anyhow!("none of {TRIES} random poses has enough returns"))
}

fn misfit(beams: usize, headings: usize) -> anyhow::Error {
    anyhow!("{beams} beams do not fall on a grid of {headings} headings: it must be a multiple")
}

fn look_out(
    world: &World,
    space: &Space,
    config: &ScanConfig,
    (x, y, heading): (usize, usize, usize),
    rng: &mut Xoshiro256PlusPlus,
) -> Vec<f32> {
    let apart = space.directions.count() / config.beams;
    let reading = |beam| {
        let direction = space.directions.get(heading + beam * apart);
        let Some(steps) = reference::range(&world.grid, x as i64, y as i64, direction) else {
            return f32::INFINITY;
        };
        let range_m = f64::from(steps) / direction.steps_per_cell * space.resolution_m;
        let error: f64 = StandardNormal.sample(rng);
        (range_m * (1.0 + config.noise_percent / 100.0 * error)) as f32
    };
    (0..config.beams).map(reading).collect()
}

#[cfg(test)]
mod tests {
    use engine::program::ScanProgram;

    use super::*;
    use crate::worlds::Kind;

    const EXACT: ScanConfig = ScanConfig::new(36, 0.0);

    fn world() -> World {
        World::generate(Kind::Rooms, (150, 120), 0.1, 7).unwrap()
    }

    #[test]
    fn without_noise_the_true_pose_has_all_votes() {
        let world = world();
        let space = world.space(72).unwrap();
        for scan in simulate(&world, &space, &EXACT, 20, 1).unwrap() {
            let config = EXACT.votes(TaperShape::Trapezoid);
            let program = ScanProgram::new(&scan.scan(), 0.0, &space, &config).unwrap();
            let (x, y) = (scan.x as i64, scan.y as i64);
            let votes = reference::intensity(&world.grid, &program, &space, x, y, scan.heading);
            assert_eq!(u32::from(votes), program.highest_possible());
            assert_eq!(program.beams(), 36);
        }
    }

    #[test]
    fn noise_has_the_deviation_that_was_asked_for() {
        let world = world();
        let space = world.space(72).unwrap();
        let noisy = ScanConfig {
            noise_percent: 10.0,
            ..EXACT
        };
        let mut errors = Vec::new();
        for scan in simulate(&world, &space, &noisy, 100, 1).unwrap() {
            for (beam, &range) in scan.ranges.iter().enumerate() {
                let direction = space.directions.get(scan.heading + 2 * beam);
                let (x, y) = (scan.x as i64, scan.y as i64);
                let steps = reference::range(&world.grid, x, y, direction).unwrap();
                let true_m = f64::from(steps) / direction.steps_per_cell * space.resolution_m;
                errors.push(f64::from(range) / true_m - 1.0);
            }
        }
        let square_mean =
            errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64;
        // 3600 samples give the standard deviation to 1.2 %; four times that is allowed.
        let deviation = square_mean.sqrt();
        assert!((deviation - 0.10).abs() < 0.005, "{deviation}");
    }

    #[test]
    fn a_ring_reads_along_its_axes_and_nothing_else() {
        let world = world();
        let space = world.space(360).unwrap();
        let ring = RingConfig {
            bearings_deg: &[-90, 0, 41],
            noise_percent: 0.0,
            bearing_sigma_deg: 0.0,
        };
        for scan in simulate_ring(&world, &space, &ring, 3, 1).unwrap() {
            let (x, y) = (scan.x as i64, scan.y as i64);
            for (bearing, range) in scan.ranges.iter().enumerate() {
                let direction = space.directions.get(scan.heading + bearing);
                let steps = reference::range(&world.grid, x, y, direction).unwrap();
                let true_m = f64::from(steps) / direction.steps_per_cell * space.resolution_m;
                match [270, 0, 41].contains(&bearing) {
                    // The range is kept as an f32.
                    true => assert!((f64::from(*range) - true_m).abs() < 1e-5),
                    false => assert!(range.is_nan()),
                }
            }
        }
        assert!(simulate_ring(&world, &world.space(72).unwrap(), &ring, 1, 1).is_err());
    }

    #[test]
    fn beams_off_the_heading_grid_are_refused() {
        let world = world();
        let space = world.space(72).unwrap();
        let config = ScanConfig { beams: 7, ..EXACT };
        assert!(simulate(&world, &space, &config, 1, 1).is_err());
    }
}
