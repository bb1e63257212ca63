//! The topics that are taken, and whether somebody publishes them as expected. Pure.

use std::collections::BTreeMap;

use ros::RosMessage;

use super::description;
use super::type_info::TypeInfo;
use crate::GatewayError;
use crate::waiting::Publishing;

/// What was seen.
#[derive(Debug)]
pub(crate) enum Seen {
    /// Somebody subscribes to the topic that is watched; the node's name.
    Subscriber(String),
    /// Somebody publishes a topic, where everything is looked for.
    Publisher {
        /// Namespace and name of the node.
        node: String,
        topic: String,
        /// The type, as middleware names it.
        kind: String,
    },
    /// Somebody publishes a topic that is taken in a way that it cannot be received.
    Stranger(GatewayError),
}

/// A topic of another node.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Endpoint {
    pub(super) is_publisher: bool,
    /// Namespace and name.
    pub(super) node: String,
    pub(super) topic: String,
    pub(super) info: TypeInfo,
}

/// What is awaited of other nodes.
#[derive(Debug)]
pub(super) struct Expected {
    subscribed: String,
    published: Vec<(String, TypeInfo)>,
    is_everything: bool,
    /// How those of them are published that somebody has published.
    found: BTreeMap<String, Publishing>,
}

impl Expected {
    /// Looks for subscribers of `subscribed`.
    pub(super) fn new(subscribed: &str) -> Self {
        Expected {
            subscribed: subscribed.to_owned(),
            published: Vec::new(),
            is_everything: false,
            found: BTreeMap::new(),
        }
    }

    /// Also looks for publishers of `topic`.
    pub(super) fn expect<M: RosMessage>(&mut self, topic: &str) -> Result<(), GatewayError> {
        let info = description::of_message::<M>()?;
        self.published.push((topic.to_owned(), info));
        Ok(())
    }

    /// Reports publishers of all topics instead.
    pub(super) fn expect_everything(&mut self) {
        self.is_everything = true;
    }

    /// How the topic is published, by whoever does so as it is taken.
    pub(super) fn publishing(&self, topic: &str) -> Publishing {
        let found = self.found.get(topic);
        found.copied().unwrap_or(Publishing::Nobody)
    }

    /// Whether anything is awaited of this topic.
    pub(super) fn concerns(&self, is_publisher: bool, topic: &str) -> bool {
        match is_publisher {
            false => topic == self.subscribed,
            true => self.is_everything || self.published.iter().any(|(known, _)| known == topic),
        }
    }

    /// Takes notice of another node's topic; what is to be said of it.
    pub(super) fn note(&mut self, endpoint: &Endpoint) -> Option<Seen> {
        let Endpoint { node, topic, .. } = endpoint;
        if !self.concerns(endpoint.is_publisher, topic) {
            return None;
        }
        if !endpoint.is_publisher {
            return Some(Seen::Subscriber(node.clone()));
        }
        if self.is_everything {
            return Some(Seen::Publisher {
                node: node.clone(),
                topic: topic.clone(),
                kind: endpoint.info.name.clone(),
            });
        }
        let (_, expected) = self.published.iter().find(|(known, _)| known == topic)?;
        let (how, expected) = (judge(&endpoint.info, expected), expected.to_string());
        self.found_as(topic, how);
        (how != Publishing::Expected).then(|| {
            Seen::Stranger(GatewayError::Stranger {
                node: node.clone(),
                topic: topic.clone(),
                found: endpoint.info.to_string(),
                expected,
            })
        })
    }

    /// Notes how a topic is published; one publisher whose messages are taken is enough.
    pub(super) fn found_as(&mut self, topic: &str, how: Publishing) {
        if self.publishing(topic) != Publishing::Expected {
            self.found.insert(topic.to_owned(), how);
        }
    }
}

/// How a topic of this type is published, where another one is taken, or the same.
fn judge(found: &TypeInfo, expected: &TypeInfo) -> Publishing {
    match () {
        () if found == expected => Publishing::Expected,
        () if found.name != expected.name => Publishing::OtherType,
        // Humble says none, and its messages are the same.
        () if !found.hash.starts_with("RIHS01_") => Publishing::Expected,
        () => Publishing::OtherVersion,
    }
}

#[cfg(test)]
mod tests {
    use ros::{LaserScan, PoseArray};

    use super::*;

    fn expected() -> Expected {
        let mut expected = Expected::new("/initialpose");
        expected.expect::<LaserScan>("/scan").unwrap();
        expected
    }

    fn publisher(name: &str, hash: &str) -> Endpoint {
        Endpoint {
            is_publisher: true,
            node: "/r2/lidar".to_owned(),
            topic: "/scan".to_owned(),
            info: TypeInfo {
                name: name.to_owned(),
                hash: hash.to_owned(),
            },
        }
    }

    #[test]
    fn how_a_topic_is_published_is_distinguished() {
        let scan = description::of_message::<LaserScan>().unwrap();
        let with = |name: &str, hash: &str| {
            let mut expected = expected();
            let seen = expected.note(&publisher(name, hash));
            let how = expected.publishing("/scan");
            assert_eq!(seen.is_some(), how != Publishing::Expected);
            how
        };
        assert_eq!(with(&scan.name, &scan.hash), Publishing::Expected);
        let humble = "TypeHashNotSupported";
        assert_eq!(with(&scan.name, humble), Publishing::Expected);
        assert_eq!(with(&scan.name, ""), Publishing::Expected);
        let other = with(&scan.name, "RIHS01_00");
        assert_eq!(other, Publishing::OtherVersion);
        assert_eq!(with("other", &scan.hash), Publishing::OtherType);
    }

    #[test]
    fn a_publisher_with_another_type_is_named() {
        let wrong = description::of_message::<PoseArray>().unwrap();
        let seen = expected().note(&publisher(&wrong.name, &wrong.hash));
        let Some(Seen::Stranger(error)) = seen else {
            panic!("not seen");
        };
        let text = error.to_string();
        assert!(
            text.starts_with("/r2/lidar publishes /scan as geometry_msgs"),
            "{text}"
        );
    }
}
