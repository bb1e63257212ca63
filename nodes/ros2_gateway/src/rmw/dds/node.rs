//! The gateway as a node that others see, and the nodes that it sees.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use rustdds::bytes::Bytes;
use rustdds::no_key::DataWriter;
use rustdds::{GUID, RTPSEntity};

use super::domain::Domain;
use super::entities::{self, Format, Gid};
use super::quality;
use super::raw::{Raw, fields};
use super::reader::Reader;
use crate::GatewayError;
use crate::rmw::Keeping;

/// Largest size of a participant's message about its nodes, bytes.
const MAX_INFO_BYTES: usize = 1 << 20;

/// Number of such messages that are queued until the next tick.
const MAX_INFOS: usize = 256;

/// Largest number of endpoints of others whose nodes are known; a large robot has some thousand.
const MAX_NAMES: usize = 16384;

/// The gateway's node, published until it is dropped.
pub(super) struct Node {
    participant: Gid,
    infos: Reader,
    writer: DataWriter<Bytes, Raw>,
    state: RefCell<State>,
}

struct State {
    own: entities::Node,
    /// Format of other nodes; nothing is published before it is known.
    format: Option<Format>,
    is_changed: bool,
    /// Names of nodes by endpoint.
    names: BTreeMap<Gid, String>,
}

/// An endpoint that others see as the node's, until this is dropped.
pub(super) struct Shown {
    node: Rc<Node>,
    gid: Gid,
}

impl Node {
    pub(super) fn open(domain: &Domain, namespace: &str, name: &str) -> Result<Self, GatewayError> {
        let (topic, kind) = (entities::TOPIC, entities::TYPE);
        let requested = quality::requested(Keeping::Kept, MAX_INFOS);
        let infos = domain.reader((topic, kind, topic), &requested, None, MAX_INFO_BYTES)?;
        let offered = quality::offered(Keeping::Kept, 1, false);
        let own = entities::Node {
            namespace: namespace.to_owned(),
            name: name.to_owned(),
            ..entities::Node::default()
        };
        Ok(Node {
            participant: domain.participant.guid().to_bytes(),
            infos,
            writer: domain.writer(topic, kind, &offered)?,
            state: RefCell::new(State {
                own,
                format: None,
                is_changed: true,
                names: BTreeMap::new(),
            }),
        })
    }

    pub(super) fn show_reader(self: &Rc<Self>, guid: GUID) -> Shown {
        self.show(guid, |own, gid| own.readers.push(gid))
    }

    pub(super) fn show_writer(self: &Rc<Self>, guid: GUID) -> Shown {
        self.show(guid, |own, gid| own.writers.push(gid))
    }

    fn show(self: &Rc<Self>, guid: GUID, push: impl FnOnce(&mut entities::Node, Gid)) -> Shown {
        let gid = guid.to_bytes();
        let mut state = self.state.borrow_mut();
        push(&mut state.own, gid);
        state.is_changed = true;
        let node = Rc::clone(self);
        Shown { node, gid }
    }

    /// Returns the node that an endpoint belongs to, if that is known.
    pub(super) fn name_of(&self, endpoint: GUID) -> Option<String> {
        self.state.borrow().names.get(&endpoint.to_bytes()).cloned()
    }

    /// Takes the messages of other nodes, and publishes changes of this one.
    pub(super) fn tick(&self) {
        let mut state = self.state.borrow_mut();
        while let Some(sample) = self.infos.next() {
            let info = sample.map_err(|error| error.to_string());
            match info.and_then(|sample| entities::decode(&sample.bytes)) {
                Ok((format, nodes)) => state.on_nodes(format, nodes),
                Err(reason) => tracing::debug!("{}: {reason}", entities::TOPIC),
            }
        }
        if let (true, Some(format)) = (state.is_changed, state.format) {
            // What could not be sent is sent at the next tick.
            state.is_changed = !self.send(format, Some(&state.own));
        }
    }

    pub(super) fn leave(&self) {
        if let Some(format) = self.state.borrow().format {
            self.send(format, None);
        }
    }

    fn send(&self, format: Format, own: Option<&entities::Node>) -> bool {
        let sent = entities::encode(format, self.participant, own).and_then(|bytes| {
            let sent = self.writer.write(fields(bytes), None);
            sent.map_err(|error| error.to_string())
        });
        sent.inspect_err(|reason| tracing::debug!("{}: {reason}", entities::TOPIC))
            .is_ok()
    }
}

impl State {
    fn on_nodes(&mut self, format: Option<Format>, nodes: Vec<entities::Node>) {
        if format.is_some() && format != self.format {
            self.format = format;
            self.is_changed = true;
        }
        for node in nodes {
            let name = node.whole_name();
            for gid in node.readers.into_iter().chain(node.writers) {
                if self.names.len() >= MAX_NAMES {
                    self.names.clear();
                }
                self.names.insert(gid, name.clone());
            }
        }
    }
}

impl Drop for Shown {
    fn drop(&mut self) {
        let mut state = self.node.state.borrow_mut();
        let own = &mut state.own;
        own.readers.retain(|gid| *gid != self.gid);
        own.writers.retain(|gid| *gid != self.gid);
        state.is_changed = true;
    }
}
