//! A message as it will stand in a file: made on one thread, written on another.

use std::borrow::Cow;

use ros::{RosMessage, cdr};

use crate::RecordingError;

/// A message that is encoded but not yet written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Encoded {
    /// The channel.
    pub topic: Cow<'static, str>,
    /// The schema's name.
    pub schema: &'static str,
    /// The schema's text.
    pub definition: &'static str,
    /// Whether late joiners get the newest message, as of `/map`: it stands at
    /// the head of each part of a recording that is split.
    pub latched: bool,
    /// When it was recorded, nanoseconds since 1970.
    pub log_time_ns: i64,
    /// The message in CDR.
    pub body: Vec<u8>,
}

impl Encoded {
    /// Encodes a message of a topic that is not latched.
    ///
    /// # Errors
    /// If a text or a list of it is longer than CDR can say.
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

    /// As [`Encoded::new`], of a latched topic.
    ///
    /// # Errors
    /// As [`Encoded::new`].
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
