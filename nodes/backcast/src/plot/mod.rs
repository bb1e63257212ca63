//! `backcast plot`: pictures of a map, of a scan at its places, of its votes,
//! and of how far off the places are. PNG or SVG, by the name of the file.
//!
//! It asks the same engine as `locate` and judges nothing anew. One file a
//! picture; those that are pure compute a scene from what they are given:
//!
//! ```text
//! command ─ subject ─┬─ scan ─────┐
//!                    ├─ field ────┤
//!                    ├─ surface ──┼─ drawing
//!                    ├─ sheet ────┤
//!                    └─ errors ───┘
//! map ───────────────── outline ──┘
//! ```
//!
//! `difference` is drawn by `backcast regress`, `drive` by `backcast evaluate --sequence`.

mod axes;
mod chart;
mod command;
mod config;
mod curves;
mod difference;
mod drive;
mod errors;
mod extent;
mod field;
mod ground;
mod marks;
mod outline;
mod page;
mod places;
mod scale;
mod scan;
mod sheet;
mod subject;
mod surface;
mod theme;
mod view;

pub(crate) use command::run;
pub(crate) use config::{Config, NOTES};
pub(crate) use difference::{Contrast, draw as draw_contrast};
pub(crate) use drive::{Stop, draw as draw_drive};
