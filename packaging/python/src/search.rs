//! Maps prepared without Python's lock, and searches that any number of Python's threads may make at
//! once, until Ctrl-C.

use std::cell::Cell;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use engine::EngineError;
use engine::localizer::{Answer, Localizer, PreparedMap, Settings, Workspace};
use engine::observation::Observation;
use engine::vote_search::Prior;
use index_cache::CachePlace;
use pyo3::prelude::*;

use crate::error::{SIGNALS_EVERY, check_signals, interruptible, of_cache, of_engine};
use crate::map::Map;
use crate::settings::EngineSettings;

/// Prepares a map without Python's lock; an exception of a signal's handler is raised at once.
pub(crate) fn prepare(
    py: Python<'_>,
    map: &Map,
    settings: EngineSettings,
    prior: Prior,
) -> PyResult<Localizer> {
    let map = map.shared();
    interruptible(py, move || prepared(&map, settings, prior))
}

fn prepared(map: &Map, settings: EngineSettings, prior: Prior) -> PyResult<Localizer> {
    let EngineSettings {
        cells,
        vote_search,
        peaks,
        index_cache,
    } = settings;
    let cache = index_cache
        .open(CachePlace::Off)
        .map_err(|error| of_cache(&error))?;
    let settings = Settings {
        vote_search,
        peaks,
        prior,
    };
    let prepared = index_cache::prepared_map(cache.as_ref(), map.view(cells), settings);
    let (prepared, kept) = prepared.map_err(of_engine)?;
    if let Some(unsaved) = kept.unsaved {
        unsaved.save().map_err(|error| of_cache(&error))?;
    }
    Localizer::of_maps(vec![prepared]).map_err(of_engine)
}

/// Runs a search until Python's signal handlers want to stop it. Python's lock must not be held.
pub(crate) fn until_signal<T>(
    run: impl FnOnce(&dyn Fn() -> bool) -> Result<Option<T>, EngineError>,
) -> PyResult<T> {
    let (asked, said) = (Cell::new(Instant::now()), Cell::new(None));
    let found = run(&|| {
        let mut interrupt = said.take();
        if asked.get().elapsed() >= SIGNALS_EVERY {
            interrupt = check_signals().err().or(interrupt);
            asked.set(Instant::now());
        }
        let is_over = interrupt.is_some();
        said.set(interrupt);
        is_over
    });
    match (found, said.take()) {
        (_, Some(interrupt)) => Err(interrupt),
        (Err(error), None) => Err(of_engine(error)),
        (Ok(Some(found)), None) => Ok(found),
        (Ok(None), None) => Err(crate::error::value("the search was stopped")),
    }
}

/// A prepared map, and the workspaces that its searches reuse.
#[derive(Debug)]
pub(crate) struct Search {
    localizer: Localizer,
    /// Workspaces of searches that have ended: as many as have run at once.
    workspaces: Mutex<Vec<Workspace>>,
}

impl Search {
    pub(crate) fn new(localizer: Localizer) -> Self {
        Search {
            localizer,
            workspaces: Mutex::new(Vec::new()),
        }
    }

    pub(crate) fn map(&self) -> &PreparedMap {
        &self.localizer.maps()[0]
    }

    /// Searches the map, at `heading` if it was prepared for known headings, and passes the result
    /// to `read`. Python's lock must not be held.
    pub(crate) fn locate<T>(
        &self,
        seen: Observation<'_>,
        heading: Option<f64>,
        read: impl FnOnce(Answer<'_>) -> T,
    ) -> PyResult<T> {
        let mut workspace = self.lock().pop().unwrap_or_default();
        let read = until_signal(|stop| {
            let localizer = &self.localizer;
            let found = localizer.locate_unless(&mut workspace, seen, heading, stop)?;
            Ok(found.map(read))
        });
        self.lock().push(workspace);
        read
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<Workspace>> {
        let workspaces = self.workspaces.lock();
        // Nothing that can panic runs while it is locked.
        workspaces.unwrap_or_else(PoisonError::into_inner)
    }
}
