//! Selects the map for a scan: the newest one recorded before it, as in the graph, or the first one
//! after it if there is none before. [`map_in`] returns the newest map.

use std::borrow::Cow;
use std::iter::Peekable;

use anyhow::anyhow;
use map::OccupancyGrid;
use recording::{Recording, RecordingError};
use transport::with_causes;

/// A map with the log time from which it counts, or the reason why it cannot be decoded.
type Due<'a> = (i64, Result<Cow<'a, OccupancyGrid>, String>);

/// Maps of a recording by log time, or one map for all scans.
pub(super) struct Maps<'a> {
    maps: Peekable<Box<dyn Iterator<Item = Due<'a>> + 'a>>,
    /// True once a map has been returned.
    began: bool,
}

impl<'a> Maps<'a> {
    /// Uses the given map for all scans, and ignores recorded ones.
    pub(super) fn given(map: &'a OccupancyGrid) -> Self {
        Maps::of(std::iter::once((i64::MIN, Ok(Cow::Borrowed(map)))))
    }

    /// Contains no map, since the map has already been prepared.
    pub(super) fn none() -> Self {
        Maps::of(std::iter::empty())
    }

    pub(super) fn recorded(recording: &'a Recording) -> Result<Self, RecordingError> {
        let maps = recording.maps()?;
        Ok(Maps::of(maps.map(|recorded| match recorded {
            Ok((time_ns, map)) => {
                let grid = map.to_grid().map(Cow::Owned);
                (time_ns, grid.map_err(|error| with_causes(&error)))
            }
            // A map that cannot be decoded has no log time and is due at once.
            Err(error) => (i64::MIN, Err(with_causes(&error))),
        })))
    }

    fn of(maps: impl Iterator<Item = Due<'a>> + 'a) -> Self {
        let maps: Box<dyn Iterator<Item = Due<'a>> + 'a> = Box::new(maps);
        Maps {
            maps: maps.peekable(),
            began: false,
        }
    }

    pub(super) fn is_empty(&mut self) -> bool {
        self.maps.peek().is_none()
    }

    /// Returns the maps that arrived since the last call, for a scan of this log time.
    pub(super) fn since(
        &mut self,
        log_time_ns: i64,
        check: impl Fn(&OccupancyGrid) -> Result<(), String>,
    ) -> Arrived<'a> {
        let mut arrived = Arrived::default();
        // The first map counts for the scans before it, too.
        let began = &mut self.began;
        while let Some((_, map)) = self
            .maps
            .next_if(|(due_ns, _)| *due_ns <= log_time_ns || !*began)
        {
            *began = true;
            arrived.take(map, &check);
        }
        arrived
    }
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
