//! Saves a grid as a description and an image.

use std::fs::{File, Permissions};
use std::io::{self, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use serde::Serialize;
use serde_saphyr::{DoubleQuoted, FlowSeq};

use crate::{MapError, OccupancyGrid, UNKNOWN};

/// Shades of occupied, free and unknown in the files of map savers.
const TRINARY_SHADES: [u8; 3] = [0, 254, 205];

#[derive(Serialize)]
struct Keys<'a> {
    image: DoubleQuoted<&'a str>,
    mode: &'a str,
    resolution: f64,
    origin: FlowSeq<[f64; 3]>,
    negate: u8,
    occupied_thresh: f64,
    free_thresh: f64,
}

/// Writes a map as the YAML file at `yaml` and a PNG of the same stem next to it, so that
/// [`crate::load`] returns the same grid. The mode is trinary, or raw if a cell is neither free nor
/// occupied nor unknown.
///
/// Each file is replaced atomically, the image first: a concurrent reader never reads a partial
/// file, but may read the new image with the old description.
pub fn save(grid: &OccupancyGrid, yaml: impl AsRef<Path>) -> Result<(), MapError> {
    let yaml = yaml.as_ref();
    let image = yaml.with_extension("png");
    let is_trinary = |&cell: &u8| matches!(cell, 0 | 100 | UNKNOWN);
    let trinary = grid.cells.iter().all(is_trinary);
    let shade = if trinary { trinary_shade } else { |cell| cell };
    let description = describe(grid, &image, trinary).map_err(|source| MapError::Write {
        path: yaml.to_owned(),
        source,
    })?;
    replace(&image, |file| write_png(grid, shade, file))?;
    replace(yaml, |mut file| file.write_all(description.as_bytes()))
}

fn trinary_shade(cell: u8) -> u8 {
    let [occupied, free, unknown] = TRINARY_SHADES;
    match cell {
        0 => free,
        UNKNOWN => unknown,
        _ => occupied,
    }
}

fn describe(grid: &OccupancyGrid, image: &Path, trinary: bool) -> io::Result<String> {
    let name = image.file_name().and_then(|name| name.to_str());
    let keys = Keys {
        image: DoubleQuoted(name.ok_or_else(|| io::Error::other("the name is not UTF-8"))?),
        mode: if trinary { "trinary" } else { "raw" },
        resolution: grid.resolution_m,
        origin: FlowSeq([
            grid.map_from_grid.x,
            grid.map_from_grid.y,
            grid.map_from_grid.yaw,
        ]),
        negate: 0,
        occupied_thresh: 0.65,
        free_thresh: 0.196,
    };
    serde_saphyr::to_string(&keys).map_err(io::Error::other)
}

fn write_png(grid: &OccupancyGrid, shade: fn(u8) -> u8, file: &File) -> io::Result<()> {
    let rows = grid.cells.chunks_exact(grid.width as usize).rev();
    let pixels: Vec<u8> = rows.flatten().map(|&cell| shade(cell)).collect();
    PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::NoFilter)
        .write_image(&pixels, grid.width, grid.height, ExtendedColorType::L8)
        .map_err(io::Error::other)
}

/// Writes to a temporary file next to `path`, then renames it.
fn replace(path: &Path, write: impl FnOnce(&File) -> io::Result<()>) -> Result<(), MapError> {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    let written = tempfile::Builder::new()
        // The process's umask decides who may read it, as for any new file.
        .permissions(Permissions::from_mode(0o666))
        .tempfile_in(folder)
        .and_then(|file| {
            write(file.as_file())?;
            file.persist(path).map_err(|error| error.error)
        });
    written.map(drop).map_err(|source| MapError::Write {
        path: path.to_owned(),
        source,
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use geometry::Pose;
    use proptest::prelude::*;
    use tempfile::TempDir;

    use super::*;
    use crate::load;

    fn grid(cells: &[u8]) -> OccupancyGrid {
        let origin = Pose::new(-48.6, -15.600_000_000_000_001, 0.1);
        let height = cells.len() as u32 / 3;
        OccupancyGrid::from_parts(3, height, 0.05, origin, cells.to_vec()).unwrap()
    }

    #[test]
    fn a_saved_map_loads_as_it_was() {
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("ground \"floor\".yaml");
        for cells in [[0, 100, UNKNOWN, 0, 0, 100], [0, 100, UNKNOWN, 1, 50, 99]] {
            let map = grid(&cells);
            save(&map, &path).unwrap();
            assert_eq!(load(&path).unwrap(), map);
        }
        let names = std::fs::read_dir(folder.path()).unwrap().count();
        assert_eq!(names, 2, "no temporary file stays");
    }

    #[test]
    fn trinary_maps_are_written_as_map_savers_do() {
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("floor.yaml");
        save(&grid(&[0, 100, UNKNOWN]), &path).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(
            text,
            "image: \"floor.png\"\nmode: trinary\nresolution: 0.05\n\
             origin: [-48.6, -15.600000000000001, 0.1]\nnegate: 0\n\
             occupied_thresh: 0.65\nfree_thresh: 0.196\n"
        );
        let image = image::ImageReader::open(folder.path().join("floor.png")).unwrap();
        assert_eq!(image.decode().unwrap().to_luma8().as_raw(), &[254, 0, 205]);
    }

    #[test]
    fn a_folder_that_is_not_there_is_named() {
        let error = save(&grid(&[0, 0, 0]), "no/such/folder/floor.yaml").unwrap_err();
        assert_eq!(error.to_string(), "cannot write no/such/folder/floor.png");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn every_map_survives_saving_and_loading(
            width in 1usize..20, height in 1usize..20, trinary in any::<bool>(),
            seeds in prop::collection::vec(any::<u8>(), 400),
            resolution in 0.001..10.0f64,
            x in -1e8..1e8f64, y in -1e8..1e8f64, yaw in -TAU..TAU,
        ) {
            let cell = |seed: &u8| match seed {
                seed if trinary => [0, 100, UNKNOWN][usize::from(seed % 3)],
                0..=100 => *seed,
                _ => UNKNOWN,
            };
            let cells = seeds[..width * height].iter().map(cell).collect();
            let map = OccupancyGrid::from_parts(
                width as u32, height as u32, resolution, Pose::new(x, y, yaw), cells,
            ).unwrap();
            let folder = TempDir::new().unwrap();
            let path = folder.path().join("floor.yaml");
            save(&map, &path).unwrap();
            prop_assert_eq!(load(&path).unwrap(), map);
        }
    }
}
