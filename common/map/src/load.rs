//! Loads a grid from a description and its image.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::claim::HEAD_BYTES;
use crate::description::Description;
use crate::raster::Raster;
use crate::{MapError, MemoryLimit, OccupancyGrid, UnknownKey, check_kind, kind};

/// Largest size of a description in bytes; a valid one has a few hundred.
const MAX_DESCRIPTION_BYTES: u64 = 64 << 10;

/// Largest size of an image in bytes. 16-bit colour with alpha reaches it at 268 million cells.
const MAX_IMAGE_BYTES: u64 = 1 << 31;

/// Loads a map like `map_server`: the YAML file at `yaml`, and its image, whose name is relative to
/// the YAML file's folder.
pub fn load(yaml: impl AsRef<Path>) -> Result<OccupancyGrid, MapError> {
    load_within(MemoryLimit::NONE, yaml, |_| {})
}

/// Like [`load`], and calls `note` for each unknown key of the description, to be shown to the
/// user. Fails if the graph cannot hold the map, which is checked with the sides before memory is
/// allocated, and again with the cells to be searched.
///
/// # Errors
/// See [`load`]; also [`MapError::Memory`].
pub fn load_within(
    limit: MemoryLimit,
    yaml: impl AsRef<Path>,
    note: impl FnMut(&UnknownKey),
) -> Result<OccupancyGrid, MapError> {
    let yaml = yaml.as_ref();
    let text = read_text(yaml)?;
    let description = Description::parse(&text, yaml)?;
    description.unknown.iter().for_each(note);
    let bytes = read_image(&description.image, limit, unreadable(&description, yaml))?;
    let raster = kind::decode(&bytes, &description.image)?;
    drop(bytes);
    let grid = OccupancyGrid::from_parts(
        raster.width,
        raster.height,
        description.resolution_m,
        description.map_from_grid,
        cells(&raster, &description),
    )?;
    limit.check_grid(&grid)?;
    Ok(grid)
}

fn unreadable(description: &Description, yaml: &Path) -> impl Fn(io::Error) -> MapError {
    let (line, column) = description.image_named_at;
    move |source| MapError::Image {
        image: description.image.clone(),
        yaml: yaml.to_owned(),
        line,
        column,
        source,
    }
}

/// Returns the path of the image in the description at `yaml`; the image may be missing.
pub fn image_of(yaml: impl AsRef<Path>) -> Result<PathBuf, MapError> {
    let yaml = yaml.as_ref();
    Ok(Description::parse(&read_text(yaml)?, yaml)?.image)
}

/// Converts pixels to cells. Images run from the top down, grids from the lowest y up.
fn cells(raster: &Raster, description: &Description) -> Vec<u8> {
    let rules = description.rules;
    let rows = (0..raster.height).rev().map(|y| raster.row(y));
    rows.flatten().map(|pixel| rules.occupancy(pixel)).collect()
}

pub(crate) fn read_text(yaml: &Path) -> Result<String, MapError> {
    check_kind(yaml)?;
    let unread = MapError::unread(yaml);
    let file = File::open(yaml).map_err(unread)?;
    let mut bytes = Vec::new();
    read_rest(file, &mut bytes, MAX_DESCRIPTION_BYTES, yaml, unread)?;
    String::from_utf8(bytes).map_err(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = valid.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
        let column = valid
            .rsplit(|&byte| byte == b'\n')
            .next()
            .map_or(0, <[u8]>::len) as u64
            + 1;
        MapError::at(yaml, (line, column), "not UTF-8 text".to_owned())
    })
}

/// Reads an image, at most as many bytes as its header allows. The header is checked before memory
/// is allocated.
fn read_image(
    path: &Path,
    limit: MemoryLimit,
    unreadable: impl Fn(io::Error) -> MapError,
) -> Result<Vec<u8>, MapError> {
    let (file, mut bytes) = open_image(path, &unreadable)?;
    let claim = kind::claim(&bytes, path)?;
    limit.check(claim.sides)?;
    let allowed = claim.most_bytes.min(MAX_IMAGE_BYTES);
    read_rest(file, &mut bytes, allowed, path, unreadable)?;
    Ok(bytes)
}

fn open_image(
    path: &Path,
    unreadable: impl Fn(io::Error) -> MapError,
) -> Result<(File, Vec<u8>), MapError> {
    // Opening a pipe without a writer would block forever.
    if !fs::metadata(path).map_err(&unreadable)?.is_file() {
        let problem = io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file");
        return Err(unreadable(problem));
    }
    let mut file = File::open(path).map_err(&unreadable)?;
    let mut head = Vec::new();
    (&mut file)
        .take(HEAD_BYTES)
        .read_to_end(&mut head)
        .map_err(&unreadable)?;
    Ok((file, head))
}

