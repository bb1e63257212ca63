//! Samples within one process: order, loss, growth, health, the event loop.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::time::Duration;

use messages::{HealthHeader, NodeState, Topic, topic};
use transport::testing::Isolated;
use transport::{Flow, GapCounter, Graph, Publisher, Subscriber, TransportError};

fn pair<T: Topic>(graph: &Graph) -> (Publisher<T>, Subscriber<T>) {
    (graph.publisher().unwrap(), graph.subscriber().unwrap())
}

#[test]
fn a_slow_subscriber_keeps_the_newest_and_can_count_the_rest() {
    let isolated = Isolated::new("overflow");
    let graph = isolated.join("tester");
    let (publisher, subscriber) = pair::<topic::Scan>(&graph);
    let send = |counters: std::ops::Range<u64>| {
        for counter in counters {
            let mut loan = publisher.loan(5).unwrap();
            loan.header_mut().stamp.counter = counter;
            loan.send().unwrap();
        }
    };
    let mut gaps = GapCounter::default();
    let mut lost = 0;
    let mut receive = || {
        let mut counters = Vec::new();
        while let Some(sample) = subscriber.receive().unwrap() {
            let counter = sample.header().stamp.counter;
            lost += gaps.lost_before(counter);
            counters.push(counter);
        }
        counters
    };
    send(0..2);
    assert_eq!(receive(), [0, 1]);
    send(2..12);
    assert_eq!(receive(), [4, 5, 6, 7, 8, 9, 10, 11]);
    assert_eq!(lost, 2);
}

#[test]
fn a_publisher_is_settled_once_all_subscribers_are_done_with_what_it_sent() {
    let isolated = Isolated::new("settled");
    let graph = isolated.join("tester");
    let (publisher, one) = pair::<topic::Scan>(&graph);
    let other = graph.subscriber::<topic::Scan>().unwrap();
    let send = |items: &[usize]| {
        for &items in items {
            publisher.loan(items).unwrap().send().unwrap();
        }
    };
    let take_all = |subscriber: &Subscriber<topic::Scan>| {
        while subscriber.receive().unwrap().is_some() {}
    };
    let is_settled = || publisher.is_settled().unwrap();
    assert!(is_settled(), "nothing was sent");

    send(&[5, 5, 5]);
    assert!(!is_settled());
    take_all(&one);
    assert!(!is_settled(), "the other one has not looked");
    let held: Vec<_> = std::iter::from_fn(|| other.receive().unwrap()).collect();
    assert!(!is_settled(), "the other one looks at them still");
    drop(held);
    assert!(is_settled());
    assert!(is_settled(), "asking changes nothing");

    // More than fit, and larger than the memory so far.
    send(&[1000, 1, 2000, 1, 1, 5000, 3]);
    take_all(&other);
    assert!(!is_settled());
    take_all(&one);
    assert!(is_settled());

    send(&[5, 5]);
    take_all(&other);
    drop(one);
    assert!(is_settled(), "who has left takes nothing any more");
    drop(other);
    send(&[5]);
    assert!(is_settled(), "nobody is there");
}

#[test]
fn the_current_map_stays_while_the_next_ones_are_taken() {
    let isolated = Isolated::new("growth");
    let graph = isolated.join("tester");
    let (publisher, subscriber) = pair::<topic::Map>(&graph);
    let serve = |cells: usize, value: u8| {
        let mut loan = publisher.loan(cells).unwrap();
        loan.items_mut().fill(value);
        loan.send().unwrap();
        subscriber.newest().unwrap().unwrap()
    };
    let small = serve(1, 1);
    let large = serve(8_000_000, 2);
    let other = serve(8_000_000, 3);
    assert_eq!(small.items(), [1]);
    assert_eq!(large.items().len(), 8_000_000);
    assert!(large.items().iter().all(|&cell| cell == 2));
    assert!(other.items().iter().all(|&cell| cell == 3));
}

#[test]
fn health_is_sent_at_once_when_it_changes_and_when_the_node_ends() {
    let isolated = Isolated::new("reports");
    let graph = isolated.join("accumulator");
    let subscriber = graph.subscriber::<topic::Health>().unwrap();
    let mut health = graph.health().unwrap();
    let report = || {
        let sample = subscriber.receive().unwrap()?;
        let text = std::str::from_utf8(sample.items()).unwrap().to_owned();
        Some((*sample.header(), text))
    };
    let (first, text) = report().unwrap();
    assert_eq!(first.node.as_str(), "accumulator");
    assert_eq!(first.pid, std::process::id());
    assert_eq!(NodeState::from_code(first.state), Some(NodeState::Waiting));
    assert_eq!(text, "");

    health.count_received(5);
    health.count_sent(4);
    health.count_dropped(3);
    health.count_refused(1);
    assert!(report().is_none(), "counting alone sends nothing");
    health.state(NodeState::Ready).unwrap();
    health.state(NodeState::Ready).unwrap();
    let (ready, _) = report().unwrap();
    assert_eq!(NodeState::from_code(ready.state), Some(NodeState::Ready));
    let counts = (ready.received, ready.sent, ready.dropped, ready.refused);
    assert_eq!(counts, (5, 4, 3, 1));
    assert!(report().is_none(), "an old state is no news");

    // The last character would end one byte behind the limit.
    let long = format!("{}ä and more", "a".repeat(HealthHeader::ERROR_CAPACITY - 1));
    health.error(&long).unwrap();
    let cut = "a".repeat(HealthHeader::ERROR_CAPACITY - 1);
    assert_eq!(report().unwrap().1, cut);
    health.error("scan refused").unwrap();
    assert_eq!(report().unwrap().1, "scan refused");

    drop(health);
    let (last, text) = report().unwrap();
    assert_eq!(NodeState::from_code(last.state), Some(NodeState::Stopped));
    assert_eq!(text, "scan refused");
}

#[test]
fn the_event_loop_ends_when_asked() {
    let isolated = Isolated::new("loop");
    let graph = isolated.join("tester");
    let tick = Duration::from_millis(1);

    let mut calls = 0;
    let outcome = graph.run(&[], tick, |wake| {
        assert!(wake.tick, "without inputs, only ticks wake");
        calls += 1;
        Ok::<_, TransportError>(match calls {
            3 => Flow::Stop,
            _ => Flow::Continue,
        })
    });
    outcome.unwrap();
    assert_eq!(calls, 3);

    let name = "mine".to_owned();
    let mut error = Some(TransportError::GraphName { name });
    let outcome = graph.run(&[], tick, |_| Err(error.take().unwrap()));
    let error = outcome.unwrap_err();
    assert!(matches!(error, TransportError::GraphName { name } if name == "mine"));

    let flag = graph.stop_flag();
    let mut calls = 0;
    let mut step = |_| {
        calls += 1;
        flag.store(true, std::sync::atomic::Ordering::Relaxed);
        Ok::<_, TransportError>(Flow::Continue)
    };
    graph.run(&[], tick, &mut step).unwrap();
    graph.run(&[], tick, &mut step).unwrap();
    assert_eq!(calls, 1, "a set flag ends the loop before the next call");
}
