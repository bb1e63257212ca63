//! Starts and controls a graph: `run` supervises the processes, `check` reports errors in the
//! descriptor, and `control` talks to a running launcher. Localizes nothing.

pub mod check;
pub mod control;
pub mod descriptor;
mod installed;
pub mod run;

pub use installed::node;

pub fn schemas() -> Vec<command_line::json::schema::Named> {
    use command_line::json::schema::of_object;

    vec![
        of_object::<answers::Row>("run"),
        of_object::<run::SummaryLine<'_>>("run_summary"),
        of_object::<run::control::Status>("status"),
        of_object::<control::LogLine>("logs"),
    ]
}
