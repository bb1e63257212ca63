//! The gateway as a node of ROS: its token, and those of its topics and services.
//!
//! | part of a token | holds |
//! |---|---|
//! | `@ros2_lv` | what all tokens begin with |
//! | domain, session, node, entity | numbers; the session's is Zenoh's own |
//! | kind | `NN` node, `MP` publisher, `MS` subscription, `SS` service, `SC` client |
//! | enclave, namespace, node | names, each `/` as `%`; `%` alone is none |
//! | topic, type, hash, quality | of all but nodes |

use std::sync::atomic::{AtomicUsize, Ordering};

use transport::{Graph, Waker};
use twox_hash::XxHash3_128;
use zenoh::liveliness::LivelinessToken;
use zenoh::{Session, Wait};
use zenoh_session::{KeyError, Report, Routers};

use crate::rmw::description::TypeInfo;
use crate::rmw::{Keeping, Topic};
use crate::{Config, GatewayError};

const TOKENS: &str = "@ros2_lv";

/// Text that ROS 2 Humble writes in the place of a type's hash.
const NO_HASH: &str = "TypeHashNotSupported";

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Publisher,
    Subscription,
    Service,
}

impl Kind {
    pub(super) fn code(self) -> &'static str {
        match self {
            Kind::Publisher => "MP",
            Kind::Subscription => "MS",
            Kind::Service => "SS",
        }
    }
}

pub(crate) struct Member {
    pub(super) session: Session,
    pub(super) domain: u32,
    /// Namespace and name.
    pub(super) node: String,
    /// Namespace and name, mangled.
    who: String,
    pub(super) routers: Routers,
    pub(super) waker: Waker,
    _token: LivelinessToken,
    /// Number of the next entity; the node itself has 0.
    next: AtomicUsize,
}

/// A topic that the node sends or takes, or a service that it offers.
pub(super) struct Endpoint {
    pub(super) key: String,
    /// Key that nodes of ROS 2 Humble use.
    pub(super) humble_key: String,
    pub(super) sender: [u8; 16],
    token: String,
}

impl Member {
    /// Opens the session, which waits for a router if need be, and joins; `None` once the stop flag
    /// is set.
    pub(crate) fn join(
        graph: &Graph,
        config: &Config,
        report: &mut Report,
    ) -> Result<Option<Self>, GatewayError> {
        let domain = config.domain()?;
        let routers = Routers::of(&config.network)?;
        report.waiting_for(Some(&routers.awaited()))?;
        let session = zenoh_session::open(graph, &config.network, || report.tick())?;
        let Some(session) = session else {
            return Ok(None);
        };
        let namespace = config.namespace();
        let who = format!("{}/{}", mangled(namespace), config.node());
        let key = format!("{TOKENS}/{domain}/{}/0/0/NN/%/{who}", session.zid());
        Ok(Some(Member {
            _token: declare(&session, &key)?,
            session,
            domain,
            node: format!("{}/{}", namespace.trim_end_matches('/'), config.node()),
            who,
            routers,
            waker: graph.waker()?,
            next: AtomicUsize::new(1),
        }))
    }

    /// Returns the key expression of all tokens on the domain.
    pub(super) fn tokens(&self) -> String {
        format!("{TOKENS}/{}/**", self.domain)
    }

    pub(super) fn endpoint(&self, kind: Kind, topic: &Topic<'_>) -> Endpoint {
        let (domain, who, kind) = (self.domain, &self.who, kind.code());
        let (session, entity) = (
            self.session.zid(),
            self.next.fetch_add(1, Ordering::Relaxed),
        );
        let (name, info) = (mangled(topic.name), topic.info);
        let quality = encoded(topic.keeping, topic.depth);
        let of_type = format!("{domain}/{}/{}", topic.name.trim_matches('/'), info.name);
        let token = format!(
            "{TOKENS}/{domain}/{session}/0/{entity}/{kind}/%/{who}/{name}/{info}/{quality}"
        );
        Endpoint {
            key: format!("{of_type}/{}", info.hash),
            humble_key: format!("{of_type}/{NO_HASH}"),
            // Computed as in rmw_zenoh: both halves, the lower one first.
            sender: XxHash3_128::oneshot(token.as_bytes()).to_le_bytes(),
            token,
        }
    }

