//! Renders a scene as pixels.

use tiny_skia::{
    FillRule, FilterQuality, LineCap, LineJoin, Mask, Paint, PathBuilder, Pixmap, PixmapPaint,
    StrokeDash, Transform,
};

use crate::path::Piece;
use crate::scene::Item;
use crate::{Color, DrawingError, Image, Path, Rect, Scene, Stroke};

/// Encodes a PNG file with one pixel per unit of the scene.
///
/// # Errors
/// The pixels cannot be allocated, or the encoder fails.
pub fn to_png(scene: &Scene) -> Result<Vec<u8>, DrawingError> {
    pixels(scene)?.to_png()
}

/// Renders one pixel per unit of the scene.
///
/// # Errors
/// The pixels cannot be allocated.
pub(crate) fn pixels(scene: &Scene) -> Result<Image, DrawingError> {
    let (width, height) = (scene.width(), scene.height());
    let mut pixmap = Pixmap::new(width, height).ok_or(DrawingError::Size { width, height })?;
    draw(&mut pixmap, scene.items(), None);
    Image::new(width, height, pixmap.take_demultiplied())
}

fn draw(pixmap: &mut Pixmap, items: &[Item], mask: Option<&Mask>) {
    for item in items {
        match item {
            Item::Fill(path, color) => fill(pixmap, path, *color, mask),
            Item::Stroke(path, stroke) => draw_lines(pixmap, path, stroke, mask),
            Item::Image(image, over) => draw_image(pixmap, image, *over, mask),
            Item::Clip(area, items) => {
                if let Some(mask) = clipped(pixmap, *area, mask) {
                    draw(pixmap, items, Some(&mask));
                }
            }
        }
    }
}

fn fill(pixmap: &mut Pixmap, path: &Path, color: Color, mask: Option<&Mask>) {
    if let Some(path) = built(path) {
        let rule = FillRule::Winding;
        pixmap.fill_path(&path, &paint(color), rule, Transform::identity(), mask);
    }
}

fn draw_lines(pixmap: &mut Pixmap, path: &Path, stroke: &Stroke, mask: Option<&Mask>) {
    let Some(path) = built(path) else { return };
    let dash = stroke.dash as f32;
    let how = tiny_skia::Stroke {
        width: stroke.width as f32,
        line_cap: LineCap::Round,
        line_join: LineJoin::Round,
        // No dashes for a length of 0, for which this is `None`.
        dash: StrokeDash::new(vec![dash, dash], 0.0),
        ..tiny_skia::Stroke::default()
    };
    let paint = paint(stroke.color);
    pixmap.stroke_path(&path, &paint, &how, Transform::identity(), mask);
}

fn draw_image(pixmap: &mut Pixmap, image: &Image, over: Rect, mask: Option<&Mask>) {
    let Some(mut source) = Pixmap::new(image.width(), image.height()) else {
        return;
    };
    for (pixel, rgba) in source
        .pixels_mut()
        .iter_mut()
        .zip(image.rgba().chunks_exact(4))
    {
        if let &[red, green, blue, opacity] = rgba {
            *pixel = tiny_skia::ColorU8::from_rgba(red, green, blue, opacity).premultiply();
        }
    }
    let scale_x = over.width / f64::from(image.width());
    let scale_y = over.height / f64::from(image.height());
    let place = Transform::from_row(
        scale_x as f32,
        0.0,
        0.0,
        scale_y as f32,
        over.x as f32,
        over.y as f32,
    );
    let how = PixmapPaint {
        quality: FilterQuality::Nearest,
        ..PixmapPaint::default()
    };
    pixmap.draw_pixmap(0, 0, source.as_ref(), &how, place, mask);
}

/// Mask for `area` within the existing mask.
fn clipped(pixmap: &Pixmap, area: Rect, mask: Option<&Mask>) -> Option<Mask> {
    let path = built(&Path::rect(area))?;
    let rule = FillRule::Winding;
    match mask {
        Some(mask) => {
            let mut mask = mask.clone();
            mask.intersect_path(&path, rule, true, Transform::identity());
            Some(mask)
        }
        None => {
            let mut mask = Mask::new(pixmap.width(), pixmap.height())?;
            mask.fill_path(&path, rule, true, Transform::identity());
            Some(mask)
        }
    }
}

