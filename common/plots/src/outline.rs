//! The picture of a map: its boundary cells, from which readings are projected
//! back, and how many there are.

use drawing::Scene;
use engine::boundary;
use engine::grid::Grid;

use super::axes;
use super::ground;
use super::page::{self, Heading, Page};
use super::scan::Size;
use super::subject::Ground;
use super::theme;

/// The body's height as a share of its width at most.
const HIGHEST: f64 = 1.3;

/// Draws what is known of the map; `grid` is the same map as rays see it.
///
/// # Errors
/// The picture would be too large.
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
    let extent = ground.known();
    let ratio = (extent.height() / extent.width()).clamp(0.2, HIGHEST);
    let (width, unit) = (page::body_width(size.width), page::unit(size.width));
    let height = axes::height_for(ratio, width, unit);
    let mut page = Page::new(size.width, height, &heading(ground, grid, name))?;
    let view = axes::view_within(extent, page.body, unit);
    let occupied = ground::occupied(ground.map, ground.rules);
    ground::draw(
        (&mut page.scene, &mut page.legend),
        (ground.map, ground.rules),
        &view,
        |index| match is_boundary.get(index) {
            Some(true) => Some((theme::BOUNDARY, "boundary cell")),
            _ => occupied(index).map(|(color, _)| (color, "obstacle behind it")),
        },
    )?;
    axes::draw_metres(&mut page.scene, &view, unit);
    Ok(page.finish()?)
}

fn heading(ground: &Ground<'_>, grid: &Grid, name: &str) -> Heading {
    let map = ground.map;
    let boundary = boundary::extract(grid).len();
    let share = 100.0 * boundary as f64 / grid.free_cells().max(1) as f64;
    let metres = |cells: u32| f64::from(cells) * map.resolution_m;
    Heading {
        title: name.to_owned(),
        verdict: None,
        says: format!(
            "{} × {} cells of {} m, {:.1} × {:.1} m; {} free cells, {boundary} boundary cells ({share:.1} %)",
            map.width,
            map.height,
            map.resolution_m,
            metres(map.width),
            metres(map.height),
            grid.free_cells(),
        ),
    }
}
