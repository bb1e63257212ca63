//! Error of a message with invalid values.

/// A message that decodes, but has invalid values: the text says what was found and what is
/// allowed.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct ConversionError(pub String);
