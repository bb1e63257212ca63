//! Elements of SVG files.

use anyhow::Context;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use svg::node::element::{Image, Path as PathElement, Rectangle};

use crate::drawing::encoding::{NOT_ENCODED, check_size, encoded};
use crate::drawing::path::rounded;
use crate::drawing::{Color, Path, Rect};

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    pub color: Color,
    pub width: f64,
    /// Length of dashes and of gaps, in pixels; 0 draws a solid line.
    pub dash: f64,
}

impl Stroke {
    pub const fn new(color: Color, width: f64) -> Self {
        Stroke {
            color,
            width,
            dash: 0.0,
        }
    }
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
pub(crate) fn picture(
    over: Rect,
    mut color: impl FnMut(u32, u32) -> Color,
) -> anyhow::Result<Image> {
    let (width, height) = (over.width as u32, over.height as u32);
    check_size(width, height)?;
    let mut rgb = Vec::with_capacity(3 * width as usize * height as usize);
    for y in 0..height {
        for x in 0..width {
            let color = color(x, y);
            rgb.extend([color.red, color.green, color.blue]);
        }
    }
    let png = STANDARD.encode(encoded((width, height), &rgb).context(NOT_ENCODED)?);
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
    let [red, green, blue] = [color.red, color.green, color.blue];
    let element = element.set(attribute, format!("#{red:02x}{green:02x}{blue:02x}"));
    if color.opacity < 1.0 {
        return element.set(
            format!("{attribute}-opacity"),
            rounded(color.opacity.into()),
        );
    }
    element
}
