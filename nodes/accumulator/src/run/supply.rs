//! Maps and boundaries on their way to localizers.

use std::error::Error;
use std::time::Instant;

use engine::limits::Region;
use engine::localizer::{LocalizerConfig, Prior};
use index_cache::{CachePlace, IndexCache, Kept};
use messages::{Corner, NodeState, topic};
use transport::{Health, Sample, Subscriber, TransportError, with_causes};

use super::inputs::Inputs;
use crate::background::Background;
use crate::preparation::{Job, Key, PreparedMap};
use crate::{AccumulatorError, Config};

/// What has come, what is wanted of it, and what is being prepared: one
/// localizer at a time, always for what came last.
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
    /// To be prepared, once nothing else is.
    wanted: Option<Order>,
    under_way: Option<UnderWay>,
    /// Of the map that was handed out last.
    handed_out: Option<Order>,
}

/// What to prepare, and the number of the request for a region that it is to heed.
type Order = (Key, u64);

struct UnderWay {
    order: Order,
    since: Instant,
    work: Background<Result<(PreparedMap, Kept), AccumulatorError>>,
}

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
            wanted: None,
            under_way: None,
            handed_out: None,
        }
    }

    /// Takes what has come and starts or ends a preparation; returns a new
    /// localizer as soon as there is one.
    ///
    /// # Errors
    /// If the graph or a preparing thread fails. A map or a boundary that is
    /// refused is reported in `health`.
    pub(super) fn poll(
        &mut self,
        inputs: &Inputs,
        health: &mut Health,
    ) -> Result<Option<PreparedMap>, AccumulatorError> {
        let region_changed = self.on_region(&inputs.regions, health)?;
        if self.receive(&inputs.maps, &inputs.boundaries, health)? || region_changed {
            self.consider(health)?;
        }
        let prepared = self.finish(health)?;
        self.start(health)?;
        Ok(prepared)
    }

    fn receive(
        &mut self,
        maps: &Subscriber<topic::Map>,
        boundaries: &Subscriber<topic::Boundary>,
        health: &mut Health,
    ) -> Result<bool, TransportError> {
        let (map, boundary) = (maps.newest()?, boundaries.newest()?);
        let came = u64::from(map.is_some()) + u64::from(boundary.is_some());
        health.count_received(came);
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
        if let (Some(map), Some(boundary)) = (&self.map, &self.boundary) {
            match Key::of(map.header(), (boundary.header(), boundary.items())) {
                Ok(key) => self.wanted = key.map(|key| (key, self.requests)),
                Err(error) => refuse(map.header().map_id, &error, health)?,
            }
        }
        Ok(())
    }

    fn finish(&mut self, health: &mut Health) -> Result<Option<PreparedMap>, AccumulatorError> {
        let Some(UnderWay { order, since, work }) = self
            .under_way
            .take_if(|under_way| under_way.work.is_finished())
        else {
            return Ok(None);
        };
        let map_id = order.0.map_id;
        let outcome = work
            .finish()
            .map_err(|reason| AccumulatorError::PreparationDied { map_id, reason })?;
        let (prepared, kept) = match outcome {
            Ok(prepared) => prepared,
            Err(error) => {
                refuse(map_id, &error, health)?;
                return Ok(None);
            }
        };
        let grid = prepared.localizer.grid();
        tracing::info!(
            map = format_args!("{map_id:016x}"),
            width = grid.width(),
            height = grid.height(),
            seconds = since.elapsed().as_secs_f64(),
            from_file = kept.is_read,
            "map prepared"
        );
        keep(kept);
        self.handed_out = Some(order);
        health.state(NodeState::Ready)?;
        Ok(Some(prepared))
    }

    fn start(&mut self, health: &mut Health) -> Result<(), AccumulatorError> {
        let (None, Some(map), Some(boundary)) = (&self.under_way, &self.map, &self.boundary) else {
            return Ok(());
        };
        let Some(order) = self.wanted.take() else {
            return Ok(());
        };
        if self.handed_out == Some(order) {
            // Served again, or taken back after another one was refused.
            return Ok(health.state(NodeState::Ready)?);
        }
        let job = Job::new(
            map.header(),
            map.items(),
            boundary.header(),
            boundary.items(),
        );
        let job = match job {
            Ok(job) => job,
            Err(error) => return Ok(refuse(order.0.map_id, &error, health)?),
        };
        if self.handed_out.is_none() {
            // Scans are not answered before; with another map, they are meanwhile.
            health.state(NodeState::Busy)?;
        }
        let (config, prior, cache) = (self.config.clone(), self.prior, self.cache.clone());
        let prepare = move || job.prepare(config, prior, cache.as_ref());
        let work = Background::start("prepare map", prepare);
        self.under_way = Some(UnderWay {
            order,
            since: Instant::now(),
            work: work.map_err(|source| AccumulatorError::Thread {
                map_id: order.0.map_id,
                source,
            })?,
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
