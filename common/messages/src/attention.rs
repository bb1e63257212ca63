//! Search requests of the tracker.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

use crate::Stamp;
#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;

/// The message of topic `attention`: requests a search of a scan.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("AttentionHeader/v1")
)]
#[repr(C)]
pub struct AttentionHeader {
    /// Stamp of the scan; with several lasers, of the first laser's scan.
    pub stamp: Stamp,
}
