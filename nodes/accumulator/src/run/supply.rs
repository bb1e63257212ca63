//! Preparation of localizers from received maps and boundaries.

use std::any::Any;
use std::error::Error;
use std::thread::{self, JoinHandle};
use std::time::Instant;

use engine::limits::Region;
use engine::space;
use engine::vote_search::{Prior, VoteSearchConfig};
use index_cache::{CachePlace, IndexCache, Kept};
use messages::{Corner, InvalidMapSet, MapSet, MapsHeader, NodeState, topic};
use transport::{Health, Sample, Subscriber, TransportError, with_causes};

use super::inputs::Inputs;
use crate::preparation::{Job, Key, PreparedMap, Received};
use crate::subject::{Refused, Subject};
use crate::{AccumulatorError, Config};

/// Received maps and the state of their preparation, one at a time for the newest input.
pub(super) struct Supply {
    config: VoteSearchConfig,
    configured: Option<Region>,
    prior: Prior,
    cache: Option<IndexCache>,
    map: Option<Sample<topic::Map>>,
    boundary: Option<Sample<topic::Boundary>>,
    /// Set of maps, which takes precedence; `map` is then the one of its maps that is displayed.
    set: Option<Sample<topic::Maps>>,
    wanted: Option<Order>,
    under_way: Option<UnderWay>,
    /// Order of the maps returned last.
    handed_out: Option<Order>,
}

#[derive(Debug, Clone, PartialEq)]
struct Order {
    keys: Vec<Key>,
    region: Option<Region>,
}

struct UnderWay {
    order: Order,
    since: Instant,
    work: JoinHandle<Prepared>,
}

/// All ordered maps with allowed poses, or the map that cannot be used.
type Prepared = Result<Vec<(PreparedMap, Kept)>, Refused>;

impl Supply {
    pub(super) fn new(config: &Config) -> Self {
        let cache = config.index_cache.open(CachePlace::User);
        let cache = cache.unwrap_or_else(|problem| {
            tracing::warn!("prepared maps are not cached: {}", with_causes(&problem));
            None
        });
        Supply {
            configured: config.vote_search.limits.region.clone(),
            config: config.vote_search(),
            prior: config.prior(),
            cache,
            map: None,
            boundary: None,
            set: None,
            wanted: None,
            under_way: None,
            handed_out: None,
        }
    }

    /// Processes new inputs and prepares maps; returns those to search from now on.
    pub(super) fn poll(
        &mut self,
        inputs: &Inputs,
        health: &mut Health,
    ) -> Result<Option<Vec<PreparedMap>>, AccumulatorError> {
        let region_changed = self.on_region(&inputs.regions, health)?;
        if self.receive(inputs, health)? || region_changed {
            self.consider(health)?;
        }
        let prepared = self.finish(health)?;
        self.start(health)?;
        Ok(prepared)
    }

    fn receive(&mut self, inputs: &Inputs, health: &mut Health) -> Result<bool, TransportError> {
        let (map, boundary) = (inputs.maps.newest()?, inputs.boundaries.newest()?);
        let set = inputs.sets.newest()?;
        let came = [map.is_some(), boundary.is_some(), set.is_some()];
        let came = came.into_iter().map(u64::from).sum();
        health.count_received(came);
        if let Some(set) = set {
            let keys = maps_of(&set, MapSet::read).and_then(|maps| keys_of(&maps));
            match keys {
                Ok(_) => self.set = Some(set),
                Err(refused) => refuse(&refused, health)?,
            }
        }
        self.boundary = boundary.or(self.boundary.take());
        // While a publisher sends sets, this is the map of the set that is displayed.
        if let Some(map) = map.filter(|_| !inputs.sets.has_publishers()) {
            match map.header().check_id(map.items()) {
                Ok(()) => {
                    self.map = Some(map);
                    self.set = None;
                }
                Err(error) => refuse(&Subject::map(map.header()).refused(error), health)?,
            }
        }
        Ok(came > 0)
    }

