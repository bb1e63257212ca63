//! Serves a set of maps: all of them for searches, and the one on which the robot is for display.

use std::path::Path;
use std::time::Instant;

use map::{MapError, MapFile};
use messages::{MapHeader, MapSet, NodeState, PoseHeader, Stamp, Transition, topic};
use transport::{Flow, Graph, Health, Loan, Publisher, TransportError, with_causes};

use super::{TICK, header, now, reject, wait_for};
use crate::files::Seen;
use crate::shown::Shown;
use crate::watch::{Look, Watch};
use crate::{Config, MapServerError};

pub(super) fn run(graph: &Graph, config: &Config, path: &Path) -> Result<(), MapServerError> {
    let mut health = graph.health()?;
    health.state(NodeState::Busy)?;
    let look = || Seen::of_set(path, &config.on);
    // Checked before loading, so that changes in between are noticed.
    let mut watch = Watch::new(look());
    let first = load(config, path);
    let poses = graph.subscriber::<topic::Tracked>()?;
    // Opened before the publisher of `map`, so that its subscribers see that the map is part of a
    // set.
    let sets = graph.publisher::<topic::Maps>()?;
    let mut server = Server {
        sets,
        maps: graph.publisher()?,
        health,
        served: 0,
        shown: Shown::at(0),
        set: Loaded::default(),
        is_refused: false,
        has_room: true,
    };
    match first {
        Ok(set) => server.serve(set, 0)?,
        Err(error) => wait_for(&mut server.health, &with_causes(&error), path)?,
    }
    graph.run(&[&poses], TICK, |wake| {
        while let Some(pose) = poses.receive()? {
            server.follow(pose.header())?;
        }
        if wake.tick && watch.look(look()) == Look::Settled {
            server.health.state(NodeState::Busy)?;
            let outcome = load(config, path);
            if watch.judged(look()) {
                server.judge(outcome, path)?;
            }
        }
        server.health.tick()?;
        Ok(Flow::Continue)
    })
}

#[derive(Default)]
pub(super) struct Loaded {
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
    header: MapHeader,
    cells: Vec<u8>,
}

impl LoadedMap {
    fn header_at(&self, stamp: Stamp) -> MapHeader {
        MapHeader {
            stamp,
            ..self.header
        }
    }
}

