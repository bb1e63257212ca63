//! A set of maps: the floors of a building, or the buildings of a campus.

use std::hash::Hasher;

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};
use twox_hash::XxHash3_64;

use crate::{MapHeader, Pose2, Stamp, WrongMapId};

crate::message! {
    #[type_name("MapsHeader/v1")]
    /// Header of topic `maps`. The items are bytes: the [`MapHeader`] of each map, the
    /// [`Transition`]s between them, and the cells of each map; [`MapSet`] reads and writes them.
    #[derive(Eq)]
    pub struct MapsHeader {
        /// Time at which the maps were read; the counter counts the sets served.
        pub stamp: Stamp,
        /// Hash of all maps and transitions.
        pub set_id: u64,
        /// Number of maps.
        pub maps: u32,
        /// Number of transitions.
        pub transitions: u32,
    }
}

/// A connection between two maps: a lift, stairs, a door between buildings. It is a rectangle that
/// is on both maps.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[repr(C)]
pub struct Transition {
    /// Indices of the two maps in their set, from 0.
    pub maps: [u32; 2],
    /// Centre and x axis of the rectangle on each map. A robot in it has the same pose relative to
    /// the rectangle on both maps.
    pub map_from_region: [Pose2; 2],
    /// Sides of the rectangle along its x and y, in metres.
    pub size_m: [f64; 2],
}

/// Content of a message of topic `maps`.
#[derive(Debug, Clone, PartialEq)]
pub struct MapSet<'a> {
    /// Maps with their cells, in the order that decides ties.
    pub maps: Vec<(MapHeader, &'a [u8])>,
    /// Connections between the maps.
    pub transitions: Vec<Transition>,
}

/// Error of an invalid message of topic `maps`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum InvalidMapSet {
    /// There are no maps.
    #[error("the set has no maps")]
    Empty,
    /// The size differs from that of its maps and transitions.
    #[error("{found} bytes are not those of its maps and transitions")]
    Size {
        /// Bytes received.
        found: usize,
    },
    /// The id of a map does not match its content.
    #[error("a map of the set: {0}")]
    MapId(WrongMapId),
    /// A transition has invalid maps or an invalid rectangle.
    #[error("transition {number} is not a rectangle on two different maps of the set")]
    Transition {
        /// Index of the transition.
        number: usize,
    },
}

const HEADER: usize = size_of::<MapHeader>();
const TRANSITION: usize = size_of::<Transition>();

impl<'a> MapSet<'a> {
    /// Reads and checks a message.
    ///
    /// # Errors
    /// The size is wrong, the id of a map does not match its content, or a transition is invalid.
    pub fn read(header: &MapsHeader, items: &'a [u8]) -> Result<Self, InvalidMapSet> {
        let set = MapSet::split(header, items)?;
        for (map, cells) in &set.maps {
            map.check_id(cells).map_err(InvalidMapSet::MapId)?;
        }
        let mut transitions = set.transitions.iter();
        match transitions.position(|transition| !transition.is_between(set.maps.len())) {
            Some(number) => Err(InvalidMapSet::Transition { number }),
            None => Ok(set),
        }
    }

    /// Splits a message that was checked before, without checking ids and transitions again.
    ///
    /// # Errors
    /// The size is wrong or there are no maps.
    pub fn split(header: &MapsHeader, items: &'a [u8]) -> Result<Self, InvalidMapSet> {
        let wrong_size = InvalidMapSet::Size { found: items.len() };
        let (maps, transitions) = (header.maps as usize, header.transitions as usize);
        let split = |items: &'a [u8], bytes: Option<usize>| {
            let at = bytes.filter(|bytes| *bytes <= items.len());
            at.map(|at| items.split_at(at)).ok_or(wrong_size)
        };
        let (headers, rest) = split(items, maps.checked_mul(HEADER))?;
        let (between, mut rest) = split(rest, transitions.checked_mul(TRANSITION))?;
        let mut set = MapSet {
            maps: Vec::with_capacity(maps),
            transitions: Vec::with_capacity(transitions),
        };
        for bytes in headers.chunks_exact(HEADER) {
            let map: MapHeader = bytemuck::pod_read_unaligned(bytes);
            let area = (map.width as usize).checked_mul(map.height as usize);
            let (cells, after) = split(rest, area)?;
            set.maps.push((map, cells));
            rest = after;
        }
        if !rest.is_empty() {
            return Err(wrong_size);
        }
        if set.maps.is_empty() {
            return Err(InvalidMapSet::Empty);
        }
        let between = between.chunks_exact(TRANSITION);
        set.transitions
            .extend(between.map(bytemuck::pod_read_unaligned::<Transition>));
        Ok(set)
    }

    /// Returns the size of the message's items in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let cells: usize = self.maps.iter().map(|(_, cells)| cells.len()).sum();
        self.maps.len() * HEADER + self.transitions.len() * TRANSITION + cells
    }

    /// Writes `items`, which must be [`MapSet::bytes`] long, and returns the header.
    ///
    /// # Panics
    /// `items` has another length.
    #[must_use]
    pub fn write(&self, stamp: Stamp, items: &mut [u8]) -> MapsHeader {
        let headers = self.maps.iter().map(|(map, _)| bytemuck::bytes_of(map));
        let between = self.transitions.iter().map(bytemuck::bytes_of);
        let cells = self.maps.iter().map(|(_, cells)| *cells);
        let mut rest = items;
        for part in headers.chain(between).chain(cells) {
            let (here, after) = rest.split_at_mut(part.len());
            here.copy_from_slice(part);
            rest = after;
        }
        assert!(rest.is_empty(), "as many bytes as the set has");
        MapsHeader {
            stamp,
            set_id: self.id(),
            maps: self.maps.len() as u32,
            transitions: self.transitions.len() as u32,
        }
    }

    /// Returns a hash of all maps and transitions; the times of reading do not count.
    #[must_use]
    pub fn id(&self) -> u64 {
        let mut hasher = XxHash3_64::new();
        for (map, _) in &self.maps {
            let map = MapHeader {
                stamp: Stamp::default(),
                ..*map
            };
            hasher.write(bytemuck::bytes_of(&map));
        }
        hasher.write(bytemuck::cast_slice(&self.transitions));
        hasher.finish()
    }
}

