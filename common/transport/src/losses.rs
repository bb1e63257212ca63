//! Samples that were not sent because shared memory was full.
//!
//! A node continues without them: whoever fills shared memory must not end a graph. They
//! are counted for the node's health and said once, when they begin and when they end.

use std::cell::{Cell, RefCell};
use std::rc::Rc;

use crate::TransportError;

/// What all publishers of one process have lost; a handle on it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Losses(Rc<Inner>);

#[derive(Debug, Default)]
struct Inner {
    count: Cell<u64>,
    reason: RefCell<String>,
}

impl Losses {
    /// How many samples, since the process joined.
    pub(crate) fn count(&self) -> u64 {
        self.0.count.get()
    }

    /// Why the last one was lost; empty where none was.
    pub(crate) fn reason(&self) -> String {
        self.0.reason.borrow().clone()
    }

    pub(crate) fn add(&self, why: &TransportError) {
        self.0.count.set(self.count() + 1);
        self.0.reason.replace(why.to_string());
    }
}
