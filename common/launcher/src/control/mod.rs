//! `backcast status`, `stop`, `restart`, `record` and `logs`: control a running graph from another terminal.

mod command;
mod logs;
mod text;

pub use command::{
    OneGraph, RecordConfig, RestartConfig, StatusConfig, record, restart, status, stop,
};
pub use logs::{LogLine, LogsConfig, logs};
