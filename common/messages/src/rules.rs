//! Rules that classify cells as occupied, free or unknown; they are part of the map.

use crate::{FREE_TO, MapHeader, OCCUPIED_FROM, UNKNOWN};

/// Rules that classify a cell by its occupancy, 0..=100 or unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct CellRules {
    /// Occupancy from which a cell is occupied, in per cent, 1..=100; map savers use the same
    /// default.
    #[cfg_attr(feature = "clap", arg(long, value_name = "PERCENT", default_value_t = OCCUPIED_FROM, value_parser = clap::value_parser!(u8).range(1..=100)))]
    pub occupied_from: u8,
    /// Occupancy up to which a cell is free, in per cent, 0..=99; values in between are unknown.
    #[cfg_attr(feature = "clap", arg(long, value_name = "PERCENT", default_value_t = FREE_TO, value_parser = clap::value_parser!(u8).range(0..=99)))]
    pub free_to: u8,
    /// Unknown cells block rays and cannot hold the robot. Real maps are half unknown, so by
    /// default they do not block rays, and those near free cells can hold the robot.
    #[cfg_attr(feature = "clap", arg(long))]
    pub unknown_blocks: bool,
}

/// Error of a map with a rule out of range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{field} of the map is {found}: allowed are {allowed}")]
pub struct InvalidRule {
    /// Name of the rule.
    pub field: &'static str,
    /// Value in the map.
    pub found: u64,
    /// Description of the allowed values.
    pub allowed: &'static str,
}

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
    /// Reads the rules of a map and checks them, as it comes from another process.
    ///
    /// # Errors
    /// A rule is out of range.
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

    /// Puts these rules into the header of a map.
    #[must_use]
    pub fn header(self, map: MapHeader) -> MapHeader {
        MapHeader {
            occupied_from: self.occupied_from.into(),
            free_to: self.free_to.into(),
            unknown_blocks: self.unknown_blocks.into(),
            ..map
        }
    }

    /// True if the cell is an obstacle.
    #[must_use]
    pub fn is_occupied(self, occupancy: u8) -> bool {
        occupancy >= self.occupied_from && occupancy != UNKNOWN
    }

    /// True if the cell is known to be free.
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
