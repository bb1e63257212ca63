//! Reasons to reject a payload.
//!
//! Each variant says what was found and what is allowed.

#[derive(Debug, thiserror::Error)]
pub enum WireError {
    #[error("the payload is {found:?}: on topic {topic} allowed is {expected:?}")]
    Encoding {
        topic: &'static str,
        found: String,
        expected: String,
    },
    #[error("{found} bytes on topic {topic}: allowed are at most {most}")]
    TooLong {
        topic: &'static str,
        found: usize,
        most: usize,
    },
    #[error("topic {topic} does not unpack to at most {most} bytes")]
    Compression {
        topic: &'static str,
        most: usize,
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    #[error("topic {topic} does not match its postcard schema")]
    Postcard {
        topic: &'static str,
        source: postcard::Error,
    },
    #[error("{found} bytes follow the message on topic {topic}: allowed is none")]
    Trailing { topic: &'static str, found: usize },
    #[error("topic {topic}: {field} is {found}, but must be {allowed}")]
    Field {
        topic: &'static str,
        field: &'static str,
        found: String,
        allowed: String,
    },
    #[error("{found:?} is not a name: allowed are 1 to {most} of a-z A-Z 0-9 - _ .", most = crate::MAX_NAME_BYTES)]
    Name { found: String },
    #[error("{found:?} is taken: a robot needs another name")]
    Taken { found: String },
}