/// Reads the rest of a file of which `bytes` are known, with at most `allowed` bytes in all.
fn read_rest(
    file: File,
    bytes: &mut Vec<u8>,
    allowed: u64,
    path: &Path,
    unreadable: impl Fn(io::Error) -> MapError,
) -> Result<(), MapError> {
    // Reading one byte more than allowed detects a file that is too large, even without a known
    // size.
    let rest = (allowed + 1).saturating_sub(bytes.len() as u64);
    file.take(rest).read_to_end(bytes).map_err(unreadable)?;
    let found = bytes.len() as u64;
    if found > allowed {
        let found = format!("has {found} bytes; at most {allowed} are allowed");
        return Err(MapError::invalid(path, found));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use geometry::Pose;
    use tempfile::TempDir;

    use super::*;
    use crate::{MemoryOptions, UNKNOWN};

    const YAML: &str = "image: floor.pgm\nresolution: 0.5\norigin: [1, 2, 0.25]\n\
                        negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

    fn folder(yaml: &str, name: &str, image: &[u8]) -> TempDir {
        let folder = TempDir::new().unwrap();
        fs::write(folder.path().join("floor.yaml"), yaml).unwrap();
        fs::write(folder.path().join(name), image).unwrap();
        folder
    }

    fn load_from(folder: &TempDir) -> Result<OccupancyGrid, MapError> {
        load(folder.path().join("floor.yaml"))
    }

    #[test]
    fn the_top_row_of_the_image_has_the_highest_y() {
        let image = b"P5 3 2 255\n\x00\xfe\xcd\xfe\xfe\x00";
        let map = load_from(&folder(YAML, "floor.pgm", image)).unwrap();
        assert_eq!((map.width, map.height, map.resolution_m), (3, 2, 0.5));
        assert_eq!(map.map_from_grid, Pose::new(1.0, 2.0, 0.25));
        assert_eq!(map.cells, [0, 0, 100, 100, 0, UNKNOWN]);
        // The image's top left pixel in the map frame.
        let (x, y) = map.cell_center(0, 1);
        let (sin, cos) = 0.25f64.sin_cos();
        // The tolerance covers the same sums in another order.
        assert!((x - (1.0 + 0.25 * cos - 0.75 * sin)).abs() < 1e-12);
        assert!((y - (2.0 + 0.25 * sin + 0.75 * cos)).abs() < 1e-12);
    }

    #[test]
    fn missing_files_are_named() {
        let nowhere = load("no/such.yaml").unwrap_err().to_string();
        assert_eq!(nowhere, "cannot read the map description no/such.yaml");
        let folder = folder(YAML, "other.pgm", b"P5 1 1 255\n\x00");
        let error = load_from(&folder).unwrap_err();
        let image = folder.path().join("floor.pgm");
        let yaml = folder.path().join("floor.yaml");
        assert_eq!(
            error.to_string(),
            format!(
                "cannot read the image {}, named by {}:1:8",
                image.display(),
                yaml.display()
            )
        );
        assert!(std::error::Error::source(&error).is_some(), "the system's");
    }

    #[test]
    fn a_map_that_the_graph_could_not_hold_is_refused_by_its_header() {
        let memory_limit = Some(100);
        let limit = MemoryOptions { memory_limit }.limit();
        // Only headers; a decoder would find no pixels.
        let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR".to_vec();
        png.extend([0, 0, 0x10, 0, 0, 0, 0x10, 0]);
        for image in [&png[..], b"P5 4096 4096 255\n", b"P2 4096 4096 255\n"] {
            let folder = folder(YAML, "floor.pgm", image);
            let path = folder.path().join("floor.yaml");
            let error = load_within(limit, path, |_| {}).unwrap_err();
            assert!(
                matches!(error, MapError::Memory { limit_mb: 100, .. }),
                "{error}"
            );
        }
        let folder = folder(YAML, "floor.pgm", b"P5 1 1 255\n\x00");
        assert!(load_within(limit, folder.path().join("floor.yaml"), |_| {}).is_ok());
    }

    #[test]
    fn a_description_that_is_no_text_is_refused() {
        let folder = folder(YAML, "floor.pgm", b"");
        let path = folder.path().join("floor.yaml");
        fs::write(&path, b"image: a\nmode: \xff").unwrap();
        let error = load(&path).unwrap_err();
        assert!(
            matches!(
                error,
                MapError::Yaml {
                    line: 2,
                    column: 7,
                    ..
                }
            ),
            "{error}"
        );
        fs::write(&path, vec![b'#'; MAX_DESCRIPTION_BYTES as usize + 1]).unwrap();
        let error = load(&path).unwrap_err().to_string();
        assert!(error.ends_with("at most 65536 are allowed"), "{error}");
        assert!(matches!(
            load(folder.path()),
            Err(MapError::Description { .. })
        ));
    }

    #[test]
    fn no_more_is_read_than_the_header_makes_room_for() {
        let refused = |image: &[u8]| {
            let folder = folder(YAML, "floor.pgm", image);
            load_from(&folder).unwrap_err().to_string()
        };
        let mut long = b"P5\n2 1\n255\n".to_vec();
        long.resize(1 << 20, 0);
        let error = refused(&long);
        assert!(error.contains("bytes; at most"), "{error}");
        let mut claims = b"P5\n32767 32767\n255\n".to_vec();
        claims.resize(1 << 20, 0);
        let error = refused(&claims);
        assert!(error.contains("claims 32767 x 32767"), "{error}");
        // Without an image format, only the first bytes are read.
        let error = refused(&vec![0; 1 << 20]);
        assert!(error.contains("at its start"), "{error}");
    }

    #[test]
    fn what_is_no_regular_file_is_not_opened() {
        let folder = folder(YAML, "other", b"");
        std::os::unix::fs::symlink("/dev/zero", folder.path().join("floor.pgm")).unwrap();
        let error = load_from(&folder).unwrap_err();
        let MapError::Image { source, .. } = &error else {
            panic!("{error}");
        };
        assert!(
            source.to_string().contains("not a regular file"),
            "{source}"
        );
    }
}
