//! A set of maps: all of them for those who search, and the one on which the robot is for those
//! who show a map.

use std::path::{Path, PathBuf};
use std::time::Instant;

use map::MapError;
use messages::{MapHeader, MapSet, NodeState, PoseHeader, TrackState, Transition, topic};
use transport::{Flow, Graph, Health, Publisher, TransportError, with_causes};

use super::{TICK, header, now};
use crate::files::{Files, Fingerprint, Seen, fingerprint};
use crate::shown::Shown;
use crate::watch::{Look, Watch};
use crate::{Config, MapServerError};

/// Serves the maps of a set until the stop flag is set.
pub(super) fn run(graph: &Graph, config: &Config, path: &Path) -> Result<(), MapServerError> {
    let mut health = graph.health()?;
    health.state(NodeState::Busy)?;
    let mut files = SetFiles::new(path);
    let set = load(config, path).map_err(|source| MapServerError::Map {
        path: path.to_owned(),
        source: Box::new(source),
    })?;
    files.follow(&set);
    let mut watch = Watch::new(files.look());
    let poses = graph.subscriber::<topic::Tracked>()?;
    // Whoever looks at `map` sees that it is one of a set.
    let sets = graph.publisher::<topic::Maps>()?;
    let mut server = Server {
        sets,
        maps: graph.publisher()?,
        health,
        served: 0,
        shown: Shown::at(0),
        set,
    };
    server.serve()?;
    graph.run(&[&poses], TICK, |wake| {
        while let Some(pose) = poses.receive()? {
            server.follow(pose.header())?;
        }
        if wake.tick && watch.look(files.look()) == Look::Settled {
            server.health.state(NodeState::Busy)?;
            let outcome = load(config, path);
            if watch.judged(files.look()) {
                server.judge(outcome, path)?;
                files.follow(&server.set);
                watch = Watch::new(files.look());
            }
        }
        server.health.tick()?;
        Ok(Flow::Continue)
    })
}

/// The maps of a set, in its order, with the names of their files.
struct Loaded {
    maps: Vec<LoadedMap>,
    transitions: Vec<Transition>,
}

impl Loaded {
    fn is_same(&self, other: &Loaded) -> bool {
        let ids = |set: &Loaded| -> Vec<u64> {
            let maps = set.maps.iter();
            maps.map(|map| map.header.map_id).collect()
        };
        ids(self) == ids(other) && self.transitions == other.transitions
    }
}

struct LoadedMap {
    name: String,
    yaml: PathBuf,
    header: MapHeader,
    cells: Vec<u8>,
}

/// Reads the maps, if the graph can hold all of them.
fn load(config: &Config, path: &Path) -> Result<Loaded, MapError> {
    let set = map::set_of(path)?.select(&config.on)?;
    let mut left = config.memory.limit();
    let mut maps = Vec::with_capacity(set.maps.len());
    for file in set.maps {
        let grid = map::load_within(left, &file.yaml, |key| tracing::warn!("{key}"))?;
        left = left.without(&grid);
        maps.push(LoadedMap {
            header: header(&grid, config.cells, &file.name),
            name: file.name,
            yaml: file.yaml,
            cells: grid.cells,
        });
    }
    let transitions = set.transitions.iter().map(|transition| Transition {
        maps: transition.maps.map(|map| map as u32),
        map_from_region: transition.map_from_region.map(Into::into),
        size_m: transition.size_m,
    });
    Ok(Loaded {
        maps,
        transitions: transitions.collect(),
    })
}

/// The file or folder of a set, and the files of its maps.
struct SetFiles {
    path: PathBuf,
    list: PathBuf,
    maps: Vec<Files>,
}

impl SetFiles {
    fn new(path: &Path) -> Self {
        SetFiles {
            path: path.to_owned(),
            list: path.join("maps.yaml"),
            maps: Vec::new(),
        }
    }

