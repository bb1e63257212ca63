//! Counts samples that were not sent because shared memory was full.
//!
//! A node continues without them, so that full shared memory does not end a graph. They are counted
//! in the node's health and logged twice: when losses begin and when they end.

use std::cell::{Cell, RefCell};
use std::rc::Rc;

use crate::TransportError;

/// Handle to the losses of all publishers of one process.
#[derive(Debug, Clone, Default)]
pub(crate) struct Losses(Rc<Inner>);

#[derive(Debug, Default)]
struct Inner {
    count: Cell<u64>,
    reason: RefCell<String>,
}

impl Losses {
    pub(crate) fn count(&self) -> u64 {
        self.0.count.get()
    }

    /// Reason of the last loss; empty without one.
    pub(crate) fn reason(&self) -> String {
        self.0.reason.borrow().clone()
    }

    pub(crate) fn add(&self, why: &TransportError) {
        self.0.count.set(self.count() + 1);
        self.0.reason.replace(why.to_string());
    }
}
