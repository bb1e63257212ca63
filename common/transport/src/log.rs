//! Routes iceoryx2's log to `tracing` instead of the console.

use std::fmt::Arguments;

use iceoryx2::prelude::{LogLevel, set_log_level, set_logger};
use iceoryx2_log::Log;
use tracing::level_filters::LevelFilter;

struct ToTracing;

impl Log for ToTracing {
    fn log(&self, level: LogLevel, origin: Arguments, message: Arguments) {
        // The origin is a dump of whole structures, useful to developers only.
        match level {
            LogLevel::Trace => tracing::trace!(target: "iceoryx2", %origin, "{message}"),
            LogLevel::Debug => tracing::debug!(target: "iceoryx2", %origin, "{message}"),
            LogLevel::Info => tracing::info!(target: "iceoryx2", "{message}"),
            LogLevel::Warn => tracing::warn!(target: "iceoryx2", "{message}"),
            LogLevel::Error | LogLevel::Fatal => tracing::error!(target: "iceoryx2", "{message}"),
        }
    }
}

/// Routes iceoryx2's messages to `tracing`, at the level that is enabled there.
pub(crate) fn route_to_tracing() {
    set_logger(&ToTracing);
    set_log_level(match LevelFilter::current() {
        LevelFilter::TRACE => LogLevel::Trace,
        LevelFilter::DEBUG => LogLevel::Debug,
        LevelFilter::INFO => LogLevel::Info,
        LevelFilter::WARN => LogLevel::Warn,
        LevelFilter::ERROR => LogLevel::Error,
        _ => LogLevel::Fatal,
    });
}
