//! Watch of the robot's domain, by the tokens of its nodes.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crossbeam::queue::ArrayQueue;
use zenoh::Wait;
use zenoh::pubsub::Subscriber;
use zenoh::sample::{Sample, SampleKind};
use zenoh_session::KeyError;

use super::Member;
use super::entity::{Kind, Token};
use crate::GatewayError;
use crate::rmw::Discovery;
use crate::rmw::expected::{Endpoint, Expected, Seen};

/// Largest number of queued tokens: a large robot has some hundred.
const MAX_WAITING: usize = 4096;

pub(super) struct Watch {
    /// Id of the gateway's own session.
    mine: String,
    /// Namespace and name of the gateway's own node.
    node: String,
    tokens: Arc<ArrayQueue<String>>,
    dropped: Arc<AtomicU64>,
    _subscriber: Subscriber<()>,
}

impl Watch {
    pub(super) fn open(member: &Member) -> Result<Self, GatewayError> {
        let tokens = Arc::new(ArrayQueue::new(MAX_WAITING));
        let dropped = Arc::new(AtomicU64::new(0));
        let waker = member.waker.clone();
        let key = member.tokens();
        let put = {
            let (tokens, dropped) = (Arc::clone(&tokens), Arc::clone(&dropped));
            move |sample: Sample| {
                if sample.kind() != SampleKind::Put {
                    return;
                }
                if tokens.push(sample.key_expr().to_string()).is_err() {
                    dropped.fetch_add(1, Ordering::Relaxed);
                }
                waker.wake();
            }
        };
        let liveliness = member.session.liveliness();
        let subscriber = liveliness.declare_subscriber(key.clone()).history(true);
        let subscriber = subscriber.callback(put).wait();
        let subscriber = subscriber.map_err(KeyError::when("watch", &key))?;
        Ok(Watch {
            mine: member.session.zid().to_string(),
            node: member.node.clone(),
            tokens,
            dropped,
            _subscriber: subscriber,
        })
    }
}

impl Discovery for Watch {
    fn dropped(&self) -> u64 {
        self.dropped.swap(0, Ordering::Relaxed)
    }

    /// Returns the next event of interest; a token that cannot be read is none.
    fn next(&mut self, expected: &mut Expected) -> Option<Seen> {
        while let Some(key) = self.tokens.pop() {
            let Some(token) = Token::read(&key).filter(|token| token.session != self.mine) else {
                continue;
            };
            if is_second(&token, &self.node) {
                return Some(Seen::Stranger(GatewayError::Refused(format!(
                    "there is a second node {}: both answer its services and publish its \
                     transform; leave the other one out of the launch file, or give this one \
                     another --node",
                    token.node
                ))));
            }
            let seen = endpoint(token).and_then(|other| expected.note(&other));
            if seen.is_some() {
                return seen;
            }
        }
        None
    }
}

const EVENTS: &str = "/parameter_events";

/// True if the token shows that another process has a node of this name.
fn is_second(token: &Token, node: &str) -> bool {
    token.node == node && token.kind == Kind::Publisher.code() && token.topic == EVENTS
}

/// Returns the topic of a token; nodes and services have none.
fn endpoint(token: Token) -> Option<Endpoint> {
    let is_publisher = token.kind == Kind::Publisher.code();
    if !is_publisher && token.kind != Kind::Subscription.code() {
        return None;
    }
    Some(Endpoint {
        is_publisher,
        node: token.node,
        topic: token.topic,
        info: token.info,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(token: &str) -> Option<Seen> {
        Expected::new("/initialpose").note(&endpoint(Token::read(token)?)?)
    }

    const START: &str = "@ros2_lv/0/aac3178e146ba6f1fc6e6a4085e77f21/0/10";
    const QOS: &str = "::,10:,:,:,,";

    #[test]
    fn a_second_node_of_this_ones_name_is_seen_once() {
        let kind = "rcl_interfaces::msg::dds_::ParameterEvent_/RIHS01_00";
        let of = |node: &str, topic: &str| {
            let token = format!("{START}/MP/%/{node}/{topic}/{kind}/{QOS}");
            is_second(&Token::read(&token).unwrap(), "/r2/amcl")
        };
        assert!(of("%r2/amcl", "%parameter_events"));
        assert!(!of("%r2/amcl", "%r2%amcl_pose"));
        assert!(!of("%/amcl", "%parameter_events"));
    }

    #[test]
    fn a_subscriber_of_the_initial_pose_is_seen() {
        let kind = "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_/RIHS01_26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e";
        let token = format!("{START}/MS/%/%/amcl/%initialpose/{kind}/{QOS}");
        assert!(matches!(seen(&token), Some(Seen::Subscriber(node)) if node == "/amcl"));
        let other = format!("{START}/MS/%/%/amcl/%other/{kind}/{QOS}");
        assert!(seen(&other).is_none());
        let service = format!("{START}/SS/%/%/amcl/%initialpose/{kind}/{QOS}");
        assert!(seen(&service).is_none());
        assert!(seen(&format!("{START}/NN/%/%/amcl")).is_none());
    }
}