    /// Looks at the files of these maps from now on.
    fn follow(&mut self, set: &Loaded) {
        self.maps = set.maps.iter().map(|map| Files::new(&map.yaml)).collect();
    }

    fn look(&mut self) -> (Option<Fingerprint>, Option<Fingerprint>, Vec<Seen>) {
        let maps = self.maps.iter_mut().map(Files::look).collect();
        (fingerprint(&self.path), fingerprint(&self.list), maps)
    }
}

struct Server {
    sets: Publisher<topic::Maps>,
    maps: Publisher<topic::Map>,
    health: Health,
    /// Sets and maps that were sent.
    served: u64,
    /// Which of the maps is sent alone.
    shown: Shown,
    set: Loaded,
}

impl Server {
    /// Sends all maps, and the one that is shown.
    fn serve(&mut self) -> Result<(), TransportError> {
        let stamp = now(self.served);
        let maps = self.set.maps.iter();
        let maps = maps.map(|map| {
            (
                MapHeader {
                    stamp,
                    ..map.header
                },
                &map.cells[..],
            )
        });
        let set = MapSet {
            maps: maps.collect(),
            transitions: self.set.transitions.clone(),
        };
        let mut loan = self.sets.loan(set.bytes())?;
        let header = set.write(stamp, loan.items_mut());
        *loan.header_mut() = header;
        loan.send()?;
        self.served += 1;
        self.health.count_sent(1);
        for map in &self.set.maps {
            let MapHeader {
                width,
                height,
                resolution_m,
                map_id,
                ..
            } = map.header;
            let (name, map_id) = (&map.name, format!("{map_id:016x}"));
            tracing::info!(name, width, height, resolution_m, map_id, "serving the map");
        }
        self.show()?;
        self.health.state(NodeState::Ready)
    }

    fn show(&mut self) -> Result<(), TransportError> {
        let map = &self.set.maps[self.shown.map()];
        let mut loan = self.maps.loan(map.cells.len())?;
        *loan.header_mut() = MapHeader {
            stamp: now(self.served),
            ..map.header
        };
        loan.items_mut().copy_from_slice(&map.cells);
        loan.send()?;
        self.served += 1;
        self.health.count_sent(1);
        Ok(())
    }

    /// Shows the map on which the robot is.
    fn follow(&mut self, pose: &PoseHeader) -> Result<(), TransportError> {
        let mut maps = self.set.maps.iter();
        let Some(number) = maps.position(|map| map.header.map_id == pose.map_id) else {
            return Ok(());
        };
        let is_found = pose.state != TrackState::Searching as u32;
        if self.shown.changes_to((number, is_found), Instant::now()) {
            tracing::info!("the robot is on map {}", self.set.maps[number].name);
            self.show()?;
        }
        Ok(())
    }

    fn judge(
        &mut self,
        outcome: Result<Loaded, MapError>,
        path: &Path,
    ) -> Result<(), TransportError> {
        let problem = match outcome {
            Ok(set) if set.is_same(&self.set) => {
                tracing::info!("the files of the set were rewritten with the same maps");
                return self.health.state(NodeState::Ready);
            }
            Ok(set) => {
                let shown = self.set.maps[self.shown.map()].name.clone();
                let before = std::mem::replace(&mut self.set, set);
                let stays = self.set.maps.iter().position(|map| map.name == shown);
                let kept = std::mem::replace(&mut self.shown, Shown::at(stays.unwrap_or(0)));
                match self.serve() {
                    Err(error @ TransportError::SharedMemoryFull { .. }) => {
                        (self.set, self.shown) = (before, kept);
                        with_causes(&error)
                    }
                    outcome => return outcome,
                }
            }
            Err(error) => with_causes(&error),
        };
        let path = path.display();
        tracing::warn!("the changed maps {path} are rejected, the previous ones stay: {problem}");
        self.health.count_refused(1);
        self.health
            .error(&format!("maps {path} refused: {problem}"))?;
        self.health.state(NodeState::Degraded)
    }
}
