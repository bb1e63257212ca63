//! Redraws a map as by hand: walls become straight lines, and furniture is left out.

use std::collections::BTreeMap;

use ::map::OccupancyGrid;

use super::map::{FREE, WALL, index, walls};
use super::material::Change;

/// Isolated groups of cells smaller than this count as furniture, metres.
const FURNITURE_M: f64 = 1.5;

/// Shortest wall, and largest gap within a wall, metres.
const SHORTEST_M: f64 = 0.3;
const GAP_M: f64 = 0.3;

/// Distance within which cells belong to a line, metres.
const NEAR_M: f64 = 0.12;

/// Number of line directions in the Hough transform.
const DIRECTIONS: usize = 90;

type Cell = (u32, u32);

/// Replaces the walls of the map by straight lines.
pub(super) fn draw(map: &mut OccupancyGrid) -> Change<()> {
    let lines = lines(&large(&walls(map), map.resolution_m), map.resolution_m);
    for (x, y) in walls(map) {
        map.cells[(y * map.width + x) as usize] = FREE;
    }
    for ((x0, y0), (x1, y1)) in lines {
        let steps = (2.0 * (x1 - x0).hypot(y1 - y0)).ceil().max(1.0);
        for i in 0..=steps as u32 {
            let share = f64::from(i) / steps;
            let [x, y] = [x0 + share * (x1 - x0), y0 + share * (y1 - y0)];
            if let Some(at) = index(map, x.round() as i64, y.round() as i64) {
                map.cells[at] = WALL;
            }
        }
    }
    Ok(())
}

/// Returns the cells of all groups as large as a wall. Cells up to two apart are a group.
fn large(walls: &[Cell], resolution_m: f64) -> Vec<Cell> {
    let mut left: BTreeMap<Cell, ()> = walls.iter().map(|&cell| (cell, ())).collect();
    let mut large = Vec::new();
    while let Some((first, ())) = left.pop_first() {
        let (mut group, mut looked_at) = (vec![first], 0);
        while let Some(&(x, y)) = group.get(looked_at) {
            looked_at += 1;
            for near_x in x.saturating_sub(2)..=x + 2 {
                for near_y in y.saturating_sub(2)..=y + 2 {
                    if left.remove(&(near_x, near_y)).is_some() {
                        group.push((near_x, near_y));
                    }
                }
            }
        }
        let span = |of: fn(&Cell) -> u32| {
            let (least, most) = (group.iter().map(of).min(), group.iter().map(of).max());
            f64::from(most.unwrap_or(0) - least.unwrap_or(0)) * resolution_m
        };
        if span(|cell| cell.0).hypot(span(|cell| cell.1)) >= FURNITURE_M {
            large.extend(group);
        }
    }
    large
}

/// Returns the end points of straight walls, longest first (a greedy Hough transform).
fn lines(walls: &[Cell], resolution_m: f64) -> Vec<((f64, f64), (f64, f64))> {
    let mut bins: BTreeMap<(usize, i64), Vec<usize>> = BTreeMap::new();
    let normals: Vec<(f64, f64)> = (0..DIRECTIONS)
        .map(|i| (i as f64 * std::f64::consts::PI / DIRECTIONS as f64).sin_cos())
        .map(|(sin, cos)| (cos, sin))
        .collect();
    let near = (NEAR_M / resolution_m).max(0.75);
    let (cells, mut is_left) = (walls.iter(), vec![true; walls.len()]);
    for (i, &(x, y)) in cells.enumerate() {
        for (direction, (cos, sin)) in normals.iter().enumerate() {
            let away = f64::from(x) * cos + f64::from(y) * sin;
            let bin = (away / near).round() as i64;
            bins.entry((direction, bin)).or_default().push(i);
        }
    }
    let mut by_size: BTreeMap<usize, Vec<(usize, i64)>> = BTreeMap::new();
    for (&bin, cells) in &bins {
        by_size.entry(cells.len()).or_default().push(bin);
    }
    let mut lines = Vec::new();
    while let Some(mut most) = by_size.last_entry() {
        let size = *most.key();
        let Some(bin) = most.get_mut().pop() else {
            most.remove();
            continue;
        };
        let Some(cells) = bins.get_mut(&bin) else {
            continue;
        };
        cells.retain(|&i| is_left[i]);
        // Longer walls took some of its cells, so it moves back in the order.
        if cells.len() < size {
            by_size.entry(cells.len()).or_default().push(bin);
            continue;
        }
        let (cos, sin) = normals[bin.0];
        let along = |i: usize| f64::from(walls[i].1) * cos - f64::from(walls[i].0) * sin;
        cells.sort_by(|&a, &b| along(a).total_cmp(&along(b)));
        for run in cells.chunk_by(|&a, &b| along(b) - along(a) <= GAP_M / resolution_m) {
            let (begin, end) = (along(run[0]), along(run[run.len() - 1]));
            if (end - begin) * resolution_m < SHORTEST_M {
                continue;
            }
            let away = |&i: &usize| f64::from(walls[i].0) * cos + f64::from(walls[i].1) * sin;
            let away = run.iter().map(away).sum::<f64>() / run.len() as f64;
            let at = |along: f64| (away * cos - along * sin, away * sin + along * cos);
            lines.push((at(begin), at(end)));
            run.iter().for_each(|&i| is_left[i] = false);
        }
        if size == 0 {
            break;
        }
    }
    lines
}
