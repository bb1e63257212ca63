//! Services: types of request and response.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// A service type. A struct without fields has one field of 8 bits, as in ROS.
pub trait RosService {
    /// Name, such as `std_srvs/srv/Empty`.
    const NAME: &'static str;
    type Request: DeserializeOwned;
    type Response: Serialize;
}

/// A request or response without fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Nothing {
    structure_needs_at_least_one_member: u8,
}

declare! {
    service Empty = "std_srvs/srv/Empty": Nothing -> Nothing;
}
