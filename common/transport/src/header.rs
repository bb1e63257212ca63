//! The user header of a sample: a topic's own header without any additions.

use iceoryx2::prelude::ZeroCopySend;
use messages::Message;

/// A topic's header with a default of zeros for each loan, and the layout and type name of the
/// header itself.
#[derive(Debug, Clone, Copy)]
#[repr(transparent)]
pub(crate) struct Header<H>(pub(crate) H);

impl<H: Message> Default for Header<H> {
    fn default() -> Self {
        Header(bytemuck::Zeroable::zeroed())
    }
}

// SAFETY: transparent over `H`, which is itself self-contained and `repr(C)`.
unsafe impl<H: Message> ZeroCopySend for Header<H> {
    unsafe fn type_name() -> &'static str {
        // SAFETY: the layout is that of `H`, so its name promises nothing more.
        unsafe { <H as ZeroCopySend>::type_name() }
    }
}
