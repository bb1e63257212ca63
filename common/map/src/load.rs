//! Loads a grid from a description and its image.

use std::fs::{self, File};
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use image::{DynamicImage, Rgba};

use crate::description::Description;
use crate::rules::{Pixel, Rules};
use crate::{MapError, MemoryLimit, OccupancyGrid, UnknownKey, check_kind, picture};

/// Largest size of a description in bytes; a valid one has a few hundred.
const MAX_DESCRIPTION_BYTES: u64 = 64 << 10;

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
    let file = open_image(&description, yaml)?;
    let image = picture::decode(BufReader::new(file), limit, &description.image)?;
    let (width, height) = (image.width(), image.height());
    let grid = OccupancyGrid::from_parts(
        width,
        height,
        description.resolution_m,
        description.map_from_grid,
        cells(image, description.rules),
    )?;
    limit.check_grid(&grid)?;
    Ok(grid)
}

fn open_image(description: &Description, yaml: &Path) -> Result<File, MapError> {
    let image = &description.image;
    let opened = || {
        // Opening a pipe without a writer would block forever.
        match fs::metadata(image)?.is_file() {
            true => File::open(image),
            false => Err(io::Error::new(
                io::ErrorKind::InvalidInput,
                "it is not a regular file",
            )),
        }
    };
    let (line, column) = description.image_named_at;
    opened().map_err(|source| MapError::Image {
        image: image.clone(),
        yaml: yaml.to_owned(),
        line,
        column,
        source,
    })
}

/// Returns the path of the image in the description at `yaml`; the image may be missing.
pub fn image_of(yaml: impl AsRef<Path>) -> Result<PathBuf, MapError> {
    let yaml = yaml.as_ref();
    Ok(Description::parse(&read_text(yaml)?, yaml)?.image)
}

/// Converts pixels to cells. Images run from the top down, grids from the lowest y up.
fn cells(image: DynamicImage, rules: Rules) -> Vec<u8> {
    // Nearly all maps are grey: they are not blown up to eight times their size.
    if let DynamicImage::ImageLuma8(grey) = image {
        let shades: [u8; 256] =
            std::array::from_fn(|shade| rules.occupancy(Pixel::grey(shade as u8)));
        let pixels = grey.rows().rev().flatten();
        return pixels
            .map(|pixel| shades[usize::from(pixel.0[0])])
            .collect();
    }
    let has_alpha = image.color().has_alpha();
    let pixels = image.into_rgba16();
    let cell = |&Rgba([red, green, blue, alpha]): &Rgba<u16>| {
        rules.occupancy(Pixel {
            colour: [red, green, blue],
            alpha: has_alpha.then_some(alpha),
        })
    };
    pixels.rows().rev().flatten().map(cell).collect()
}

pub(crate) fn read_text(yaml: &Path) -> Result<String, MapError> {
    check_kind(yaml)?;
    let unread = MapError::unread(yaml);
    let file = File::open(yaml).map_err(unread)?;
    let mut bytes = Vec::new();
    // One byte more than allowed detects a file that is too large, even without a known size.
    let mut most = file.take(MAX_DESCRIPTION_BYTES + 1);
    let found = most.read_to_end(&mut bytes).map_err(unread)? as u64;
    if found > MAX_DESCRIPTION_BYTES {
        let found = format!("has {found} bytes; at most {MAX_DESCRIPTION_BYTES} are allowed");
        return Err(MapError::invalid(yaml, found));
    }
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

#[cfg(test)]
mod tests {
    use std::fs;

    use geometry::Pose;
    use image::{GrayImage, ImageFormat};
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
        let mut png = io::Cursor::new(Vec::new());
        let black = GrayImage::new(2048, 2048);
        black.write_to(&mut png, ImageFormat::Png).unwrap();
        // Of the others only headers: a decoder would find no pixels.
        for image in [
            png.get_ref(),
            &b"P5 4096 4096 255\n"[..],
            b"P2 4096 4096 255\n",
        ] {
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
