//! Converts maps and intensity images after a check that their headers and items agree.

use std::collections::BTreeMap;

use messages::{FieldHeader, MapHeader, Topic, topic};
use ros::{Header, OccupancyGridMsg};

use crate::export::TranscriptError;
use crate::export::error::Result;

pub(super) fn occupancy_grid(map: &MapHeader, cells: &[u8]) -> Result<OccupancyGridMsg> {
    check_size(topic::Map::NAME, map.width, map.height, cells.len())?;
    map.check_id(cells)?;
    Ok(OccupancyGridMsg::of_map(map, cells))
}

/// Converts intensities to percentages of the intensity that a pose would have if every beam
/// agreed.
pub(super) fn field(
    header: Header,
    field: &FieldHeader,
    items: &[u16],
    map: &MapHeader,
) -> Result<OccupancyGridMsg> {
    check_size(topic::Field::NAME, field.width, field.height, items.len())?;
    Ok(OccupancyGridMsg::of_field(header, field, items, map))
}

pub(super) fn metadata(map: &MapHeader) -> BTreeMap<String, String> {
    let entry = |key: &str, value: String| (key.to_owned(), value);
    BTreeMap::from([
        entry("map_id", format!("{:016x}", map.map_id)),
        entry("width", map.width.to_string()),
        entry("height", map.height.to_string()),
        entry("resolution_m", map.resolution_m.to_string()),
    ])
}

fn check_size(topic: &'static str, width: u32, height: u32, found: usize) -> Result {
    if u64::from(width) * u64::from(height) == found as u64 {
        return Ok(());
    }
    Err(TranscriptError::Size {
        topic,
        width,
        height,
        found,
    })
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;

    fn map() -> MapHeader {
        MapHeader {
            width: 2,
            height: 2,
            resolution_m: 0.05,
            map_id: 0x1f,
            ..MapHeader::default()
        }
    }

    #[test]
    fn a_map_comes_back_from_its_message() {
        let cells = [0, 100, 255, 7];
        let mut header = map();
        let error = occupancy_grid(&header, &cells).unwrap_err();
        assert!(matches!(error, TranscriptError::MapId(_)), "{error}");
        header.map_id = header.id_of(&cells);
        let message = occupancy_grid(&header, &cells).unwrap();
        let grid = message.to_grid().unwrap();
        assert_eq!(
            (grid.cells, grid.resolution_m),
            (vec![0, 100, 255, 7], 0.05)
        );
        assert_eq!(metadata(&map())["map_id"], "000000000000001f");
    }

    #[test]
    fn intensities_are_shares_of_the_highest_possible() {
        let header = FieldHeader {
            width: 3,
            height: 1,
            block: 16,
            highest_possible: 200,
            ..FieldHeader::zeroed()
        };
        let message = field(Header::default(), &header, &[0, 100, 201], &map()).unwrap();
        assert_eq!(message.data, [0, 50, 100]);
        assert_eq!(message.info.resolution, 0.8);
        let error = field(Header::default(), &header, &[0], &map()).unwrap_err();
        assert!(matches!(error, TranscriptError::Size { found: 1, .. }));
    }
}
