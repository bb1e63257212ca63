//! The votes as an aid (sections I and VI): the share of the poses in which Markov
//! localization needs to compute its belief once the votes are in, the share of the
//! particles that Monte Carlo localization needs, and time and success of both with and
//! without that help. The heading is unknown.

use std::collections::HashSet;

use crate::baselines::{Baseline, Estimate, MonteCarlo, MonteCarloConfig, RayCasting, Readings};
use crate::distinct;
use crate::scans::{ScanConfig, SimulatedScan, simulate};
use crate::timing::cpu_ms;
use crate::worlds::{Kind, World};
use engine::grid::GridFrame;
use engine::particles::Candidate;
use engine::space::Space;
use engine::taper::TaperShape;
use engine::vote_search::{Outcome, Prior, VoteSearch, VoteSearchConfig, Workspace};
use geometry::{Covariance, Pose};
use plots::drawing::Scene;
use plots::{Curve, Curves};
use statistics::SUCCESS;

use super::folder::{Csv, digits};
use super::interval::{self, Interval};

/// Noise of the readings, per cent of their ranges.
const NOISE: [u32; 3] = [2, 5, 10];
const P_OVER_N: f64 = 0.10;
const HEADINGS: u32 = 360;

/// Number of distinct poses around which particles start, at most.
const CANDIDATES: usize = 64;

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    /// Cells a side.
    pub(super) size: usize,
    pub(super) beams: usize,
    /// Maps, and scans in each.
    pub(super) worlds: u64,
    pub(super) scans: usize,
}

/// Time and success of a method over all scans.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tally {
    /// The geometric mean.
    pub(super) cpu_ms: Interval,
    pub(super) found: Interval,
}

/// What the votes save at one noise.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Saved {
    pub(super) noise_percent: u32,
    pub(super) scans: usize,
    /// Share of the poses that the votes leave, and of the cells.
    pub(super) poses: Interval,
    pub(super) cells: Interval,
    /// Particles at the start with the votes' help, over those without.
    pub(super) particles: Interval,
    /// The votes alone; Markov localization and particles without and with them. The
    /// times with help have that of the votes in them.
    pub(super) votes: Tally,
    pub(super) markov: Tally,
    pub(super) markov_helped: Tally,
    pub(super) monte_carlo: Tally,
    pub(super) monte_carlo_helped: Tally,
}

/// One scan.
struct Trial {
    poses: f64,
    cells: f64,
    particles: f64,
    /// In the order of `Saved`: milliseconds, and whether the robot was found.
    outcomes: [(f64, bool); 5],
}

/// Measures at each noise.
///
/// # Errors
/// A map or a scan cannot be made.
pub(super) fn measure(
    extent: Extent,
    seed: u64,
    mut step: impl FnMut(String),
) -> anyhow::Result<Vec<Saved>> {
    let mut all = Vec::new();
    for noise_percent in NOISE {
        let mut trials = Vec::new();
        for world in 0..extent.worlds {
            step(format!(
                "as an aid, noise {noise_percent} %, map {}",
                world + 1
            ));
            let bench = Bench::new(extent, noise_percent, seed + world)?;
            trials.extend(bench.trials(extent.scans, seed + world)?);
        }
        all.push(summarized(noise_percent, &trials));
    }
    Ok(all)
}

/// A map that is prepared for all methods.
struct Bench {
    world: World,
    space: Space,
    config: ScanConfig,
    vote_search: VoteSearch,
    markov: RayCasting,
}

impl Bench {
    fn new(extent: Extent, noise_percent: u32, seed: u64) -> anyhow::Result<Self> {
        let sides = (extent.size, extent.size);
        let world = World::generate(Kind::Rooms, sides, P_OVER_N, seed)?;
        let space = world.space(HEADINGS)?;
        let config = ScanConfig {
            beams: extent.beams,
            noise_percent: f64::from(noise_percent),
        };
        let frame = GridFrame {
            resolution_m: space.resolution_m,
            map_from_grid: Pose::IDENTITY,
        };
        let settings = VoteSearchConfig {
            headings: HEADINGS,
            votes: config.votes(TaperShape::Trapezoid),
            ..VoteSearchConfig::default()
        };
        let vote_search = VoteSearch::new(frame, world.grid.clone(), settings, Prior::None);
        Ok(Bench {
            vote_search: vote_search?,
            markov: RayCasting::new(&world, &space),
            world,
            space,
            config,
        })
    }

