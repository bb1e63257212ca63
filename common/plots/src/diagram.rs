//! Panels of cells and arrows: a method drawn step by step on a small map.

use drawing::{Anchor, Color, Path, Rect, Scene, Stroke, TextStyle};

use super::axes::{self, Axis};
use super::field;
use super::page::{self, Entry, Heading, Page, Sample};
use super::scale::Scale;
use super::theme;
use crate::PlotError;

/// The caption above a panel, pixels of a picture of the common width.
const CAPTION: f64 = 34.0;

/// What a cell shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cell {
    /// The robot may stand here; 0..=1 of the highest intensity.
    Free(f64),
    /// An occupied cell.
    Obstacle,
    /// An obstacle that readings are projected from.
    Boundary,
}

/// What an arrow stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// A reading as the robot takes it.
    Reading,
    /// A reading put to a place where it may have been taken, or projected back from
    /// where it may have ended.
    Projected,
    /// The same, where it ends beyond an obstacle or is none.
    Rejected,
}

/// An arrow between two points, in cells from the lower left corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrow {
    /// Where it begins, cells.
    pub from: (f64, f64),
    /// Where its tip is, cells.
    pub to: (f64, f64),
    /// What it shows, by its colour.
    pub role: Role,
}

/// One step.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Above the panel.
    pub caption: String,
    /// Cells along x and y.
    pub sides: (usize, usize),
    /// Row by row from the lowest y.
    pub cells: Vec<Cell>,
    /// Over the cells.
    pub arrows: Vec<Arrow>,
    /// The true place of the robot, in cells.
    pub robot: Option<(f64, f64)>,
}

/// All steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagram {
    /// Above all panels.
    pub title: String,
    /// Below the title.
    pub says: String,
    /// In rows of two.
    pub panels: Vec<Panel>,
}

/// Draws the steps side by side, two in a row.
///
/// # Errors
/// The picture would be too large.
pub fn draw(diagram: &Diagram) -> Result<Scene, PlotError> {
    let width = page::COMMON_WIDTH;
    let unit = page::unit(width);
    let side = page::body_width(width) / 2.0;
    let ratios = diagram.panels.iter().map(|panel| {
        let (across, up) = panel.sides;
        up as f64 / across.max(1) as f64
    });
    let body = axes::inside(Rect::new(0.0, 0.0, side, side), unit);
    let rim = side - body.height + CAPTION * unit;
    let height = body.width * ratios.fold(0.0, f64::max) + rim;
    let rows = diagram.panels.len().div_ceil(2) as f64;
    let heading = Heading {
        title: diagram.title.clone(),
        verdict: None,
        says: diagram.says.clone(),
    };
    let mut page = Page::new(width, height * rows, &heading, &legend(diagram, unit))?;
    for (i, panel) in diagram.panels.iter().enumerate() {
        let (column, row) = ((i % 2) as f64, (i / 2) as f64);
        let (left, top) = (page.body.x + column * side, page.body.y + row * height);
        draw_panel(
            &mut page.scene,
            panel,
            Rect::new(left, top, side, height),
            unit,
        );
    }
    Ok(page.scene)
}

fn draw_panel(scene: &mut Scene, panel: &Panel, area: Rect, unit: f64) {
    let style = TextStyle::new(15.0 * unit, theme::INK).bold();
    let caption = page::fitted(style, &panel.caption, area.width - 76.0 * unit);
    let at = (area.x + 66.0 * unit, area.y + 24.0 * unit);
    scene.text(&panel.caption, at, &caption.anchored(Anchor::Start));
    let top = area.y + CAPTION * unit;
    let below = Rect::new(area.x, top, area.width, area.bottom() - top);
    let inside = axes::inside(below, unit);
    let (across, up) = (panel.sides.0 as f64, panel.sides.1 as f64);
    let cell = (inside.width / across).min(inside.height / up);
    let grid = Rect::new(inside.x, inside.y, cell * across, cell * up);
    draw_cells(scene, panel, grid, cell);
    let at = |(x, y): (f64, f64)| (grid.x + cell * x, grid.bottom() - cell * y);
    scene.clipped(grid, |scene| {
        for arrow in &panel.arrows {
            draw_arrow(scene, (at(arrow.from), at(arrow.to)), arrow.role, unit);
        }
    });
    if let Some(robot) = panel.robot {
        let path = Path::circle(at(robot), 0.36 * cell);
        scene.fill(path.clone(), theme::TRUTH);
        scene.stroke(path, Stroke::new(Color::WHITE, 1.5 * unit));
    }
    let x = Axis {
        scale: Scale::Even(0.0, across),
        name: "x, cells",
    };
    let y = Axis {
        scale: Scale::Even(0.0, up),
        name: "y, cells",
    };
    axes::draw(scene, grid, (x, y), unit);
}

