//! `backcast plot`: pictures of a map, of a scan at its places, of its votes,
//! and of how far off the places are. PNG or SVG, by the name of the file.
//!
//! It asks the same engine as `locate` and judges nothing again. One file a
//! picture; those that are pure compute a scene from what they are given:
//!
//! ```text
//! command ─ subject ─┬─ scan ─────┐
//!                    ├─ field ────┤
//!                    ├─ surface ──┼─ drawing
//!                    ├─ animation ┤
//!                    └─ errors ───┘
//! map ───────────────── outline ──┘
//! ```
//!
//! `drive` is drawn by `backcast evaluate --sequence`, `curves`, `diagram` and
//! `places_on_map` by `backcast bench paper`.

mod animation;
mod axes;
mod command;
mod config;
mod curves;
mod diagram;
pub mod drawing;
mod drive;
mod errors;
mod extent;
mod field;
mod ground;
#[cfg(test)]
mod layout;
mod legend;
mod marks;
mod numbers;
mod outline;
mod page;
mod places;
mod places_on_map;
mod scale;
mod scan;
mod shapes;
mod subject;
mod surface;
#[cfg(test)]
mod tests;
mod theme;
mod view;

pub use command::{no_place, run, save_png};
pub use config::{Config, NOTES};
pub use curves::{Curve, CurvePoint, Curves, draw as draw_curves};
pub use diagram::{Arrow, Cell, Diagram, Panel, Role, draw as draw_diagram};
pub use drive::{Stop, draw as draw_drive};
pub use field::{Votes, draw as draw_votes};
pub use places_on_map::draw as draw_places;
pub use surface::draw as draw_surface;
