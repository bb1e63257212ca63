//! Counts samples that were lost because shared memory was full, in the node's health, and logs
//! when losses begin and end.

use std::cell::{Cell, RefCell};
use std::rc::Rc;

use crate::TransportError;

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

    pub(crate) fn reason(&self) -> String {
        self.0.reason.borrow().clone()
    }

    pub(crate) fn add(&self, why: &TransportError) {
        self.0.count.set(self.count() + 1);
        self.0.reason.replace(why.to_string());
    }
}
