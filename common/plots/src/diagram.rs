//! Panels of cells and arrows: a method drawn step by step on a small map.

use crate::drawing::{Color, Path, Rect, Scene, Stroke};

use super::axes::{self, Axis};
use super::legend::{Legend, Sample};
use super::page::{self, Heading, Page};
use super::scale::Scale;
use super::shapes::Shape;
use super::theme;

/// The caption above a panel, pixels of a picture of the common width.
const CAPTION: f64 = 34.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cell {
    /// The robot may stand here; 0..=1 of the highest intensity.
    Free(f64),
    Obstacle,
    /// An obstacle that readings are projected from.
    Boundary,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// A reading as the robot takes it.
    Reading,
    /// A reading put to a place where it may have been taken, or projected back.
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
    pub role: Role,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    pub caption: String,
    /// Cells along x and y.
    pub sides: (usize, usize),
    /// Row by row from the lowest y.
    pub cells: Vec<Cell>,
    pub arrows: Vec<Arrow>,
    /// The true place of the robot, in cells.
    pub robot: Option<(f64, f64)>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Diagram {
    pub title: String,
    pub says: String,
    /// In rows of two.
    pub panels: Vec<Panel>,
}

/// Draws the steps side by side, two in a row.
pub fn draw(diagram: &Diagram) -> anyhow::Result<Scene> {
    let width = page::COMMON_WIDTH;
    let unit = page::unit(width);
    let votes = Axis {
        scale: Scale::Even(0.0, 1.0),
        name: "share of the most votes",
    };
    let has_votes = diagram.panels.iter().flat_map(|panel| &panel.cells);
    let has_votes = has_votes
        .clone()
        .any(|cell| matches!(cell, Cell::Free(share) if *share > 0.0));
    let body = Rect::new(0.0, 0.0, page::body_width(width), f64::from(width));
    let (rest, _) = axes::beside_bar(body, &votes, unit);
    let side = if has_votes { rest.width } else { body.width } / 2.0;
    let ratios = diagram.panels.iter().map(|panel| {
        let (across, up) = panel.sides;
        up as f64 / across.max(1) as f64
    });
    let ratio = ratios.fold(0.0, f64::max);
    let height = axes::height_for(ratio, side, unit) + CAPTION * unit;
    let rows = diagram.panels.len().div_ceil(2) as f64;
    let heading = Heading::plain(&diagram.title, &diagram.says);
    let mut page = Page::new(width, height * rows, &heading)?;
    for (i, panel) in diagram.panels.iter().enumerate() {
        let (column, row) = ((i % 2) as f64, (i / 2) as f64);
        let (left, top) = (page.body.x + column * side, page.body.y + row * height);
        let area = Rect::new(left, top, side, height);
        draw_panel(&mut page.scene, panel, area, unit);
    }
    if has_votes {
        let top = page.body.y + CAPTION * unit;
        let beside = Rect::new(page.body.x, top, page.body.width, height - CAPTION * unit);
        let (_, bar) = axes::beside_bar(beside, &votes, unit);
        axes::draw_bar(&mut page.scene, bar, votes, theme::heat, unit);
    }
    name(&mut page.legend, diagram, unit);
    page.finish()
}

fn draw_panel(scene: &mut Scene, panel: &Panel, area: Rect, unit: f64) {
    let top = area.y + CAPTION * unit;
    let below = Rect::new(area.x, top, area.width, area.bottom() - top);
    let (across, up) = (panel.sides.0 as f64, panel.sides.1 as f64);
    let x = Axis {
        scale: Scale::Even(0.0, across),
        name: "x, cells",
    };
    let y = Axis {
        scale: Scale::Even(0.0, up),
        name: "y, cells",
    };
    let inside = axes::inside(below, (&x, &y), unit);
    let style = theme::text(unit).bold();
    let caption = theme::fitted(style, &panel.caption, area.right() - inside.x);
    let at = (inside.x, area.y + 0.7 * CAPTION * unit);
    scene.text(&panel.caption, at, &caption);
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
            Cell::Free(share) => theme::heat(share),
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
    // A rim keeps arrows legible over dark cells.
    let rim = Color::WHITE.with_opacity(0.75);
    let width = stroke(role, unit).width;
    let barbs = Path::polyline([barb(1.0), to, barb(-1.0)]);
    let around = Stroke::new(rim, width + 1.8 * unit);
    scene.stroke(Path::line(from, to), around);
    scene.stroke(barbs.clone(), around);
    scene.stroke(Path::line(from, to), stroke(role, unit));
    let foot = Path::circle(from, 2.6 * unit);
    scene.fill(foot, stroke(role, unit).color);
    let solid = Stroke {
        dash: 0.0,
        ..stroke(role, unit)
    };
    scene.stroke(barbs, solid);
}

fn name(legend: &mut Legend, diagram: &Diagram, unit: f64) {
    let panels = &diagram.panels;
    let has = |cell: Cell| panels.iter().any(|panel| panel.cells.contains(&cell));
    if has(Cell::Boundary) {
        legend.add(Sample::Area(theme::QUIET), "boundary cell");
    }
    if has(Cell::Obstacle) {
        legend.add(Sample::Area(theme::OCCUPIED), "obstacle behind it");
    }
    if panels.iter().any(|panel| panel.robot.is_some()) {
        legend.add(Sample::Mark(Shape::Circle, theme::TRUTH), "robot");
    }
    let roles = [
        (Role::Reading, "reading"),
        (Role::Projected, "projected reading"),
        (
            Role::Rejected,
            "projected reading that does not match or is blocked",
        ),
    ];
    for (role, name) in roles {
        let mut arrows = panels.iter().flat_map(|panel| &panel.arrows);
        if arrows.any(|arrow| arrow.role == role) {
            legend.add(Sample::Line(stroke(role, unit)), name);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout;
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
        let height = |count| {
            let scene = draw(&diagram(count)).unwrap();
            let texts = layout::texts(&scene);
            let has = |name: &str| texts.iter().any(|text| text == name);
            for name in ["robot", "reading", "share of the most votes", "x, cells"] {
                assert!(has(name), "{name}: {texts:?}");
            }
            assert!(!has("boundary cell"), "none is drawn: {texts:?}");
            scene.height()
        };
        assert_eq!(height(1), height(2));
        assert!(height(3) > height(2));
    }
}
