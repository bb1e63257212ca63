//! Interface of a topic to the event loop.

use std::rc::Rc;

use transport::{Graph, Input};
use zenoh_session::Report;

use crate::BridgeError;

/// One topic, sent or received.
pub(crate) trait Route {
    fn input(&self) -> Option<Rc<dyn Input>>;
    fn step(&mut self, graph: &Graph, tick: bool, report: &mut Report) -> Result<(), BridgeError>;
}
