//! Serves a single map.

use std::error::Error;
use std::path::Path;

use map::OccupancyGrid;
use messages::{CellRules, MapHeader, NodeState, topic};
use recording::Recording;
use transport::{Flow, Graph, Health, Publisher, TransportError, with_causes};

use super::{TICK, header, now, reject};
use crate::files::Seen;
use crate::watch::{Look, Watch};
use crate::{Config, MapServerError};

pub(super) fn run(graph: &Graph, config: &Config) -> Result<(), MapServerError> {
    // Without a map file, the recording is the only source, and is not watched.
    let path = config.map.as_deref().unwrap_or(Path::new(""));
    let mut server = Server {
        publisher: graph.publisher()?,
        health: graph.health()?,
        cells: config.cells,
        served: 0,
        map_id: 0,
    };
    // Checked before loading, so that changes in between are noticed.
    let mut watch = Watch::new(Seen::of_map(path));
    server.health.state(NodeState::Busy)?;
    let (first, is_watched) = first(config)?;
    match first {
        Ok(grid) => {
            server.serve(&grid)?;
            compare((config, path), &grid);
        }
        Err(error) => server.refuse(&error, path)?,
    }
    graph.run(&[], TICK, |_| {
        if is_watched && watch.look(Seen::of_map(path)) == Look::Settled {
            server.health.state(NodeState::Busy)?;
            let outcome = load(config, path);
            if watch.judged(Seen::of_map(path)) {
                server.judge(outcome, path)?;
            }
        }
        server.health.tick()?;
        Ok(Flow::Continue)
    })
}

/// Returns the first map to serve, and true if its files may change: the map in a recording does
/// not.
pub(super) fn first(
    config: &Config,
) -> Result<(Result<OccupancyGrid, map::MapError>, bool), MapServerError> {
    match (recorded(config)?, &config.map, &config.recorded) {
        (Some(grid), ..) => Ok((Ok(grid), false)),
        (None, Some(map), _) => Ok((load(config, map), true)),
        (None, None, path) => Err(MapServerError::NoMap {
            path: path.clone().unwrap_or_default(),
        }),
    }
}

/// Loads the map, if it fits into the graph's memory; logs unknown keys of its description.
fn load(config: &Config, path: &Path) -> Result<OccupancyGrid, map::MapError> {
    map::load_within(config.memory.limit(), path, |key| tracing::warn!("{key}"))
}

/// Returns the last map of the recording from `--recorded`, if it contains one.
fn recorded(config: &Config) -> Result<Option<OccupancyGrid>, MapServerError> {
    let Some(path) = &config.recorded else {
        return Ok(None);
    };
    let grid = map_in(path, config).map_err(|source| MapServerError::Recorded {
        path: path.clone(),
        source,
    })?;
    let found = match &grid {
        Some(_) => "the map is that of the recording",
        None => "the recording holds no map",
    };
    tracing::info!(recording = %path.display(), "{found}");
    Ok(grid)
}

/// Returns the last map of a recording, if it contains one and it fits into the graph's memory.
fn map_in(
    path: &Path,
    config: &Config,
) -> Result<Option<OccupancyGrid>, Box<dyn Error + Send + Sync>> {
    let recording = Recording::open(path)?;
    let Some(last) = recording.maps()?.last() else {
        return Ok(None);
    };
    let (_, map) = last?;
    let limit = config.memory.limit();
    limit.check((map.info.width, map.info.height))?;
    let grid = map.to_grid()?;
    limit.check_grid(&grid)?;
    Ok(Some(grid))
}

/// Logs a warning if the played recording was made on another map than the served one.
fn compare((config, map): (&Config, &Path), served: &OccupancyGrid) {
    let Some(path) = &config.played else {
        return;
    };
    // Errors in the recording are reported by its player.
    let Ok(Some(own)) = map_in(path, config) else {
        return;
    };
    if own.id() == served.id() {
        return;
    }
    let size = |grid: &OccupancyGrid| {
        let OccupancyGrid { width, height, .. } = grid;
        format!("{width} x {height} cells of {} m", grid.resolution_m)
    };
    tracing::warn!(
        "{} was recorded on another map ({}) than {} ({}): where they differ, scans do not fit",
        path.display(),
        size(&own),
        map.display(),
        size(served)
    );
}

struct Server {
    publisher: Publisher<topic::Map>,
    health: Health,
    cells: CellRules,
    served: u64,
    map_id: u64,
}

impl Server {
    fn judge(
        &mut self,
        outcome: Result<OccupancyGrid, map::MapError>,
        path: &Path,
    ) -> Result<(), TransportError> {
        match outcome {
            Ok(grid) if grid.id() == self.map_id => {
                tracing::info!("the map files were rewritten with the same map");
                self.health.state(NodeState::Ready)
            }
            Ok(grid) => match self.serve(&grid) {
                Err(error @ TransportError::SharedMemoryFull { .. }) => self.refuse(&error, path),
                outcome => outcome,
            },
            Err(error) => self.refuse(&error, path),
        }
    }

    /// Keeps the served map, or waits for one if there is none.
    fn refuse(&mut self, error: &dyn Error, path: &Path) -> Result<(), TransportError> {
        let words = ("map", "is rejected, the previous one stays");
        let (is_served, problem) = (self.served > 0, with_causes(error));
        reject(&mut self.health, is_served, words, &problem, path)
    }

    fn serve(&mut self, grid: &OccupancyGrid) -> Result<(), TransportError> {
        let map_id = grid.id();
        let header = MapHeader {
            stamp: now(self.served),
            ..header(grid, self.cells, "")
        };
        self.publisher.send(header, &grid.cells)?;
        self.map_id = map_id;
        self.served += 1;
        self.health.count_sent(1);
        let (width, height, resolution_m) = (grid.width, grid.height, grid.resolution_m);
        let map_id = format!("{map_id:016x}");
        tracing::info!(width, height, resolution_m, map_id, "serving the map");
        self.health.state(NodeState::Ready)
    }
}
