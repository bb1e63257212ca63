//! Section IV: a robot with eight sonars in maps like those of figures 4 and 5, its pose
//! by the paper's method as written, at a known heading and unless said otherwise with
//! the Gaussian of Eq. 1 over the range alone.

use crate::scans::{RingConfig, SimulatedScan, simulate_ring};
use crate::timing::median;
use crate::worlds::{Kind, World};
use engine::grid::{Cell, CellRules};
use engine::peaks::PeakConfig;
use engine::space::Space;
use engine::taper::TaperShape;
use engine::vote_search::{Prior, VoteSearchConfig};
use geometry::Pose;
use map::OccupancyGrid;
use offline::{EngineOptions, Field, World as Searched};
use plots::drawing::Scene;
use plots::{Curve, CurvePoint, Curves, Votes};
use simulation::TRANSDUCERS_DEG;

use super::super::scope::name_of;
use super::folder::{Csv, digits};
use super::interval::{self, Interval};
use super::ring::{self, Projection};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Place {
    /// The paper's figure that it is like.
    pub(super) figure: u32,
    kind: Kind,
    side: usize,
    p_over_n_percent: u32,
}

/// A hall with a few obstacles, and a building.
pub(super) const PLACES: [Place; 2] = [
    Place {
        figure: 4,
        kind: Kind::Boxes,
        side: 160,
        p_over_n_percent: 6,
    },
    Place {
        figure: 5,
        kind: Kind::Rooms,
        side: 240,
        p_over_n_percent: 8,
    },
];

/// The paper's errors of a reading, and one above them.
pub(super) const NOISE: [u32; 4] = [3, 4, 5, 10];
/// What the variants below are compared at.
const COMMON_NOISE: u32 = 4;

/// Position and peak are one up to this distance, metres, as in all other tables.
const FOUND_M: f64 = 0.5;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Variant {
    pub(super) noise_percent: u32,
    pub(super) taper: TaperShape,
    /// Of the bearings in which readings are taken, and of Eq. 1, degrees.
    pub(super) true_sigma_deg: f64,
    pub(super) sigma_deg: f64,
}

