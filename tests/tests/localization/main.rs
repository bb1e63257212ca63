//! Whether the robot is found: by the engine, the tools and the graph, on buildings that
//! are drawn, simulated and recorded.

mod any_sensor;
mod broken_recordings;
mod corridor;
mod evaluation;
mod floors;
mod hard_cases;
mod lost_searches;
mod many_maps;
mod reference;
mod side_by_side;
mod starting_over;
mod tracking;
