//! Who comes to the robot's domain, by the tokens of its nodes.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crossbeam::queue::ArrayQueue;
use ros::RosMessage;
use transport::Graph;
use zenoh::Wait;
use zenoh::pubsub::Subscriber;
use zenoh::sample::{Sample, SampleKind};
use zenoh_session::KeyError;

use super::entity::{Kind, Token, TypeInfo};
use super::{Member, description};
use crate::GatewayError;
use crate::waiting::Publishing;

/// Tokens that wait: a large robot has some hundred.
const MAX_WAITING: usize = 4096;

/// What was seen.
#[derive(Debug)]
pub(crate) enum Seen {
    /// Somebody subscribes to the topic that is watched; the node's name.
    Subscriber(String),
    /// Somebody publishes a topic that is taken, as something else than it is taken
    /// for: it will never come. Or there is a second node of this one's name.
    Stranger(GatewayError),
}

/// Watches the tokens.
pub(crate) struct Watch {
    tokens: Arc<ArrayQueue<String>>,
    dropped: Arc<AtomicU64>,
    subscribed: String,
    published: Vec<(String, TypeInfo)>,
    /// How those of them are published that somebody has published.
    found: BTreeMap<String, Publishing>,
    _subscriber: Subscriber<()>,
}

impl Watch {
    /// Reports subscribers of `subscribed`.
    pub(crate) fn open(
        graph: &Graph,
        member: &Member,
        subscribed: &str,
    ) -> Result<Self, GatewayError> {
        let tokens = Arc::new(ArrayQueue::new(MAX_WAITING));
        let dropped = Arc::new(AtomicU64::new(0));
        let waker = graph.waker()?;
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
        let liveliness = member.session().liveliness();
        let subscriber = liveliness.declare_subscriber(key.clone()).history(true);
        let subscriber = subscriber.callback(put).wait();
        let subscriber = subscriber.map_err(KeyError::when("watch", &key))?;
        Ok(Watch {
            tokens,
            dropped,
            subscribed: subscribed.to_owned(),
            published: Vec::new(),
            found: BTreeMap::new(),
            _subscriber: subscriber,
        })
    }

    /// Also reports publishers of `topic` that publish anything but `M`.
    pub(crate) fn expect<M: RosMessage>(&mut self, topic: &str) -> Result<(), GatewayError> {
        let info = description::of_message::<M>()?;
        self.published.push((topic.to_owned(), info));
        Ok(())
    }

    /// How the topic is published, by whoever does so as it is taken.
    pub(crate) fn publishing(&self, topic: &str) -> Publishing {
        let found = self.found.get(topic);
        found.copied().unwrap_or(Publishing::Nobody)
    }

    /// Tokens that were not looked at since the last call: there were too many.
    pub(crate) fn dropped(&self) -> u64 {
        self.dropped.swap(0, Ordering::Relaxed)
    }

    fn note(&mut self, token: &Token) {
        let known = self
            .published
            .iter()
            .find(|(topic, _)| *topic == token.topic);
        if let Some((topic, expected)) = known
            && token.kind == Kind::Publisher.code()
            && self.publishing(topic) != Publishing::Expected
        {
            let publishing = publishing(&token.info, expected);
            self.found.insert(token.topic.clone(), publishing);
        }
    }

    /// The next that is of interest. A token that cannot be read is of no interest.
    pub(crate) fn next(&mut self, member: &Member) -> Option<Seen> {
        while let Some(key) = self.tokens.pop() {
            let token = Token::read(&key);
            let mine = member.session().zid().to_string();
            let others = token.filter(|token| token.session != mine);
            if let Some(token) = &others {
                self.note(token);
            }
            let seen = others.and_then(|token| {
                let is_second = is_second(&token, member.node());
                let second = || GatewayError::SecondNode(token.node.clone());
                is_second
                    .then(|| Seen::Stranger(second()))
                    .or_else(|| judge(&token, &self.subscribed, &self.published))
            });
            if seen.is_some() {
                return seen;
            }
        }
        None
    }
}