fn draw_cells(scene: &mut Scene, panel: &Panel, grid: Rect, side: f64) {
    for (i, &cell) in panel.cells.iter().enumerate() {
        let (x, y) = (i % panel.sides.0, i / panel.sides.0);
        let square = Rect::new(
            grid.x + side * x as f64,
            grid.bottom() - side * (y + 1) as f64,
            side,
            side,
        );
        let color = match cell {
            Cell::Free(share) => field::heat(share),
            Cell::Obstacle => theme::OCCUPIED,
            Cell::Boundary => theme::QUIET,
        };
        scene.fill(Path::rect(square), color);
        scene.stroke(Path::rect(square), Stroke::new(theme::GRATING, 0.6));
    }
}

/// Purple, blue and orange, which the colour-blind can distinguish; what is rejected is dashed.
fn stroke(role: Role, unit: f64) -> Stroke {
    match role {
        Role::Reading => Stroke::new(theme::TRUTH, 2.2 * unit),
        Role::Projected => Stroke::new(theme::CURVES[0], 1.5 * unit),
        Role::Rejected => Stroke {
            dash: 4.0 * unit,
            ..Stroke::new(theme::CURVES[1], 1.5 * unit)
        },
    }
}

fn draw_arrow(scene: &mut Scene, (from, to): ((f64, f64), (f64, f64)), role: Role, unit: f64) {
    let (along_x, along_y) = (to.0 - from.0, to.1 - from.1);
    let length = along_x.hypot(along_y).max(f64::MIN_POSITIVE);
    let (x, y) = (along_x / length, along_y / length);
    let size = 6.0 * unit;
    let barb = |side: f64| {
        (
            to.0 - size * x + side * size * 0.5 * y,
            to.1 - size * y - side * size * 0.5 * x,
        )
    };
    scene.stroke(Path::line(from, to), stroke(role, unit));
    let foot = Path::circle(from, 2.6 * unit);
    scene.fill(foot, stroke(role, unit).color);
    let solid = Stroke {
        dash: 0.0,
        ..stroke(role, unit)
    };
    scene.stroke(Path::polyline([barb(1.0), to, barb(-1.0)]), solid);
}

fn legend(diagram: &Diagram, unit: f64) -> Vec<Entry> {
    let panels = &diagram.panels;
    let mut entries = vec![(Sample::Square(theme::QUIET), "boundary cell".to_owned())];
    let mut cells = panels.iter().flat_map(|panel| &panel.cells);
    if cells.any(|&cell| cell == Cell::Obstacle) {
        let name = "obstacle behind it".to_owned();
        entries.push((Sample::Square(theme::OCCUPIED), name));
    }
    if panels.iter().any(|panel| panel.robot.is_some()) {
        entries.push((Sample::Dot(theme::TRUTH), "robot".to_owned()));
    }
    let roles = [
        (Role::Reading, "reading"),
        (Role::Projected, "projected reading"),
        (
            Role::Rejected,
            "the same, which does not match or is blocked",
        ),
    ];
    for (role, name) in roles {
        let mut arrows = panels.iter().flat_map(|panel| &panel.arrows);
        if arrows.any(|arrow| arrow.role == role) {
            entries.push((Sample::Line(stroke(role, unit)), name.to_owned()));
        }
    }
    entries.push((
        Sample::Square(field::heat(0.25)),
        "a quarter of the votes".to_owned(),
    ));
    entries.push((Sample::Square(field::heat(1.0)), "all votes".to_owned()));
    entries
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_stand_two_in_a_row() {
        let panel = Panel {
            caption: "one".into(),
            sides: (3, 2),
            cells: vec![Cell::Free(0.5); 6],
            arrows: vec![Arrow {
                from: (0.5, 0.5),
                to: (2.5, 0.5),
                role: Role::Reading,
            }],
            robot: Some((0.5, 0.5)),
        };
        let diagram = |count: usize| Diagram {
            title: String::new(),
            says: String::new(),
            panels: vec![panel.clone(); count],
        };
        let height = |count| draw(&diagram(count)).unwrap().height();
        assert_eq!(height(1), height(2));
        assert!(height(3) > height(2));
    }
}
