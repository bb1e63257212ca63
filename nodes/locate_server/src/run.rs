//! Prepares the map, opens the service, and reports its state.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use engine::localizer::Settings;
use map::MapFile;
use messages::NodeState;
use transport::{Flow, Graph, Waker, wall_ns};
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Subscriber;
use zenoh::query::{Query, Queryable};
use zenoh::sample::SampleKind;
use zenoh::{Result as ZenohResult, Session, Wait};
use zenoh_session::KeyError;

use crate::counts::Counts;
use crate::dispatcher::Dispatcher;
use crate::locator::{Locator, SearchedMap};
use crate::{Config, LocateError, worker};

/// Interval for reporting counters and checking for other servers.
const TICK: Duration = Duration::from_millis(200);

/// Time to discover other servers before taking requests.
const ACQUAINTANCE: Duration = Duration::from_millis(500);

pub fn run(graph: &Graph, config: &Config) -> Result<(), LocateError> {
    let mut health = graph.health()?;
    health.state(NodeState::Busy)?;
    let locator = Arc::new(prepare(config)?);
    health.state(NodeState::Waiting)?;
    let Some(session) = zenoh_session::open(graph, &config.network, || health.tick())? else {
        return Ok(());
    };
    let counts = Arc::new(Counts::default());
    let mut service = Service::open(&session, config, &locator, &counts, graph.waker()?)?;
    let opened = Instant::now();
    let mut is_ready = false;
    graph.run(&[], TICK, |_| {
        if opened.elapsed() >= ACQUAINTANCE {
            service.follow_team()?;
            if !std::mem::replace(&mut is_ready, true) {
                health.state(NodeState::Ready)?;
            }
        }
        counts.report(&mut health)?;
        Ok(Flow::Continue)
    })
}

fn prepare(config: &Config) -> Result<Locator, LocateError> {
    let how = Settings {
        vote_search: config.vote_search.clone(),
        peaks: config.peaks,
        ..Settings::default()
    };
    let failed = |path: &Path, source| LocateError::Map {
        path: path.to_owned(),
        source: Box::new(source),
    };
    let set = config.maps.as_deref().unwrap_or(Path::new("--map"));
    let mut maps = Vec::new();
    let files = config.files().map_err(|source| failed(set, source))?;
    for MapFile { name, yaml, .. } in files {
        let grid = map::load_within(map::MemoryLimit::NONE, &yaml, |key| tracing::warn!("{key}"));
        let grid = grid.map_err(|source| failed(&yaml, source))?;
        let map = SearchedMap::new(name, &grid, config.cells, how.clone());
        maps.push(map.map_err(|source| LocateError::UnusableMap { path: yaml, source })?);
    }
    Locator::of_set(maps).map_err(|source| LocateError::UnusableMap {
        path: set.to_owned(),
        source,
    })
}

/// Declarations on the network; dropping it withdraws them.
struct Service {
    session: Session,
    /// `backcast/locate/<map>`.
    key: String,
    since: u64,
    dispatcher: Arc<Dispatcher>,
    /// Queryable for requests to all servers, while this server is the one that takes them.
    to_all: Option<Queryable<()>>,
    _handed_on: Queryable<()>,
    _team: Subscriber<()>,
    _token: LivelinessToken,
}

impl Service {
    fn open(
        session: &Session,
        config: &Config,
        locator: &Arc<Locator>,
        counts: &Arc<Counts>,
        waker: Waker,
    ) -> Result<Self, LocateError> {
        let key = network_payload::locate(&config.name());
        let workers = config.workers();
        let me = session.zid().to_string();
        let waiting = usize::from(config.waiting);
        let load = (workers, waiting);
        let (dispatcher, work_queue) =
            Dispatcher::new(session, &key, load, config.deadline, counts);
        let shared = (Arc::new(work_queue), locator.clone(), counts.clone());
        for _ in 0..workers {
            let (work_queue, locator, counts) = shared.clone();
            // The threads end when the dispatcher is closed, or with the process.
            std::thread::spawn(move || worker::work(&work_queue, &locator, &counts));
        }
        let map_id = locator.map_id();
        let since = wall_ns().unsigned_abs();
        let token = format!("{key}/{me}/{map_id:016x}/{since:x}/{workers}");
        let mine = format!("{key}/{me}");
        let service = Service {
            session: session.clone(),
            to_all: None,
            _handed_on: answer(session, &mine, {
                let (dispatcher, key) = (dispatcher.clone(), mine.as_str().into());
                move |query| dispatcher.ask_me(query, &key)
            })?,
            _team: meet(session, &key, map_id, &dispatcher, waker)?,
            _token: tried("be alive at", &token, |key| {
                session.liveliness().declare_token(key).wait()
            })?,
            dispatcher,
            since,
            key,
        };
        let map_id = format!("{map_id:016x}");
        tracing::info!(key = service.key, workers, map_id, "answering");
        Ok(service)
    }

