//! Re-exports of the iceoryx2 trait for types in shared memory, and of its derive macro, which adds
//! the versioned name of the type.

pub(crate) use iceoryx2_bb_derive_macros::ZeroCopySend;
pub(crate) use iceoryx2_bb_elementary_traits::zero_copy_send::ZeroCopySend;
