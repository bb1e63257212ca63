//! The type of a topic or service.

use std::fmt;

/// Type name and hash, in the form that all middlewares use.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct TypeInfo {
    /// Name, such as `std_msgs::msg::dds_::String_`.
    pub(super) name: String,
    /// Hash: `RIHS01_` and 64 digits.
    pub(super) hash: String,
}

impl fmt::Display for TypeInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.name, self.hash)
    }
}