/// Each node publishes this topic.
const EVENTS: &str = "/parameter_events";

/// Whether somebody else is a node of this name.
fn is_second(token: &Token, node: &str) -> bool {
    token.node == node && token.kind == Kind::Publisher.code() && token.topic == EVENTS
}

/// How a topic is published where another type is expected, or the same.
fn publishing(found: &TypeInfo, expected: &TypeInfo) -> Publishing {
    match () {
        () if found.name != expected.name => Publishing::OtherType,
        () if found.hash == expected.hash || found.has_no_hash() => Publishing::Expected,
        () => Publishing::OtherVersion,
    }
}

fn judge(token: &Token, subscribed: &str, published: &[(String, TypeInfo)]) -> Option<Seen> {
    let Token {
        kind, node, topic, ..
    } = token;
    if kind == Kind::Subscription.code() && topic == subscribed {
        return Some(Seen::Subscriber(node.clone()));
    }
    let (_, expected) = published.iter().find(|(known, _)| known == topic)?;
    let is_strange =
        kind == Kind::Publisher.code() && publishing(&token.info, expected) != Publishing::Expected;
    is_strange.then(|| {
        Seen::Stranger(GatewayError::Stranger {
            node: node.clone(),
            topic: topic.clone(),
            found: token.info.to_string(),
            expected: expected.to_string(),
        })
    })
}

#[cfg(test)]
mod tests {
    use ros::{LaserScan, PoseArray};

    use super::*;

    fn seen(token: &str) -> Option<Seen> {
        let scan = description::of_message::<LaserScan>().unwrap();
        let published = [("/scan".to_owned(), scan)];
        judge(&Token::read(token)?, "/initialpose", &published)
    }

    const START: &str = "@ros2_lv/0/aac3178e146ba6f1fc6e6a4085e77f21/0/10";
    const QOS: &str = "::,10:,:,:,,";

    #[test]
    fn a_subscriber_of_the_initial_pose_is_seen() {
        let kind = "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_/RIHS01_26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e";
        let token = format!("{START}/MS/%/%/amcl/%initialpose/{kind}/{QOS}");
        assert!(matches!(seen(&token), Some(Seen::Subscriber(node)) if node == "/amcl"));
        let other = format!("{START}/MS/%/%/amcl/%other/{kind}/{QOS}");
        assert!(seen(&other).is_none());
        assert!(seen(&format!("{START}/NN/%/%/amcl")).is_none());
    }

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
    fn how_a_topic_is_published_is_distinguished() {
        let expected = description::of_message::<LaserScan>().unwrap();
        let with = |name: &str, hash: &str| {
            let (name, hash) = (name.to_owned(), hash.to_owned());
            publishing(&TypeInfo { name, hash }, &expected)
        };
        assert_eq!(with(&expected.name, &expected.hash), Publishing::Expected);
        let humble = with(&expected.name, "TypeHashNotSupported");
        assert_eq!(humble, Publishing::Expected);
        assert_eq!(with(&expected.name, "RIHS01_00"), Publishing::OtherVersion);
        assert_eq!(with("other", &expected.hash), Publishing::OtherType);
    }

    #[test]
    fn a_publisher_with_another_type_is_seen_and_the_right_one_is_not() {
        let publisher =
            |info: &TypeInfo| seen(&format!("{START}/MP/%/%r2/lidar/%scan/{info}/{QOS}"));
        let right = description::of_message::<LaserScan>().unwrap();
        assert!(publisher(&right).is_none());
        let wrong = description::of_message::<PoseArray>().unwrap();
        let Some(Seen::Stranger(error)) = publisher(&wrong) else {
            panic!("not seen");
        };
        let text = error.to_string();
        assert!(
            text.starts_with("/r2/lidar publishes /scan as geometry_msgs"),
            "{text}"
        );
    }
}