/// Loads the maps, if all of them fit into the graph's memory.
pub(super) fn load(config: &Config, path: &Path) -> Result<Loaded, MapError> {
    let set = map::set_of_noting(path, |line| tracing::info!("{line}"))?.select(&config.on)?;
    let mut limit = config.memory.limit();
    let mut maps = Vec::with_capacity(set.maps.len());
    for MapFile { name, yaml, .. } in set.maps {
        let grid = map::load_within(limit, yaml, |key| tracing::warn!("{key}"));
        let grid = grid.map_err(|source| MapError::OfSet {
            name: name.clone(),
            source: Box::new(source),
        })?;
        limit = limit.without(&grid);
        maps.push(LoadedMap {
            header: header(&grid, config.cells, &name),
            name,
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

struct Server {
    sets: Publisher<topic::Maps>,
    maps: Publisher<topic::Map>,
    health: Health,
    /// Number of messages sent: sets and single maps.
    served: u64,
    shown: Shown,
    set: Loaded,
    /// True if the files hold something other than the served set.
    is_refused: bool,
    /// True if the map to be displayed fitted into memory.
    has_room: bool,
}

impl Server {
    /// Publishes all maps, and the one with this number for display; publishes nothing if not all
    /// of them fit into memory.
    fn serve(&mut self, set: Loaded, shown: usize) -> Result<(), TransportError> {
        let stamp = now(self.served);
        let maps = set.maps.iter();
        let maps = maps.map(|map| (map.header_at(stamp), &map.cells[..]));
        let all = MapSet {
            maps: maps.collect(),
            transitions: set.transitions.clone(),
        };
        let mut loan = self.sets.loan(all.bytes())?;
        let header = all.write(stamp, loan.items_mut());
        *loan.header_mut() = header;
        let shown_loan = filled(&self.maps, &set.maps[shown], now(self.served + 1))?;
        loan.send()?;
        shown_loan.send()?;
        self.served += 2;
        self.health.count_sent(2);
        for map in &set.maps {
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
        (self.set, self.shown) = (set, Shown::at(shown));
        (self.is_refused, self.has_room) = (false, true);
        self.report_state()
    }

    fn show(&mut self, number: usize) -> Result<(), TransportError> {
        let map = &self.set.maps[number];
        filled(&self.maps, map, now(self.served))?.send()?;
        tracing::info!("the robot is on map {}", map.name);
        self.served += 1;
        self.health.count_sent(1);
        self.shown.change_to(number);
        Ok(())
    }

    /// Displays the map on which the robot is; if it does not fit into memory, tries again with the
    /// next pose.
    fn follow(&mut self, pose: &PoseHeader) -> Result<(), TransportError> {
        if pose.pose_known == 0 {
            return Ok(());
        }
        let mut maps = self.set.maps.iter();
        let Some(number) = maps.position(|map| map.header.map_id == pose.map_id) else {
            return Ok(());
        };
        let named = (number, pose.is_believed());
        if !self.shown.is_due(named, Instant::now()) {
            // Back on the displayed map, the other one is no longer needed.
            return self.note_room(self.has_room || number == self.shown.map());
        }
        match self.show(number) {
            Err(error @ TransportError::SharedMemoryFull { .. }) => {
                if self.has_room {
                    let name = &self.set.maps[number].name;
                    let problem = with_causes(&error);
                    let problem = format!("the robot is on map {name}, not shown: {problem}");
                    tracing::warn!("{problem}");
                    self.health.error(&problem)?;
                }
                self.note_room(false)
            }
            Ok(()) => self.note_room(true),
            error => error,
        }
    }

    /// Records `has_room` and updates the state: true if the map to be displayed fitted into
    /// memory.
    fn note_room(&mut self, has_room: bool) -> Result<(), TransportError> {
        if self.has_room == has_room {
            return Ok(());
        }
        self.has_room = has_room;
        self.report_state()
    }

    fn report_state(&mut self) -> Result<(), TransportError> {
        let state = match self.is_refused || !self.has_room {
            true => NodeState::Degraded,
            false => NodeState::Ready,
        };
        self.health.state(state)
    }

    fn judge(
        &mut self,
        outcome: Result<Loaded, MapError>,
        path: &Path,
    ) -> Result<(), TransportError> {
        let problem = match outcome {
            Ok(set) if set.is_same(&self.set) => {
                tracing::info!("the files of the set were rewritten with the same maps");
                self.is_refused = false;
                return self.report_state();
            }
            Ok(set) => {
                let shown = self.set.maps.get(self.shown.map());
                let is_shown = |map: &LoadedMap| shown.is_some_and(|shown| map.name == shown.name);
                let stays = set.maps.iter().position(is_shown);
                match self.serve(set, stays.unwrap_or(0)) {
                    Err(error @ TransportError::SharedMemoryFull { .. }) => with_causes(&error),
                    outcome => return outcome,
                }
            }
            Err(error) => with_causes(&error),
        };
        self.is_refused = self.served > 0;
        let words = ("maps", "are rejected, the previous ones stay");
        reject(&mut self.health, self.is_refused, words, &problem, path)
    }
}

fn filled<'p>(
    publisher: &'p Publisher<topic::Map>,
    map: &LoadedMap,
    stamp: Stamp,
) -> Result<Loan<'p, topic::Map>, TransportError> {
    let mut loan = publisher.loan(map.cells.len())?;
    *loan.header_mut() = map.header_at(stamp);
    loan.items_mut().copy_from_slice(&map.cells);
    Ok(loan)
}
