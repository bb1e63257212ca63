//! The type of a topic or service.

use std::fmt;

/// A type, as all middlewares name it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct TypeInfo {
    /// As `std_msgs::msg::dds_::String_`.
    pub(super) name: String,
    /// As `RIHS01_` and 64 digits.
    pub(super) hash: String,
}

impl fmt::Display for TypeInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.name, self.hash)
    }
}
