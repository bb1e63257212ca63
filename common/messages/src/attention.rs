//! What the tracker wants searched.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

use crate::Stamp;
#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;

/// The message of topic `attention`: a scan that is to be searched.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("AttentionHeader/v1")
)]
#[repr(C)]
pub struct AttentionHeader {
    /// Of the scan; of the first laser's, where several are joined.
    pub stamp: Stamp,
}

#[cfg(test)]
mod tests {
    use super::*;
    crate::pin_layout!(AttentionHeader, size 24, align 8, { stamp: 0 });
}
