//! The votes as a surface in space, seen from above and from behind, as in
//! figures 5c and 5d of the paper: the heading's whole field at one glance.

use std::f64::consts::PI;

use drawing::{Anchor, Color, Path, Rect, Scene, Stroke, TextStyle};
use offline::{frame_of, sides_of};

use super::axes;
use super::extent::Extent;
use super::field::{self, Votes, WALL};
use super::ground::Sampler;
use super::page::{self, Page, Sample};
use super::scale::Scale;
use super::theme;
use super::view::View;
use crate::PlotError;

/// Patches along the longer side: finer ones cannot be distinguished.
const PATCHES: f64 = 150.0;
/// The height of the highest peak, as a share of the longer side.
const PEAK: f64 = 0.32;
/// Where nothing votes, and what lies in the shade.
const FLOOR: Color = Color::rgb(0xEC_EFF4);
const SHADOW: Color = Color::rgb(0x6B_2A3A);
/// The height of both pictures as a share of the width.
const HEIGHTS: (f64, f64) = (0.47, 0.40);

/// From where the surface is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Camera {
    name: &'static str,
    /// By how much the map is turned before it is looked at along its y axis,
    /// radians.
    azimuth: f64,
    /// Above the ground, radians.
    elevation: f64,
}

const CAMERAS: [Camera; 2] = [
    Camera {
        name: "from above",
        azimuth: 0.35,
        elevation: 0.87,
    },
    Camera {
        name: "from behind",
        azimuth: PI + 0.35,
        elevation: 0.35,
    },
];

/// The surface: heights on a grid of corners, row by row from the lowest y.
#[derive(Debug, Clone, PartialEq)]
struct Relief {
    columns: usize,
    rows: usize,
    /// The corner of the map with the lowest x and y, metres.
    from: (f64, f64),
    /// The longer side, metres.
    longer_m: f64,
    /// 0..=1 at each corner.
    heights: Vec<f64>,
    /// Share of walls around each corner.
    walls: Vec<f64>,
}

/// A corner in the picture, and how near its foot is.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Corner {
    at: (f64, f64),
    nearness: f64,
}

impl Camera {
    /// Looks at a point whose coordinates are shares of the longer side, the
    /// map's middle at 0; y downwards.
    fn look(&self, (x, y, z): (f64, f64, f64)) -> Corner {
        let (sin, cos) = self.azimuth.sin_cos();
        let (right, away) = (x * cos - y * sin, x * sin + y * cos);
        let (up_sin, up_cos) = self.elevation.sin_cos();
        Corner {
            at: (right, -(away * up_sin + z * up_cos)),
            // Over flat ground what stands nearer hides what stands behind it,
            // however high either is.
            nearness: -away,
        }
    }
}

impl Relief {
    /// The surface over a part of the map.
    fn of(votes: &Votes<'_>) -> Self {
        let (ground, field, extent) = (&votes.ground, votes.field, votes.extent);
        let longer = extent.width().max(extent.height());
        let count = |metres: f64| (PATCHES * metres / longer).round().max(2.0);
        let (columns, rows) = (count(extent.width()), count(extent.height()));
        // A view of one pixel a corner does the sampling.
        let view = View::fitting(extent, Rect::new(0.0, 0.0, columns, rows));
        let under = Sampler::new(&view, field.frame, field.sides);
        let map = ground.map;
        let cells = Sampler::new(&view, frame_of(map), sides_of(map));
        let most = f64::from(field.outcome.found.best.max(1));
        let (columns, rows) = (columns as u32, rows as u32);
        let mut relief = Relief {
            columns: columns as usize,
            rows: rows as usize,
            from: view.metres_at((0.0, f64::from(rows))),
            longer_m: longer,
            heights: Vec::new(),
            walls: Vec::new(),
        };
        for row in (0..rows).rev() {
            for column in 0..columns {
                let mut highest = 0;
                under.each(column, row, |index| {
                    let intensity = index.and_then(|index| field.intensities.get(index));
                    highest = highest.max(intensity.copied().unwrap_or_default());
                });
                relief.heights.push(f64::from(highest) / most);
                let (mut met, mut walls) = (0.0_f64, 0.0);
                cells.each(column, row, |index| {
                    met += 1.0;
                    if index.is_some_and(|index| field::is_wall(map, ground.rules, index)) {
                        walls += 1.0;
                    }
                });
                relief.walls.push((walls / met.max(1.0)).sqrt());
            }
        }
        relief
    }

    /// Half of each side, as shares of the longer one.
    fn halves(&self) -> (f64, f64) {
        let longer = self.columns.max(self.rows) as f64;
        let half = |corners: usize| corners as f64 / 2.0 / longer;
        (half(self.columns), half(self.rows))
    }

