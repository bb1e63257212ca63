//! Tables 1 and 2: the times of all methods as ratios to the paper's method as written,
//! beside the ratios that the paper prints.

use std::collections::BTreeMap;

use crate::worlds::Kind;
use engine::taper::TaperShape;
use plots::drawing::Scene;
use plots::{Curve, CurvePoint, Curves};

use super::super::contest::Effort;
use super::super::line_up::LineUp;
use super::super::method::Method;
use super::super::row::Row;
use super::super::scope::{Place, Sight, Table, name_of};
use super::folder::{Csv, digits};
use super::interval::{self, Interval};
use super::printed::{self, NOISE, P_OVER_N, Printed};

/// As many beams as the robot of the section has sonars.
const BEAMS: u32 = 8;
/// Boundary cells over free cells beyond the paper's tables, at the common noise, per cent.
const BEYOND: [u32; 4] = [135, 150, 200, 300];
/// The noise of table 2, and that at which table 1 is drawn, per cent.
pub(super) const COMMON_NOISE: u32 = 10;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    pub(super) size: u32,
    /// Worlds for each p/n, over which the intervals run.
    pub(super) worlds: u64,
    pub(super) effort: Effort,
}

/// A method in one case, over all worlds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Measured {
    pub(super) method: &'static str,
    pub(super) p_over_n: u32,
    pub(super) noise: u32,
    /// Cells of a taper, on average.
    pub(super) k: f64,
    /// Milliseconds for one scan, the geometric mean of the worlds' medians.
    pub(super) cpu_ms: Interval,
    /// Its time over that of the paper's method as written.
    pub(super) ratio: Interval,
    /// Share of scans that were found; NaN where only some headings were searched.
    pub(super) found: f64,
    /// The paper's ratio; `None` where it has none.
    pub(super) paper_ratio: Option<f64>,
}

pub(super) fn measure(
    table: Table,
    extent: Extent,
    mut step: impl FnMut(String),
) -> anyhow::Result<Vec<Measured>> {
    let mut rows: BTreeMap<(u32, u32), Vec<Vec<Row>>> = BTreeMap::new();
    for p_over_n in P_OVER_N.into_iter().chain(BEYOND) {
        for world in 0..extent.worlds {
            step(format!(
                "{}, p/n {p_over_n} %, map {}",
                name_of(&table),
                world + 1
            ));
            let place = Place {
                kind: Kind::Rooms,
                size: extent.size,
                p_over_n: f64::from(p_over_n),
                headings: 360,
            };
            let effort = Effort {
                seed: extent.effort.seed + world,
                ..extent.effort
            };
            let mut line_up = LineUp::new(table, place, effort.seed)?;
            let noises = match table {
                Table::Table1 if !BEYOND.contains(&p_over_n) => &NOISE[..],
                _ => &[COMMON_NOISE],
            };
            for &noise in noises {
                let sight = Sight {
                    beams: BEAMS,
                    noise_percent: f64::from(noise),
                    taper: TaperShape::Trapezoid,
                };
                let case = rows.entry((p_over_n, noise)).or_default();
                case.push(line_up.run(&sight, effort, || {})?);
            }
        }
    }
    let cases = rows.iter();
    Ok(cases
        .flat_map(|(&case, worlds)| summarized(table, case, worlds))
        .collect())
}

fn summarized(table: Table, (p_over_n, noise): (u32, u32), worlds: &[Vec<Row>]) -> Vec<Measured> {
    let Some(first) = worlds.first() else {
        return Vec::new();
    };
    let printed = match table {
        Table::Table1 => printed::table_1(p_over_n, noise),
        _ => printed::table_2(p_over_n),
    };
    let of = |method: &'static str| {
        let times: Vec<(f64, f64)> = worlds
            .iter()
            .filter_map(|rows| {
                let time = |name| rows.iter().find(|row| row.method == name)?.cpu_ms;
                Some((time(method)?, time(Method::Scatter.name())?))
            })
            .collect();
        let found = worlds.iter().flatten().filter(|row| row.method == method);
        let found: Vec<f64> = found.filter_map(|row| row.found).collect();
        let own: Vec<f64> = times.iter().map(|time| time.0).collect();
        let ratios: Vec<f64> = times.iter().map(|(own, scatter)| own / scatter).collect();
        Measured {
            method,
            p_over_n,
            noise,
            k: first.first().map_or(f64::NAN, |row| row.k),
            cpu_ms: interval::of_ratio(&own),
            ratio: interval::of_ratio(&ratios),
            found: interval::of_mean(&found).value,
            paper_ratio: printed.and_then(|printed| paper_ratio(method, printed)),
        }
    };
    first.iter().map(|row| of(row.method)).collect()
}

