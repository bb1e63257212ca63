//! Search requests of the tracker.

use crate::Stamp;

crate::message! {
    #[type_name("AttentionHeader/v1")]
    /// The message of topic `attention`: requests a search of a scan.
    pub struct AttentionHeader {
        /// Stamp of the scan; with several lasers, of the first laser's scan.
        pub stamp: Stamp,
    }
}
