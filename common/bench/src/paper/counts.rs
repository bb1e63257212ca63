//! Section II B: the operations of Markov localization and of reverse projection, counted
//! while both run, against the paper's formulas.

use crate::baselines::Readings;
use crate::counted::{self, Counts};
use crate::scans::{ScanConfig, simulate};
use crate::worlds::{Kind, World};
use engine::accumulator::Query;
use engine::program::ScanProgram;
use engine::taper::TaperShape;
use plots::drawing::Scene;
use plots::{Curve, CurvePoint, Curves};

use super::folder::{Csv, digits};

/// Boundary cells over free cells, per cent; from 120 on there are more of them.
const P_OVER_N: [u32; 10] = [5, 10, 25, 50, 100, 120, 150, 200, 250, 300];

/// As many beams as the robot of section IV has sonars.
const BEAMS: ScanConfig = ScanConfig::new(8, 10.0);

/// What was counted at one p/n, summed over all scans.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Counted {
    pub(super) p_over_n: u32,
    pub(super) n: u64,
    pub(super) p: u64,
    pub(super) scans: u64,
    pub(super) markov: Counts,
    pub(super) reverse: Counts,
    pub(super) most_votes: u16,
}

impl Counted {
    pub(super) const M: u64 = BEAMS.beams as u64;

    /// Free cells and beams, over all scans.
    pub(super) fn mn(&self) -> u64 {
        Self::M * self.n * self.scans
    }

    pub(super) fn mp(&self) -> u64 {
        Self::M * self.p * self.scans
    }

    /// The paper's count of Markov localization, n(2m + 1).
    pub(super) fn markov_formula(&self) -> u64 {
        self.n * self.scans * (2 * Self::M + 1)
    }

    /// Cells of a taper, on average.
    pub(super) fn k(&self) -> f64 {
        self.reverse.worst_additions as f64 / self.mp() as f64
    }
}

pub(super) fn count(side: usize, scans: usize, seed: u64) -> anyhow::Result<Vec<Counted>> {
    let count = |p_over_n| count_in(p_over_n, side, scans, seed);
    P_OVER_N.into_iter().map(count).collect()
}

fn count_in(p_over_n: u32, side: usize, scans: usize, seed: u64) -> anyhow::Result<Counted> {
    let ratio = f64::from(p_over_n) / 100.0;
    let world = World::generate(Kind::Rooms, (side, side), ratio, seed)?;
    let space = world.space(360)?;
    let votes = BEAMS.votes(TaperShape::Trapezoid);
    let mut counted = Counted {
        p_over_n,
        n: world.grid.free_cells() as u64,
        p: world.boundary.len() as u64,
        scans: scans as u64,
        markov: Counts::default(),
        reverse: Counts::default(),
        most_votes: 0,
    };
    for scan in simulate(&world, &space, &BEAMS, scans, seed)? {
        let program = ScanProgram::new(&scan.scan(), 0.0, &space, &votes)?;
        let readings = Readings::new(&scan.scan(), &space, &votes)?;
        let query = Query {
            program: &program,
            space: &space,
            heading: scan.heading,
        };
        counted.markov += counted::markov(&world, &readings, query).1;
        let mut beams = vec![0; world.grid.cells().len()];
        let count = |index: usize, _| beams[index] += 1;
        counted.reverse += counted::reverse_projection(&world, query, count);
        counted.most_votes = beams.into_iter().fold(counted.most_votes, u16::max);
    }
    Ok(counted)
}

/// Counts and formulas, for one scan.
pub(super) fn csv(all: &[Counted]) -> Csv {
    let mut csv = Csv::new(
        "p_over_n_percent,n,p,m,k,markov_operations,n_2m_plus_1,markov_additions,2mn,\
         reverse_operations,2mp,reverse_additions,kmp,mn,most_beams_for_a_cell",
    );
    for counted in all {
        let each = |sum: u64| digits(sum as f64 / counted.scans as f64);
        csv.push([
            counted.p_over_n.to_string(),
            counted.n.to_string(),
            counted.p.to_string(),
            Counted::M.to_string(),
            digits(counted.k()),
            each(counted.markov.operations),
            each(counted.markov_formula()),
            each(counted.markov.additions),
            each(2 * counted.mn()),
            each(counted.reverse.operations),
            each(2 * counted.mp()),
            each(counted.reverse.additions),
            each(counted.reverse.worst_additions),
            each(counted.mn()),
            counted.most_votes.to_string(),
        ]);
    }
    csv
}

type Value = fn(&Counted) -> f64;

/// All counts as shares of what Markov localization takes.
pub(super) fn draw(all: &[Counted]) -> anyhow::Result<Scene> {
    let curves: [(&str, usize, bool, Value); 5] = [
        ("operations, counted", 0, false, |c| {
            c.reverse.operations as f64 / c.markov.operations as f64
        }),
        ("2mp / n(2m+1)", 0, true, |c| {
            2.0 * c.mp() as f64 / c.markov_formula() as f64
        }),
        ("additions, counted", 1, false, |c| {
            c.reverse.additions as f64 / c.markov.additions as f64
        }),
        ("kmp / 2mn", 1, true, |c| {
            c.reverse.worst_additions as f64 / (2 * c.mn()) as f64
        }),
        ("mn / 2mn (Theorem 1)", 2, true, |_| 0.5),
    ];
    let curve = |(name, color, is_dashed, value): (&str, usize, bool, Value)| Curve {
        name: name.to_owned(),
        color,
        is_dashed,
        points: all
            .iter()
            .map(|counted| CurvePoint {
                x: 100.0 * counted.p as f64 / counted.n as f64,
                y: value(counted),
                interval: None,
            })
            .collect(),
    };
    let chart = Curves {
        title: "Operations of reverse projection against Markov localization".into(),
        says: format!(
            "1 is as many as Markov localization takes; {} beams, counted while both run; exact, so without intervals",
            Counted::M
        ),
        x: "p/n: boundary cells over free cells, %".into(),
        y: "share of Markov's".into(),
        by_decades: true,
        curves: curves.map(curve).to_vec(),
    };
    plots::draw_curves(&chart)
}
