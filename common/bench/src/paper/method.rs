//! Figures 1 to 3: the method step by step on small maps, each step computed by
//! projection from the boundary cells.

use crate::scatter::Scatter;
use engine::EngineError;
use engine::accumulator::{Accumulator, Query};
use engine::boundary;
use engine::directions::Direction;
use engine::grid::{self, CellRules, Grid};
use engine::program::{ScanProgram, VoteConfig};
use engine::scan::Scan;
use engine::space::Space;
use engine::taper::TaperShape;
use messages::BoundaryCell;
use plots::drawing::Scene;
use plots::{Arrow, Cell, Diagram, Panel, Role};

/// Beams of all figures, over a turn; cells are of one metre.
const BEAMS: usize = 8;

/// A robot in a small map, with one reading a beam.
struct Example {
    grid: Grid,
    boundary: Vec<BoundaryCell>,
    space: Space,
    robot: (i64, i64),
    /// Cells of the map, exact; infinite beside `looks`.
    readings: [f32; BEAMS],
    votes: VoteConfig,
}

impl Example {
    /// A map of rows from the highest y, `#` occupied; and beams in which the robot looks.
    fn new(rows: &[&str], robot: (i64, i64), looks: &[usize]) -> Result<Self, EngineError> {
        let width = rows.first().map_or(0, |row| row.len());
        let cells = rows.iter().rev().flat_map(|row| row.bytes());
        let cells: Vec<u8> = cells.map(|it| if it == b'#' { 100 } else { 0 }).collect();
        let grid = Grid::new(width, rows.len(), &cells, CellRules::default())?;
        let space = Space::new(BEAMS as u32, 1.0, width, rows.len())?;
        let mut readings = [f32::INFINITY; BEAMS];
        for &beam in looks {
            let direction = space.directions.get(beam);
            let steps = engine::reference::range(&grid, robot.0, robot.1, direction);
            readings[beam] = steps.map_or(f32::INFINITY, |steps| {
                (f64::from(steps) / direction.steps_per_cell) as f32
            });
        }
        let mut votes = VoteConfig {
            taper: TaperShape::Linear,
            // Votes of 15, 9 and 3 at 0, 1 and 2 cells from the reading: k = 5.
            sigma_m: 1.3,
            sigma_per_m: 0.0,
            ..VoteConfig::default()
        };
        votes.beams.beam_arc_m = 0.0;
        Ok(Example {
            boundary: boundary::extract(&grid),
            grid,
            space,
            robot,
            readings,
            votes,
        })
    }

