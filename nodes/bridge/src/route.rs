//! What the event loop does with each topic.

use std::rc::Rc;

use transport::{Graph, Input};
use zenoh_session::Report;

use crate::BridgeError;

/// One topic, out or in.
pub(crate) trait Route {
    fn input(&self) -> Option<Rc<dyn Input>>;
    fn step(&mut self, graph: &Graph, tick: bool, report: &mut Report) -> Result<(), BridgeError>;
}
