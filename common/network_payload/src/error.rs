//! Reasons to reject a payload.
//!
//! Each variant says what was found and what is allowed.

/// Error of decoding or encoding a payload.
#[derive(Debug, thiserror::Error)]
pub enum WireError {
    /// The payload has another schema or version, or none.
    #[error("the payload is {found:?}: on topic {topic} allowed is {expected:?}")]
    Encoding {
        topic: &'static str,
        /// Encoding given by the sender, cut to its first characters.
        found: String,
        /// Encoding of this topic.
        expected: String,
    },
    /// The payload has more bytes than allowed on this topic.
    #[error("{found} bytes on topic {topic}: allowed are at most {most}")]
    TooLong {
        topic: &'static str,
        /// Size found, in bytes.
        found: usize,
        /// Largest size allowed, in bytes.
        most: usize,
    },
    /// The payload is not a zstd frame, or unpacks to more than allowed.
    #[error("topic {topic} does not unpack to at most {most} bytes")]
    Compression {
        topic: &'static str,
        /// Largest size allowed, in bytes.
        most: usize,
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The payload does not match its schema.
    #[error("topic {topic} does not match its postcard schema")]
    Postcard {
        topic: &'static str,
        source: postcard::Error,
    },
    /// Bytes follow the message.
    #[error("{found} bytes follow the message on topic {topic}: allowed is none")]
    Trailing {
        topic: &'static str,
        /// Number of these bytes.
        found: usize,
    },
    /// A field is out of its range or contradicts another one.
    #[error("topic {topic}: {field} is {found}, but must be {allowed}")]
    Field {
        topic: &'static str,
        /// Name of the field.
        field: &'static str,
        found: String,
        /// Description of the allowed values.
        allowed: String,
    },
    /// The name of a robot or a map is invalid.
    #[error("{found:?} is not a name: allowed are 1 to {most} of a-z A-Z 0-9 - _ .", most = crate::MAX_NAME_BYTES)]
    Name {
        /// Text as found.
        found: String,
    },
    /// The name is reserved.
    #[error("{found:?} is taken: a robot needs another name")]
    Taken {
        /// Text as found.
        found: String,
    },
}
