//! `backcast status`, `stop`, `restart`, `record` and `logs`: control a running graph from another terminal.

mod command;
mod logs;
mod text;

pub use command::{
    RecordConfig, RestartConfig, StatusConfig, StopConfig, record, restart, status, stop,
};
pub use logs::{LogLine, LogsConfig, logs};
