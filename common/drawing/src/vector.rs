//! Elements of SVG files.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use svg::Document;
use svg::node::element::{Image, Path as PathElement, Rectangle, Title};

use crate::path::rounded;
use crate::raster::encoded;
use crate::size::check_size;
use crate::{Color, DrawingError, Path, Rect, Scene, Stroke};

/// Encodes an SVG file without external references.
#[must_use]
pub fn to_svg(scene: &Scene) -> String {
    let (width, height) = (scene.width(), scene.height());
    let document = Document::new()
        .set("width", width)
        .set("height", height)
        .set("viewBox", (0, 0, width, height))
        .add(Title::new(scene.title()))
        .add(filled(Path::rect(scene.area()), Color::WHITE))
        .add(scene.items().clone());
    format!("{document}\n")
}

pub(crate) fn filled(path: Path, color: Color) -> PathElement {
    colored(PathElement::new().set("d", path.into_data()), "fill", color)
}

pub(crate) fn stroked(path: Path, stroke: Stroke) -> PathElement {
    let mut element = PathElement::new()
        .set("d", path.into_data())
        .set("fill", "none")
        .set("stroke-width", rounded(stroke.width))
        .set("stroke-linecap", "round")
        .set("stroke-linejoin", "round");
    if stroke.dash > 0.0 {
        element = element.set("stroke-dasharray", rounded(stroke.dash));
    }
    colored(element, "stroke", stroke.color)
}

/// An image from the opaque colour of each pixel.
///
/// # Errors
/// A side is below one pixel or too large, or the encoder fails.
pub(crate) fn picture(
    over: Rect,
    mut color: impl FnMut(u32, u32) -> Color,
) -> Result<Image, DrawingError> {
    let (width, height) = (over.width as u32, over.height as u32);
    check_size(width, height)?;
    let mut rgb = Vec::with_capacity(3 * width as usize * height as usize);
    for y in 0..height {
        for x in 0..width {
            let color = color(x, y);
            rgb.extend([color.red, color.green, color.blue]);
        }
    }
    let png = STANDARD.encode(encoded((width, height), &rgb)?);
    Ok(Image::new()
        .set("x", rounded(over.x))
        .set("y", rounded(over.y))
        .set("width", rounded(over.width))
        .set("height", rounded(over.height))
        .set("preserveAspectRatio", "none")
        .set("image-rendering", "pixelated")
        .set("href", format!("data:image/png;base64,{png}")))
}

pub(crate) fn rectangle(area: Rect) -> Rectangle {
    Rectangle::new()
        .set("x", rounded(area.x))
        .set("y", rounded(area.y))
        .set("width", rounded(area.width))
        .set("height", rounded(area.height))
}

fn colored(element: PathElement, attribute: &str, color: Color) -> PathElement {
    let Color {
        red,
        green,
        blue,
        opacity,
    } = color;
    let element = element.set(attribute, format!("#{red:02x}{green:02x}{blue:02x}"));
    if opacity < 1.0 {
        return element.set(format!("{attribute}-opacity"), rounded(opacity.into()));
    }
    element
}

#[cfg(test)]
mod tests {
    use svg::node::element::tag::Type;
    use svg::parser::Event;

    use super::*;
    use crate::scene::tests::everything;

    #[test]
    fn the_file_holds_each_item_and_reads_back() {
        let text = to_svg(&everything());
        let mut names = Vec::new();
        for event in svg::read(&text).unwrap() {
            match event {
                Event::Tag(name, kind, _) if kind != Type::End => names.push(name),
                Event::Error(error) => panic!("{error}"),
                _ => {}
            }
        }
        let expected = [
            "svg", "title", "path", "g", "path", "path", "image", "clipPath", "rect", "g", "path",
            "path",
        ];
        assert_eq!(names, expected);
        assert!(text.contains("a &lt;title&gt;"), "{text}");
        assert!(
            text.contains(r##"fill="#ff0000" fill-opacity="0.5""##),
            "{text}"
        );
        assert_eq!(text, to_svg(&everything()));
    }
}