    /// Applies a requested search region; empty restores the configured one, invalid is refused.
    fn on_region(
        &mut self,
        regions: &Subscriber<topic::Region>,
        health: &mut Health,
    ) -> Result<bool, TransportError> {
        let Some(request) = regions.newest()? else {
            return Ok(false);
        };
        health.count_received(1);
        match region(request.items()) {
            Ok(region) => {
                let region = region.or_else(|| self.configured.clone());
                let is_new = region != self.config.limits.region;
                self.config.limits.region = region;
                Ok(is_new)
            }
            Err(problem) => {
                refuse_region(&problem, health)?;
                Ok(false)
            }
        }
    }

    /// Determines what to prepare; newer inputs replace an older order.
    fn consider(&mut self, health: &mut Health) -> Result<(), TransportError> {
        self.wanted = None;
        match self.received().and_then(|maps| keys_of(&maps)) {
            Ok(keys) => {
                let keys = keys.filter(|keys| !keys.is_empty());
                let region = self.config.limits.region.clone();
                self.wanted = keys.map(|keys| Order { keys, region });
            }
            Err(refused) => refuse(&refused, health)?,
        }
        Ok(())
    }

    /// Returns the maps to search: those of the set, or else the map and its boundary once both
    /// have come.
    fn received(&self) -> Result<Vec<Received<'_>>, Refused> {
        if let Some(set) = &self.set {
            return maps_of(set, MapSet::split);
        }
        let both = self.map.iter().zip(&self.boundary);
        let received = both.map(|(map, boundary)| Received {
            map: *map.header(),
            occupancy: map.items(),
            boundary: Some((boundary.header(), boundary.items())),
        });
        Ok(received.collect())
    }

    fn jobs(&self) -> Result<Vec<Job>, Refused> {
        let maps = self.received()?;
        let reach_m = match self.set {
            Some(_) => space::reach_m(maps.iter().map(|received| &received.map)),
            None => 0.0,
        };
        maps.iter().map(|received| received.job(reach_m)).collect()
    }

    fn finish(
        &mut self,
        health: &mut Health,
    ) -> Result<Option<Vec<PreparedMap>>, AccumulatorError> {
        let Some(UnderWay { order, since, work }) = self
            .under_way
            .take_if(|under_way| under_way.work.is_finished())
        else {
            return Ok(None);
        };
        let map_id = order.keys.first().map_or(0, |key| key.map_id);
        let outcome = work
            .join()
            .map_err(|panic| AccumulatorError::PreparationDied {
                map_id,
                reason: words_of(&*panic),
            })?;
        let all = match outcome {
            Ok(all) => all,
            Err(refused) => {
                self.refuse_order(&order, &refused, health)?;
                return Ok(None);
            }
        };
        let mut maps = Vec::with_capacity(all.len());
        for (prepared, kept) in all {
            let grid = prepared.vote_search.grid();
            tracing::info!(
                map = format_args!("{:016x}", prepared.map_id),
                width = grid.width(),
                height = grid.height(),
                seconds = since.elapsed().as_secs_f64(),
                from_file = kept.is_read,
                "map prepared"
            );
            keep(kept);
            maps.push(prepared);
        }
        self.handed_out = Some(order);
        health.state(NodeState::Ready)?;
        Ok(Some(maps))
    }

    /// Refuses the region, not the maps, if it leaves no pose of maps searched before.
    fn refuse_order(
        &mut self,
        order: &Order,
        refused: &Refused,
        health: &mut Health,
    ) -> Result<(), TransportError> {
        let before = match &self.handed_out {
            Some(order) => &order.region,
            None => &self.configured,
        };
        if !refused.1.leaves_no_pose() || order.region == *before {
            return refuse(refused, health);
        }
        refuse_region(&with_causes(&*refused.1), health)?;
        if self.config.limits.region == order.region {
            self.config.limits.region = before.clone();
            self.consider(health)?;
        }
        Ok(())
    }

    fn start(&mut self, health: &mut Health) -> Result<(), AccumulatorError> {
        if self.under_way.is_some() {
            return Ok(());
        }
        let Some(order) = self.wanted.take() else {
            return Ok(());
        };
        if self.handed_out.as_ref() == Some(&order) {
            // The same map was sent again, or restored after another one was refused.
            return Ok(health.state(NodeState::Ready)?);
        }
        let jobs = match self.jobs() {
            Ok(jobs) => jobs,
            Err(refused) => return Ok(refuse(&refused, health)?),
        };
        if self.handed_out.is_none() {
            // Before the first map, scans are refused; later, the previous map answers them.
            health.state(NodeState::Busy)?;
        }
        let (config, prior, cache) = (self.config.clone(), self.prior, self.cache.clone());
        let prepare = move || prepare(jobs, &config, prior, cache.as_ref());
        let work = thread::Builder::new()
            .name("prepare map".into())
            .spawn(prepare);
        let map_id = order.keys.first().map_or(0, |key| key.map_id);
        self.under_way = Some(UnderWay {
            order,
            since: Instant::now(),
            work: work.map_err(|source| AccumulatorError::Thread { map_id, source })?,
        });
        Ok(())
    }
}

