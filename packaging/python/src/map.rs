//! Maps from files and from arrays.

use std::ffi::CString;
use std::path::PathBuf;
use std::sync::Arc;

use engine::Map as MapView;
use engine::grid::{CellRules, GridFrame};
use geometry::Pose;
use map::{MAX_CELLS, OccupancyGrid, UNKNOWN};
use numpy::{
    PyArray1, PyArray2, PyArrayDescrMethods, PyArrayMethods, PyReadonlyArray2, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;

use crate::error::{detached, of_map, value};
use crate::numbers::{self, PoseTuple};

/// Arguments that make a map: cells, resolution and origin.
type Reduced<'py> = (Bound<'py, PyArray2<i8>>, f64, PoseTuple);

/// An occupancy grid: a map of square cells.
///
/// Made by `Map.from_yaml` or `Map.from_array`; it does not change.
#[pyclass(frozen, module = "backcast")]
pub(crate) struct Map {
    grid: Arc<OccupancyGrid>,
}

#[pymethods]
impl Map {
    /// Reads a map in the format of ROS' map_server: a YAML file, and the image that it
    /// names, a PGM, PNG or BMP.
    ///
    /// An unknown key of the YAML file causes a warning. Raises OSError if a file cannot be
    /// read, ValueError if one is invalid.
    #[staticmethod]
    fn from_yaml(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let (grid, notes) = detached(py, move || {
            let mut notes = Vec::new();
            let grid = map::load_within(map::MemoryLimit::NONE, path, |key| {
                notes.push(key.to_string());
            });
            Ok((grid.map_err(|error| of_map(&error))?, notes))
        })?;
        for note in notes {
            let category = py.get_type::<PyUserWarning>();
            PyErr::warn(py, &category, &CString::new(note)?, 1)?;
        }
        Ok(Map::of(grid))
    }

    /// Makes a map from cells in the form of nav_msgs/OccupancyGrid: a 2-D array of int8
    /// with 0 for free to 100 for occupied, per cent, and -1 for unknown; in uint8, 255 is
    /// unknown.
    ///
    /// Row 0 has the lowest y, column 0 the lowest x, so that cells[row, column] is the
    /// cell at x = (column + 0.5) · resolution and y = (row + 0.5) · resolution from the
    /// origin. An image has its rows in the opposite order: numpy.flipud reverses them.
    ///
    /// resolution is the side of a cell in metres. origin is the pose of the outer corner
    /// of cell (0, 0) in the map, (x, y, yaw) in metres and radians.
    #[staticmethod]
    #[pyo3(signature = (cells, resolution, origin=None))]
    fn from_array(
        py: Python<'_>,
        cells: &Bound<'_, PyAny>,
        resolution: f64,
        origin: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let origin = origin.map_or(Ok(Pose::IDENTITY), |given| numbers::pose("origin", given))?;
        let ((height, width), cells) = occupancies(cells)?;
        let grid = detached(py, || {
            let grid = OccupancyGrid::from_parts(width, height, resolution, origin, cells);
            grid.map_err(|error| of_map(&error))
        })?;
        Ok(Map::of(grid))
    }

    /// Side of a cell, metres.
    #[getter]
    fn resolution(&self) -> f64 {
        self.grid.resolution_m
    }

    /// Number of cells along x.
    #[getter]
    fn width(&self) -> u32 {
        self.grid.width
    }

    /// Number of cells along y.
    #[getter]
    fn height(&self) -> u32 {
        self.grid.height
    }

    /// Pose of the outer corner of cell (0, 0) in the map: (x, y, yaw) in metres and
    /// radians.
    #[getter]
    fn origin(&self) -> PoseTuple {
        numbers::tuple(self.grid.map_from_grid)
    }

    /// A copy of the cells, height × width of int8. Row 0 has the lowest y; 0 is free, 100
    /// occupied, per cent, and -1 unknown.
    #[getter]
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i8>>> {
        let cells = self.grid.cells.iter().map(|&cell| cell as i8);
        let sides = [self.grid.height as usize, self.grid.width as usize];
        PyArray1::from_vec(py, cells.collect()).reshape(sides)
    }

