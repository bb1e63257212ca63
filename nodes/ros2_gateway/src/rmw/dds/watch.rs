//! Watch of the robot's domain, by the discovery of DDS.

use std::collections::BTreeSet;
use std::rc::Rc;
use std::time::{Duration, Instant};

use rustdds::{
    DomainParticipant, DomainParticipantStatusEvent as Event, DomainParticipantStatusListener,
    EndpointDescription, GUID, RTPSEntity, StatusEvented,
};

use super::node::Node;
use super::{Member, quality};
use crate::GatewayError;
use crate::rmw::Discovery;
use crate::rmw::description::TypeInfo;
use crate::rmw::expected::{Endpoint, Expected, Seen};
use crate::waiting::Publishing;

/// Time that an endpoint waits for reports about its quality of service.
const SETTLED: Duration = Duration::from_millis(50);

/// Time that an endpoint waits for the name of its node.
const NAMED: Duration = Duration::from_secs(3);

pub(super) struct Watch {
    node: Rc<Node>,
    participant: DomainParticipant,
    listener: DomainParticipantStatusListener,
    /// True once the endpoints that were there before were looked at.
    has_begun: bool,
    /// Endpoints that were looked at: discovery repeats everything.
    known: BTreeSet<GUID>,
    pending: Vec<Pending>,
}

struct Pending {
    guid: GUID,
    since: Instant,
    /// The endpoint, whose node is not named yet.
    endpoint: Endpoint,
    /// Offered and requested quality of service, if they do not match.
    mismatch: Option<[String; 2]>,
}

impl Watch {
    pub(super) fn open(member: &Member) -> Self {
        let participant = member.domain.participant.clone();
        Watch {
            node: Rc::clone(&member.node),
            listener: participant.status_listener(),
            participant,
            has_begun: false,
            known: BTreeSet::new(),
            pending: Vec::new(),
        }
    }

    fn begin(&mut self, expected: &Expected) {
        for reader in self.participant.discovered_readers() {
            let data = &reader.subscription_topic_data;
            let names = (data.topic_name().as_str(), data.type_name().as_str());
            self.add(expected, data.key(), false, names, &reader.user_data);
        }
        for writer in self.participant.discovered_writers() {
            let data = &writer.publication_topic_data;
            let names = (data.topic_name.as_str(), data.type_name.as_str());
            self.add(expected, data.key, true, names, &writer.user_data);
        }
    }

    fn add_described(
        &mut self,
        expected: &Expected,
        is_publisher: bool,
        endpoint: &EndpointDescription,
    ) {
        let names = (&*endpoint.topic_name, &*endpoint.type_name);
        self.add(
            expected,
            endpoint.guid,
            is_publisher,
            names,
            &endpoint.user_data,
        );
    }

    fn add(
        &mut self,
        expected: &Expected,
        guid: GUID,
        is_publisher: bool,
        (topic, kind): (&str, &str),
        user_data: &[u8],
    ) {
        let is_own = guid.prefix == self.participant.guid().prefix;
        let topic = topic.strip_prefix("rt").filter(|_| !is_own);
        if let Some(topic) = topic
            && expected.concerns(is_publisher, topic)
            && self.known.insert(guid)
        {
            self.pending.push(Pending {
                guid,
                since: Instant::now(),
                endpoint: Endpoint {
                    is_publisher,
                    node: String::new(),
                    topic: topic.to_owned(),
                    info: TypeInfo {
                        name: kind.to_owned(),
                        hash: type_hash(user_data),
                    },
                },
                mismatch: None,
            });
        }
    }

    /// Returns the next event of an endpoint that is fully known, or has waited long enough.
    fn settle(&mut self, expected: &mut Expected) -> Option<Seen> {
        let mut index = 0;
        while let Some(pending) = self.pending.get(index) {
            let waited = pending.since.elapsed();
            let name = self.node.name_of(pending.guid);
            if waited < SETTLED || (name.is_none() && waited < NAMED) {
                index += 1;
                continue;
            }
            let Pending {
                mut endpoint,
                mismatch,
                ..
            } = self.pending.remove(index);
            endpoint.node = name.unwrap_or_else(|| "a node without a name".to_owned());
            let seen = match mismatch {
                None => expected.note(&endpoint),
                Some([found, wanted]) => {
                    expected.found_as(&endpoint.topic, Publishing::OtherQuality);
                    let Endpoint { node, topic, .. } = &endpoint;
                    let error = GatewayError::stranger(node, topic, &found, &wanted);
                    Some(Seen::Stranger(error))
                }
            };
            if seen.is_some() {
                return seen;
            }
        }
        None
    }
}

impl Discovery for Watch {
    fn next(&mut self, expected: &mut Expected) -> Option<Seen> {
        if !std::mem::replace(&mut self.has_begun, true) {
            self.begin(expected);
        }
        while let Some(event) = self.listener.try_recv_status() {
            match event {
                Event::ReaderDetected { reader } => self.add_described(expected, false, &reader),
                Event::WriterDetected { writer } => self.add_described(expected, true, &writer),
                Event::ReaderLost { guid, .. } | Event::WriterLost { guid, .. } => {
                    self.known.remove(&guid);
                    self.pending.retain(|pending| pending.guid != guid);
                }
                Event::RemoteWriterQosIncompatible {
                    remote_writer,
                    requested_qos,
                    offered_qos,
                    ..
                } => {
                    let is_it = |pending: &&mut Pending| pending.guid == remote_writer;
                    if let Some(pending) = self.pending.iter_mut().find(is_it) {
                        let words = [&*offered_qos, &*requested_qos].map(quality::in_words);
                        pending.mismatch = Some(words);
                    }
                }
                _ => {}
            }
        }
        self.settle(expected)
    }
}

/// Returns the type hash in an endpoint's user data, given as `typehash=RIHS01_…;`, if there is
/// one.
fn type_hash(user_data: &[u8]) -> String {
    let text = String::from_utf8_lossy(user_data);
    let hash = text
        .split(';')
        .find_map(|pair| pair.strip_prefix("typehash="));
    hash.unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_type_hash_is_found() {
        assert_eq!(type_hash(b"enclave=/;typehash=RIHS01_00;"), "RIHS01_00");
        assert_eq!(type_hash(b"enclave=/;"), "");
        assert_eq!(type_hash(&[0xff, 0]), "");
    }
}
