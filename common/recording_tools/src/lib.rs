//! Tools for recordings: `info` lists the contents of a recording, `doctor` finds its faults,
//! `convert` converts other logs and bags, and `simulate` records a simulated drive.

pub mod convert;
pub mod doctor;
mod each;
pub mod info;
mod messages;
pub mod simulate;

/// Schemas of what the commands print.
pub fn schemas() -> Vec<command_line::json::schema::Named> {
    vec![
        command_line::json::schema::of_object::<info::Contents>("info"),
        command_line::json::schema::of_object::<doctor::Report>("doctor"),
    ]
}