/// Returns the id of maps that are searched together, from their ids in order: for one map its own
/// id, for none 0. Transitions do not affect a search and so do not count.
#[must_use]
pub fn searched_id(map_ids: impl IntoIterator<Item = u64>) -> u64 {
    let mut hasher = XxHash3_64::new();
    let (mut count, mut last) = (0, 0);
    for map_id in map_ids {
        hasher.write_u64(map_id);
        (count, last) = (count + 1, map_id);
    }
    match count {
        0 | 1 => last,
        _ => hasher.finish(),
    }
}

impl Transition {
    /// True if it is a valid rectangle on two different maps of a set of `maps` maps.
    #[must_use]
    pub fn is_between(&self, maps: usize) -> bool {
        let [a, b] = self.maps;
        let poses = self.map_from_region.iter().flat_map(|p| [p.x, p.y, p.yaw]);
        a != b
            && self.maps.iter().all(|&map| (map as usize) < maps)
            && self.size_m.iter().all(|side| *side > 0.0)
            && poses.chain(self.size_m).all(f64::is_finite)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(width: u32, cells: &[u8]) -> (MapHeader, &[u8]) {
        let mut map = MapHeader {
            width,
            height: cells.len() as u32 / width,
            resolution_m: 0.05,
            ..MapHeader::default()
        };
        map.map_id = map.id_of(cells);
        (map, cells)
    }

    fn lift() -> Transition {
        Transition {
            maps: [0, 1],
            size_m: [2.0, 1.5],
            ..Transition::zeroed()
        }
    }

    fn message(set: &MapSet<'_>) -> (MapsHeader, Vec<u8>) {
        let mut items = vec![0; set.bytes()];
        let header = set.write(Stamp::default(), &mut items);
        (header, items)
    }

    #[test]
    fn a_set_that_is_written_is_read() {
        let set = MapSet {
            maps: vec![map(2, &[0, 100, 255, 0]), map(3, &[0, 0, 100])],
            transitions: vec![lift()],
        };
        let (header, items) = message(&set);
        assert_eq!((header.maps, header.transitions), (2, 1));
        assert_eq!(MapSet::read(&header, &items), Ok(set.clone()));
        let mut later = set.clone();
        later.maps[0].0.stamp.measured_ns = 5;
        assert_eq!(later.id(), header.set_id, "when it was read does not count");
        later.maps.swap(0, 1);
        assert_ne!(later.id(), header.set_id, "the order counts");
    }

    #[test]
    fn maps_that_are_searched_together_have_one_id() {
        let id = |ids: &[u64]| searched_id(ids.iter().copied());
        assert_eq!((id(&[]), id(&[7])), (0, 7));
        let several = [id(&[7, 8]), id(&[8, 7]), id(&[7, 9]), id(&[7, 8, 9])];
        for (number, of) in several.iter().enumerate() {
            assert!(*of != 0 && !several[..number].contains(of), "{several:?}");
        }
    }

    #[test]
    fn what_is_no_set_is_refused() {
        let set = MapSet {
            maps: vec![map(2, &[0, 100, 255, 0]), map(3, &[0, 0, 100])],
            transitions: vec![lift()],
        };
        let (header, items) = message(&set);
        let refused = |header: &MapsHeader, items: &[u8]| MapSet::read(header, items).unwrap_err();
        for cut in [0, 10, HEADER, items.len() - 1] {
            let error = refused(&header, &items[..cut]);
            assert_eq!(error, InvalidMapSet::Size { found: cut });
        }
        let longer = [&items[..], &[0]].concat();
        assert!(matches!(
            refused(&header, &longer),
            InvalidMapSet::Size { .. }
        ));
        let many = MapsHeader {
            maps: u32::MAX,
            transitions: u32::MAX,
            ..header
        };
        assert!(matches!(refused(&many, &items), InvalidMapSet::Size { .. }));
        let mut changed = items.clone();
        *changed.last_mut().unwrap() = 7;
        assert!(matches!(
            refused(&header, &changed),
            InvalidMapSet::MapId(_)
        ));
        let none = MapsHeader {
            maps: 0,
            transitions: 0,
            ..header
        };
        assert_eq!(refused(&none, &[]), InvalidMapSet::Empty);
        let change = |change: fn(&mut Transition)| {
            let mut set = set.clone();
            change(&mut set.transitions[0]);
            let (header, items) = message(&set);
            assert_eq!(
                refused(&header, &items),
                InvalidMapSet::Transition { number: 0 }
            );
        };
        change(|lift| lift.maps = [1, 1]);
        change(|lift| lift.maps = [0, 2]);
        change(|lift| lift.size_m[1] = 0.0);
        change(|lift| lift.map_from_region[1].yaw = f64::NAN);
    }
}
