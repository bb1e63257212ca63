//! The map's cells, and other fields over them, as an image through a view.
//!
//! A pixel shows all cells that lie under it, or the one cell that it is a part
//! of: nothing that is thin is lost where many cells meet one pixel.

use crate::drawing::Color;
use engine::fit::GridPose;
use engine::grid::{CellRules, GridFrame};
use map::OccupancyGrid;
use offline::{frame_of, sides_of};

use super::extent::Extent;
use super::legend::Sample;
use super::page::Page;
use super::theme;
use super::view::View;

/// Looks at most that often along each axis of a pixel.
const MAX_LOOKS: f64 = 12.0;

/// Which cells of a raster lie under each pixel of a view.
pub(super) struct Sampler {
    sides: (usize, usize),
    /// Cells from one look to the next, along the picture's axes.
    step_x: (f64, f64),
    step_y: (f64, f64),
    /// In cells, of the first look.
    start: (f64, f64),
    looks: u32,
}

impl Sampler {
    pub(super) fn new(view: &View, frame: GridFrame, sides: (usize, usize)) -> Self {
        let cells_per_pixel = 1.0 / (view.pixels_per_m * frame.resolution_m);
        let looks = (1.5 * cells_per_pixel).ceil().clamp(1.0, MAX_LOOKS);
        let step = cells_per_pixel / looks;
        let GridPose { x, y, heading } = GridPose::of(frame, view.map_from_corner());
        let (sin, cos) = heading.sin_cos();
        // Down in the picture is against y in the map.
        let (step_x, step_y) = ((step * cos, step * sin), (step * sin, -step * cos));
        let start = (
            x + (step_x.0 + step_y.0) / 2.0,
            y + (step_x.1 + step_y.1) / 2.0,
        );
        Sampler {
            sides,
            step_x,
            step_y,
            start,
            looks: looks as u32,
        }
    }

    /// Calls `see` with each cell met under a pixel, some twice, or `None` beyond the raster.
    pub(super) fn each(&self, column: u32, row: u32, mut see: impl FnMut(Option<usize>)) {
        for v in row * self.looks..(row + 1) * self.looks {
            for u in column * self.looks..(column + 1) * self.looks {
                let (u, v) = (f64::from(u), f64::from(v));
                let x = self.start.0 + u * self.step_x.0 + v * self.step_y.0;
                let y = self.start.1 + u * self.step_x.1 + v * self.step_y.1;
                see(self.index(x, y));
            }
        }
    }

    fn index(&self, x: f64, y: f64) -> Option<usize> {
        let (width, height) = self.sides;
        let inside = x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64;
        inside.then(|| y as usize * width + x as usize)
    }
}

/// Cells of a kind, their colour and their name.
pub(super) type Ink = (Color, &'static str);

/// A map, and which of its cells are free and occupied.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ground<'a> {
    pub(super) map: &'a OccupancyGrid,
    pub(super) rules: CellRules,
}

/// Around what is shown, as a share of its longer side.
const MARGIN: f64 = 0.02;

impl Ground<'_> {
    pub(super) fn draw(&self, page: &mut Page, view: &View) -> anyhow::Result<()> {
        draw(page, *self, view, |index| self.occupied(index))
    }

    pub(super) fn occupied(&self, index: usize) -> Option<Ink> {
        let value = *self.map.cells.get(index)?;
        let is_occupied = self.rules.is_occupied(value);
        is_occupied.then_some((theme::OCCUPIED, "obstacle"))
    }

    /// All that is known of the map, with a margin.
    pub(super) fn known(&self) -> Extent {
        Extent::of_known(self.map, self.rules).with_rim(MARGIN, 0.0)
    }

    pub(super) fn whole(&self) -> Extent {
        Extent::of_map(self.map).with_rim(MARGIN, 0.0)
    }
}