    /// Identifier of the map by geometry and cells; the command prints it as map_id.
    #[getter]
    fn id(&self) -> String {
        format!("{:016x}", self.grid.id())
    }

    fn __repr__(&self) -> String {
        format!("<backcast.{self}>")
    }

    fn __eq__(&self, other: &Map) -> bool {
        self.grid == other.grid
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Reduced<'py>)> {
        let map = slf.get();
        let fields = (map.cells(slf.py())?, map.resolution(), map.origin());
        Ok((slf.get_type().getattr("from_array")?, fields))
    }

    fn __hash__(&self) -> u64 {
        self.grid.id()
    }
}

impl Map {
    /// Takes a grid.
    pub(crate) fn of(grid: OccupancyGrid) -> Self {
        Map {
            grid: Arc::new(grid),
        }
    }

    /// Returns the same map, without copying its cells.
    pub(crate) fn shared(&self) -> Self {
        Map {
            grid: Arc::clone(&self.grid),
        }
    }

    /// Returns the map in the engine's form.
    pub(crate) fn view(&self, rules: CellRules) -> MapView<'_> {
        let grid = &*self.grid;
        MapView {
            frame: GridFrame::new(grid.resolution_m, grid.map_from_grid),
            sides: (grid.width as usize, grid.height as usize),
            occupancy: &grid.cells,
            rules,
        }
    }
}

impl std::fmt::Display for Map {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let grid = &self.grid;
        let Pose { x, y, yaw } = grid.map_from_grid;
        write!(
            f,
            "Map of {} x {} cells of {} m from ({x}, {y}, {yaw})",
            grid.width, grid.height, grid.resolution_m
        )
    }
}

/// Returns rows and columns, and the cells row by row.
fn occupancies(given: &Bound<'_, PyAny>) -> PyResult<((u32, u32), Vec<u8>)> {
    let allowed = "allowed: a 2-D numpy array of int8 or uint8, rows from the lowest y";
    let Ok(array) = given.cast::<PyUntypedArray>() else {
        let kind = given.get_type().name()?;
        return Err(value(format!("cells is a {kind}; {allowed}")));
    };
    let sides = match *array.shape() {
        [height, width] => (height, width),
        _ => {
            let dimensions = array.ndim();
            return Err(value(format!(
                "cells has {dimensions} dimensions; {allowed}"
            )));
        }
    };
    // A broadcast array repeats one cell, and takes no memory before it is copied.
    if array.len() as u64 > MAX_CELLS {
        let (height, width) = sides;
        return Err(value(format!(
            "cells has {height} x {width} cells; at most {MAX_CELLS} are allowed"
        )));
    }
    let cells = if let Ok(cells) = given.extract::<PyReadonlyArray2<'_, i8>>() {
        let cells = cells.as_array();
        check(cells.iter().map(|&cell| i16::from(cell)), sides.1, -1)?;
        cells.iter().map(|&cell| cell as u8).collect()
    } else if let Ok(cells) = given.extract::<PyReadonlyArray2<'_, u8>>() {
        let cells = cells.as_array();
        let unknown = i16::from(UNKNOWN);
        check(cells.iter().map(|&cell| cell.into()), sides.1, unknown)?;
        cells.iter().copied().collect()
    } else {
        let dtype = array.dtype().typeobj();
        return Err(value(format!(
            "cells has dtype {}; {allowed}",
            dtype.name()?
        )));
    };
    let side = |cells: usize| u32::try_from(cells).unwrap_or(u32::MAX);
    Ok(((side(sides.0), side(sides.1)), cells))
}

fn check(mut cells: impl Iterator<Item = i16>, width: usize, unknown: i16) -> PyResult<()> {
    let is_wrong = |cell: &i16| !(0..=100).contains(cell) && *cell != unknown;
    let mut at = 0;
    let wrong = cells.find(|cell| {
        at += 1;
        is_wrong(cell)
    });
    let Some(cell) = wrong else { return Ok(()) };
    let (row, column) = ((at - 1) / width, (at - 1) % width);
    Err(value(format!(
        "cells[{row}, {column}] is {cell}; allowed: 0 for free to 100 for occupied, {unknown} \
         for unknown"
    )))
}