    /// Shows the endpoint to others, once it is ready.
    pub(super) fn show(&self, endpoint: &Endpoint) -> Result<LivelinessToken, GatewayError> {
        declare(&self.session, &endpoint.token)
    }
}

fn declare(session: &Session, key: &str) -> Result<LivelinessToken, GatewayError> {
    let token = session.liveliness().declare_token(key.to_owned()).wait();
    Ok(token.map_err(KeyError::when("be alive at", key))?)
}

fn mangled(name: &str) -> String {
    name.replace('/', "%")
}

/// Encodes reliability, durability, history, deadline, lifespan and liveliness; values that are the
/// defaults of ROS are left out.
fn encoded(keeping: Keeping, depth: usize) -> String {
    let start = match keeping {
        Keeping::Fresh => "2:",
        Keeping::Reliable => ":",
        Keeping::Kept => ":1",
    };
    format!("{start}:,{depth}:,:,:,,")
}

#[derive(Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub(super) session: String,
    pub(super) kind: String,
    /// Namespace and name.
    pub(super) node: String,
    pub(super) topic: String,
    pub(super) info: TypeInfo,
}

impl Token {
    /// Reads the token of a topic or service; nodes have no topic.
    pub(super) fn read(key: &str) -> Option<Self> {
        let parts: Vec<&str> = key.split('/').collect();
        if parts.len() != 13 || parts[0] != TOKENS {
            return None;
        }
        let [session, kind, namespace, node] = [2, 5, 7, 8].map(|index| parts[index]);
        let [topic, name, hash] = [9, 10, 11].map(|index| parts[index]);
        let namespace = namespace.replace('%', "/");
        let namespace = namespace.trim_end_matches('/');
        Some(Token {
            session: session.to_owned(),
            kind: kind.to_owned(),
            node: format!("{namespace}/{node}"),
            topic: topic.replace('%', "/"),
            info: TypeInfo {
                name: name.to_owned(),
                hash: hash.to_owned(),
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example of rmw_zenoh's own documentation.
    const TALKER: &str = "@ros2_lv/2/aac3178e146ba6f1fc6e6a4085e77f21/0/10/MP/%/%/talker/%chatter/\
        std_msgs::msg::dds_::String_/\
        RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18/::,7:,:,:,,";

    #[test]
    fn tokens_of_others_are_read() {
        let token = Token::read(TALKER).unwrap();
        assert_eq!(token.session, "aac3178e146ba6f1fc6e6a4085e77f21");
        assert_eq!((&*token.kind, &*token.node), ("MP", "/talker"));
        assert_eq!(
            (&*token.topic, &*token.info.name),
            ("/chatter", "std_msgs::msg::dds_::String_")
        );
        let spaced = TALKER.replace("/%/%/talker", "/%/%r2%front/talker");
        assert_eq!(Token::read(&spaced).unwrap().node, "/r2/front/talker");
        for end in 0..TALKER.len() {
            let _ = Token::read(&TALKER[..end]);
        }
        assert_eq!(Token::read(&format!("{TALKER}/more")), None);
        assert_eq!(Token::read("@ros2_lv/2/aac3/0/0/NN/%/%/talker"), None);
    }

    #[test]
    fn qualities_stand_as_rmw_zenoh_writes_them() {
        assert_eq!(encoded(Keeping::Reliable, 7), "::,7:,:,:,,");
        assert_eq!(encoded(Keeping::Fresh, 5), "2::,5:,:,:,,");
        assert_eq!(encoded(Keeping::Kept, 1), ":1:,1:,:,:,,");
    }
}