/// What the paper has for a method, as a ratio to its own.
fn paper_ratio(method: &str, printed: Printed) -> Option<f64> {
    let is = |other: Method| method == other.name();
    if is(Method::RayStepping) {
        return Some(printed.markov / printed.current);
    }
    if is(Method::PlainPatch) {
        return Some(printed.correlation / printed.current);
    }
    is(Method::Scatter).then_some(1.0)
}

pub(super) fn csv(all: &[Measured]) -> Csv {
    let mut csv = Csv::new(
        "p_over_n_percent,noise_percent,k,method,cpu_ms,cpu_ms_low_95,cpu_ms_high_95,\
         ratio,ratio_low_95,ratio_high_95,paper_ratio,found",
    );
    for row in all {
        let mut fields = vec![
            row.p_over_n.to_string(),
            row.noise.to_string(),
            digits(row.k),
            row.method.to_owned(),
        ];
        fields.extend([row.cpu_ms, row.ratio].map(Interval::fields).concat());
        fields.push(row.paper_ratio.map_or_else(String::new, digits));
        fields.push(digits(row.found));
        csv.push(fields);
    }
    csv
}

/// The ratios over p/n at the common noise, and the paper's, dashed.
pub(super) fn draw(table: Table, extent: Extent, all: &[Measured]) -> anyhow::Result<Scene> {
    let ours = match table {
        Table::Table1 => Method::Sweep,
        _ => Method::Search,
    };
    let shown = [
        (Method::RayStepping, "Markov, rays cell by cell"),
        (Method::RangeTable, "Markov, range table"),
        (Method::PlainPatch, "Correlation, pose by pose"),
        (Method::Field, "Correlation, likelihood field"),
        (Method::MonteCarlo, "Monte Carlo"),
        (ours, ours.names().1),
    ];
    let mut curves = Vec::new();
    for (color, (method, name)) in shown.into_iter().enumerate() {
        let here = || {
            let rows = all.iter().filter(move |row| row.noise == COMMON_NOISE);
            rows.filter(move |row| row.method == method.name())
        };
        let curve = |name: String, is_dashed, points| Curve {
            name,
            color,
            is_dashed,
            points,
        };
        let measured = here().map(|row| row.ratio.at(row.p_over_n.into()));
        curves.push(curve(name.to_owned(), false, measured.collect()));
        let printed = here().filter_map(|row| {
            Some(CurvePoint {
                x: f64::from(row.p_over_n),
                y: row.paper_ratio?,
                interval: None,
            })
        });
        let printed: Vec<CurvePoint> = printed.collect();
        if !printed.is_empty() {
            curves.push(curve(format!("{name}, the paper's"), true, printed));
        }
    }
    let (number, heading) = match table {
        Table::Table1 => (1, "heading known"),
        _ => (2, "heading unknown, 360 headings"),
    };
    plots::draw_curves(&Curves {
        title: format!("Table {number}: time over that of the paper's method as written"),
        says: format!(
            "{size} × {size} cells, {BEAMS} beams, noise {COMMON_NOISE} %, {heading}; bars hold 95 %, over {worlds} maps a point",
            size = extent.size,
            worlds = extent.worlds,
        ),
        x: "p/n: boundary cells over free cells, %".into(),
        y: "ratio of times".into(),
        by_decades: true,
        curves,
    })
}
