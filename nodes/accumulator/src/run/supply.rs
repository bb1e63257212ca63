//! Maps and boundaries on their way to localizers.

use std::time::Instant;

use engine::localizer::{LocalizerConfig, Prior};
use messages::{NodeState, topic};
use transport::{Health, Sample, Subscriber, TransportError, with_causes};

use crate::AccumulatorError;
use crate::background::Background;
use crate::preparation::{Job, Key, PreparedMap};

/// What has come, what is wanted of it, and what is being prepared: one
/// localizer at a time, always for what came last.
pub(super) struct Supply {
    config: LocalizerConfig,
    prior: Prior,
    map: Option<Sample<topic::Map>>,
    boundary: Option<Sample<topic::Boundary>>,
    /// To be prepared, once nothing else is.
    wanted: Option<Key>,
    under_way: Option<UnderWay>,
    /// Of the map that was handed out last.
    handed_out: Option<Key>,
}

struct UnderWay {
    key: Key,
    since: Instant,
    work: Background<Result<PreparedMap, AccumulatorError>>,
}

impl Supply {
    pub(super) fn new(config: LocalizerConfig, prior: Prior) -> Self {
        Supply {
            config,
            prior,
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
        maps: &Subscriber<topic::Map>,
        boundaries: &Subscriber<topic::Boundary>,
        health: &mut Health,
    ) -> Result<Option<PreparedMap>, AccumulatorError> {
        if self.receive(maps, boundaries, health)? {
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
        self.map = map.or(self.map.take());
        self.boundary = boundary.or(self.boundary.take());
        Ok(came > 0)
    }

    /// Decides what there is to prepare. Samples that came last replace what was
    /// wanted before them.
    fn consider(&mut self, health: &mut Health) -> Result<(), TransportError> {
        self.wanted = None;
        if let (Some(map), Some(boundary)) = (&self.map, &self.boundary) {
            match Key::of(map.header(), boundary.header()) {
                Ok(key) => self.wanted = key,
                Err(error) => refuse(map.header().map_id, &error, health)?,
            }
        }
        Ok(())
    }

    fn finish(&mut self, health: &mut Health) -> Result<Option<PreparedMap>, AccumulatorError> {
        let Some(UnderWay { key, since, work }) = self
            .under_way
            .take_if(|under_way| under_way.work.is_finished())
        else {
            return Ok(None);
        };
        let map_id = key.map_id;
        let outcome = work
            .finish()
            .map_err(|reason| AccumulatorError::PreparationDied { map_id, reason })?;
        let prepared = match outcome {
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
            "map prepared"
        );
        self.handed_out = Some(key);
        health.state(NodeState::Ready)?;
        Ok(Some(prepared))
    }

    fn start(&mut self, health: &mut Health) -> Result<(), AccumulatorError> {
        let (None, Some(map), Some(boundary)) = (&self.under_way, &self.map, &self.boundary) else {
            return Ok(());
        };
        let Some(key) = self.wanted.take() else {
            return Ok(());
        };
        if self.handed_out == Some(key) {
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
            Err(error) => return Ok(refuse(key.map_id, &error, health)?),
        };
        let (config, prior) = (self.config.clone(), self.prior);
        let work = Background::start("prepare map", move || job.prepare(config, prior));
        self.under_way = Some(UnderWay {
            key,
            since: Instant::now(),
            work: work.map_err(|source| AccumulatorError::Thread {
                map_id: key.map_id,
                source,
            })?,
        });
        Ok(())
    }
}

/// Scans are answered as before.
fn refuse(
    map_id: u64,
    error: &AccumulatorError,
    health: &mut Health,
) -> Result<(), TransportError> {
    let problem = format!("map {map_id:016x} is refused: {}", with_causes(error));
    tracing::warn!("{problem}");
    health.count_refused(1);
    health.error(&problem)?;
    health.state(NodeState::Degraded)
}
