//! Changes of the map.

use ::map::{OccupancyGrid, UNKNOWN};
use geometry::Pose;
use rand::RngExt;

use super::material::Material;
use super::material::{Change, Means};

/// Occupancy from which a cell counts as a wall, per cent, and the values that are drawn.
const WALL_FROM: u8 = 65;
pub(super) const WALL: u8 = 100;
pub(super) const FREE: u8 = 0;

/// Radius of the discs in which walls are erased, metres.
const ERASED_M: f64 = 0.5;

/// Side lengths of furniture (metres), free floor per piece (m²), and distance of the pieces from
/// the robot's path (metres).
const SIDES_M: std::ops::Range<f64> = 0.3..1.2;
const FLOOR_M2: f64 = 10.0;
const FROM_WAY_M: f64 = 0.4;

pub(super) fn is_wall(cell: u8) -> bool {
    (WALL_FROM..UNKNOWN).contains(&cell)
}

/// Column and row of each wall cell.
pub(super) fn walls(map: &OccupancyGrid) -> Vec<(u32, u32)> {
    let cells = (0u32..).zip(&map.cells);
    let walls = cells.filter(|&(_, &cell)| is_wall(cell));
    walls.map(|(i, _)| (i % map.width, i / map.width)).collect()
}

/// Index of a cell; `None` outside the map.
pub(super) fn index(map: &OccupancyGrid, column: i64, row: i64) -> Option<usize> {
    let (width, height) = (i64::from(map.width), i64::from(map.height));
    let is_inside = (0..width).contains(&column) && (0..height).contains(&row);
    is_inside.then(|| (row * width + column) as usize)
}

/// Erases a share of the walls, disc by disc.
pub(super) fn erase(it: &mut Material, means: &mut Means<'_>, share: f64) -> Change<()> {
    let map = &mut it.map;
    let walls = walls(map);
    let reach = (ERASED_M / map.resolution_m).ceil() as i64;
    let mut left = (share * walls.len() as f64).round() as i64;
    while left > 0 {
        let (x, y) = walls[means.rng.random_range(0..walls.len())];
        for (dx, dy) in disc(reach) {
            let at = index(map, i64::from(x) + dx, i64::from(y) + dy);
            if let Some(at) = at.filter(|&at| is_wall(map.cells[at])) {
                map.cells[at] = FREE;
                left -= 1;
            }
        }
    }
    Ok(())
}

fn disc(reach: i64) -> impl Iterator<Item = (i64, i64)> {
    let side = move || -reach..=reach;
    let square = side().flat_map(move |dx| side().map(move |dy| (dx, dy)));
    square.filter(move |(dx, dy)| dx * dx + dy * dy <= reach * reach)
}

/// Puts boxes on the free floor, away from the robot's path.
pub(super) fn furnish(it: &mut Material, means: &mut Means<'_>) -> Change<()> {
    let map = &mut it.map;
    let free = map.cells.iter().filter(|&&cell| cell == FREE).count();
    let floor_m2 = free as f64 * map.resolution_m * map.resolution_m;
    let mut left = (floor_m2 / FLOOR_M2).ceil() as u32;
    // In a corridor most positions are rejected.
    for _ in 0..100 * left {
        if left == 0 {
            break;
        }
        let sides: [f64; 2] = std::array::from_fn(|_| means.rng.random_range(SIDES_M));
        let [column, row] = [map.width, map.height].map(|side| means.rng.random_range(0..side));
        let (x, y) = map.cell_center(column, row);
        let clear_m = FROM_WAY_M + 0.5 * sides[0].hypot(sides[1]);
        let is_near = |at: Pose| (at.x - x).hypot(at.y - y) < clear_m;
        let [wide, high] = sides.map(|side| (side / map.resolution_m).round() as i64);
        let corner = (i64::from(column) - wide / 2, i64::from(row) - high / 2);
        let cells: Option<Vec<usize>> = (0..wide * high)
            .map(|i| index(map, corner.0 + i % wide, corner.1 + i / wide))
            .collect();
        let Some(cells) = cells else { continue };
        if cells.iter().all(|&i| map.cells[i] == FREE)
            && !it.steps.iter().any(|step| is_near(step.map_from_laser))
        {
            cells.into_iter().for_each(|i| map.cells[i] = WALL);
            left -= 1;
        }
    }
    Ok(())
}

/// Makes one side of the map unknown, with half of its walls.
pub(super) fn halve(it: &mut Material) -> Change<()> {
    let map = &mut it.map;
    let is_wide = map.width >= map.height;
    let along = |(x, y): (u32, u32)| if is_wide { x } else { y };
    let mut walls: Vec<u32> = walls(map).into_iter().map(along).collect();
    walls.sort_unstable();
    let Some(&middle) = walls.get(walls.len() / 2) else {
        return Err("the map has no walls");
    };
    let width = map.width;
    for (i, cell) in (0..).zip(&mut map.cells) {
        if along((i % width, i / width)) >= middle {
            *cell = UNKNOWN;
        }
    }
    Ok(())
}

/// Scales the map, and the truth with it.
pub(super) fn enlarge(it: &mut Material, factor: f64) -> Change<()> {
    it.map.resolution_m *= factor;
    let map_from_grid = it.map.map_from_grid;
    let scaled = |pose: Pose| {
        let at = map_from_grid.inverse().then(pose);
        map_from_grid.then(Pose::new(factor * at.x, factor * at.y, at.yaw))
    };
    for step in &mut it.steps {
        step.truth = step.truth.map(scaled);
        step.map_from_laser = scaled(step.map_from_laser);
    }
    Ok(())
}

/// Mirrors the map; no pose is right on it.
pub(super) fn mirror(it: &mut Material) -> Change<()> {
    let width = it.map.width as usize;
    it.map.cells.chunks_mut(width).for_each(<[u8]>::reverse);
    it.is_nowhere = true;
    Ok(())
}

/// Replaces the map by that of another building; no pose is right on it.
pub(super) fn exchange(it: &mut Material, means: &mut Means<'_>) -> Change<()> {
    let other = means.other_map.filter(|other| other.id() != it.map.id());
    let other = other.ok_or("no other map is at hand: give --other-map or a second recording")?;
    it.map = other.clone();
    it.is_nowhere = true;
    Ok(())
}

/// Enlarges the cells to this side; a cell with any wall becomes a wall.
pub(super) fn coarsen(it: &mut Material, side_m: f64) -> Change<()> {
    let map = &it.map;
    if map.resolution_m > 0.99 * side_m {
        return Err("its cells are no smaller");
    }
    let share = map.resolution_m / side_m;
    let side = |cells: u32| (f64::from(cells) * share).ceil() as u32;
    let (width, height) = (side(map.width), side(map.height));
    let mut cells = vec![UNKNOWN; (width * height) as usize];
    let of = |cell: u32| ((f64::from(cell) + 0.5) * share) as u32;
    for (i, &cell) in (0u32..).zip(&map.cells) {
        let (x, y) = (of(i % map.width), of(i / map.width));
        let coarse = &mut cells[(y * width + x) as usize];
        *coarse = match (*coarse, cell) {
            (UNKNOWN, other) | (other, UNKNOWN) => other,
            (a, b) => a.max(b),
        };
    }
    let coarse = OccupancyGrid::from_parts(width, height, side_m, map.map_from_grid, cells);
    it.map = coarse.map_err(|_| "such cells are not allowed")?;
    Ok(())
}