impl Variant {
    const fn plain(noise_percent: u32) -> Self {
        Variant {
            noise_percent,
            taper: TaperShape::Gaussian,
            true_sigma_deg: 0.0,
            sigma_deg: 0.0,
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Judged {
    pub(super) place: Place,
    pub(super) variant: Variant,
    pub(super) poses: usize,
    /// Position error over the mean reading of the scan, per cent: the mean over all
    /// poses, the mean over those that were found, and the median over all.
    pub(super) mean_percent: Interval,
    pub(super) found_mean_percent: Interval,
    pub(super) median_percent: f64,
    pub(super) found: Interval,
}

/// All variants: the errors of a reading, the tapers, and the bearing.
pub(super) fn variants() -> Vec<Variant> {
    let mut all = NOISE.map(Variant::plain).to_vec();
    let common = Variant::plain(COMMON_NOISE);
    for taper in [TaperShape::Linear, TaperShape::Trapezoid, TaperShape::Box] {
        all.push(Variant { taper, ..common });
    }
    for (true_sigma_deg, sigma_deg) in [(0.0, 1.0), (1.0, 0.0), (1.0, 1.0)] {
        all.push(Variant {
            true_sigma_deg,
            sigma_deg,
            ..common
        });
    }
    all
}

/// Judges all variants in both maps, at this many poses each.
pub(super) fn judge(
    poses: usize,
    seed: u64,
    mut step: impl FnMut(),
) -> anyhow::Result<Vec<Judged>> {
    let mut all = Vec::new();
    for place in PLACES {
        let (world, space) = place.world(seed)?;
        for variant in variants() {
            all.push(judge_one(place, (&world, &space), variant, poses, seed)?);
            step();
        }
    }
    Ok(all)
}

impl Place {
    fn world(self, seed: u64) -> anyhow::Result<(World, Space)> {
        let ratio = f64::from(self.p_over_n_percent) / 100.0;
        let world = World::generate(self.kind, (self.side, self.side), ratio, seed)?;
        let space = world.space(360)?;
        Ok((world, space))
    }
}

fn ring_of(variant: Variant) -> RingConfig<'static> {
    RingConfig {
        bearings_deg: &TRANSDUCERS_DEG,
        noise_percent: f64::from(variant.noise_percent),
        bearing_sigma_deg: variant.true_sigma_deg,
    }
}

fn judge_one(
    place: Place,
    (world, space): (&World, &Space),
    variant: Variant,
    poses: usize,
    seed: u64,
) -> anyhow::Result<Judged> {
    let ring = ring_of(variant);
    let projection = Projection {
        votes: ring.votes(variant.taper),
        bearing_sigma_deg: variant.sigma_deg,
    };
    let (mut percents, mut of_found) = (Vec::new(), Vec::new());
    for scan in simulate_ring(world, space, &ring, poses, seed)? {
        let here = (world, space);
        let field = ring::intensities(here, &scan.scan(), scan.heading, &projection)?;
        let Some(best) = ring::best_cell(&field, world.grid.width()) else {
            percents.push(f64::INFINITY);
            continue;
        };
        let error_m = off_m(&scan, best, space);
        let percent = 100.0 * error_m / mean_reading(&scan);
        percents.push(percent);
        if error_m <= FOUND_M {
            of_found.push(percent);
        }
    }
    Ok(Judged {
        place,
        variant,
        poses: percents.len(),
        mean_percent: interval::of_errors(&percents),
        found_mean_percent: interval::of_errors(&of_found),
        found: interval::of_share(of_found.len(), percents.len()),
        median_percent: median(percents),
    })
}

fn off_m(scan: &SimulatedScan, (x, y): (usize, usize), space: &Space) -> f64 {
    let (dx, dy) = (x.abs_diff(scan.x) as f64, y.abs_diff(scan.y) as f64);
    dx.hypot(dy) * space.resolution_m
}

/// Metres.
fn mean_reading(scan: &SimulatedScan) -> f64 {
    let readings = scan.ranges.iter().filter(|range| range.is_finite());
    let (sum, count) = readings.fold((0.0, 0), |(sum, count), &range| {
        (sum + f64::from(range), count + 1)
    });
    sum / f64::from(count.max(1))
}

pub(super) fn csv(all: &[Judged]) -> Csv {
    let mut csv = Csv::new(
        "like_figure,noise_percent,taper,true_bearing_sigma_deg,bearing_sigma_deg,poses,\
         mean_error_percent,low_95,high_95,median_error_percent,found_within_0.5_m,\
         found_low_95,found_high_95,mean_error_of_found_percent,\
         mean_error_of_found_low_95,mean_error_of_found_high_95",
    );
    for judged in all {
        let variant = judged.variant;
        let mut row = vec![
            judged.place.figure.to_string(),
            variant.noise_percent.to_string(),
            name_of(&variant.taper),
            digits(variant.true_sigma_deg),
            digits(variant.sigma_deg),
            judged.poses.to_string(),
        ];
        row.extend(judged.mean_percent.fields());
        row.push(digits(judged.median_percent));
        row.extend(judged.found.fields());
        row.extend(judged.found_mean_percent.fields());
        csv.push(row);
    }
    csv
}

pub(super) fn draw_errors(all: &[Judged]) -> anyhow::Result<Scene> {
    let mut curves = Vec::new();
    for (color, place) in PLACES.into_iter().enumerate() {
        let plain = || {
            let here = all.iter().filter(move |judged| judged.place == place);
            here.filter(|judged| judged.variant == Variant::plain(judged.variant.noise_percent))
        };
        let name = |what: &str| format!("map like figure {}: {what}", place.figure);
        let x = |judged: &Judged| f64::from(judged.variant.noise_percent);
        let mut mean = |what, color, of: fn(&Judged) -> Interval| {
            curves.push(Curve {
                name: name(what),
                color,
                is_dashed: false,
                points: plain().map(|judged| of(judged).at(x(judged))).collect(),
            });
        };
        mean("mean of all poses", color, |judged| judged.mean_percent);
        mean(
            "mean of those found within 0.5 m",
            color + PLACES.len(),
            |judged| judged.found_mean_percent,
        );
    }
    let equal = NOISE.map(|noise| CurvePoint {
        x: f64::from(noise),
        y: f64::from(noise),
        interval: None,
    });
    curves.push(Curve {
        name: "as large as the error of a reading".into(),
        color: 6,
        is_dashed: true,
        points: equal.to_vec(),
    });
    plots::draw_curves(&Curves {
        title: "Section IV: position error of eight sonars".into(),
        says: "the paper's method as written, heading known; bars hold the mean with 95 %".into(),
        x: "standard deviation of a reading, % of its range".into(),
        y: "position error, % of the mean reading".into(),
        by_decades: false,
        curves,
    })
}

/// The intensity field of the first pose in a map, flat and as a surface.
pub(super) fn draw_field(place: Place, seed: u64) -> anyhow::Result<[Scene; 2]> {
    let (world, space) = place.world(seed)?;
    let ring = ring_of(Variant::plain(COMMON_NOISE));
    let mut scans = simulate_ring(&world, &space, &ring, 1, seed)?;
    let scan = scans.remove(0);
    let map = occupancy(&world, space.resolution_m)?;
    let field = field_of(&map, &scan, &ring, &space)?;
    let truth = Pose::new(
        (scan.x as f64 + 0.5) * space.resolution_m,
        (scan.y as f64 + 0.5) * space.resolution_m,
        scan.heading as f64 * space.directions.spacing(),
    );
    let title = format!("Eight sonars in a map like figure {}", place.figure);
    let best = field.outcome.found.votes.first();
    let off = best.map(|best| off_m(&scan, (best.x.into(), best.y.into()), &space));
    let says = format!(
        "one pose, readings with errors of {COMMON_NOISE} %, heading known; the peak is {:.2} m from the truth",
        off.unwrap_or(f64::NAN)
    );
    let rules = CellRules::default();
    let votes = Votes::whole((&map, rules), &field, Some(truth), (title, says));
    Ok([plots::draw_votes(&votes)?, plots::draw_surface(&votes)?])
}

fn occupancy(world: &World, resolution_m: f64) -> anyhow::Result<OccupancyGrid> {
    let cells = world.grid.cells().iter();
    let cells = cells.map(|&cell| if cell == Cell::Open { 0 } else { 100 });
    let (width, height) = (world.grid.width() as u32, world.grid.height() as u32);
    let (cells, origin) = (cells.collect(), Pose::IDENTITY);
    let map = OccupancyGrid::from_parts(width, height, resolution_m, origin, cells)?;
    Ok(map)
}

fn field_of(
    map: &OccupancyGrid,
    scan: &SimulatedScan,
    ring: &RingConfig<'_>,
    space: &Space,
) -> anyhow::Result<Field> {
    let votes = ring.votes(TaperShape::Gaussian);
    let options = EngineOptions {
        cells: CellRules::default(),
        vote_search: VoteSearchConfig {
            votes,
            ..VoteSearchConfig::default()
        },
        peaks: PeakConfig::default(),
    };
    let heading = scan.heading as f64 * space.directions.spacing();
    let searched = Searched::prepare(map, &options, Prior::Heading);
    let field = searched.and_then(|searched| searched.field_at(&scan.scan(), heading));
    Ok(field?)
}
