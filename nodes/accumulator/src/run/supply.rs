//! Maps and boundaries on their way to localizers.

use std::error::Error;
use std::time::Instant;

use engine::limits::Region;
use engine::localizer::{LocalizerConfig, Prior};
use index_cache::{CachePlace, IndexCache, Kept};
use messages::{Corner, MapSet, NodeState, topic};
use transport::{Health, Sample, Subscriber, TransportError, with_causes};

use super::inputs::Inputs;
use crate::background::Background;
use crate::preparation::{Job, Key, PreparedMap};
use crate::{AccumulatorError, Config};

/// What has come, what is wanted of it, and what is being prepared: one map, or all maps of a
/// set, at a time, always for what came last.
pub(super) struct Supply {
    config: LocalizerConfig,
    /// Where poses are searched unless somebody requests otherwise.
    configured: Option<Region>,
    /// Counts the regions that were region_changed for.
    requests: u64,
    prior: Prior,
    /// Where prepared maps are kept.
    cache: Option<IndexCache>,
    map: Option<Sample<topic::Map>>,
    boundary: Option<Sample<topic::Boundary>>,
    /// Where there is one, it is searched, and the map above is that of it which is shown.
    set: Option<Sample<topic::Maps>>,
    /// To be prepared, once nothing else is.
    wanted: Option<Order>,
    under_way: Option<UnderWay>,
    /// Of the map that was handed out last.
    handed_out: Option<Order>,
}

/// What to prepare, and the number of the request for a region that it is to heed.
type Order = (Vec<Key>, u64);

struct UnderWay {
    order: Order,
    since: Instant,
    work: Background<Prepared>,
}

/// All maps that were ordered, or the id of the one that cannot be used.
type Prepared = Result<Vec<(PreparedMap, Kept)>, (u64, AccumulatorError)>;

impl Supply {
    pub(super) fn new(config: &Config) -> Self {
        let cache = config.index_cache.open(CachePlace::User);
        let cache = cache.unwrap_or_else(|problem| {
            tracing::warn!("prepared maps are not cached: {}", with_causes(&problem));
            None
        });
        Supply {
            configured: config.localizer.limits.region.clone(),
            requests: 0,
            config: config.localizer(),
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

    /// Takes what has come and starts or ends a preparation; returns what is to be searched
    /// from now on as soon as it is prepared.
    ///
    /// # Errors
    /// If the graph or a preparing thread fails. A map or a boundary that is
    /// refused is reported in `health`.
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
            match MapSet::read(set.header(), set.items()) {
                Ok(_) => self.set = Some(set),
                Err(error) => refuse(0, &error.into(), health)?,
            }
        }
        if self.set.is_some() || inputs.sets.has_publishers() {
            // The map that is shown is one of those, or will be.
            return Ok(came > 0);
        }
        match map.as_ref().map(|map| map.header().check_id(map.items())) {
            Some(Err(error)) => {
                let map_id = error.found;
                refuse(map_id, &error.into(), health)?;
            }
            Some(Ok(())) => self.map = map,
            None => {}
        }
        self.boundary = boundary.or(self.boundary.take());
        Ok(came > 0)
    }