fn paint(color: Color) -> Paint<'static> {
    let mut paint = Paint::default();
    let opacity = (255.0 * color.opacity).round() as u8;
    paint.set_color_rgba8(color.red, color.green, color.blue, opacity);
    paint
}

/// Converts to the library's path; `None` if it is empty or not finite.
fn built(path: &Path) -> Option<tiny_skia::Path> {
    let mut builder = PathBuilder::new();
    let single = |(x, y): (f64, f64)| (x as f32, y as f32);
    for piece in &path.pieces {
        match *piece {
            Piece::Move(to) => {
                let (x, y) = single(to);
                builder.move_to(x, y);
            }
            Piece::Line(to) => {
                let (x, y) = single(to);
                builder.line_to(x, y);
            }
            Piece::Quadratic(handle, to) => {
                let ((x1, y1), (x, y)) = (single(handle), single(to));
                builder.quad_to(x1, y1, x, y);
            }
            Piece::Cubic(first, second, to) => {
                let ((x1, y1), (x2, y2), (x, y)) = (single(first), single(second), single(to));
                builder.cubic_to(x1, y1, x2, y2, x, y);
            }
            Piece::Close => builder.close(),
        }
    }
    builder.finish()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::TextStyle;
    use crate::image::tests::decode;

    const RED: Color = Color::rgb(0xFF_0000);
    const BLUE: Color = Color::rgb(0x00_00FF);

    /// A scene with one item of each kind.
    pub(crate) fn everything() -> Scene {
        let mut scene = Scene::new(40, 30, "a <title>", Color::WHITE).unwrap();
        scene.fill(Path::rect(Rect::new(0.0, 0.0, 10.0, 10.0)), RED);
        let line = Path::line((20.0, 0.0), (20.0, 30.0));
        scene.stroke(line, Stroke::new(BLUE, 2.0));
        let image = Image::from_pixels(2, 1, |x, _| [RED, BLUE][x as usize]).unwrap();
        scene.image(image, Rect::new(24.0, 4.0, 8.0, 4.0));
        scene.clipped(Rect::new(30.0, 20.0, 5.0, 5.0), |scene| {
            scene.fill(Path::circle((32.0, 22.0), 20.0), RED.with_opacity(0.5));
        });
        scene.text("E", (2.0, 28.0), &TextStyle::new(16.0, BLUE).bold());
        scene
    }

    fn pixel(pixels: &[u8], x: usize, y: usize) -> [u8; 3] {
        std::array::from_fn(|channel| pixels[3 * (40 * y + x) + channel])
    }

    #[test]
    fn each_item_colours_the_pixels_that_it_covers() {
        let (size, pixels, samples) = decode(&to_png(&everything()).unwrap());
        assert_eq!((size, samples), ((40, 30), 3));
        let at = |x, y| pixel(&pixels, x, y);
        let (white, red, blue) = ([255; 3], [255, 0, 0], [0, 0, 255]);
        assert_eq!((at(5, 5), at(12, 5)), (red, white));
        assert_eq!((at(19, 15), at(20, 15), at(22, 15)), (blue, blue, white));
        assert_eq!((at(25, 5), at(30, 5), at(30, 9)), (red, blue, white));
        // Half red on white; nothing outside the clip.
        assert_eq!((at(32, 22), at(28, 22)), ([255, 127, 127], white));
        let letter = (2..14).flat_map(|x| (16..28).map(move |y| (x, y)));
        assert!(letter.filter(|&(x, y)| at(x, y) == blue).count() > 20);
    }

    #[test]
    fn what_is_not_finite_is_not_drawn() {
        let mut scene = Scene::new(4, 4, "", Color::WHITE).unwrap();
        scene.fill(Path::circle((f64::NAN, 2.0), 9.0), RED);
        let line = Path::line((0.0, 0.0), (f64::INFINITY, 4.0));
        scene.stroke(line, Stroke::new(RED, 2.0));
        let (_, pixels, _) = decode(&to_png(&scene).unwrap());
        assert!(pixels.iter().all(|&channel| channel == 255));
    }
}
