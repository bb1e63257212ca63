//! Selects the map for a scan: the newest one recorded before it, as in the graph, or the first one
//! after it if there is none before. [`map_in`] returns the newest map.

use std::iter::Peekable;

use anyhow::anyhow;
use engine::grid::{CellRules, Grid, GridFrame};
use map::OccupancyGrid;
use recording::Recording;
use ros::OccupancyGridMsg;
use transport::with_causes;

/// A map with the log time from which it counts, or the reason why it cannot be searched.
type Due = (i64, Result<OccupancyGrid, String>);

/// Maps of a recording by log time.
pub(super) struct Maps<'a> {
    maps: Peekable<Box<dyn Iterator<Item = Due> + 'a>>,
    /// True once a map has been returned.
    began: bool,
}

impl<'a> Maps<'a> {
    /// Contains no map, since the map has already been prepared.
    pub(super) fn none() -> Self {
        Maps::of(std::iter::empty())
    }

    /// Fails if the recording contains no map.
    pub(super) fn recorded(recording: &'a Recording, rules: CellRules) -> anyhow::Result<Self> {
        let maps = recording.maps()?.map(move |recorded| match recorded {
            Ok((time_ns, map)) => (time_ns, searchable(&map, rules)),
            // A map that cannot be decoded has no log time and is due at once.
            Err(error) => (i64::MIN, Err(with_causes(&error))),
        });
        let mut maps = Maps::of(maps);
        match maps.maps.peek() {
            Some(_) => Ok(maps),
            None => Err(no_map(recording)),
        }
    }

    fn of(maps: impl Iterator<Item = Due> + 'a) -> Self {
        let maps: Box<dyn Iterator<Item = Due> + 'a> = Box::new(maps);
        Maps {
            maps: maps.peekable(),
            began: false,
        }
    }

    /// Returns the next map that arrived before a scan of this log time. The first map counts for
    /// the scans before it, too.
    pub(super) fn next_for(&mut self, log_time_ns: i64) -> Option<Result<OccupancyGrid, String>> {
        let is_due = |(due_ns, _): &Due| *due_ns <= log_time_ns || !self.began;
        let (_, map) = self.maps.next_if(is_due)?;
        self.began = true;
        Some(map)
    }
}

/// Converts a recorded map, and checks that it can be searched, without preparing it.
/// Fails with a reason: a field out of range, or no occupied or no free cell.
pub fn searchable(map: &OccupancyGridMsg, rules: CellRules) -> Result<OccupancyGrid, String> {
    let grid = map.to_grid().map_err(|error| with_causes(&error))?;
    let (width, height) = sides_of(&grid);
    let checked = Grid::new(width, height, &grid.cells, rules);
    match checked.and_then(|grid| grid.check_use()) {
        Ok(()) => Ok(grid),
        Err(error) => Err(with_causes(&error)),
    }
}

/// Returns the newest map of a recording.
/// Fails if it contains no map, or one that cannot be used.
pub fn map_in(recording: &Recording) -> anyhow::Result<OccupancyGrid> {
    recording.map()?.ok_or_else(|| no_map(recording))
}

/// Error for a recording without a map; its damage, if it is damaged.
fn no_map(recording: &Recording) -> anyhow::Error {
    let path = recording.path().display();
    match recording.damage_error() {
        Some(damage) => damage.into(),
        None => anyhow!("{path} has no map on /map: name one with --map map.yaml"),
    }
}

pub fn frame_of(map: &OccupancyGrid) -> GridFrame {
    GridFrame::new(map.resolution_m, map.map_from_grid)
}

pub fn sides_of(map: &OccupancyGrid) -> (usize, usize) {
    (map.width as usize, map.height as usize)
}
