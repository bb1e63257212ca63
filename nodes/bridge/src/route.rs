//! Interface of a topic to the event loop.

use std::rc::Rc;

use transport::{Graph, Input};
use zenoh::Session;
use zenoh_session::Report;

use crate::{BridgeError, Config};

#[derive(Clone, Copy)]
pub(crate) struct Ends<'a> {
    pub(crate) graph: &'a Graph,
    pub(crate) session: &'a Session,
    pub(crate) robot: &'a str,
    pub(crate) config: &'a Config,
    pub(crate) sender: u64,
}

pub(crate) trait Route {
    /// Returns the input for the event loop, if it is a topic of the graph.
    fn input(&self) -> Option<Rc<dyn Input>> {
        None
    }

    /// Carries the messages since the last call.
    fn step(&mut self, graph: &Graph, tick: bool, report: &mut Report) -> Result<(), BridgeError>;
}
