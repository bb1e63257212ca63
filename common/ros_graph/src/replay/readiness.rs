//! Tracks which nodes are ready.

use messages::{HealthHeader, NodeState};

#[derive(Debug)]
pub(crate) struct Readiness {
    nodes: Vec<(String, Option<NodeState>)>,
}

impl Readiness {
    pub(crate) fn of(names: &[String]) -> Self {
        let nodes = names.iter().map(|name| (name.clone(), None));
        Readiness {
            nodes: nodes.collect(),
        }
    }

    pub(crate) fn receive(&mut self, report: &HealthHeader) {
        let name = report.node.as_str();
        for (_, state) in self.nodes.iter_mut().filter(|(node, _)| node == name) {
            *state = NodeState::from_code(report.state);
        }
    }

    /// Names and states of the nodes that are not ready; empty if all are.
    pub(crate) fn missing(&self) -> Vec<String> {
        let missing = |(name, state): &(String, Option<NodeState>)| match state {
            Some(NodeState::Ready) => None,
            Some(state) => Some(format!("{name} ({state:?})")),
            None => Some(format!("{name} (not started)")),
        };
        self.nodes.iter().filter_map(missing).collect()
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::Name;

    use super::*;

    fn report(node: &str, state: u32) -> HealthHeader {
        HealthHeader {
            node: Name::new(node),
            state,
            ..HealthHeader::zeroed()
        }
    }

    #[test]
    fn all_must_be_ready_at_the_same_time() {
        let mut readiness = Readiness::of(&["a".into(), "b".into()]);
        assert_eq!(readiness.missing(), ["a (not started)", "b (not started)"]);
        readiness.receive(&report("a", NodeState::Ready as u32));
        readiness.receive(&report("c", NodeState::Ready as u32));
        readiness.receive(&report("b", NodeState::Waiting as u32));
        assert_eq!(readiness.missing(), ["b (Waiting)"]);
        readiness.receive(&report("b", NodeState::Ready as u32));
        readiness.receive(&report("a", 99));
        assert_eq!(readiness.missing(), ["a (not started)"]);
        readiness.receive(&report("a", NodeState::Ready as u32));
        assert!(readiness.missing().is_empty());
        assert!(Readiness::of(&[]).missing().is_empty());
    }
}
