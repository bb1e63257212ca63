//! A service: each request has one response.
//!
//! A response names the request that it answers: on Fast DDS outside the message, on Cyclone DDS by
//! 16 bytes before its fields, which are copied from the request.

use std::cell::RefCell;
use std::collections::{BTreeMap, VecDeque};
use std::time::{Duration, Instant};

use rustdds::bytes::Bytes;
use rustdds::no_key::DataWriter;
use rustdds::with_key::WriteOptionsBuilder;
use rustdds::{
    DomainParticipant, GUID, RTPSEntity, SampleIdentity, SequenceNumber, TopicDescription,
};
use transport::TransportError;
use zenoh_session::Report;

use super::node::Shown;
use super::raw::{HEADER, Raw, fields};
use super::reader::{Reader, Sample};
use super::{Member, quality};
use crate::GatewayError;
use crate::rmw::description::TypeInfo;
use crate::rmw::{Calls, Keeping, MAX_REQUEST_BYTES, Respond};

/// Largest number of queued requests, of all clients together, and of queued responses.
const MAX_WAITING: usize = 128;

/// Time that a response waits for a client whose reader is not known yet.
const MATCHING: Duration = Duration::from_secs(2);

/// Time after its discovery from which a reader is certainly sent what is written.
const SETTLED: Duration = Duration::from_millis(20);

/// First bytes of the numbers of Cyclone DDS participants.
const CYCLONE: [u8; 2] = [0x01, 0x10];

/// Number of bytes before the fields, on Cyclone DDS.
const CALL: usize = 16;

pub(super) struct Service {
    topic: String,
    participant: DomainParticipant,
    requests: Reader,
    responses: DataWriter<Bytes, Raw>,
    state: RefCell<State>,
    _shown: [Shown; 2],
}

#[derive(Default)]
struct State {
    /// Readers of responses, and when each was first seen.
    readers: BTreeMap<GUID, Instant>,
    waiting: VecDeque<Response>,
}

struct Response {
    fields: Bytes,
    /// Identity of the request, by its client's writer or reader.
    request: SampleIdentity,
    since: Instant,
}

impl Service {
    pub(super) fn open(
        member: &Member,
        topic: &str,
        info: &TypeInfo,
    ) -> Result<Self, GatewayError> {
        let domain = &member.domain;
        let quality = quality::offered(Keeping::Reliable, MAX_WAITING, true);
        let (name, kind) = (format!("rr{topic}Reply"), format!("{}Response_", info.name));
        let responses = domain.writer(&name, &kind, &quality)?;
        let quality = quality::requested(Keeping::Reliable, MAX_WAITING);
        let (name, kind) = (
            format!("rq{topic}Request"),
            format!("{}Request_", info.name),
        );
        let (names, waker) = ((&*name, &*kind, topic), Some(member.waker.clone()));
        let requests = domain.reader(names, &quality, waker, MAX_REQUEST_BYTES)?;
        let node = &member.node;
        let _shown = [
            node.show_writer(responses.guid()),
            node.show_reader(requests.guid()),
        ];
        Ok(Service {
            topic: topic.to_owned(),
            participant: domain.participant.clone(),
            requests,
            responses,
            state: RefCell::default(),
            _shown,
        })
    }

    fn answer(
        &self,
        request: &Sample,
        respond: &mut Respond<'_>,
    ) -> Result<Response, GatewayError> {
        let since = Instant::now();
        let is_prefixed =
            request.related.is_none() && request.identity.writer_guid.to_bytes()[..2] == CYCLONE;
        let bytes = &request.bytes;
        if let (true, Some((start, rest))) = (is_prefixed, bytes.split_at_checked(HEADER + CALL)) {
            let (header, prefix) = start.split_at(HEADER);
            let response = fields(respond(&[header, rest].concat())?);
            return Ok(Response {
                fields: [prefix, &response].concat().into(),
                request: request.identity,
                since,
            });
        }
        Ok(Response {
            fields: fields(respond(bytes)?),
            request: called(request),
            since,
        })
    }

    fn send(&self, response: Response) -> Result<(), GatewayError> {
        let client = response.request.writer_guid;
        let mut options = WriteOptionsBuilder::new().related_sample_identity(response.request);
        if client.entity_id.entity_kind.is_reader() {
            // Each client keeps some responses only, and would lose its own among many others.
            options = options.to_single_reader(client);
        }
        let responses = &self.responses;
        let sent = responses.write_with_options(response.fields, options.build());
        sent.map(drop).map_err(GatewayError::sending(&self.topic))
    }

    fn look_for_readers(&self, state: &mut State) {
        let topic = self.responses.topic().name();
        let now = Instant::now();
        let found = self.participant.discovered_readers().into_iter();
        let found = found
            .map(|reader| reader.subscription_topic_data)
            .filter(|data| *data.topic_name() == topic)
            .map(|data| data.key());
        let since = |guid| (guid, state.readers.get(&guid).copied().unwrap_or(now));
        state.readers = found.map(since).collect();
    }
}

impl Calls for Service {
    fn serve(&self, report: &mut Report, respond: &mut Respond<'_>) -> Result<u64, TransportError> {
        let mut answered = 0;
        let mut state = self.state.borrow_mut();
        for _ in 0..MAX_WAITING {
            let Some(request) = self.requests.next() else {
                break;
            };
            report.received();
            match request.and_then(|request| self.answer(&request, respond)) {
                Ok(response) => {
                    answered += 1;
                    state.waiting.push_back(response);
                }
                Err(error) => report.refused(&error)?,
            }
        }
        if state.waiting.iter().any(|response| !state.is_due(response)) {
            self.look_for_readers(&mut state);
        }
        for response in std::mem::take(&mut state.waiting) {
            if state.is_due(&response) {
                if let Err(error) = self.send(response) {
                    report.refused(&error)?;
                }
            } else if state.waiting.len() < MAX_WAITING {
                state.waiting.push_back(response);
            }
        }
        Ok(answered)
    }
}

impl State {
    /// True if the response is to be sent: its client's reader is there, or has not come in time.
    fn is_due(&self, response: &Response) -> bool {
        let client = response.request.writer_guid;
        let mut readers = self.readers.iter();
        // Which of a client's readers takes responses is not always said.
        let is_reader = |reader: &GUID| match client.entity_id.entity_kind.is_reader() {
            true => *reader == client,
            false => reader.prefix == client.prefix,
        };
        let is_there =
            readers.any(|(reader, since)| is_reader(reader) && since.elapsed() > SETTLED);
        is_there || response.since.elapsed() > MATCHING
    }
}

/// Returns the identity by which the client recognises its request. Clients on Fast DDS give the
/// number of the reader that waits for the response, and leave out that of the message.
fn called(request: &Sample) -> SampleIdentity {
    let own = request.identity;
    match request.related {
        Some(related) if related.writer_guid != GUID::GUID_UNKNOWN => SampleIdentity {
            writer_guid: related.writer_guid,
            sequence_number: match related.sequence_number == SequenceNumber::UNKNOWN {
                true => own.sequence_number,
                false => related.sequence_number,
            },
        },
        _ => own,
    }
}
