//! Request to save the last minutes.

use crate::Stamp;

crate::message! {
    #[type_name("SaveHeader/v1")]
    /// The message of topic `save`.
    #[derive(Eq)]
    pub struct SaveHeader {
        /// Time of the request; the counter counts the requests.
        pub stamp: Stamp,
    }
}
