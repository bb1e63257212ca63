//! The votes as a surface in space, seen from above and from behind, as in
//! figures 5c and 5d of the paper: the heading's whole field at one glance.

use std::f64::consts::PI;

use crate::drawing::{Color, Path, Rect, Scene, Stroke};

use super::axes::{self, Axis};
use super::field::{Votes, WALL};
use super::legend::Sample;
use super::page::{self, Page};
use super::view::View;
use super::{marks, theme};

mod space;

use space::Space;

/// Patches along the longer side: finer ones cannot be distinguished.
const PATCHES: f64 = 150.0;
/// The height of the highest peak, as a share of the longer side.
const PEAK: f64 = 0.32;
/// Darkening of patches that are turned from the light, and lightening of those turned to it.
const SHADE: (f64, f64) = (0.22, 0.15);
/// The height of both pictures as a share of the width.
const HEIGHTS: (f64, f64) = (0.50, 0.42);
/// Around a picture from one side: left, above, right and below.
const ROOM: [f64; 4] = [80.0, 46.0, 100.0, 62.0];

#[derive(Debug, Clone, Copy, PartialEq)]
struct Camera {
    name: &'static str,
    /// Turn of the map before it is looked at along its y axis, radians.
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
    /// 1 where it looks from the side of the lowest y, with x to the right, and -1 from the other.
    fn side(&self) -> f64 {
        self.azimuth.cos().signum()
    }

    /// Looks at a point in shares of the longer side, the map's middle at 0; y downwards.
    fn look(&self, (x, y, z): (f64, f64, f64)) -> Corner {
        let (sin, cos) = self.azimuth.sin_cos();
        let (right, away) = (x * cos - y * sin, x * sin + y * cos);
        let (up_sin, up_cos) = self.elevation.sin_cos();
        Corner {
            at: (right, -(away * up_sin + z * up_cos)),
            // Over flat ground, nearer things hide farther ones, however high either is.
            nearness: -away,
        }
    }
}

impl Relief {
    fn of(votes: &Votes<'_>) -> Self {
        let extent = votes.extent;
        let longer = extent.width().max(extent.height());
        let count = |metres: f64| (PATCHES * metres / longer).round().max(2.0);
        let (columns, rows) = (count(extent.width()), count(extent.height()));
        // A view of one pixel a corner does the sampling.
        let view = View::fitting(extent, Rect::new(0.0, 0.0, columns, rows));
        let sampled = votes.sampler(&view);
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
                let (height, walls) = sampled(column, row);
                relief.heights.push(height);
                relief.walls.push(walls);
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

    /// Colours by height, darker where turned from the light, which comes from the upper left.
    fn color(&self, index: usize, corners: [(f64, f64, f64); 4]) -> Color {
        let [a, b, _, d] = corners;
        let highest = corners.iter().fold(0.0_f64, |high, c| high.max(c.2)) / PEAK;
        let side = (b.0 - a.0).max(f64::MIN_POSITIVE);
        let (slope_x, slope_y) = ((b.2 - a.2) / side, (d.2 - a.2) / side);
        let light = (0.5 * slope_x - 0.35 * slope_y).clamp(-1.0, 1.0);
        let color = theme::heat(highest);
        let lit = match light >= 0.0 {
            true => color.towards(Color::WHITE, SHADE.1 * light),
            false => color.towards(theme::INK, -SHADE.0 * light),
        };
        let walls = self.walls.get(index).copied().unwrap_or_default();
        lit.towards(WALL, walls * (1.0 - 4.0 * highest))
    }
}

pub fn draw(votes: &Votes<'_>) -> anyhow::Result<Scene> {
    let relief = Relief::of(votes);
    let width = page::body_width(votes.width);
    let height = (width * (HEIGHTS.0 + HEIGHTS.1)).round();
    let mut page = Page::new(votes.width, height, &votes.heading)?;
    let unit = page.unit;
    if relief.walls.iter().any(|&share| share > 0.0) {
        page.legend.add(Sample::Area(WALL), "obstacle");
    }
    let (body, bar) = axes::beside_bar(page.body, &votes.scale(), unit);
    let first = Rect::new(body.x, body.y, body.width, width * HEIGHTS.0);
    let second = Rect::new(body.x, first.bottom(), body.width, width * HEIGHTS.1);
    for (camera, area) in CAMERAS.iter().zip([first, second]) {
        draw_from(&mut page, (&relief, votes.scale()), camera, area);
    }
    axes::draw_bar(&mut page.scene, bar, votes.scale(), theme::heat, unit);
    page.finish()
}

fn draw_from(page: &mut Page, (relief, up): (&Relief, Axis<'_>), camera: &Camera, area: Rect) {
    let unit = page.unit;
    let patches = relief.patches(camera);
    // The arrow stands above the summit, and numbers and names of the axes around.
    let [left, above, right, below] = ROOM.map(|side| side * unit);
    let room = Rect::new(
        area.x + left,
        area.y + above,
        (area.width - left - right).max(1.0),
        (area.height - above - below).max(1.0),
    );
    let space = Space::of(relief, camera, room);
    space.draw_floor(&mut page.scene, relief, unit);
    for (corners, color) in patches {
        let path = Path::polygon(corners.map(|corner| space.placed(corner)));
        // The rim closes the gaps between patches.
        page.scene.stroke(path.clone(), Stroke::new(color, 0.5));
        page.scene.fill(path, color);
    }
    let style = theme::text(unit).bold();
    let at = (area.x, area.y + theme::TEXT * unit);
    page.scene.text(camera.name, at, &style);
    space.draw_axes(&mut page.scene, relief, up, unit);
    if let Some(summit) = relief.summit() {
        let (x, y) = space.at(summit);
        let stroke = Stroke::new(theme::BEST, 2.6 * unit);
        let tip = (x, y - 4.0 * unit);
        marks::arrow_down(&mut page.scene, tip, 34.0 * unit, stroke);
        page.legend.add(Sample::Arrow(stroke), "most votes");
    }
}

#[cfg(test)]
mod tests;