    /// Takes a request for a region: none is for what is configured. One that cannot
    /// be used is refused, and the one before holds.
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
                self.requests += u64::from(is_new);
                Ok(is_new)
            }
            Err(problem) => {
                tracing::warn!("search region rejected: {problem}");
                health.count_refused(1);
                health.error(&format!("search region rejected: {problem}"))?;
                Ok(false)
            }
        }
    }

    /// Decides what there is to prepare. Samples that came last replace what was
    /// wanted before them.
    fn consider(&mut self, health: &mut Health) -> Result<(), TransportError> {
        self.wanted = None;
        match self.keys() {
            Ok(keys) => self.wanted = keys.map(|keys| (keys, self.requests)),
            Err((map_id, error)) => refuse(map_id, &error, health)?,
        }
        Ok(())
    }

    fn keys(&self) -> Result<Option<Vec<Key>>, (u64, AccumulatorError)> {
        if let Some(set) = &self.set {
            let set = MapSet::read(set.header(), set.items()).map_err(|e| (0, e.into()))?;
            let keys = set
                .maps
                .iter()
                .map(|(map, _)| Key::in_set(map).map_err(|error| (map.map_id, error)));
            return keys.collect::<Result<_, _>>().map(Some);
        }
        let (Some(map), Some(boundary)) = (&self.map, &self.boundary) else {
            return Ok(None);
        };
        let key = Key::of(map.header(), (boundary.header(), boundary.items()));
        let key = key.map_err(|error| (map.header().map_id, error))?;
        Ok(key.map(|key| vec![key]))
    }

    /// What to do for what is wanted.
    fn jobs(&self) -> Result<Vec<Job>, (u64, AccumulatorError)> {
        if let Some(set) = &self.set {
            let set = MapSet::read(set.header(), set.items()).map_err(|e| (0, e.into()))?;
            let jobs = set
                .maps
                .iter()
                .map(|(map, cells)| Job::in_set(map, cells).map_err(|error| (map.map_id, error)));
            return jobs.collect();
        }
        let (Some(map), Some(boundary)) = (&self.map, &self.boundary) else {
            return Ok(Vec::new());
        };
        let (boundary, cells) = (boundary.header(), boundary.items());
        let job = Job::new(map.header(), map.items(), boundary, cells);
        Ok(vec![job.map_err(|error| (map.header().map_id, error))?])
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
        let map_id = order.0.first().map_or(0, |key| key.map_id);
        let outcome = work
            .finish()
            .map_err(|reason| AccumulatorError::PreparationDied { map_id, reason })?;
        let all = match outcome {
            Ok(all) => all,
            Err((map_id, error)) => {
                refuse(map_id, &error, health)?;
                return Ok(None);
            }
        };
        let mut maps = Vec::with_capacity(all.len());
        for (prepared, kept) in all {
            let grid = prepared.localizer.grid();
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

    fn start(&mut self, health: &mut Health) -> Result<(), AccumulatorError> {
        if self.under_way.is_some() {
            return Ok(());
        }
        let Some(order) = self.wanted.take() else {
            return Ok(());
        };
        if self.handed_out.as_ref() == Some(&order) {
            // Served again, or taken back after another one was refused.
            return Ok(health.state(NodeState::Ready)?);
        }
        let jobs = match self.jobs() {
            Ok(jobs) => jobs,
            Err((map_id, error)) => return Ok(refuse(map_id, &error, health)?),
        };
        if self.handed_out.is_none() {
            // Scans are not answered before; with another map, they are meanwhile.
            health.state(NodeState::Busy)?;
        }
        let (config, prior, cache) = (self.config.clone(), self.prior, self.cache.clone());
        let prepare = move || {
            let prepared = jobs.into_iter().map(|job| {
                let map_id = job.map_id();
                let prepared = job.prepare(config.clone(), prior, cache.as_ref());
                prepared.map_err(|error| (map_id, error))
            });
            prepared.collect()
        };
        let work = Background::start("prepare map", prepare);
        let map_id = order.0.first().map_or(0, |key| key.map_id);
        self.under_way = Some(UnderWay {
            order,
            since: Instant::now(),
            work: work.map_err(|source| AccumulatorError::Thread { map_id, source })?,
        });
        Ok(())
    }
}

/// The region with these corners; none is everywhere.
fn region(corners: &[Corner]) -> Result<Option<Region>, String> {
    let corners: Vec<[f64; 2]> = corners.iter().map(|&Corner { x, y }| [x, y]).collect();
    if corners.is_empty() {
        return Ok(None);
    }
    Region::new(&corners).map(Some)
}

/// Reports on the file of an index, and writes one that is to be written, beside the scans
/// that are answered meanwhile. Nobody waits for that.
fn keep(kept: Kept) {
    let warn = |problem: &dyn Error| tracing::warn!("cached index: {}", with_causes(problem));
    if let Some(problem) = kept.problem {
        warn(&problem);
    }
    let Some(unsaved) = kept.unsaved else { return };
    let save = move || unsaved.save().unwrap_or_else(|problem| warn(&problem));
    if let Err(problem) = Background::start("keep index", save) {
        warn(&problem);
    }
}

/// Scans are answered as before.
fn refuse(
    map_id: u64,
    error: &AccumulatorError,
    health: &mut Health,
) -> Result<(), TransportError> {
    let problem = format!("map {map_id:016x} rejected: {}", with_causes(error));
    tracing::warn!("{problem}");
    health.count_refused(1);
    health.error(&problem)?;
    health.state(NodeState::Degraded)
}
