//! Occupancy grids, and ROS map files.
//!
//! [`load`] reads the files of `map_server`: a YAML description and a PGM, PNG or BMP image, in
//! trinary, scale or raw mode; [`save`] writes such a pair. [`set_of`] lists the maps of a
//! building; [`OccupancyGrid::from_parts`] creates a grid from other data. Every grid of this crate
//! is within its limits. The crate knows no topics and no engine, and repairs nothing: an invalid
//! map is an error with file, place and what is allowed.

mod description;
mod error;
mod foreign;
mod grid;
mod keys;
mod load;
mod memory;
mod picture;
mod rules;
mod save;
mod set;

pub use error::MapError;
pub use foreign::check_kind;
pub use grid::{OccupancyGrid, UNKNOWN};
pub use keys::UnknownKey;
pub use load::{image_of, load, load_within};
pub use memory::{MemoryLimit, MemoryOptions};
pub use messages::limits::{MAX_CELLS, MAX_ORIGIN_M, MAX_RESOLUTION_M, MAX_SIDE, MIN_RESOLUTION_M};
pub use save::save;
pub use set::{
    MAX_MAPS, MapFile, MapSet, Transition, list_of, set_of, set_of_files, set_of_noting,
};