    /// A corner as shares of the longer side.
    fn corner(&self, column: usize, row: usize) -> (f64, f64, f64) {
        let longer = self.columns.max(self.rows) as f64;
        let x = (column as f64 - self.columns as f64 / 2.0) / longer;
        let y = (row as f64 - self.rows as f64 / 2.0) / longer;
        let height = self.heights.get(row * self.columns + column);
        (x, y, PEAK * height.copied().unwrap_or_default())
    }

    /// The highest corner.
    fn summit(&self) -> Option<(f64, f64, f64)> {
        let all = self.heights.iter().enumerate();
        let (index, _) = all.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
        Some(self.corner(index % self.columns, index / self.columns))
    }

    /// The patches as a camera sees them, farthest first: corners and colour.
    fn patches(&self, camera: &Camera) -> Vec<([(f64, f64); 4], Color)> {
        let mut patches = Vec::with_capacity(self.columns * self.rows);
        for row in 0..self.rows.saturating_sub(1) {
            for column in 0..self.columns.saturating_sub(1) {
                let around = [(0, 0), (1, 0), (1, 1), (0, 1)];
                let corners = around.map(|(x, y)| self.corner(column + x, row + y));
                let seen = corners.map(|corner| camera.look(corner));
                let nearness = seen.iter().map(|corner| corner.nearness).sum::<f64>();
                let color = self.color(row * self.columns + column, corners);
                patches.push((nearness, seen.map(|corner| corner.at), color));
            }
        }
        patches.sort_by(|a, b| a.0.total_cmp(&b.0));
        let seen = patches.into_iter();
        seen.map(|(_, corners, color)| (corners, color)).collect()
    }

    /// By height, darker where the surface is turned from the light, which
    /// comes from the left and above.
    fn color(&self, index: usize, corners: [(f64, f64, f64); 4]) -> Color {
        let [a, b, _, d] = corners;
        let highest = corners.iter().fold(0.0_f64, |high, c| high.max(c.2)) / PEAK;
        let side = (b.0 - a.0).max(f64::MIN_POSITIVE);
        let (slope_x, slope_y) = ((b.2 - a.2) / side, (d.2 - a.2) / side);
        let light = (0.5 * slope_x - 0.35 * slope_y).clamp(-1.0, 1.0);
        let color = FLOOR.towards(field::heat(highest), 8.0 * highest);
        let lit = match light >= 0.0 {
            true => color.towards(Color::WHITE, 0.4 * light),
            false => color.towards(SHADOW, -0.3 * light),
        };
        let walls = self.walls.get(index).copied().unwrap_or_default();
        lit.towards(WALL, walls * (1.0 - 4.0 * highest))
    }
}

/// Draws the picture.
///
/// # Errors
/// The picture would be too large.
pub fn draw(votes: &Votes<'_>) -> Result<Scene, PlotError> {
    let relief = Relief::of(votes);
    let width = page::body_width(votes.width);
    let height = (width * (HEIGHTS.0 + HEIGHTS.1)).round();
    let arrow = arrow_stroke(page::unit(votes.width));
    let legend = [
        (Sample::Square(WALL), "obstacle".to_owned()),
        (Sample::Line(arrow), "most votes".to_owned()),
    ];
    let mut page = Page::new(votes.width, height, &votes.heading, &legend)?;
    let unit = page.unit;
    let (body, bar) = axes::beside_bar(page.body, unit);
    let first = Rect::new(body.x, body.y, body.width, width * HEIGHTS.0);
    let second = Rect::new(body.x, first.bottom(), body.width, width * HEIGHTS.1);
    for (camera, area) in CAMERAS.iter().zip([first, second]) {
        draw_from(&mut page, &relief, camera, area);
    }
    axes::draw_bar(&mut page.scene, bar, votes.scale(), field::heat, unit);
    Ok(page.scene)
}

fn draw_from(page: &mut Page, relief: &Relief, camera: &Camera, area: Rect) {
    let unit = page.unit;
    let patches = relief.patches(camera);
    // The arrow stands above the summit, and the numbers of the axes below the edges.
    let room = Rect::new(
        area.x + 56.0 * unit,
        area.y + 46.0 * unit,
        area.width - 112.0 * unit,
        area.height - 96.0 * unit,
    );
    let placing = Placing::of(&patches, room);
    for (corners, color) in patches {
        let path = Path::polygon(corners.map(|corner| placing.at(corner)));
        // The rim closes the gaps between patches.
        page.scene.stroke(path.clone(), Stroke::new(color, 0.5));
        page.scene.fill(path, color);
    }
    draw_edges(&mut page.scene, relief, (camera, &placing), unit);
    if let Some(summit) = relief.summit() {
        arrow(&mut page.scene, placing.at(camera.look(summit).at), unit);
    }
    let style = TextStyle::new(16.0 * unit, theme::QUIET).bold();
    let at = (area.x, area.y + 20.0 * unit);
    page.scene
        .text(camera.name, at, &style.anchored(Anchor::Start));
}

