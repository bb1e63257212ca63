//! Checks the files, loads and publishes: one map, or the maps of a set.

mod one;
mod several;

use std::path::Path;
use std::time::Duration;

use map::OccupancyGrid;
use messages::{CellRules, MapHeader, MapName, NodeState, Stamp};
use transport::{Graph, Health, TransportError};

use crate::{Config, MapServerError};

/// Interval at which the files are checked, also the time for which a change must be stable, and
/// the longest wait of a late joiner for the map.
const TICK: Duration = Duration::from_millis(250);

/// Serves the map or the maps until the stop flag is set.
///
/// # Errors
/// If the transport fails, or the recording of `--recorded` is broken. Maps that are missing or
/// broken at the start are waited for; later, a broken map is reported in `health` and the previous
/// one stays.
pub fn run(graph: &Graph, config: &Config) -> Result<(), MapServerError> {
    match (&config.maps, &config.map) {
        (Some(set), _) => several::run(graph, config, set),
        (None, Some(map)) => one::run(graph, config, map),
        (None, None) => unreachable!("the command line asks for one of them"),
    }
}

/// Reports that no map can be served until a file changes, and why.
fn wait_for(health: &mut Health, problem: &str, path: &Path) -> Result<(), TransportError> {
    let problem = format!("waiting for the map {}: {problem}", path.display());
    tracing::warn!("{problem}");
    health.error(&problem)?;
    health.state(NodeState::Waiting)
}

/// Returns the header of a map; `name` is empty unless the map is part of a set.
fn header(grid: &OccupancyGrid, rules: CellRules, name: &str) -> MapHeader {
    let mut header = rules.header(MapHeader {
        width: grid.width,
        height: grid.height,
        resolution_m: grid.resolution_m,
        map_from_grid: grid.map_from_grid.into(),
        name: MapName::new(name),
        ..MapHeader::default()
    });
    header.map_id = header.id_of(&grid.cells);
    header
}

/// Returns the stamp of a map that is read now; `served` is its counter.
fn now(served: u64) -> Stamp {
    Stamp {
        measured_ns: transport::wall_ns(),
        entered_ns: transport::monotonic_ns(),
        counter: served,
    }
}
