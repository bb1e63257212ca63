//! `rmw_dds_common/ParticipantEntitiesInfo`: the nodes of a participant and their topics.
//!
//! An endpoint's number has 16 bytes since ROS 2 Iron, and 24 up to Humble, whose nodes
//! fail on messages of the other kind.

use serde::{Deserialize, Serialize};

/// Topic of these messages, without the prefix that others have.
pub(super) const TOPIC: &str = "ros_discovery_info";

/// Type of these messages.
pub(super) const TYPE: &str = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";

pub(super) type Gid = [u8; 16];

/// Format of endpoint numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Humble,
    Iron,
}

#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Node<G = Gid> {
    pub(super) namespace: String,
    pub(super) name: String,
    pub(super) readers: Vec<G>,
    pub(super) writers: Vec<G>,
}

#[derive(Serialize, Deserialize)]
struct Info<G> {
    participant: G,
    nodes: Vec<Node<G>>,
}

impl Node {
    pub(super) fn whole_name(&self) -> String {
        format!("{}/{}", self.namespace.trim_end_matches('/'), self.name)
    }
}

impl<G> Node<G> {
    /// Converts the numbers.
    fn with<H>(self, gid: impl Fn(G) -> H) -> Node<H> {
        let all = |gids: Vec<G>| gids.into_iter().map(&gid).collect();
        Node {
            namespace: self.namespace,
            name: self.name,
            readers: all(self.readers),
            writers: all(self.writers),
        }
    }
}

/// Encodes the message of a participant with one node or none, in CDR.
pub(super) fn encode(
    format: Format,
    participant: Gid,
    node: Option<&Node>,
) -> Result<Vec<u8>, String> {
    let node = node.cloned();
    match format {
        Format::Iron => encode_as(participant, node),
        Format::Humble => encode_as(long(participant), node.map(|node| node.with(long))),
    }
}

fn encode_as<G: Serialize>(participant: G, node: Option<Node<G>>) -> Result<Vec<u8>, String> {
    let nodes = node.into_iter().collect();
    ros::cdr::encode(&Info { participant, nodes }).map_err(|error| error.to_string())
}

/// Decodes the nodes of a message; the format of their numbers is known only if there is a node.
pub(super) fn decode(bytes: &[u8]) -> Result<(Option<Format>, Vec<Node>), String> {
    // Numbers of 16 bytes read as of 24 leave the number of nodes to be letters of a name, and so
    // more nodes than there are bytes. The other way round, it is the zeros that fill up the first.
    let (format, nodes): (_, Vec<Node>) = match ros::cdr::decode::<Info<[u8; 24]>>(bytes) {
        Ok(info) if !info.nodes.is_empty() => {
            let nodes = info.nodes.into_iter().map(|node| node.with(short));
            (Format::Humble, nodes.collect())
        }
        _ => (Format::Iron, ros::cdr::decode::<Info<Gid>>(bytes)?.nodes),
    };
    let format = Some(format).filter(|_| !nodes.is_empty());
    Ok((format, nodes))
}

fn long(gid: Gid) -> [u8; 24] {
    let mut long = [0; 24];
    long[..16].copy_from_slice(&gid);
    long
}

fn short(gid: [u8; 24]) -> Gid {
    std::array::from_fn(|index| gid[index])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_formats_are_told_apart() {
        let node = Node {
            namespace: "/r2".to_owned(),
            name: "amcl".to_owned(),
            readers: vec![[1; 16], [2; 16]],
            writers: vec![[3; 16]],
        };
        assert_eq!(node.whole_name(), "/r2/amcl");
        for format in [Format::Humble, Format::Iron] {
            let bytes = encode(format, [9; 16], Some(&node)).unwrap();
            let (found, nodes) = decode(&bytes).unwrap();
            assert_eq!((found, nodes), (Some(format), vec![node.clone()]));
            for length in 0..bytes.len() - 8 {
                // A message that was cut may still be one of no node, with bytes left over.
                let nodes = decode(&bytes[..length]).map_or(Vec::new(), |(_, nodes)| nodes);
                assert_eq!(nodes, [], "{format:?} {length}");
            }
        }
    }
}