/// The two edges of the floor that are nearest to the camera, with the metres of the map
/// along them.
fn draw_edges(
    scene: &mut Scene,
    relief: &Relief,
    (camera, placing): (&Camera, &Placing),
    unit: f64,
) {
    let (half_x, half_y) = relief.halves();
    let nearness = |x: f64, y: f64| camera.look((x, y, 0.0)).nearness;
    let front = if nearness(0.0, -half_y) > nearness(0.0, half_y) {
        -half_y
    } else {
        half_y
    };
    let side = if nearness(-half_x, 0.0) > nearness(half_x, 0.0) {
        -half_x
    } else {
        half_x
    };
    let scale_x = Scale::Even(
        relief.from.0,
        relief.from.0 + 2.0 * half_x * relief.longer_m,
    );
    let scale_y = Scale::Even(
        relief.from.1,
        relief.from.1 + 2.0 * half_y * relief.longer_m,
    );
    let along_x = |share: f64| ((2.0 * share - 1.0) * half_x, front);
    let along_y = |share: f64| (side, (2.0 * share - 1.0) * half_y);
    let at = |(x, y): (f64, f64)| placing.at(camera.look((x, y, 0.0)).at);
    let middle = at((0.0, 0.0));
    let edge = Edge { middle, unit };
    edge.draw(scene, (scale_x, "x, m"), &|share| at(along_x(share)));
    edge.draw(scene, (scale_y, "y, m"), &|share| at(along_y(share)));
}

/// An edge of the floor with its numbers outside.
#[derive(Debug, Clone, Copy)]
struct Edge {
    /// Of the floor, in the picture.
    middle: (f64, f64),
    unit: f64,
}

impl Edge {
    /// `at` takes shares of the edge to points of the picture.
    fn draw(self, scene: &mut Scene, (scale, name): (Scale, &str), at: &dyn Fn(f64) -> (f64, f64)) {
        let unit = self.unit;
        let mut lines = Path::line(at(0.0), at(1.0));
        let style = TextStyle::new(13.0 * unit, theme::INK).anchored(Anchor::Middle);
        let (out_x, out_y) = self.outwards(at(0.0), at(1.0));
        let write = |scene: &mut Scene, text: &str, (x, y): (f64, f64), away: f64| {
            let beside = (x + away * out_x, y + away * out_y + 4.5 * unit);
            scene.text(text, beside, &style);
        };
        for (value, text) in scale.ticks() {
            let (x, y) = at(scale.share(value));
            lines.add_line((x, y), (x + 6.0 * unit * out_x, y + 6.0 * unit * out_y));
            write(scene, &text, (x, y), 20.0 * unit);
        }
        scene.stroke(lines, Stroke::new(theme::INK, unit.max(1.0)));
        write(scene, name, at(0.5), 46.0 * unit);
    }

    /// The direction across the edge that leads away from the floor.
    fn outwards(self, from: (f64, f64), to: (f64, f64)) -> (f64, f64) {
        let (along_x, along_y) = (to.0 - from.0, to.1 - from.1);
        let length = along_x.hypot(along_y).max(f64::MIN_POSITIVE);
        let (x, y) = (-along_y / length, along_x / length);
        let is_inwards = (from.0 - self.middle.0) * x + (from.1 - self.middle.1) * y < 0.0;
        if is_inwards { (-x, -y) } else { (x, y) }
    }
}

fn arrow_stroke(unit: f64) -> Stroke {
    Stroke::new(theme::BEST, 2.6 * unit)
}

/// An arrow that points at a summit from above.
fn arrow(scene: &mut Scene, (x, y): (f64, f64), unit: f64) {
    let (tip, tail) = (y - 5.0 * unit, y - 42.0 * unit);
    let mut path = Path::line((x, tail), (x, tip));
    path.add_polyline([
        (x - 6.0 * unit, tip - 9.0 * unit),
        (x, tip),
        (x + 6.0 * unit, tip - 9.0 * unit),
    ]);
    scene.stroke(path.clone(), Stroke::new(Color::WHITE, 6.0 * unit));
    scene.stroke(path, arrow_stroke(unit));
}

/// Takes what a camera sees to a part of the picture.
struct Placing {
    scale: f64,
    middle: (f64, f64),
    center: (f64, f64),
}

impl Placing {
    fn of(patches: &[([(f64, f64); 4], Color)], area: Rect) -> Self {
        let seen = Extent::of(patches.iter().flat_map(|(corners, _)| *corners));
        let scale = (area.width / seen.width()).min(area.height / seen.height());
        Placing {
            scale,
            middle: seen.center(),
            center: area.center(),
        }
    }

    fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (
            self.center.0 + self.scale * (x - self.middle.0),
            self.center.1 + self.scale * (y - self.middle.1),
        )
    }
}

#[cfg(test)]
mod tests;
