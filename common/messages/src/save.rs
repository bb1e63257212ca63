//! Request to save the last minutes.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

use crate::Stamp;
#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;

/// The message of topic `save`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name("SaveHeader/v1"))]
#[repr(C)]
pub struct SaveHeader {
    /// Time of the request; the counter counts the requests.
    pub stamp: Stamp,
}