    fn looks(&self) -> impl Iterator<Item = usize> + '_ {
        (0..BEAMS).filter(|&beam| self.readings[beam].is_finite())
    }

    /// Intensities of some beams from some boundary cells; and the highest possible one.
    fn field(
        &self,
        beams: &[usize],
        boundary: &[BoundaryCell],
    ) -> Result<(Vec<u16>, u32), EngineError> {
        let reading = |beam| match beams.contains(&beam) {
            true => self.readings[beam],
            false => f32::INFINITY,
        };
        let ranges: Vec<f32> = (0..BEAMS).map(reading).collect();
        let scan = Scan {
            angle_min: 0.0,
            angle_increment: std::f64::consts::TAU / BEAMS as f64,
            range_min_m: 0.0,
            range_max_m: f32::MAX,
            ranges: &ranges,
        };
        let program = ScanProgram::new(&scan, 0.0, &self.space, &self.votes)?;
        let query = Query {
            program: &program,
            space: &self.space,
            heading: 0,
        };
        let mut field = Vec::new();
        // Nothing stops it, so it fills the field.
        let filled = Scatter::new(&self.grid, boundary).fill(query, &mut field, &|| false);
        debug_assert!(filled.is_some());
        Ok((field, program.highest_possible()))
    }

    /// Cells shaded by a field, 1 the highest intensity that is possible.
    fn cells(&self, field: &[u16], highest: u32) -> Vec<Cell> {
        let cells = self.grid.cells().iter().enumerate();
        let cell = |(index, &cell): (usize, &grid::Cell)| {
            let (x, y) = (index % self.grid.width(), index / self.grid.width());
            match cell {
                grid::Cell::Open => {
                    let votes = field.get(index).copied().unwrap_or(0);
                    Cell::Free(f64::from(votes) / f64::from(highest.max(1)))
                }
                _ if self.grid.touches_open(x as i64, y as i64) => Cell::Boundary,
                _ => Cell::Obstacle,
            }
        };
        cells.map(cell).collect()
    }

    fn panel(&self, caption: &str, cells: Vec<Cell>, arrows: Vec<Arrow>) -> Panel {
        Panel {
            caption: caption.to_owned(),
            sides: (self.grid.width(), self.grid.height()),
            cells,
            arrows,
            robot: None,
        }
    }

    fn with_robot(&self, panel: Panel) -> Panel {
        Panel {
            robot: Some(middle(self.robot)),
            ..panel
        }
    }

    fn steps(&self, beam: usize) -> u16 {
        let direction = self.space.directions.get(beam);
        (f64::from(self.readings[beam]) * direction.steps_per_cell).round() as u16
    }

    /// A reading put to a free cell; it matches if it ends at the nearest obstacle.
    fn forward(&self, from: (i64, i64), beam: usize, role: Option<Role>) -> Arrow {
        let direction = self.space.directions.get(beam);
        let end = (0..self.steps(beam)).fold(from, |at, _| direction.advance(at.0, at.1));
        let range = engine::reference::range(&self.grid, from.0, from.1, direction);
        let found = match range == Some(self.steps(beam)) {
            true => Role::Projected,
            false => Role::Rejected,
        };
        Arrow {
            from: middle(from),
            to: middle(end),
            role: role.unwrap_or(found),
        }
    }

    /// A reading projected back; `None` where the boundary cell turns its back to it.
    fn backward(&self, from: BoundaryCell, beam: usize) -> Option<Arrow> {
        let from = (i64::from(from.x), i64::from(from.y));
        let back: Direction = self.space.directions.get(beam).opposite();
        let mut at = from;
        let mut role = Role::Projected;
        for _ in 0..self.steps(beam) {
            let next = back.advance(at.0, at.1);
            if !self.grid.is_open(next.0, next.1) {
                role = Role::Rejected;
                break;
            }
            at = next;
        }
        (at != from).then_some(Arrow {
            from: middle(from),
            to: middle(at),
            role,
        })
    }

    fn backward_from(&self, cells: &[BoundaryCell], beams: &[usize]) -> Vec<Arrow> {
        let cells = cells.iter();
        cells
            .flat_map(|&cell| beams.iter().filter_map(move |&it| self.backward(cell, it)))
            .collect()
    }
}

fn middle((x, y): (i64, i64)) -> (f64, f64) {
    (x as f64 + 0.5, y as f64 + 0.5)
}

const SQUARE: [&str; 14] = {
    let mut rows = ["#............#"; 14];
    (rows[0], rows[13]) = ("##############", "##############");
    rows
};

/// Figure 1: forward projection from all free cells, and reverse projection, in a square.
pub(super) fn draw_figure_1() -> anyhow::Result<Scene> {
    let example = Example::new(&SQUARE, (4, 9), &[0, 2, 4, 6])?;
    let beams: Vec<usize> = example.looks().collect();
    let field = example.field(&beams, &example.boundary);
    let (field, highest) = field?;
    let empty = || example.cells(&[], 1);
    let own = beams.iter();
    let own = own.map(|&beam| example.forward(example.robot, beam, Some(Role::Reading)));
    // No two share a row or a column, so that no arrows lie on one another.
    let places = [(2, 11), (4, 9), (6, 2), (8, 6), (10, 4), (12, 8)];
    let forward = places.into_iter().flat_map(|from| {
        let beams = beams.iter();
        beams
            .map(|&beam| example.forward(from, beam, None))
            .collect::<Vec<_>>()
    });
    let panels = vec![
        example.with_robot(example.panel(
            "a: the robot takes four readings",
            empty(),
            own.collect(),
        )),
        example.panel(
            "b: forward: tried from every free cell (six are drawn)",
            empty(),
            forward.collect(),
        ),
        example.panel(
            "c: the possible poses",
            example.cells(&field, highest),
            Vec::new(),
        ),
        example.panel(
            "d: reverse: projected from the boundary cells",
            example.cells(&field, highest),
            example.backward_from(&example.boundary, &beams),
        ),
    ];
    plots::draw_diagram(&Diagram {
        title: "Figure 1: forward and reverse projection".into(),
        says: format!(
            "{} free cells against {} boundary cells; readings are exact, and the heading is known",
            example.grid.free_cells(),
            example.boundary.len()
        ),
        panels,
    })
}