/// Returns the maps of a set, which `read` takes apart.
fn maps_of<'s>(
    set: &'s Sample<topic::Maps>,
    read: fn(&MapsHeader, &'s [u8]) -> Result<MapSet<'s>, InvalidMapSet>,
) -> Result<Vec<Received<'s>>, Refused> {
    let header = set.header();
    let set = read(header, set.items());
    let set = set.map_err(|error| Subject::Set(header.set_id).refused(error))?;
    let received = set.maps.into_iter().map(|(map, occupancy)| Received {
        map,
        occupancy,
        boundary: None,
    });
    Ok(received.collect())
}

/// Returns the keys of the maps; `None` if a boundary belongs to another map.
fn keys_of(maps: &[Received<'_>]) -> Result<Option<Vec<Key>>, Refused> {
    let keys: Vec<Option<Key>> = maps.iter().map(Received::key).collect::<Result<_, _>>()?;
    Ok(keys.into_iter().collect())
}

/// Returns the region with these corners; `None` (everywhere) for no corners.
fn region(corners: &[Corner]) -> Result<Option<Region>, String> {
    let corners: Vec<[f64; 2]> = corners.iter().map(|&Corner { x, y }| [x, y]).collect();
    if corners.is_empty() {
        return Ok(None);
    }
    Region::new(&corners).map(Some)
}

fn words_of(panic: &(dyn Any + Send)) -> String {
    let literal = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let words = literal.or_else(|| panic.downcast_ref::<String>().cloned());
    words.unwrap_or_else(|| "it panicked without a message".into())
}

/// Reports problems with a cached index and saves a new one on another thread.
fn keep(kept: Kept) {
    let warn = |problem: &dyn Error| tracing::warn!("cached index: {}", with_causes(problem));
    if let Some(problem) = kept.problem {
        warn(&problem);
    }
    let Some(unsaved) = kept.unsaved else { return };
    let save = move || unsaved.save().unwrap_or_else(|problem| warn(&problem));
    if let Err(problem) = thread::Builder::new().name("keep index".into()).spawn(save) {
        warn(&problem);
    }
}

/// Prepares maps, leaving out those of a set in which no pose is allowed.
fn prepare(
    jobs: Vec<Job>,
    config: &VoteSearchConfig,
    prior: Prior,
    cache: Option<&IndexCache>,
) -> Prepared {
    let mut all = Vec::with_capacity(jobs.len());
    let mut left_out = None;
    for job in jobs {
        let subject = job.subject();
        match job.prepare(config.clone(), prior, cache) {
            Ok(prepared) => all.push(prepared),
            Err(error) if error.leaves_no_pose() => {
                tracing::info!("{subject} is not searched: {error}");
                left_out = Some(subject.refused(error));
            }
            Err(error) => return Err(subject.refused(error)),
        }
    }
    match left_out {
        Some(refused) if all.is_empty() => Err(refused),
        _ => Ok(all),
    }
}

/// Reports a refused region; the previous one stays in force.
fn refuse_region(problem: &str, health: &mut Health) -> Result<(), TransportError> {
    let problem = format!("search region rejected: {problem}");
    tracing::warn!("{problem}");
    health.count_refused(1);
    health.error(&problem)
}

/// Reports a refused map or set; scans are answered with the previous one.
fn refuse((subject, error): &Refused, health: &mut Health) -> Result<(), TransportError> {
    let problem = format!("{subject} rejected: {}", with_causes(&**error));
    tracing::warn!("{problem}");
    health.count_refused(1);
    health.error(&problem)?;
    health.state(NodeState::Degraded)
}
