//! Selects the map for a scan: the newest one recorded before it, as in the graph, or the first one
//! after it if there is none before. [`map_in`] returns the newest map.

use std::borrow::Cow;
use std::iter::Peekable;

use anyhow::anyhow;
use map::OccupancyGrid;
use recording::{Recording, RecordingError};
use ros::OccupancyGridMsg;
use transport::with_causes;

/// A recorded map with its log time.
type Recorded = Result<(i64, OccupancyGridMsg), RecordingError>;

/// Maps of a recording by log time, or one map for all scans.
pub(super) struct Maps<'a> {
    given: Option<&'a OccupancyGrid>,
    recorded: Peekable<Box<dyn Iterator<Item = Recorded> + 'a>>,
    /// True once a map has been returned.
    began: bool,
}

impl<'a> Maps<'a> {
    /// Uses the given map for all scans, and ignores recorded ones.
    pub(super) fn given(map: &'a OccupancyGrid) -> Self {
        Maps {
            given: Some(map),
            recorded: Maps::of(std::iter::empty()),
            began: false,
        }
    }

    /// Contains no map, since the map has already been prepared.
    pub(super) fn none() -> Self {
        Maps {
            given: None,
            recorded: Maps::of(std::iter::empty()),
            began: true,
        }
    }

    pub(super) fn recorded(recording: &'a Recording) -> Result<Self, RecordingError> {
        Ok(Maps {
            given: None,
            recorded: Maps::of(recording.maps()?),
            began: false,
        })
    }

    fn of(
        maps: impl Iterator<Item = Recorded> + 'a,
    ) -> Peekable<Box<dyn Iterator<Item = Recorded> + 'a>> {
        let maps: Box<dyn Iterator<Item = Recorded> + 'a> = Box::new(maps);
        maps.peekable()
    }

    pub(super) fn is_empty(&mut self) -> bool {
        self.given.is_none() && self.recorded.peek().is_none()
    }

    /// Returns the maps that arrived since the last call, for a scan of this log time.
    pub(super) fn since(
        &mut self,
        log_time_ns: i64,
        check: impl Fn(&OccupancyGrid) -> Result<(), String>,
    ) -> Arrived<'a> {
        let mut arrived = Arrived::default();
        if let Some(map) = self.given.filter(|_| !self.began) {
            arrived.take(Ok(Cow::Borrowed(map)), &check);
            self.began = true;
        }
        while let Some(next) = self.recorded.peek() {
            // A map that cannot be decoded has no log time and is due at once.
            let is_due = next.as_ref().map_or(true, |(time, _)| *time <= log_time_ns);
            if !is_due && self.began {
                break;
            }
            self.began = true;
            let next = self.recorded.next();
            // Keeps one map at a time, since there may be many large ones.
            arrived.take(next.map_or(Err(String::new()), grid), &check);
        }
        arrived
    }
}

fn grid<'a>(recorded: Recorded) -> Result<Cow<'a, OccupancyGrid>, String> {
    let (_, map) = recorded.map_err(|error| with_causes(&error))?;
    let grid = map.to_grid();
    grid.map(Cow::Owned).map_err(|error| with_causes(&error))
}

#[derive(Debug, Default)]
pub(super) struct Arrived<'a> {
    pub(super) map: Option<Cow<'a, OccupancyGrid>>,
    pub(super) refusals: Vec<String>,
}

impl<'a> Arrived<'a> {
    fn take(
        &mut self,
        map: Result<Cow<'a, OccupancyGrid>, String>,
        check: impl Fn(&OccupancyGrid) -> Result<(), String>,
    ) {
        match map.and_then(|map| check(&map).map(|()| map)) {
            Ok(map) => self.map = Some(map),
            Err(refusal) if self.refusals.contains(&refusal) => {}
            Err(refusal) => self.refusals.push(refusal),
        }
    }
}

/// Returns the newest map of a recording.
/// Fails if it contains no map, or one that cannot be used.
pub fn map_in(recording: &Recording) -> anyhow::Result<OccupancyGrid> {
    recording.map()?.ok_or_else(|| no_map(recording))
}

/// Error for a recording without a map; its damage, if it is damaged.
pub(super) fn no_map(recording: &Recording) -> anyhow::Error {
    let path = recording.path().display();
    match recording.damage_error() {
        Some(damage) => damage.into(),
        None => anyhow!("{path} has no map on /map: name one with --map map.yaml"),
    }
}
