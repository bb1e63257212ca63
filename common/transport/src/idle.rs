//! Work of the event loop for idle publishers: iceoryx2 connects a publisher with new subscribers,
//! and delivers the sample that it keeps, only when the publisher is used.

use std::cell::RefCell;
use std::rc::Weak;

use crate::TransportError;

/// A publisher as seen by the event loop.
pub(crate) trait Connects {
    /// Connects with new subscribers; if the topic is latched, sends them the newest sample.
    fn serve_late_joiners(&self) -> Result<(), TransportError>;
}

/// The living publishers of one process.
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
