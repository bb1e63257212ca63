//! An encoded message: made on one thread, written on another.

use std::borrow::Cow;

use ros::{RosMessage, cdr};

use crate::RecordingError;

/// A message that is encoded but not yet written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Encoded {
    pub topic: Cow<'static, str>,
    pub schema: &'static str,
    pub definition: &'static str,
    /// True if late joiners get the newest message, as on `/map`: it is repeated at the start of
    /// each part of a split recording.
    pub latched: bool,
    /// Time of recording, in nanoseconds since 1970.
    pub log_time_ns: i64,
    pub body: Vec<u8>,
}

impl Encoded {
    /// Encodes a message of a topic that is not latched.
    pub fn new<M: RosMessage>(
        topic: impl Into<Cow<'static, str>>,
        log_time_ns: i64,
        message: &M,
    ) -> Result<Self, RecordingError> {
        let topic = topic.into();
        let body = cdr::encode(message).map_err(|error| RecordingError::Write {
            reason: format!("{topic} at {log_time_ns} ns: {error}"),
        })?;
        Ok(Encoded {
            topic,
            schema: M::SCHEMA,
            definition: M::DEFINITION,
            latched: false,
            log_time_ns,
            body,
        })
    }

    /// Same as [`Encoded::new`], for a latched topic.
    pub fn latched<M: RosMessage>(
        topic: impl Into<Cow<'static, str>>,
        log_time_ns: i64,
        message: &M,
    ) -> Result<Self, RecordingError> {
        Ok(Encoded {
            latched: true,
            ..Encoded::new(topic, log_time_ns, message)?
        })
    }
}
