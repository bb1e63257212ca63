//! That iceoryx2 may put a type into shared memory: the trait, and what derives it with
//! the versioned name of the type.

pub(crate) use iceoryx2_bb_derive_macros::ZeroCopySend;
pub(crate) use iceoryx2_bb_elementary_traits::zero_copy_send::ZeroCopySend;
