//! Which map counts for a scan: the newest that was recorded before it, as the
//! graph would have it, or the first after it where none came before.

use std::borrow::Cow;
use std::iter::Peekable;

use map::OccupancyGrid;
use recording::ros::OccupancyGridMsg;
use recording::{Recording, RecordingError};
use transport::with_causes;

/// A map that was recorded, with its log time.
type Recorded = Result<(i64, OccupancyGridMsg), RecordingError>;

/// The maps of a recording by log time, or one for all scans.
pub(super) struct Maps<'a> {
    given: Option<&'a OccupancyGrid>,
    recorded: Peekable<Box<dyn Iterator<Item = Recorded> + 'a>>,
    /// Whether one has been given out.
    began: bool,
}

impl<'a> Maps<'a> {
    /// The map that is given, whatever is recorded.
    pub(super) fn given(map: &'a OccupancyGrid) -> Self {
        Maps {
            given: Some(map),
            recorded: Maps::of(std::iter::empty()),
            began: false,
        }
    }

    /// Those of a recording.
    ///
    /// # Errors
    /// Several topics could be meant.
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

    /// Whether there is none.
    pub(super) fn is_empty(&mut self) -> bool {
        self.given.is_none() && self.recorded.peek().is_none()
    }

    /// The maps that have come since the last question, for a scan of this log
    /// time, the oldest first: the last of them that can be used counts. Those
    /// that do not decode are the reason why not.
    pub(super) fn since(&mut self, log_time_ns: i64) -> Vec<Result<Candidate<'a>, String>> {
        let mut found = Vec::new();
        if let Some(map) = self.given.filter(|_| !self.began) {
            found.push(Ok(Candidate::Given(map)));
        }
        while let Some(next) = self.recorded.peek() {
            let is_first = !self.began && found.is_empty();
            // One that does not decode stands among those of its time.
            let is_due = next.as_ref().map_or(true, |(time, _)| *time <= log_time_ns);
            if !is_due && !is_first {
                break;
            }
            if let Some(next) = self.recorded.next() {
                found.push(match next {
                    Ok((_, map)) => Ok(Candidate::Recorded(Box::new(map))),
                    Err(error) => Err(with_causes(&error)),
                });
            }
            if !is_due {
                break;
            }
        }
        self.began |= !found.is_empty();
        found
    }
}

/// A map that may be the one that counts.
pub(super) enum Candidate<'a> {
    Given(&'a OccupancyGrid),
    Recorded(Box<OccupancyGridMsg>),
}

impl<'a> Candidate<'a> {
    /// The grid in it.
    ///
    /// # Errors
    /// Why there is none.
    pub(super) fn grid(self) -> Result<Cow<'a, OccupancyGrid>, String> {
        match self {
            Candidate::Given(map) => Ok(Cow::Borrowed(map)),
            Candidate::Recorded(map) => {
                let grid = map.to_grid();
                grid.map(Cow::Owned).map_err(|error| with_causes(&error))
            }
        }
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

    fn widths(maps: &mut Maps<'_>, log_time_ns: i64) -> Vec<u32> {
        let candidates = maps.since(log_time_ns);
        let grids = candidates.into_iter().map(|map| map.unwrap().grid());
        grids.map(|grid| grid.unwrap().width).collect()
    }

    #[test]
    fn those_before_a_scan_count_and_the_first_after_it_where_there_are_none() {
        let recording = recording(&[3, 5, 9]);
        let mut maps = Maps::recorded(&recording).unwrap();
        assert_eq!(widths(&mut maps, 1), [3]);
        assert_eq!(widths(&mut maps, 4), [0; 0]);
        assert_eq!(widths(&mut maps, 9), [5, 9]);
        assert_eq!(widths(&mut maps, 10), [0; 0]);
        let mut late = Maps::recorded(&recording).unwrap();
        assert_eq!(widths(&mut late, 5), [3, 5]);
    }

    #[test]
    fn a_map_that_is_given_counts_for_all() {
        let grid = OccupancyGrid::from_parts(7, 1, 0.5, Default::default(), vec![0; 7]).unwrap();
        let mut maps = Maps::given(&grid);
        assert!(!maps.is_empty());
        assert_eq!(widths(&mut maps, 1), [7]);
        assert_eq!(widths(&mut maps, 2), [0; 0]);
        assert!(Maps::recorded(&recording(&[])).unwrap().is_empty());
    }
}
