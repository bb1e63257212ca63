//! A prepared map that any number of Python's threads may ask at once, and Ctrl-C while it
//! is asked.

use std::cell::{Cell, RefCell};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use engine::localizer::Prior;
use engine::locator::{Located, Locator, LocatorConfig, Workspace};
use engine::observation::Observation;
use pyo3::prelude::*;

use crate::error::of_engine;
use crate::map::Map;
use crate::settings::EngineSettings;

/// Python is asked as often whether somebody wants to stop.
const SIGNALS_EVERY: Duration = Duration::from_millis(100);

/// A prepared map, and what searches of it keep from scan to scan.
#[derive(Debug)]
pub(crate) struct Search {
    locator: Locator,
    /// Of searches that have ended; there are as many as have run at once.
    workspaces: Mutex<Vec<Workspace>>,
}

impl Search {
    /// Prepares a map.
    pub(crate) fn prepare(map: &Map, settings: EngineSettings, prior: Prior) -> PyResult<Self> {
        let EngineSettings {
            cells,
            localizer,
            peaks,
        } = settings;
        let config = LocatorConfig { localizer, peaks };
        let locator = Locator::new(map.view(cells), config, prior);
        Ok(Search {
            locator: locator.map_err(|error| of_engine(&error))?,
            workspaces: Mutex::new(Vec::new()),
        })
    }

    pub(crate) fn locator(&self) -> &Locator {
        &self.locator
    }

    /// Searches, at a heading in the map where the map was prepared for that, and reads
    /// what was found. Python's lock must not be held.
    pub(crate) fn locate<T>(
        &self,
        seen: Observation<'_>,
        heading: Option<f64>,
        read: impl FnOnce(Located<'_>) -> T,
    ) -> PyResult<T> {
        let mut workspace = self.lock().pop().unwrap_or_default();
        let signals = Signals::default();
        let stop = || signals.ask();
        let found = self
            .locator
            .locate_unless(&mut workspace, seen, heading, &stop);
        let read = match (found, signals.said.take()) {
            (_, Some(interrupt)) => Err(interrupt),
            (Err(error), None) => Err(of_engine(&error)),
            (Ok(Some(found)), None) => Ok(read(found)),
            (Ok(None), None) => Err(crate::error::value("the search was stopped")),
        };
        self.lock().push(workspace);
        read
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<Workspace>> {
        let workspaces = self.workspaces.lock();
        // Nothing that can panic runs while it is locked.
        workspaces.unwrap_or_else(PoisonError::into_inner)
    }
}

/// Whether Python's handlers of signals want to stop: by default that of Ctrl-C does.
struct Signals {
    asked: Cell<Instant>,
    said: RefCell<Option<PyErr>>,
}

impl Default for Signals {
    fn default() -> Self {
        Signals {
            asked: Cell::new(Instant::now()),
            said: RefCell::new(None),
        }
    }
}

impl Signals {
    fn ask(&self) -> bool {
        if self.asked.get().elapsed() >= SIGNALS_EVERY {
            let signals = |py: Python<'_>| py.check_signals();
            let said = Python::attach(signals).err();
            self.asked.set(Instant::now());
            if said.is_some() {
                self.said.replace(said);
            }
        }
        self.said.borrow().is_some()
    }
}
