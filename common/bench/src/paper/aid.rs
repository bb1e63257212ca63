//! The votes as an aid (sections I and VI): the share of the poses in which Markov
//! localization needs to compute its belief once the votes are in, the share of the
//! particles that Monte Carlo localization needs, and time and success of both with and
//! without that help. The heading is unknown.

use std::collections::HashSet;

use crate::baselines::{Baseline, Estimate, MonteCarlo, RayCasting, Readings};
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

use super::folder::{Csv, digits};
use super::interval::{self, Interval};

/// Noise of the readings, per cent of their ranges.
const NOISE: [u32; 3] = [2, 5, 10];
const P_OVER_N: f64 = 0.10;
const HEADINGS: u32 = 360;

/// Number of distinct poses around which particles start, at most.
const CANDIDATES: usize = 64;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    pub(super) size: usize,
    pub(super) beams: usize,
    /// Maps, and scans in each.
    pub(super) worlds: u64,
    pub(super) scans: usize,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tally {
    pub(super) cpu_ms: Interval,
    pub(super) found: Interval,
}

/// Names in tables and in the picture. The times with help have that of the votes in them.
const METHODS: [(&str, &str); 5] = [
    ("votes", "votes alone"),
    ("markov", "Markov, everywhere"),
    ("markov_with_votes", "Markov, where the votes say"),
    ("monte_carlo", "Monte Carlo, from everywhere"),
    ("monte_carlo_with_votes", "Monte Carlo, from the votes"),
];

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Saved {
    noise_percent: u32,
    scans: usize,
    /// Shares that the votes leave of the poses, the cells, and the particles at the start.
    left: [f64; 3],
    tallies: [Tally; 5],
}

struct Trial {
    left: [f64; 3],
    /// In the order of [`METHODS`]: milliseconds, and whether the robot was found.
    outcomes: [(f64, bool); 5],
}

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
        let config = ScanConfig::new(extent.beams, f64::from(noise_percent));
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
                .search_in(&mut workspace, &scan.scan(), None, &|| false);
            found.map(Option::<&Outcome>::cloned)
        });
        let outcome = outcome?.unwrap_or_default();
        let near =
            |found: Option<Estimate>| found.is_some_and(|at| scan.is_found_at(&at, &self.space));
        let by_votes = near(outcome.found.votes.first().map(Estimate::from));
        let headings: Vec<usize> = (0..self.space.directions.count()).collect();
        let (all, markov_ms) = cpu_ms(|| self.markov.locate(&readings, &headings));
        let (some, helped_ms) = cpu_ms(|| self.markov_among(&readings, &outcome));
        let sigma_cells = readings.median_sigma_cells();
        let mut particles = MonteCarlo::new(&self.world, &self.space, sigma_cells);
        let (gathered, monte_carlo_ms) = cpu_ms(|| particles.locate(&readings, &headings));
        let without = particles.started_with as f64;
        let (seeded, seeded_ms) = cpu_ms(|| {
            let candidates = self.candidates(&outcome);
            particles.locate_from(&readings, &candidates)
        });
        let (n, poses) = (self.world.grid.free_cells() as f64, &outcome.found.votes);
        let cells: HashSet<(u16, u16)> = poses.iter().map(|vote| (vote.x, vote.y)).collect();
        Ok(Trial {
            left: [
                poses.len() as f64 / (n * headings.len() as f64),
                cells.len() as f64 / n,
                particles.started_with as f64 / without,
            ],
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
}

fn summarized(noise_percent: u32, trials: &[Trial]) -> Saved {
    let mean = |share: usize| {
        let values: Vec<f64> = trials.iter().map(|trial| trial.left[share]).collect();
        interval::of_mean(&values).value
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
        left: std::array::from_fn(mean),
        tallies: std::array::from_fn(tally),
    }
}

pub(super) fn csv(all: &[Saved]) -> Csv {
    let mut csv = Csv::new(
        "noise_percent,scans,method,cpu_ms,cpu_ms_low_95,cpu_ms_high_95,found,\
         found_low_95,found_high_95,share_of_poses_left,share_of_cells_left,\
         share_of_particles_left",
    );
    for saved in all {
        for ((name, _), tally) in METHODS.into_iter().zip(&saved.tallies) {
            let (noise, scans) = (saved.noise_percent.to_string(), saved.scans.to_string());
            let mut row = vec![noise, scans, name.to_owned()];
            row.extend([tally.cpu_ms, tally.found].map(Interval::fields).concat());
            row.extend(saved.left.map(digits));
            csv.push(row);
        }
    }
    csv
}

pub(super) fn draw(extent: Extent, all: &[Saved]) -> anyhow::Result<Scene> {
    let curve = |(i, (_, name)): (usize, (&str, &str))| Curve {
        name: name.to_owned(),
        color: i,
        is_dashed: false,
        points: all
            .iter()
            .map(|saved| saved.tallies[i].cpu_ms.at(saved.noise_percent.into()))
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
        curves: METHODS.into_iter().enumerate().map(curve).collect(),
    })
}
