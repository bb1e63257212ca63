//! Two maps of the same place, to be swapped. The second begins two metres further to the lower
//! left, so that a node that mixes cells of one with the origin of the other is wrong.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;
use geometry::Pose;
use map::{MapError, OccupancyGrid, UNKNOWN};

const MARGIN_M: f64 = 2.0;

/// A map file in a separate folder, which contains one map or the other.
#[derive(Debug)]
pub(super) struct Maps {
    served: PathBuf,
    variants: [PathBuf; 2],
    current: usize,
}

impl Maps {
    pub(super) fn new(yaml: &Path, folder: &Path) -> anyhow::Result<Self> {
        let grid = map::load(yaml)?;
        let variants = ["as_given.yaml", "larger.yaml"].map(|name| folder.join(name));
        map::save(&grid, &variants[0])?;
        map::save(&larger(&grid)?, &variants[1])?;
        let mut maps = Maps {
            served: folder.join("map.yaml"),
            variants,
            current: 1,
        };
        maps.swap()?;
        Ok(maps)
    }

    pub(super) fn served(&self) -> &Path {
        &self.served
    }

    pub(super) fn swap(&mut self) -> anyhow::Result<()> {
        self.current = 1 - self.current;
        let next = self.served.with_extension("next");
        let copied = fs::copy(&self.variants[self.current], &next)
            .and_then(|_| fs::rename(&next, &self.served));
        copied.with_context(|| format!("cannot write {}", self.served.display()))
    }
}

fn larger(grid: &OccupancyGrid) -> Result<OccupancyGrid, MapError> {
    let margin = (MARGIN_M / grid.resolution_m).ceil().max(1.0) as u32;
    let (width, height) = (
        grid.width.saturating_add(margin),
        grid.height.saturating_add(margin),
    );
    let mut cells = vec![UNKNOWN; margin as usize * width as usize];
    for row in grid.cells.chunks_exact(grid.width as usize) {
        cells.extend(std::iter::repeat_n(UNKNOWN, margin as usize));
        cells.extend_from_slice(row);
    }
    let back = -f64::from(margin) * grid.resolution_m;
    let origin = grid.map_from_grid.then(Pose::new(back, back, 0.0));
    OccupancyGrid::from_parts(width, height, grid.resolution_m, origin, cells)
}
