//! Renders a scene as a PNG file.

use anyhow::Context;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use crate::drawing::encoding::{NOT_ENCODED, encoded};
use crate::drawing::{Scene, to_svg};

/// Encodes a PNG file with one pixel per unit of the scene.
pub fn to_png(scene: &Scene) -> anyhow::Result<Vec<u8>> {
    let pixels = pixels(scene)?;
    let rgb = pixels.pixels().iter();
    let rgb: Vec<u8> = rgb.flat_map(|p| [p.red(), p.green(), p.blue()]).collect();
    encoded((scene.width(), scene.height()), &rgb).context(NOT_ENCODED)
}

/// Renders one pixel per unit of the scene; all are opaque.
pub(crate) fn pixels(scene: &Scene) -> anyhow::Result<Pixmap> {
    const NOT_RENDERED: &str = "the picture cannot be rendered";
    let tree = Tree::from_str(&to_svg(scene), &Options::default()).context(NOT_RENDERED)?;
    let mut pixels = Pixmap::new(scene.width(), scene.height()).context(NOT_RENDERED)?;
    resvg::render(&tree, Transform::identity(), &mut pixels.as_mut());
    Ok(pixels)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use png::ColorType;

    use super::*;
    use crate::drawing::scene::tests::{RED, everything};
    use crate::drawing::{Anchor, Path, Rect, Stroke, TextStyle};

    /// Sides of a PNG file, and red, green and blue of its pixels.
    fn decoded(bytes: &[u8]) -> ((u32, u32), Vec<u8>) {
        let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!(info.color_type, ColorType::Rgb);
        ((info.width, info.height), pixels)
    }

    #[test]
    fn each_item_colours_the_pixels_that_it_covers() {
        let (sides, pixels) = decoded(&to_png(&everything()).unwrap());
        assert_eq!(sides, (40, 30));
        let at = |x: usize, y: usize| pixels[3 * (40 * y + x)..].first_chunk::<3>().unwrap();
        let (white, red, blue) = (&[255; 3], &[255, 0, 0], &[0, 0, 255]);
        assert_eq!((at(5, 5), at(12, 5)), (red, white));
        assert_eq!((at(19, 15), at(20, 15), at(22, 15)), (blue, blue, white));
        assert_eq!((at(27, 5), at(28, 5), at(28, 9)), (red, blue, white));
        // Half red on white; nothing outside the clip.
        assert_eq!((at(32, 22), at(28, 22)), (&[255, 127, 127], white));
    }

    #[test]
    fn letters_lie_within_their_labels() {
        for anchor in [Anchor::Start, Anchor::Middle, Anchor::End] {
            let style = TextStyle::new(40.0, RED).anchored(anchor);
            let mut scene = Scene::new(200, 200, "").unwrap();
            scene.text("EM", (100.0, 60.0), &style);
            scene.text_upwards("EM", (60.0, 130.0), &style);
            let pixels = pixels(&scene).unwrap();
            let red = (0..200).flat_map(|y| (0..200).map(move |x| (x, y)));
            let red = red.filter(|&(x, y)| pixels.pixel(x, y).unwrap().green() == 0);
            let found = red.map(|(x, y)| {
                let pixel = Rect::new(x.into(), y.into(), 1.0, 1.0);
                let label = scene.labels().iter().position(|l| l.area.holds(&pixel));
                label.unwrap_or_else(|| panic!("{anchor:?} {pixel:?}"))
            });
            let found: Vec<usize> = found.collect();
            let upwards = found.iter().sum::<usize>();
            // A fifth of an area of 59 by 29 pixels.
            assert!(upwards > 340, "{upwards}");
            assert!(found.len() - upwards > 340, "{found:?}");
        }
    }

    #[test]
    fn what_is_not_finite_is_not_drawn() {
        let mut scene = Scene::new(4, 4, "").unwrap();
        scene.fill(Path::circle((f64::NAN, 2.0), 9.0), RED);
        let line = Path::line((0.0, 0.0), (f64::INFINITY, 4.0));
        scene.stroke(line, Stroke::new(RED, 2.0));
        let (_, pixels) = decoded(&to_png(&scene).unwrap());
        assert!(pixels.iter().all(|&channel| channel == 255));
    }
}
