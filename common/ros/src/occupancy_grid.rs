//! `nav_msgs/msg/OccupancyGrid`.

use map::OccupancyGrid;
use messages::{FieldHeader, MapHeader};

use super::{ConversionError, Header, Pose, Time, planar};

declare! {
    part MapMetaData = "nav_msgs/MapMetaData" [Pose] {
        /// Time at which the map was loaded.
        map_load_time: Time,
        /// Side of a cell, in metres.
        resolution: f32,
        width: u32,
        height: u32,
        /// Pose of the grid in the map frame: its origin is the lower left corner of cell (0, 0).
        origin: Pose,
    }

    /// An occupancy grid.
    message OccupancyGridMsg = "nav_msgs/msg/OccupancyGrid" [Header, MapMetaData] {
        /// Time of publication, and the map's frame.
        header: Header,
        info: MapMetaData,
        /// Row by row from the lowest y: 0 (free) to 100 (occupied), -1 unknown.
        data: Vec<i8>,
    }
}

impl OccupancyGridMsg {
    /// Converts the message to a grid.
    ///
    /// The resolution is the shortest decimal that rounds to the message's 32 bits: a map of 0.05 m
    /// has exactly 0.05 m, as in the file that it was loaded from.
    pub fn to_grid(&self) -> Result<OccupancyGrid, ConversionError> {
        let cells = self.data.iter().enumerate().map(cell);
        let cells: Vec<u8> = cells.collect::<Result<_, _>>()?;
        let info = &self.info;
        let grid = OccupancyGrid::from_parts(
            info.width,
            info.height,
            shortest_decimal(info.resolution),
            info.origin.planar()?,
            cells,
        );
        grid.map_err(|error| ConversionError(error.to_string()))
    }

    /// Converts a grid to a message with an empty header.
    pub fn from_grid(grid: &OccupancyGrid) -> Self {
        let origin = Pose::from_planar(grid.map_from_grid);
        let sides = (grid.width, grid.height);
        Self::of_cells(grid.resolution_m, sides, origin, &grid.cells)
    }

    /// Converts a map of the graph to a message with an empty header and load time.
    pub fn of_map(map: &MapHeader, cells: &[u8]) -> Self {
        let origin = planar::pose(map.map_from_grid.into());
        Self::of_cells(map.resolution_m, (map.width, map.height), origin, cells)
    }

    fn of_cells(
        resolution_m: f64,
        (width, height): (u32, u32),
        origin: Pose,
        cells: &[u8],
    ) -> Self {
        OccupancyGridMsg {
            header: Header::default(),
            info: MapMetaData {
                map_load_time: Time::default(),
                resolution: resolution_m as f32,
                width,
                height,
                origin,
            },
            // Unknown is 255 in the grid and -1 in the message: the same bits.
            data: cells.iter().map(|&cell| cell.cast_signed()).collect(),
        }
    }

    /// Converts an intensity field of the graph to percentages of the intensity that a pose would
    /// have if every beam agreed.
    pub fn of_field(header: Header, field: &FieldHeader, items: &[u16], map: &MapHeader) -> Self {
        let full = field.highest_possible.max(1);
        let percent = |&item: &u16| (u32::from(item) * 100 / full).min(100) as i8;
        OccupancyGridMsg {
            info: MapMetaData {
                map_load_time: header.stamp,
                resolution: (map.resolution_m * f64::from(field.block)) as f32,
                width: field.width,
                height: field.height,
                origin: planar::pose(map.map_from_grid.into()),
            },
            header,
            data: items.iter().map(percent).collect(),
        }
    }
}

fn cell((index, &found): (usize, &i8)) -> Result<u8, ConversionError> {
    match found {
        -1 => Ok(map::UNKNOWN),
        // Not negative, so the value stays the same.
        0..=100 => Ok(found as u8),
        _ => Err(ConversionError(format!(
            "cell {index} is {found}; allowed: 0..=100, and -1 for unknown"
        ))),
    }
}

fn shortest_decimal(value: f32) -> f64 {
    // An f32 prints as its shortest decimal, which is parsed as f64; NaN stays NaN and is rejected
    // later.
    value.to_string().parse().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> OccupancyGrid {
        let origin = geometry::Pose::new(-1.5, 2.0, 0.25);
        OccupancyGrid::from_parts(2, 2, 0.05, origin, vec![0, 100, 255, 42]).unwrap()
    }

    #[test]
    fn a_grid_survives_its_message() {
        let back = OccupancyGridMsg::from_grid(&grid()).to_grid().unwrap();
        assert_eq!(back.resolution_m, 0.05, "not 0.05000000074505806");
        assert_eq!(back.cells, grid().cells);
        assert_eq!(back.id(), grid().id());
    }

    #[test]
    fn unsound_messages_are_refused() {
        let refusal = |spoil: fn(&mut OccupancyGridMsg)| {
            let mut message = OccupancyGridMsg::from_grid(&grid());
            spoil(&mut message);
            message.to_grid().unwrap_err().to_string()
        };
        assert_eq!(
            refusal(|m| m.data[2] = -2),
            "cell 2 is -2; allowed: 0..=100, and -1 for unknown"
        );
        assert!(refusal(|m| m.info.width = 3).contains("4 cells for a grid of 3 x 2"));
        assert!(refusal(|m| m.info.resolution = f32::NAN).contains("a resolution of NaN m"));
        assert!(refusal(|m| m.info.origin.orientation.w = 0.0).contains("not a rotation"));
        assert!(refusal(|m| m.info.width = u32::MAX).contains("allowed: sides of"));
    }
}