/// Figure 2: the taper of one reading, and the superposition of all.
pub(super) fn draw_figure_2() -> anyhow::Result<Scene> {
    let example = Example::new(&SQUARE, (4, 9), &[0, 2, 4, 6])?;
    let step = |caption: &str, beams: &[usize], from: &[BoundaryCell]| {
        let (field, highest) = example.field(beams, from)?;
        let arrows = example.backward_from(from, beams);
        Ok(example.panel(caption, example.cells(&field, highest), arrows))
    };
    let left: Vec<BoundaryCell> = example
        .boundary
        .iter()
        .copied()
        .filter(|cell| cell.x == 0)
        .collect();
    let one: Vec<BoundaryCell> = left.iter().copied().filter(|cell| cell.y == 9).collect();
    let all = &example.boundary;
    let panels: Result<Vec<Panel>, EngineError> = [
        step("a: one reading from one boundary cell, k = 5", &[4], &one),
        step("b: the same reading from all of them", &[4], all),
        step("c: a second reading is added", &[4, 2], all),
        step(
            "d: all four: most votes where the arrows meet",
            &[0, 2, 4, 6],
            all,
        ),
    ]
    .into_iter()
    .collect();
    plots::draw_diagram(&Diagram {
        title: "Figure 2: taper and superposition".into(),
        says: "each reading adds the most votes where it falls, and fewer before and behind".into(),
        panels: panels?,
    })
}

const ROOMS: [&str; 14] = [
    "####################",
    "#..................#",
    "#..................#",
    "#....####..........#",
    "#....####..........#",
    "#..................#",
    "#..........#.......#",
    "#..........#.......#",
    "#..........#########",
    "#..................#",
    "#...##.............#",
    "#...##.............#",
    "#..................#",
    "####################",
];

/// Figure 3: what obstacles leave of the projections.
pub(super) fn draw_figure_3() -> anyhow::Result<Scene> {
    let looks = [0, 1, 3, 4, 6];
    let example = Example::new(&ROOMS, (8, 7), &looks)?;
    let some = [(19, 6), (19, 7), (11, 6), (0, 7), (5, 9), (8, 0), (4, 0)];
    let some: Vec<BoundaryCell> = some.map(|(x, y)| BoundaryCell { x, y }).to_vec();
    let arrows = example.backward_from(&some, &looks);
    let blocked = arrows.iter().filter(|arrow| arrow.role == Role::Rejected);
    let blocked = blocked.count();
    let field = example.field(&looks, &example.boundary);
    let (field, highest) = field?;
    let says = format!(
        "of {} projections from {} boundary cells {blocked} meet an obstacle first, and count nothing",
        arrows.len(),
        some.len()
    );
    let panels = vec![
        example.panel(
            "a: projections from some boundary cells",
            example.cells(&[], 1),
            arrows,
        ),
        example.with_robot(example.panel(
            "b: the votes of all boundary cells",
            example.cells(&field, highest),
            Vec::new(),
        )),
    ];
    plots::draw_diagram(&Diagram {
        title: "Figure 3: visibility".into(),
        says,
        panels,
    })
}
