//! Picture of a map with its boundary cells, from which readings are projected back.

use crate::drawing::Scene;
use engine::boundary;
use engine::grid::Grid;

use super::axes;
use super::ground::{self, Ground};
use super::page::{Heading, Page};
use super::scan::Size;
use super::theme;

/// Limits of the body's height as a share of its width.
const HEIGHTS: (f64, f64) = (0.2, 1.3);

/// Draws what is known of the map; `grid` is the same map as rays see it.
pub(super) fn draw(
    ground: &Ground<'_>,
    grid: &Grid,
    name: &str,
    size: Size,
) -> anyhow::Result<Scene> {
    let mut is_boundary = vec![false; ground.map.cells.len()];
    let boundary = boundary::extract(grid);
    for cell in &boundary {
        let index = usize::from(cell.y) * grid.width() + usize::from(cell.x);
        if let Some(mark) = is_boundary.get_mut(index) {
            *mark = true;
        }
    }
    let heading = heading(ground, (grid, boundary.len()), name);
    let (mut page, view) = Page::of_map(size.width, ground.known(), HEIGHTS, &heading)?;
    let ink = |index: usize| match (is_boundary.get(index), ground.occupied(index)) {
        (Some(true), _) => Some((theme::BOUNDARY, "boundary cell")),
        (_, occupied) => occupied.map(|(color, _)| (color, "obstacle behind it")),
    };
    ground::draw(&mut page, *ground, &view, ink)?;
    axes::draw_metres(&mut page.scene, &view, page.unit);
    page.finish()
}

fn heading(ground: &Ground<'_>, (grid, boundary): (&Grid, usize), name: &str) -> Heading {
    let map = ground.map;
    let share = 100.0 * boundary as f64 / grid.free_cells().max(1) as f64;
    let metres = |cells: u32| f64::from(cells) * map.resolution_m;
    Heading::plain(
        name,
        format!(
            "{} × {} cells of {} m, {:.1} × {:.1} m; {} free cells, {boundary} boundary cells ({share:.1} %)",
            map.width,
            map.height,
            map.resolution_m,
            metres(map.width),
            metres(map.height),
            grid.free_cells(),
        ),
    )
}