    fn trials(mut self, count: usize, seed: u64) -> anyhow::Result<Vec<Trial>> {
        let scans = simulate(&self.world, &self.space, &self.config, count, seed)?;
        scans.iter().map(|scan| self.trial(scan)).collect()
    }

    fn trial(&mut self, scan: &SimulatedScan) -> anyhow::Result<Trial> {
        let votes = self.config.votes(TaperShape::Trapezoid);
        let readings = Readings::new(&scan.scan(), &self.space, &votes)?;
        let mut workspace = Workspace::default();
        let (outcome, votes_ms) = cpu_ms(|| {
            let found = self
                .vote_search
                .search_in(&mut workspace, &scan.scan(), &|| false);
            found.map(Option::<&Outcome>::cloned)
        });
        let outcome = outcome?.unwrap_or_default();
        let by_votes = self.is_best_near(&outcome, scan);
        let headings: Vec<usize> = (0..self.space.directions.count()).collect();
        let (all, markov_ms) = cpu_ms(|| self.markov.locate(&readings, &headings));
        let (some, helped_ms) = cpu_ms(|| self.markov_among(&readings, &outcome));
        let mut particles = self.particles(&readings);
        let (gathered, monte_carlo_ms) = cpu_ms(|| particles.locate(&readings, &headings));
        let without = particles.started_with() as f64;
        let (seeded, seeded_ms) = cpu_ms(|| {
            let candidates = self.candidates(&outcome);
            particles.locate_from(&readings, &candidates)
        });
        let near = |found: Option<Estimate>| found.is_some_and(|at| self.is_near(&at, scan));
        let (n, poses) = (self.world.grid.free_cells() as f64, &outcome.found.votes);
        let cells: HashSet<(u16, u16)> = poses.iter().map(|vote| (vote.x, vote.y)).collect();
        Ok(Trial {
            poses: poses.len() as f64 / (n * headings.len() as f64),
            cells: cells.len() as f64 / n,
            particles: particles.started_with() as f64 / without,
            outcomes: [
                (votes_ms, by_votes),
                (markov_ms, near(all)),
                (votes_ms + helped_ms, near(some)),
                (monte_carlo_ms, near(gathered)),
                (votes_ms + seeded_ms, near(seeded)),
            ],
        })
    }

    /// The belief of those poses alone that the votes leave.
    fn markov_among(&self, readings: &Readings, outcome: &Outcome) -> Option<Estimate> {
        let votes = outcome.found.votes.iter();
        let mut poses: Vec<(u16, u16, u16)> = votes.map(|v| (v.heading, v.y, v.x)).collect();
        poses.sort_unstable();
        let poses = poses.into_iter();
        let poses = poses.map(|(heading, y, x)| (x.into(), y.into(), heading.into()));
        self.markov.locate_among(readings, poses)
    }

    fn particles(&self, readings: &Readings) -> MonteCarlo {
        let sigma_cells = readings.median_sigma_cells();
        MonteCarlo::new(
            &self.world,
            &self.space,
            sigma_cells,
            MonteCarloConfig::default(),
        )
    }

    fn candidates(&self, outcome: &Outcome) -> Vec<Candidate> {
        let rounding_m = self.space.resolution_m / 2.0;
        let rounding = self.space.directions.spacing() / 2.0;
        let candidate = |map_from_target| Candidate {
            map_from_target,
            covariance: Covariance::from_deviations(rounding_m, rounding_m, rounding),
            weight: 1.0,
        };
        let poses = distinct(outcome, self.vote_search.frame(), CANDIDATES).into_iter();
        poses.map(candidate).collect()
    }

    fn is_best_near(&self, outcome: &Outcome, scan: &SimulatedScan) -> bool {
        outcome.found.votes.first().is_some_and(|best| {
            let at = Estimate {
                x: best.x.into(),
                y: best.y.into(),
                heading: best.heading.into(),
                score: 0.0,
            };
            self.is_near(&at, scan)
        })
    }

