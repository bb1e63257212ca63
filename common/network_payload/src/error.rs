//! Reasons to reject a payload.
//!
//! Each variant says what was found and what is allowed.

/// A payload that cannot be used, or a message that cannot become one.
#[derive(Debug, thiserror::Error)]
pub enum WireError {
    /// Another schema, another version of it, or none.
    #[error("the payload is {found:?}: on topic {topic} allowed is {expected:?}")]
    Encoding {
        /// The topic.
        topic: &'static str,
        /// What the sender says it is, cut to a few words.
        found: String,
        /// What it should say.
        expected: String,
    },
    /// More bytes than a message of this topic can have.
    #[error("{found} bytes on topic {topic}: allowed are at most {most}")]
    TooLong {
        /// The topic.
        topic: &'static str,
        /// Bytes that came, or would have to be unpacked at least.
        found: usize,
        /// Most bytes.
        most: usize,
    },
    /// Not a zstd frame, or one that unpacks to more than a message can have.
    #[error("topic {topic} does not unpack to at most {most} bytes")]
    Compression {
        /// The topic.
        topic: &'static str,
        /// Most bytes.
        most: usize,
        /// What zstd says.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// Not what the encoding says.
    #[error("topic {topic} does not match its postcard schema")]
    Postcard {
        /// The topic.
        topic: &'static str,
        /// What postcard says.
        source: postcard::Error,
    },
    /// Bytes behind the message.
    #[error("{found} bytes follow the message on topic {topic}: allowed is none")]
    Trailing {
        /// The topic.
        topic: &'static str,
        /// How many.
        found: usize,
    },
    /// A field that is out of its range, or contradicts another one.
    #[error("topic {topic}: {field} is {found}, but must be {allowed}")]
    Field {
        /// The topic.
        topic: &'static str,
        /// The field.
        field: &'static str,
        /// What it holds.
        found: String,
        /// What it may hold.
        allowed: String,
    },
    /// No name for a robot or a map.
    #[error("{found:?} is not a name: allowed are 1 to {most} of a-z A-Z 0-9 - _ .", most = crate::MAX_NAME_BYTES)]
    Name {
        /// What was given.
        found: String,
    },
    /// A name that no robot may have.
    #[error("{found:?} is taken: a robot needs another name")]
    Taken {
        /// What was given.
        found: String,
    },
}
