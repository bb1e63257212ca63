//! Pictures: a scene of shapes, images and text, written as PNG or as SVG.
//!
//! ```text
//! path, text, image ─ scene ─┬─ to_png
//!                            ├─ to_animated_png
//!                            └─ to_svg
//! ```
//!
//! All come from the same items, so they show the same. Letters are outlines
//! of a font that is linked in: nothing has to be installed where a picture is
//! made or looked at, and an SVG holds no text that could come out otherwise.
//! Coordinates are pixels from the upper left corner, y downwards.
//!
//! The crate knows no map, robot or file. It draws with `tiny-skia` rather than
//! through a whole SVG renderer, which takes ten times as long to build.

mod animation;
mod color;
mod error;
mod image;
mod path;
mod raster;
mod scene;
mod size;
mod text;
mod vector;

pub use animation::{Frame, to_animated_png};
pub use color::Color;
pub use error::DrawingError;
pub use image::Image;
pub use path::{Path, Rect};
pub use raster::to_png;
pub use scene::{Label, Scene, Stroke};
pub use size::MAX_SIDE;
pub use text::{Anchor, TextStyle, Weight};
pub use vector::to_svg;