    fn is_near(&self, at: &Estimate, scan: &SimulatedScan) -> bool {
        let (dx, dy) = (at.x.abs_diff(scan.x) as f64, at.y.abs_diff(scan.y) as f64);
        let turned = (at.heading as f64 - scan.heading as f64) * self.space.directions.spacing();
        dx.hypot(dy) * self.space.resolution_m <= SUCCESS.0
            && geometry::wrap_angle(turned).abs() <= SUCCESS.1.to_radians()
    }
}

fn summarized(noise_percent: u32, trials: &[Trial]) -> Saved {
    let mean = |of: fn(&Trial) -> f64| {
        let values: Vec<f64> = trials.iter().map(of).collect();
        interval::of_mean(&values)
    };
    let tally = |method: usize| {
        let outcomes = || trials.iter().map(|trial| trial.outcomes[method]);
        let times: Vec<f64> = outcomes().map(|(ms, _)| ms).collect();
        Tally {
            cpu_ms: interval::of_ratio(&times),
            found: interval::of_share(outcomes().filter(|o| o.1).count(), times.len()),
        }
    };
    Saved {
        noise_percent,
        scans: trials.len(),
        poses: mean(|trial| trial.poses),
        cells: mean(|trial| trial.cells),
        particles: mean(|trial| trial.particles),
        votes: tally(0),
        markov: tally(1),
        markov_helped: tally(2),
        monte_carlo: tally(3),
        monte_carlo_helped: tally(4),
    }
}

impl Saved {
    /// All methods with their names.
    fn methods(&self) -> [(&'static str, &Tally); 5] {
        [
            ("votes", &self.votes),
            ("markov", &self.markov),
            ("markov_with_votes", &self.markov_helped),
            ("monte_carlo", &self.monte_carlo),
            ("monte_carlo_with_votes", &self.monte_carlo_helped),
        ]
    }
}

/// A row for each noise and method.
pub(super) fn csv(all: &[Saved]) -> Csv {
    let mut csv = Csv::new(&[
        "noise_percent",
        "scans",
        "method",
        "cpu_ms",
        "cpu_ms_low_95",
        "cpu_ms_high_95",
        "found",
        "found_low_95",
        "found_high_95",
        "share_of_poses_left",
        "share_of_cells_left",
        "share_of_particles_left",
    ]);
    for saved in all {
        for (name, tally) in saved.methods() {
            let mut row = vec![
                saved.noise_percent.to_string(),
                saved.scans.to_string(),
                name.to_owned(),
            ];
            row.extend([tally.cpu_ms, tally.found].map(Interval::fields).concat());
            let left = [saved.poses, saved.cells, saved.particles];
            row.extend(left.map(|share| digits(share.value)));
            csv.push(row);
        }
    }
    csv
}

/// The times over the noise.
///
/// # Errors
/// The picture would be too large.
pub(super) fn draw(extent: Extent, all: &[Saved]) -> anyhow::Result<Scene> {
    let names = [
        "votes alone",
        "Markov, everywhere",
        "Markov, where the votes say",
        "Monte Carlo, from everywhere",
        "Monte Carlo, from the votes",
    ];
    let curve = |(i, name): (usize, &str)| Curve {
        name: name.to_owned(),
        color: i,
        is_dashed: false,
        points: all
            .iter()
            .map(|saved| saved.methods()[i].1.cpu_ms.at(saved.noise_percent.into()))
            .collect(),
    };
    plots::draw_curves(&Curves {
        title: "The votes as an aid: time for one scan, heading unknown".into(),
        says: format!(
            "{size} × {size} cells, p/n 10 %, {beams} beams, {scans} scans a point; with help, the votes' own time is included; bars hold 95 %",
            size = extent.size,
            beams = extent.beams,
            scans = extent.worlds * extent.scans as u64,
        ),
        x: "standard deviation of a reading, % of its range".into(),
        y: "processor time, ms".into(),
        by_decades: true,
        curves: names.into_iter().enumerate().map(curve).collect(),
    })
}
