//! Waits for messages of nodes.

use std::time::Duration;

use messages::{HealthHeader, NodeState, Topic, topic};

use crate::{Flow, Graph, Subscriber, TransportError};

/// Tick of the test: a late joiner waits for its latched samples for that long.
const TICK: Duration = Duration::from_millis(20);

/// Returns the first value of `take`; meanwhile the test's own latched topics are served.
pub fn wait_for<T: Topic, R>(
    graph: &Graph,
    subscriber: &Subscriber<T>,
    mut take: impl FnMut(&T::Header, &[T::Item]) -> Option<R>,
) -> R {
    let mut taken = None;
    graph
        .run(&[subscriber], TICK, |_| {
            while let Some(sample) = subscriber.receive()? {
                taken = take(sample.header(), sample.items());
                if taken.is_some() {
                    return Ok::<_, TransportError>(Flow::Stop);
                }
            }
            Ok(Flow::Continue)
        })
        .unwrap();
    taken.unwrap()
}

/// Returns the first value of `look`, which is called each tick.
pub fn wait_to_see<R>(graph: &Graph, mut look: impl FnMut() -> Option<R>) -> R {
    let mut seen = None;
    graph
        .run(&[], TICK, |_| {
            seen = look();
            Ok::<_, TransportError>(match seen {
                Some(_) => Flow::Stop,
                None => Flow::Continue,
            })
        })
        .unwrap();
    seen.unwrap()
}

/// Waits for the next message and returns copies of its header and items.
pub fn wait_for_next<T: Topic>(
    graph: &Graph,
    subscriber: &Subscriber<T>,
) -> (T::Header, Vec<T::Item>) {
    wait_for(graph, subscriber, |header, items| {
        Some((*header, items.to_vec()))
    })
}

/// Waits for a message for which `is_awaited` is true.
pub fn wait_until<T: Topic>(
    graph: &Graph,
    subscriber: &Subscriber<T>,
    mut is_awaited: impl FnMut(&T::Header, &[T::Item]) -> bool,
) {
    wait_for(graph, subscriber, |header, items| {
        is_awaited(header, items).then_some(())
    });
}

/// Waits for a health message for which `is_awaited` is true; returns it and its last error.
pub fn wait_for_health(
    graph: &Graph,
    health: &Subscriber<topic::Health>,
    is_awaited: impl Fn(&HealthHeader) -> bool,
) -> (HealthHeader, String) {
    wait_for(graph, health, |report, error| {
        is_awaited(report).then(|| (*report, String::from_utf8(error.to_vec()).unwrap()))
    })
}

/// Waits for a health message with this state; returns it and its last error.
pub fn wait_for_state(
    graph: &Graph,
    health: &Subscriber<topic::Health>,
    state: NodeState,
) -> (HealthHeader, String) {
    wait_for_health(graph, health, |report| report.state == state as u32)
}

/// Waits until a node reports that it is ready.
pub fn wait_until_ready(graph: &Graph, node: &str) {
    let health = graph.subscriber::<topic::Health>().unwrap();
    let is_ready = NodeState::Ready as u32;
    wait_until(graph, &health, |report, _| {
        report.node.as_str() == node && report.state == is_ready
    });
}
