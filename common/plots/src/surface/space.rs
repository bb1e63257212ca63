//! Where points of the surface lie in the picture, and its three axes: the two edges of the
//! floor that are nearest to the camera, and the height at the corner farthest to the right.

use std::iter;

use crate::drawing::{Path, Rect, Scene, Stroke};

use super::super::axes::Axis;
use super::super::extent::Extent;
use super::super::scale::Scale;
use super::super::theme::{self, TEXT};
use super::{Camera, PEAK, Relief};

/// From an axis to its numbers, and from these to its name.
const BESIDE: f64 = 10.0;
const NAME: f64 = 6.0;
const NUMBERS: u32 = 6;

/// A part of the picture that shows what a camera sees.
#[derive(Debug)]
pub(super) struct Space<'a> {
    camera: &'a Camera,
    scale: f64,
    middle: (f64, f64),
    center: (f64, f64),
}

#[derive(Debug, Clone, Copy)]
struct Edge<'a> {
    axis: Axis<'a>,
    from: (f64, f64),
    to: (f64, f64),
    /// The direction of its numbers, of length 1.
    outwards: (f64, f64),
}

impl<'a> Space<'a> {
    /// The whole surface, as large as fits into an area.
    pub(super) fn of(relief: &Relief, camera: &'a Camera, area: Rect) -> Self {
        let all = (0..relief.rows).flat_map(|row| (0..relief.columns).map(move |c| (c, row)));
        let corners = all.map(|(column, row)| relief.corner(column, row));
        let (x, y) = rightmost(relief, camera);
        let floor = floor(relief).map(|(x, y)| (x, y, 0.0));
        let points = corners.chain(floor).chain(iter::once((x, y, PEAK)));
        let seen = Extent::of(points.map(|point| camera.look(point).at));
        Space {
            camera,
            scale: (area.width / seen.width()).min(area.height / seen.height()),
            middle: seen.center(),
            center: area.center(),
        }
    }

    pub(super) fn at(&self, point: (f64, f64, f64)) -> (f64, f64) {
        self.placed(self.camera.look(point).at)
    }

    /// Where a point that the camera sees lies.
    pub(super) fn placed(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (
            self.center.0 + self.scale * (x - self.middle.0),
            self.center.1 + self.scale * (y - self.middle.1),
        )
    }

    /// Draws the edges of the floor, over which the surface stands.
    pub(super) fn draw_floor(&self, scene: &mut Scene, relief: &Relief, unit: f64) {
        let corners = floor(relief).map(|(x, y)| self.at((x, y, 0.0)));
        let stroke = Stroke::new(theme::FRAME, 2.0 * unit);
        scene.stroke(Path::polygon(corners), stroke);
    }

    /// Draws the axes; `up` is that of the height.
    pub(super) fn draw_axes(&self, scene: &mut Scene, relief: &Relief, up: Axis<'_>, unit: f64) {
        let edges = self.edges(relief, up);
        // Names come first: a number that one of them covers is left out.
        for edge in &edges {
            edge.write_name(scene, unit);
        }
        for edge in &edges {
            edge.draw(scene, unit);
        }
    }

    fn edges<'b>(&self, relief: &Relief, up: Axis<'b>) -> [Edge<'b>; 3] {
        let (half_x, half_y) = relief.halves();
        let side = self.camera.side();
        let (near_x, near_y) = (-side * half_x, -side * half_y);
        let floor = |x: f64, y: f64| self.at((x, y, 0.0));
        let metres = |from: f64, half: f64, name| Axis {
            scale: Scale::Even(from, from + 2.0 * half * relief.longer_m),
            name,
        };
        let middle = floor(0.0, 0.0);
        let of_floor = |axis, from, to| Edge {
            axis,
            from,
            to,
            outwards: outwards((from, to), middle),
        };
        let x = metres(relief.from.0, half_x, "x, m");
        let y = metres(relief.from.1, half_y, "y, m");
        let (right_x, right_y) = rightmost(relief, self.camera);
        [
            of_floor(x, floor(-half_x, near_y), floor(half_x, near_y)),
            of_floor(y, floor(near_x, -half_y), floor(near_x, half_y)),
            Edge {
                axis: up,
                from: floor(right_x, right_y),
                to: self.at((right_x, right_y, PEAK)),
                outwards: (1.0, 0.0),
            },
        ]
    }
}

fn floor(relief: &Relief) -> [(f64, f64); 4] {
    let (x, y) = relief.halves();
    [(-x, -y), (x, -y), (x, y), (-x, y)]
}

/// The corner of the floor that is farthest to the right.
fn rightmost(relief: &Relief, camera: &Camera) -> (f64, f64) {
    let (x, y) = relief.halves();
    (camera.side() * x, -camera.side() * y)
}

/// The direction across an edge that leads away from a point.
fn outwards((from, to): ((f64, f64), (f64, f64)), point: (f64, f64)) -> (f64, f64) {
    let (along_x, along_y) = (to.0 - from.0, to.1 - from.1);
    let length = along_x.hypot(along_y).max(f64::MIN_POSITIVE);
    let (x, y) = (-along_y / length, along_x / length);
    let is_inwards = (from.0 - point.0) * x + (from.1 - point.1) * y < 0.0;
    if is_inwards { (-x, -y) } else { (x, y) }
}

impl Edge<'_> {
    fn at(&self, share: f64) -> (f64, f64) {
        (
            self.from.0 + share * (self.to.0 - self.from.0),
            self.from.1 + share * (self.to.1 - self.from.1),
        )
    }

    /// Draws the line with its ticks and numbers.
    fn draw(&self, scene: &mut Scene, unit: f64) {
        let mut lines = Path::line(self.from, self.to);
        for (value, text) in self.axis.scale.ticks(NUMBERS) {
            let share = self.axis.scale.share(value);
            let (x, y) = self.at(share);
            let (out_x, out_y) = self.outwards;
            lines.add_line((x, y), (x + 6.0 * unit * out_x, y + 6.0 * unit * out_y));
            self.write(scene, &text, (share, BESIDE * unit), unit);
        }
        scene.stroke(lines, Stroke::new(theme::INK, unit.max(1.0)));
    }

    fn write_name(&self, scene: &mut Scene, unit: f64) {
        let ticks = self.axis.scale.ticks(NUMBERS);
        let depths = ticks.iter().map(|(_, text)| self.depth(text, unit));
        let away = depths.fold(0.0, f64::max) + (BESIDE + NAME) * unit;
        self.write(scene, self.axis.name, (0.5, away), unit);
    }

    /// How far a text reaches along the direction of the numbers.
    fn depth(&self, text: &str, unit: f64) -> f64 {
        let (x, y) = self.outwards;
        let width = theme::text(unit).width_of(text);
        x.abs() * width + y.abs() * TEXT * unit
    }

    /// Writes a text at a distance from the axis, unless it would lie over another.
    fn write(&self, scene: &mut Scene, text: &str, (share, away): (f64, f64), unit: f64) {
        let style = theme::text(unit).anchored(crate::drawing::Anchor::Middle);
        let away = away + self.depth(text, unit) / 2.0;
        let (x, y) = self.at(share);
        let (out_x, out_y) = self.outwards;
        let base = (x + away * out_x, y + away * out_y + 0.25 * TEXT * unit);
        let area = style.area_of(text, base);
        let is_free = scene.labels().iter().all(|it| !it.area.overlaps(&area));
        if is_free && scene.area().holds(&area) {
            scene.text(text, base, &style);
        }
    }
}
