//! Services: a request, and the response to it.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// A service type. A struct without fields has one of eight bits, as ROS gives it.
pub trait RosService {
    /// Its name, as `std_srvs/srv/Empty`.
    const NAME: &'static str;
    /// The request's fields, then those of each type used; see
    /// [`RosMessage::DEFINITION`](crate::RosMessage::DEFINITION).
    const REQUEST: &'static str;
    /// The response's.
    const RESPONSE: &'static str;
    /// The request.
    type Request: DeserializeOwned;
    /// The response.
    type Response: Serialize;
}

/// What has no fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Nothing {
    structure_needs_at_least_one_member: u8,
}

/// `std_srvs/srv/Empty`.
#[derive(Debug)]
pub enum Empty {}

impl RosService for Empty {
    const NAME: &'static str = "std_srvs/srv/Empty";
    const REQUEST: &'static str = "";
    const RESPONSE: &'static str = "";
    type Request = Nothing;
    type Response = Nothing;
}
