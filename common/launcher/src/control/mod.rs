//! `backcast status`, `stop`, `restart` and `logs`: control a running graph from another terminal.

mod command;
mod logs;
mod text;

pub use command::{RestartConfig, StatusConfig, StopConfig, restart, status, stop};
pub use logs::{LogLine, LogsConfig, logs};
