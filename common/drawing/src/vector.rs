//! Encodes a scene as SVG.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use svg::Document;
use svg::node::element::path::Data;
use svg::node::element::{
    ClipPath, Group, Image as ImageElement, Path as PathElement, Rectangle, Title,
};

use crate::path::Piece;
use crate::scene::Item;
use crate::{Color, DrawingError, Path, Rect, Scene};

/// Encodes an SVG file without external references.
///
/// # Errors
/// An image cannot be encoded.
pub fn to_svg(scene: &Scene) -> Result<String, DrawingError> {
    let (width, height) = (scene.width(), scene.height());
    let mut all = Group::new();
    let mut clips = 0;
    for item in scene.items() {
        all = add(all, item, &mut clips)?;
    }
    let document = Document::new()
        .set("width", width)
        .set("height", height)
        .set("viewBox", (0, 0, width, height))
        .add(Title::new(scene.title()))
        .add(all);
    Ok(format!("{document}\n"))
}

fn add(group: Group, item: &Item, clips: &mut u32) -> Result<Group, DrawingError> {
    Ok(match item {
        Item::Fill(path, color) => {
            let element = PathElement::new().set("d", data(path));
            group.add(colored(element, "fill", *color))
        }
        Item::Stroke(path, stroke) => {
            let mut element = PathElement::new()
                .set("d", data(path))
                .set("fill", "none")
                .set("stroke-width", rounded(stroke.width))
                .set("stroke-linecap", "round")
                .set("stroke-linejoin", "round");
            if stroke.dash > 0.0 {
                element = element.set("stroke-dasharray", rounded(stroke.dash));
            }
            group.add(colored(element, "stroke", stroke.color))
        }
        Item::Image(image, over) => {
            let bytes = STANDARD.encode(image.to_png()?);
            let element = ImageElement::new()
                .set("x", rounded(over.x))
                .set("y", rounded(over.y))
                .set("width", rounded(over.width))
                .set("height", rounded(over.height))
                .set("preserveAspectRatio", "none")
                .set("image-rendering", "pixelated")
                .set("href", format!("data:image/png;base64,{bytes}"));
            group.add(element)
        }
        Item::Clip(area, items) => {
            *clips += 1;
            let name = format!("clip{clips}");
            let mut inside = Group::new().set("clip-path", format!("url(#{name})"));
            for item in items {
                inside = add(inside, item, clips)?;
            }
            let clip = ClipPath::new().set("id", name).add(rectangle(*area));
            group.add(clip).add(inside)
        }
    })
}

fn rectangle(area: Rect) -> Rectangle {
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

fn data(path: &Path) -> Data {
    let mut data = Data::new();
    let at = |(x, y): (f64, f64)| (rounded(x), rounded(y));
    for piece in &path.pieces {
        data = match *piece {
            Piece::Move(to) => data.move_to(at(to)),
            Piece::Line(to) => data.line_to(at(to)),
            Piece::Quadratic(handle, to) => {
                let ((x1, y1), (x, y)) = (at(handle), at(to));
                data.quadratic_curve_to((x1, y1, x, y))
            }
            Piece::Cubic(first, second, to) => {
                let ((x1, y1), (x2, y2), (x, y)) = (at(first), at(second), at(to));
                data.cubic_curve_to((x1, y1, x2, y2, x, y))
            }
            Piece::Close => data.close(),
        };
    }
    data
}

/// Rounds to a hundredth of a pixel, which keeps files small.
fn rounded(value: f64) -> f32 {
    ((value * 100.0).round() / 100.0) as f32
}

#[cfg(test)]
mod tests {
    use svg::parser::Event;

    use super::*;
    use crate::image::tests::decode;
    use crate::raster::tests::everything;

    #[test]
    fn the_file_holds_each_item_and_reads_back() {
        let text = to_svg(&everything()).unwrap();
        let mut names = Vec::new();
        let mut image = None;
        for event in svg::read(&text).unwrap() {
            match event {
                Event::Tag(name, kind, attributes)
                    if kind != svg::node::element::tag::Type::End =>
                {
                    if let Some(href) = attributes.get("href") {
                        image = Some(href.to_string());
                    }
                    names.push(name);
                }
                Event::Error(error) => panic!("{error}"),
                _ => {}
            }
        }
        let expected = [
            "svg", "title", "g", "path", "path", "path", "image", "clipPath", "rect", "g", "path",
            "path",
        ];
        assert_eq!(names, expected);
        let image = image.unwrap();
        let encoded = image.strip_prefix("data:image/png;base64,").unwrap();
        let (size, pixels, _) = decode(&STANDARD.decode(encoded).unwrap());
        assert_eq!((size, pixels), ((2, 1), vec![255, 0, 0, 0, 0, 255]));
        assert!(text.contains("a &lt;title&gt;"), "{text}");
        assert!(
            text.contains(r##"fill="#ff0000" fill-opacity="0.5""##),
            "{text}"
        );
    }

    #[test]
    fn the_same_scene_is_the_same_text() {
        assert_eq!(
            to_svg(&everything()).unwrap(),
            to_svg(&everything()).unwrap()
        );
    }
}