/// Draws the map, and names what is seen; `ink` is of occupied cells, however small.
pub(super) fn draw(
    page: &mut Page,
    Ground { map, rules }: Ground<'_>,
    view: &View,
    ink: impl Fn(usize) -> Option<Ink>,
) -> anyhow::Result<()> {
    let sampler = Sampler::new(view, frame_of(map), sides_of(map));
    let mut inks: Vec<Ink> = Vec::new();
    let mut seen = Pixel::default();
    page.scene.image(view.area, |column, row| {
        let mut pixel = Pixel::default();
        sampler.each(column, row, |index| {
            let cell = index.and_then(|index| Some((index, *map.cells.get(index)?)));
            match cell.map(|(index, value)| (ink(index), value)) {
                None => pixel.outside += 1.0,
                Some((Some(ink), _)) => {
                    pixel.add_ink(ink.0);
                    if !inks.contains(&ink) {
                        inks.push(ink);
                    }
                }
                Some((None, value)) if rules.is_free(value) => {
                    pixel.free += 1.0;
                }
                Some((None, _)) => pixel.unknown += 1.0,
            }
        });
        seen.free += pixel.free;
        seen.unknown += pixel.unknown;
        seen.outside += pixel.outside;
        pixel.color()
    })?;
    inks.sort_unstable_by_key(|(_, name)| *name);
    let grounds = [
        (seen.free, (theme::FREE, "free")),
        (seen.unknown, (theme::UNKNOWN, "unknown")),
        (seen.outside, (theme::OUTSIDE, "beyond the map")),
    ];
    // Less of it is not seen.
    let least = 1e-3 * (seen.free + seen.unknown + seen.outside);
    let grounds = grounds.into_iter().filter(|(count, _)| *count > least);
    for (color, name) in inks.into_iter().chain(grounds.map(|(_, ink)| ink)) {
        page.legend.add(Sample::Area(color), name);
    }
    Ok(())
}

/// What was met under a pixel, how often.
#[derive(Debug, Clone, Copy, Default)]
struct Pixel {
    free: f64,
    unknown: f64,
    outside: f64,
    ink: f64,
    color: Option<Color>,
}

impl Pixel {
    fn add_ink(&mut self, color: Color) {
        self.ink += 1.0;
        let mixed = self.color.unwrap_or(color);
        self.color = Some(mixed.towards(color, 1.0 / self.ink));
    }

    fn color(&self) -> Color {
        let ground = self.free + self.unknown + self.outside;
        let share = |count: f64| count / ground.max(1.0);
        let known = theme::FREE.towards(theme::UNKNOWN, share(self.unknown));
        let ground_color = known.towards(theme::OUTSIDE, share(self.outside));
        let Some(color) = self.color else {
            return ground_color;
        };
        // The root keeps a wall of one cell visible where a pixel is many.
        ground_color.towards(color, (self.ink / (self.ink + ground)).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use crate::drawing::Rect;
    use geometry::Pose;

    use map::UNKNOWN;

    use super::*;

    /// Three by two cells of half a metre, turned by a quarter: the grid's x axis points up.
    fn map() -> OccupancyGrid {
        let turned = Pose::new(1.0, 0.0, std::f64::consts::FRAC_PI_2);
        let cells = vec![0, 0, 100, 0, UNKNOWN, 0];
        OccupancyGrid::from_parts(3, 2, 0.5, turned, cells).unwrap()
    }

    /// The cells met at each pixel of a picture of the whole map, from the top.
    fn met(width: u32, height: u32) -> Vec<Vec<Option<usize>>> {
        let map = map();
        let area = Rect::new(7.0, 9.0, width.into(), height.into());
        let view = View::fitting(Extent::of_map(&map), area);
        let sampler = Sampler::new(&view, frame_of(&map), sides_of(&map));
        let pixels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        let met = pixels.map(|(column, row)| {
            let mut met = Vec::new();
            sampler.each(column, row, |index| met.push(index));
            met.sort_unstable();
            met.dedup();
            met
        });
        met.collect()
    }

    #[test]
    fn a_pixel_a_cell_shows_that_cell() {
        // Row by row from the top; the grid's second row lies to the left.
        let expected = [5, 2, 4, 1, 3, 0].map(|index| vec![Some(index)]);
        assert_eq!(met(2, 3), expected);
    }

    #[test]
    fn a_large_pixel_meets_all_its_cells_and_what_lies_beside() {
        let met = met(1, 1);
        let all: Vec<_> = [None].into_iter().chain((0..6).map(Some)).collect();
        // The map is higher than wide: the pixel shows what lies beside it too.
        assert_eq!(met, [all]);
    }

    #[test]
    fn a_wall_is_seen_in_a_pixel_that_is_mostly_free() {
        let mut pixel = Pixel {
            free: 15.0,
            ..Pixel::default()
        };
        assert_eq!(pixel.color(), theme::FREE);
        pixel.add_ink(theme::OCCUPIED);
        let expected = theme::FREE.towards(theme::OCCUPIED, 0.25);
        assert_eq!(pixel.color(), expected);
    }
}
