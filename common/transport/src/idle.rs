//! What the event loop does for publishers while they are idle.
//!
//! iceoryx2 connects a publisher with subscribers that came since, and hands
//! them the sample that it keeps, only when the publisher does something. An
//! idle publisher does nothing, so the event loop does it: late joiners of a
//! latched topic get the newest sample, and on the others the first sample does
//! not wait until connections stand.

use std::cell::RefCell;
use std::rc::Weak;

use crate::TransportError;

/// What the event loop knows of a publisher.
pub(crate) trait Connects {
    /// Connects with subscribers that came since the last call; hands them the
    /// newest sample and wakes them, if the topic is latched.
    fn serve_late_joiners(&self) -> Result<(), TransportError>;
}

/// The publishers of one process, as long as they live.
#[derive(Default)]
pub(crate) struct IdlePublishers(RefCell<Vec<Weak<dyn Connects>>>);

impl IdlePublishers {
    pub(crate) fn add(&self, publisher: Weak<dyn Connects>) {
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
