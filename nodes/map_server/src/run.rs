//! Looks at the files, loads and sends: one map, or the maps of a set.

mod one;
mod several;

use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use map::OccupancyGrid;
use messages::{CellRules, MapHeader, MapName, NodeState, Stamp};
use transport::{Graph, Health, TransportError};

use crate::{Config, MapServerError};

/// Between two looks at the files: also how long a change has to rest, and how
/// long somebody who joins late waits for the map.
const TICK: Duration = Duration::from_millis(250);

/// Serves the map, or the maps, until the stop flag is set.
///
/// # Errors
/// If the graph fails, or the recording of `--recorded` is broken. Maps that are not there yet, or
/// broken, are waited for; later a broken map is reported in `health` and the one before stays.
pub fn run(graph: &Graph, config: &Config) -> Result<(), MapServerError> {
    match (&config.maps, &config.map) {
        (Some(set), _) => several::run(graph, config, set),
        (None, Some(map)) => one::run(graph, config, map),
        (None, None) => unreachable!("the command line asks for one of them"),
    }
}

/// Says that nothing can be served before a file changes, and why.
fn wait_for(health: &mut Health, problem: &str, path: &Path) -> Result<(), TransportError> {
    let problem = format!("waiting for the map {}: {problem}", path.display());
    tracing::warn!("{problem}");
    health.error(&problem)?;
    health.state(NodeState::Waiting)
}

/// What goes before the cells of a map, which has a name where it is one of a set.
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

/// The stamp of what is read now and served as the next.
fn now(served: u64) -> Stamp {
    let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH);
    Stamp {
        // A clock before 1970 is as wrong as one in 1970.
        measured_ns: since_1970.map_or(0, |time| time.as_nanos() as i64),
        entered_ns: transport::monotonic_ns(),
        counter: served,
    }
}
