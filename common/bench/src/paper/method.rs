//! Figures 1 to 3: the method step by step on small maps, each step computed by
//! projection from the boundary cells.

use crate::scatter::Scatter;
use engine::EngineError;
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

/// Intensities of some beams from some boundary cells; none where nothing is projected.
#[derive(Default)]
struct Field {
    intensities: Vec<u16>,
    /// The highest one that is possible.
    highest: u32,
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

    fn field(&self, beams: &[usize], boundary: &[BoundaryCell]) -> Result<Field, EngineError> {
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
        let field = Scatter::new(&self.grid, boundary).field(&program, &self.space, 0);
        Ok(Field {
            intensities: field,
            highest: program.highest_possible(),
        })
    }

    /// The map, its cells shaded by a field: 1 is the highest intensity that is possible.
    fn panel(&self, caption: &str, field: &Field, arrows: Vec<Arrow>) -> Panel {
        let cell = |(index, &cell): (usize, &grid::Cell)| {
            let (x, y) = (index % self.grid.width(), index / self.grid.width());
            match cell {
                grid::Cell::Open => {
                    let votes = field.intensities.get(index).copied().unwrap_or(0);
                    Cell::Free(f64::from(votes) / f64::from(field.highest.max(1)))
                }
                _ if self.grid.touches_open(x as i64, y as i64) => Cell::Boundary,
                _ => Cell::Obstacle,
            }
        };
        Panel {
            caption: caption.to_owned(),
            sides: (self.grid.width(), self.grid.height()),
            cells: self.grid.cells().iter().enumerate().map(cell).collect(),
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
    let (none, field) = (Field::default(), example.field(&beams, &example.boundary)?);
    let own = beams.iter();
    let own = own.map(|&beam| example.forward(example.robot, beam, Some(Role::Reading)));
    let own = example.panel("a: the robot takes four readings", &none, own.collect());
    // No two share a row or a column, so that no arrows lie on one another.
    let places = [(2, 11), (4, 9), (6, 2), (8, 6), (10, 4), (12, 8)];
    let forward = places.into_iter().flat_map(|from| {
        let beams = beams.iter();
        beams
            .map(|&beam| example.forward(from, beam, None))
            .collect::<Vec<_>>()
    });
    let tried = "b: forward: tried from every free cell (six are drawn)";
    let reverse = "d: reverse: projected from the boundary cells";
    let backward = example.backward_from(&example.boundary, &beams);
    let panels = vec![
        example.with_robot(own),
        example.panel(tried, &none, forward.collect()),
        example.panel("c: the possible poses", &field, Vec::new()),
        example.panel(reverse, &field, backward),
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
        let field = example.field(beams, from)?;
        let arrows = example.backward_from(from, beams);
        Ok::<Panel, EngineError>(example.panel(caption, &field, arrows))
    };
    let (one, all) = ([BoundaryCell { x: 0, y: 9 }], &example.boundary);
    let every = "d: all four: most votes where the arrows meet";
    let panels = vec![
        step("a: one reading from one boundary cell, k = 5", &[4], &one)?,
        step("b: the same reading from all of them", &[4], all)?,
        step("c: a second reading is added", &[4, 2], all)?,
        step(every, &[0, 2, 4, 6], all)?,
    ];
    plots::draw_diagram(&Diagram {
        title: "Figure 2: taper and superposition".into(),
        says: "each reading adds the most votes where it falls, and fewer before and behind".into(),
        panels,
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
    let says = format!(
        "of {} projections from {} boundary cells {blocked} meet an obstacle first, and count nothing",
        arrows.len(),
        some.len()
    );
    let field = example.field(&looks, &example.boundary)?;
    let votes = example.panel("b: the votes of all boundary cells", &field, Vec::new());
    let projections = "a: projections from some boundary cells";
    let panels = vec![
        example.panel(projections, &Field::default(), arrows),
        example.with_robot(votes),
    ];
    plots::draw_diagram(&Diagram {
        title: "Figure 3: visibility".into(),
        says,
        panels,
    })
}
