//! Localization by the engine, the tools and the graph, in drawn, simulated and recorded buildings.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod any_sensor;
mod broken_recordings;
mod corridor;
mod evaluation;
mod floors;
mod hard_cases;
mod lost_searches;
mod many_maps;
mod starting_over;
mod tracking;
