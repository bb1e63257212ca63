//! Publishers whose newest sample late joiners get.
//!
//! iceoryx2 keeps that sample, but hands it out only when the publisher does
//! something. An idle publisher does nothing, so the event loop does it.

use std::cell::RefCell;
use std::rc::Weak;

use crate::TransportError;

/// What the event loop knows of a latched publisher.
pub(crate) trait Latched {
    /// Hands the newest sample to subscribers that came since the last call,
    /// and wakes them.
    fn serve_late_joiners(&self) -> Result<(), TransportError>;
}

/// The latched publishers of one process, as long as they live.
#[derive(Default)]
pub(crate) struct LatchedPublishers(RefCell<Vec<Weak<dyn Latched>>>);

impl LatchedPublishers {
    pub(crate) fn add(&self, publisher: Weak<dyn Latched>) {
        self.0.borrow_mut().push(publisher);
    }

    pub(crate) fn serve_late_joiners(&self) -> Result<(), TransportError> {
        let mut publishers = self.0.borrow_mut();
        publishers.retain(|publisher| publisher.strong_count() > 0);
        publishers
            .iter()
            .filter_map(Weak::upgrade)
            .try_for_each(|publisher| publisher.serve_late_joiners())
    }
}
