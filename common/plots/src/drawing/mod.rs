//! Pictures: a scene of shapes, images and text, written as PNG or as SVG.
//!
//! ```text
//! path, text ─ scene ─ to_svg ─┬─ to_png
//!                              └─ to_animated_png
//! ```
//!
//! PNG files are rendered from the SVG, so they look the same. Letters are outlines of an embedded
//! font: nothing has to be installed to create or view a picture, and an SVG contains no text that
//! could render differently. Coordinates are pixels from the upper left corner, y downwards.
//!
//! It is independent of maps, robots and files.

mod animation;
mod color;
mod encoding;
mod path;
mod raster;
mod scene;
mod text;
mod vector;

pub use animation::{Frame, to_animated_png};
pub use color::Color;
pub use path::{Path, Rect};
pub use raster::to_png;
pub use scene::{Scene, to_svg};
pub use text::{Anchor, TextStyle};
pub use vector::Stroke;
