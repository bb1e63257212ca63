//! How large a map is, without its cells.

use std::path::Path;

use crate::description::Description;
use crate::load::{open_image, read_text, unreadable};
use crate::{MapError, kind};

/// The diagonal of a map, metres, by its description and the head of its image: for who has to
/// know it of maps that others hold.
///
/// # Errors
/// Says which file is not there, or what in it is not sound.
pub fn diagonal_m(yaml: impl AsRef<Path>) -> Result<f64, MapError> {
    let yaml = yaml.as_ref();
    let description = Description::parse(&read_text(yaml)?, yaml)?;
    let (_, head) = open_image(&description.image, unreadable(&description, yaml))?;
    let (width, height) = kind::claim(&head, &description.image)?.sides;
    Ok(f64::from(width).hypot(f64::from(height)) * description.resolution_m)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn it_is_known_by_the_head_of_the_image() {
        let folder = tempfile::tempdir().unwrap();
        let yaml = "image: floor.pgm\nresolution: 0.5\norigin: [1, 2, 0.25]\n\
                    negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
        let (path, image) = (
            folder.path().join("a.yaml"),
            folder.path().join("floor.pgm"),
        );
        fs::write(&path, yaml).unwrap();
        fs::write(&image, b"P5 30 40 255\n").unwrap();
        assert_eq!(diagonal_m(&path).unwrap(), 25.0);
        fs::remove_file(image).unwrap();
        assert!(matches!(diagonal_m(&path), Err(MapError::Image { .. })));
    }
}
