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

    /// Uses the maps of a recording.
    ///
    /// # Errors
    /// Several topics contain maps.
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

    /// True if there is no map at all.
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
    /// The newest usable map.
    pub(super) map: Option<Cow<'a, OccupancyGrid>>,
    /// Reasons why other maps cannot be used.
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
///
/// # Errors
/// It contains no map, or one that cannot be used.
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

#[cfg(test)]
mod tests {
    use recording::Message;
    use recording::write::{Packing, RecordingWriter};

    use super::*;

    /// A recording with maps at these log times, each as wide as its time.
    fn recording(times: &[i64]) -> Recording {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        for &time in times {
            let mut map = OccupancyGridMsg {
                data: vec![0; time as usize],
                ..OccupancyGridMsg::default()
            };
            (map.info.width, map.info.height, map.info.resolution) = (time as u32, 1, 0.5);
            writer.write("/map", time, &Message::Map(map)).unwrap();
        }
        let bytes = writer.finish().unwrap().into_inner();
        Recording::from_bytes("r.mcap", bytes).unwrap()
    }

    /// Width of the arrived map, and number of refusals; maps 7 cells wide cannot be used.
    fn width(maps: &mut Maps<'_>, log_time_ns: i64) -> (Option<u32>, usize) {
        let check = |map: &OccupancyGrid| match map.width {
            7 => Err("it is 7 cells wide".to_owned()),
            _ => Ok(()),
        };
        let Arrived { map, refusals } = maps.since(log_time_ns, check);
        (map.map(|map| map.width), refusals.len())
    }

    #[test]
    fn the_newest_before_a_scan_counts_and_the_first_after_it_where_there_is_none() {
        let recording = recording(&[3, 5, 6, 9]);
        let mut maps = Maps::recorded(&recording).unwrap();
        assert_eq!(width(&mut maps, 1), (Some(3), 0));
        assert_eq!(width(&mut maps, 4), (None, 0));
        assert_eq!(width(&mut maps, 6), (Some(6), 0));
        assert_eq!(width(&mut maps, 20), (Some(9), 0));
        let mut late = Maps::recorded(&recording).unwrap();
        assert_eq!(width(&mut late, 5), (Some(5), 0));
    }

    #[test]
    fn what_cannot_be_used_is_left_out_and_reported() {
        let recording = recording(&[7, 8, 7, 7, 9]);
        let mut maps = Maps::recorded(&recording).unwrap();
        assert_eq!(width(&mut maps, 1), (None, 1), "the first after it");
        assert_eq!(width(&mut maps, 8), (Some(8), 1), "two of the same kind");
        assert_eq!(width(&mut maps, 9), (Some(9), 0));
    }

    #[test]
    fn a_map_that_is_given_counts_for_all() {
        let cells = vec![0; 6];
        let grid = OccupancyGrid::from_parts(6, 1, 0.5, geometry::Pose::IDENTITY, cells).unwrap();
        let mut maps = Maps::given(&grid);
        assert!(!maps.is_empty());
        assert_eq!(width(&mut maps, 1), (Some(6), 0));
        assert_eq!(width(&mut maps, 2), (None, 0));
        assert!(Maps::recorded(&recording(&[])).unwrap().is_empty());
    }
}
