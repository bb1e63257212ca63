//! The topics that the gateway takes, and how they are published. Pure.

use std::collections::BTreeMap;

use ros::RosMessage;

use super::description::TypeInfo;
use crate::GatewayError;
use crate::waiting::Publishing;

#[derive(Debug)]
pub(crate) enum Seen {
    /// A node subscribes to the topic that is watched: namespace and name of the node.
    Subscriber(String),
    /// A node publishes a topic, while all topics are searched.
    Publisher {
        /// Namespace and name of the node.
        node: String,
        topic: String,
        /// Type name in the middleware.
        kind: String,
    },
    /// A node publishes a topic that is taken, in a way that cannot be received.
    Stranger(GatewayError),
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Endpoint {
    pub(super) is_publisher: bool,
    /// Namespace and name of the node.
    pub(super) node: String,
    pub(super) topic: String,
    pub(super) info: TypeInfo,
}

/// Topics that other nodes are expected to subscribe to or to publish.
#[derive(Debug)]
pub(crate) struct Expected {
    subscribed: String,
    published: Vec<(String, TypeInfo)>,
    /// True if publishers of all topics are reported instead.
    pub(crate) is_everything: bool,
    /// Kind of publisher of each published topic; a matching one counts before others.
    found: BTreeMap<String, Publishing>,
}

impl Expected {
    pub(super) fn new(subscribed: &str) -> Self {
        Expected {
            subscribed: subscribed.to_owned(),
            published: Vec::new(),
            is_everything: false,
            found: BTreeMap::new(),
        }
    }

    pub(crate) fn expect<M: RosMessage>(&mut self, topic: &str) -> Result<(), GatewayError> {
        let info = TypeInfo::of(M::SCHEMA)?;
        self.published.push((topic.to_owned(), info));
        Ok(())
    }

    /// Returns the kind of the topic's publisher; a matching one counts before others.
    pub(crate) fn publishing(&self, topic: &str) -> Publishing {
        let found = self.found.get(topic);
        found.copied().unwrap_or(Publishing::Nobody)
    }

    /// True if publishers of this topic are of interest, or its subscribers if `is_publisher` is
    /// false.
    pub(super) fn concerns(&self, is_publisher: bool, topic: &str) -> bool {
        match is_publisher {
            false => topic == self.subscribed,
            true => self.is_everything || self.published.iter().any(|(known, _)| known == topic),
        }
    }

    /// Takes another node's topic; returns the event to report.
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
            let found = endpoint.info.to_string();
            Seen::Stranger(GatewayError::stranger(node, topic, &found, &expected))
        })
    }

    /// Notes a publisher of a topic; one whose messages are taken is enough.
    pub(super) fn found_as(&mut self, topic: &str, how: Publishing) {
        if self.publishing(topic) != Publishing::Expected {
            self.found.insert(topic.to_owned(), how);
        }
    }
}

fn judge(found: &TypeInfo, expected: &TypeInfo) -> Publishing {
    match () {
        () if found == expected => Publishing::Expected,
        () if found.name != expected.name => Publishing::OtherType,
        // Humble has no hashes, and its messages are the same.
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
        let scan = TypeInfo::of(LaserScan::SCHEMA).unwrap();
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
        let wrong = TypeInfo::of(PoseArray::SCHEMA).unwrap();
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