    /// Takes the requests to all servers if this server is the leader; else Zenoh would deliver
    /// each request to several. A request in transit at a change is lost until its deadline.
    fn follow_team(&mut self) -> Result<(), LocateError> {
        let me = self.session.zid().to_string();
        let is_first = self.dispatcher.team().is_led_by(self.since, &me);
        if is_first && self.to_all.is_none() {
            let dispatcher = self.dispatcher.clone();
            let ask = move |query| dispatcher.ask(query);
            self.to_all = Some(answer(&self.session, &self.key, ask)?);
            tracing::info!(key = self.key, "answers the requests to all servers");
        } else if !is_first && self.to_all.take().is_some() {
            tracing::info!(key = self.key, "another server answers the requests to all");
        }
        Ok(())
    }
}

fn answer(
    session: &Session,
    key: &str,
    ask: impl Fn(Query) + Send + Sync + 'static,
) -> Result<Queryable<()>, LocateError> {
    tried("answer at", key, |key| {
        session
            .declare_queryable(key)
            .complete(true)
            .callback(ask)
            .wait()
    })
}

fn meet(
    session: &Session,
    key: &str,
    map_id: u64,
    dispatcher: &Arc<Dispatcher>,
    waker: Waker,
) -> Result<Subscriber<()>, LocateError> {
    let (me, dispatcher) = (session.zid().to_string(), Arc::clone(dispatcher));
    tried("watch", &format!("{key}/*/*/*/*"), |key| {
        session
            .liveliness()
            .declare_subscriber(key)
            .history(true)
            .callback(move |sample| {
                let Some(other) = Other::of(sample.key_expr().as_str()) else {
                    return;
                };
                if other.session == me {
                    return;
                }
                let comes = sample.kind() == SampleKind::Put;
                let Other {
                    session,
                    since,
                    workers,
                    ..
                } = other;
                let fits = other.map_id == map_id;
                match (comes, fits) {
                    (true, true) => dispatcher.team().join(session, since, workers),
                    (false, _) => dispatcher.leave(session),
                    // It has another map of the same name and answers its own clients.
                    (true, false) => {}
                }
                tracing::info!(
                    session,
                    workers,
                    comes,
                    fits,
                    "another server has the same map name"
                );
                waker.wake();
            })
            .wait()
    })
}

fn tried<T>(
    action: &'static str,
    key: &str,
    attempt: impl FnOnce(String) -> ZenohResult<T>,
) -> Result<T, LocateError> {
    Ok(attempt(key.to_owned()).map_err(KeyError::when(action, key))?)
}

#[derive(Debug, PartialEq, Eq)]
struct Other<'a> {
    session: &'a str,
    map_id: u64,
    since: u64,
    workers: usize,
}

impl<'a> Other<'a> {
    fn of(key: &'a str) -> Option<Self> {
        let mut parts = key.rsplit('/');
        let workers = parts.next()?.parse().ok()?;
        let since = u64::from_str_radix(parts.next()?, 16).ok()?;
        let map_id = u64::from_str_radix(parts.next()?, 16).ok()?;
        Some(Other {
            session: parts.next()?,
            map_id,
            since,
            workers,
        })
        .filter(|other| (1..=256).contains(&other.workers))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_show_map_and_workers() {
        let expected = Other {
            session: "a1",
            map_id: 0xff,
            since: 0x1f,
            workers: 4,
        };
        let key = "backcast/locate/office/a1/00000000000000ff/1f/4";
        assert_eq!(Other::of(key), Some(expected));
        for key in ", a1, x/a1/ff/1/0, x/a1/ff/1/257, x/a1/xx/1/1, x/a1/ff/1/-1".split(", ") {
            assert_eq!(Other::of(key), None, "{key}");
        }
    }
}
