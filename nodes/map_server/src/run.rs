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

/// Serves the map or the maps until the stop flag is set. Maps that are missing or broken at the
/// start are waited for; later, a broken map is reported in `health` and the previous one stays.
pub fn run(graph: &Graph, config: &Config) -> Result<(), MapServerError> {
    match &config.maps {
        Some(set) => several::run(graph, config, set),
        None => one::run(graph, config),
    }
}

pub fn check(config: &Config) -> Result<(), MapServerError> {
    match &config.maps {
        Some(set) => several::load(config, set).map(drop)?,
        None => one::first(config)?.0.map(drop)?,
    }
    Ok(())
}

/// Reports that no map can be served until a file changes, and why.
fn wait_for(health: &mut Health, problem: &str, path: &Path) -> Result<(), TransportError> {
    let problem = format!("waiting for the map {}: {problem}", path.display());
    tracing::warn!("{problem}");
    health.error(&problem)?;
    health.state(NodeState::Waiting)
}

/// Reports that the changed files of `what` are rejected and what was served before stays, or waits
/// for the map if nothing was served.
fn reject(
    health: &mut Health,
    is_served: bool,
    (what, previous): (&str, &str),
    problem: &str,
    path: &Path,
) -> Result<(), TransportError> {
    if !is_served {
        return wait_for(health, problem, path);
    }
    let path = path.display();
    tracing::warn!("the changed {what} {path} {previous}: {problem}");
    health.count_refused(1);
    health.error(&format!("{what} {path} refused: {problem}"))?;
    health.state(NodeState::Degraded)
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
    transport::stamp_now(transport::wall_ns(), served)
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use transport::with_causes;

    use super::*;

    #[test]
    fn maps_that_are_missing_or_broken_are_found_before_a_graph_starts() {
        let corridor = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../recordings/malaga_corridor"
        );
        let checked = |options: &str| {
            let options = options.replace("AT", corridor);
            let words = ["map_server"].into_iter().chain(options.split(' '));
            let checked = check(&Config::try_parse_from(words).unwrap());
            checked.map_or_else(|error| with_causes(&error), |()| String::new())
        };
        let recorded = "--recorded AT/recording.mcap";
        for sound in ["--map AT/map.yaml", "--maps AT", recorded] {
            assert_eq!(checked(sound), "", "{sound}");
        }
        assert!(checked("--map AT/no.yaml").contains("no.yaml: No such file"));
        assert!(checked("--map AT/map.png").contains("not UTF-8"));
        assert!(checked("--maps AT/expected.json").contains("expected.json: "));
        assert!(checked("--recorded AT/map.yaml").contains("map.yaml"));
    }
}
