//! Which cells are occupied, free or unknown: rules that travel with the map.

use crate::{FREE_TO, MapHeader, OCCUPIED_FROM, UNKNOWN};

/// Rules by which the occupancy of a cell, 0..=100 or unknown, is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct CellRules {
    /// Occupancy from which a cell is occupied, per cent, 1..=100; the default
    /// is that of map savers.
    #[cfg_attr(feature = "clap", arg(long, value_name = "PERCENT", default_value_t = OCCUPIED_FROM, value_parser = clap::value_parser!(u8).range(1..=100)))]
    pub occupied_from: u8,
    /// Occupancy up to which a cell is free, per cent, 0..=99; what lies
    /// between counts as unknown.
    #[cfg_attr(feature = "clap", arg(long, value_name = "PERCENT", default_value_t = FREE_TO, value_parser = clap::value_parser!(u8).range(0..=99)))]
    pub free_to: u8,
    /// Unknown cells block rays and cannot hold the robot. Real maps are half
    /// known, so by default they do not block, and those near free cells can.
    #[cfg_attr(feature = "clap", arg(long))]
    pub unknown_blocks: bool,
}

/// A rule of a map that is out of range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InvalidRule {
    /// The rule.
    pub field: &'static str,
    /// As the map has it.
    pub found: u64,
    /// What it may be.
    pub allowed: &'static str,
}

impl std::fmt::Display for InvalidRule {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let InvalidRule {
            field,
            found,
            allowed,
        } = self;
        write!(f, "{field} of the map is {found}: allowed are {allowed}")
    }
}

impl std::error::Error for InvalidRule {}

impl Default for CellRules {
    fn default() -> Self {
        CellRules {
            occupied_from: OCCUPIED_FROM,
            free_to: FREE_TO,
            unknown_blocks: false,
        }
    }
}

impl CellRules {
    /// The rules of a map, which are checked, for it comes from another process.
    ///
    /// # Errors
    /// If one is out of range.
    pub fn of(map: &MapHeader) -> Result<Self, InvalidRule> {
        let refused = |field, found, allowed| InvalidRule {
            field,
            found,
            allowed,
        };
        let percent = |field, found: u32, range: std::ops::RangeInclusive<u8>, allowed| {
            let percent = u8::try_from(found).ok();
            percent
                .filter(|percent| range.contains(percent))
                .ok_or(refused(field, found.into(), allowed))
        };
        Ok(CellRules {
            occupied_from: percent("occupied_from", map.occupied_from, 1..=100, "1 to 100")?,
            free_to: percent("free_to", map.free_to, 0..=99, "0 to 99")?,
            unknown_blocks: match map.unknown_blocks {
                0 => false,
                1 => true,
                found => return Err(refused("unknown_blocks", found, "0 and 1")),
            },
        })
    }

    /// The header of a map whose cells are to be read by these rules.
    #[must_use]
    pub fn header(self, map: MapHeader) -> MapHeader {
        MapHeader {
            occupied_from: self.occupied_from.into(),
            free_to: self.free_to.into(),
            unknown_blocks: self.unknown_blocks.into(),
            ..map
        }
    }

    /// Whether a cell is an obstacle.
    #[must_use]
    pub fn is_occupied(self, occupancy: u8) -> bool {
        occupancy >= self.occupied_from && occupancy != UNKNOWN
    }

    /// Whether a cell is known to be free.
    #[must_use]
    pub fn is_free(self, occupancy: u8) -> bool {
        occupancy <= self.free_to && !self.is_occupied(occupancy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_travel_with_a_map() {
        assert_eq!(
            CellRules::of(&MapHeader::default()),
            Ok(CellRules::default())
        );
        let rules = CellRules {
            occupied_from: 50,
            free_to: 10,
            unknown_blocks: true,
        };
        assert_eq!(
            CellRules::of(&rules.header(MapHeader::default())),
            Ok(rules)
        );
    }

    #[test]
    fn rules_that_foreign_bytes_may_hold_are_checked() {
        let check = |change: fn(&mut MapHeader), expected: &str| {
            let mut map = MapHeader::default();
            change(&mut map);
            let error = CellRules::of(&map).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        };
        check(|map| map.occupied_from = 0, "occupied_from of the map is 0");
        check(
            |map| map.occupied_from = 321,
            "occupied_from of the map is 321",
        );
        check(|map| map.free_to = 100, "free_to of the map is 100");
        check(
            |map| map.unknown_blocks = 2,
            "unknown_blocks of the map is 2: allowed are 0 and 1",
        );
    }
}
