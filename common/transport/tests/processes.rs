//! Several processes in one graph: shared memory, and processes that come late, stop or are killed.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod member;

use std::process::ExitCode;

use member::{Member, place_of, serve_if_asked, wait_for_map};
use messages::{Topic, topic};
use nix::sys::signal::Signal;
use transport::testing::Isolated;
use transport::{TransportError, remove_leftovers};

/// Process that the other tests start; when run as a test, it starts itself.
#[test]
fn member() {
    if serve_if_asked() {
        return;
    }
    let isolated = Isolated::new("member");
    let mut member = Member::start(isolated.name(), "somebody");
    assert_eq!(member.ask("name"), "somebody");
    member.end();
}

#[test]
fn main_turns_outcomes_into_exit_codes() {
    let isolated = Isolated::new("main");
    for (outcome, code) in [("ok", ExitCode::SUCCESS), ("wrong", ExitCode::FAILURE)] {
        let mut member = Member::start(isolated.name(), "outer");
        assert_eq!(member.ask(&format!("main {outcome}")), format!("{code:?}"));
        // Logging has been started by now and cannot be started twice.
        let usage = format!("{:?}", ExitCode::from(2));
        assert_eq!(member.ask("main ok"), usage);
        member.end();
    }
}

#[test]
fn payload_is_shared_and_not_copied() {
    let isolated = Isolated::new("zerocopy");
    let graph = isolated.join("tester");
    let subscriber = graph.subscriber::<topic::Map>().unwrap();
    let mut publisher = Member::start(isolated.name(), "publisher");
    let mut other = Member::start(isolated.name(), "other");
    assert_eq!(other.ask("subscribe"), "subscribed");
    for id in 1..=3 {
        let place = publisher.ask(&format!("publish {id} 1440000"));
        assert!(place.starts_with("/dev/shm/"), "{place}");
        let sample = wait_for_map(&graph, &subscriber);
        assert_eq!(place_of(sample.items()), place);
        assert_eq!(other.ask("receive"), format!("{id} {place}"));
    }
    publisher.end();
    other.end();
}

#[test]
fn a_late_joiner_gets_the_latched_map_while_the_publisher_is_idle() {
    let isolated = Isolated::new("late");
    let mut publisher = Member::start(isolated.name(), "publisher");
    publisher.ask("publish 7 100");
    assert_eq!(publisher.ask("idle 10"), "idle");
    let graph = isolated.join("tester");
    for _ in 0..3 {
        let subscriber = graph.subscriber::<topic::Map>().unwrap();
        let sample = wait_for_map(&graph, &subscriber);
        assert_eq!(sample.header().map_id, 7);
        assert_eq!(sample.items(), [7; 100]);
    }
    publisher.stop(Signal::SIGTERM);
}

#[test]
fn signals_end_the_wait_at_once() {
    let isolated = Isolated::new("signals");
    for signal in [Signal::SIGINT, Signal::SIGTERM] {
        let mut idle = Member::start(isolated.name(), "idle");
        // With a tick of a day, only the signal can end the wait.
        assert_eq!(idle.ask("idle 86400000"), "idle");
        idle.stop(signal);
    }
}

#[test]
fn a_subscriber_that_came_first_is_woken_by_the_first_publisher() {
    let isolated = Isolated::new("early");
    let mut subscriber = Member::start(isolated.name(), "subscriber");
    assert_eq!(subscriber.ask("subscribe"), "subscribed");
    subscriber.command("receive");
    let mut publisher = Member::start(isolated.name(), "publisher");
    let place = publisher.ask("publish 9 10");
    assert_eq!(subscriber.answer(), format!("9 {place}"));
    subscriber.end();
    publisher.end();
}

#[test]
fn a_killed_publisher_can_be_replaced_while_the_subscriber_goes_on() {
    let isolated = Isolated::new("killpub");
    let graph = isolated.join("tester");
    let subscriber = graph.subscriber::<topic::Map>().unwrap();
    let mut held = Vec::new();
    // More often than there are slots for publishers: those of dead ones must be freed.
    let times = u8::try_from(topic::Map::MAX_PUBLISHERS).unwrap() + 2;
    for id in 1..=times {
        let mut publisher = Member::start(isolated.name(), "publisher");
        publisher.ask(&format!("publish {id} 5000"));
        let sample = wait_for_map(&graph, &subscriber);
        assert_eq!(sample.header().map_id, u64::from(id));
        publisher.kill();
        held.push(sample);
    }
    for (sample, id) in held.iter().zip(1..) {
        assert!(sample.items().iter().all(|&cell| cell == id));
    }
}

#[test]
fn a_killed_subscriber_can_be_replaced_while_the_publisher_goes_on() {
    let isolated = Isolated::new("killsub");
    let mut publisher = Member::start(isolated.name(), "publisher");
    publisher.ask("publish 7 100");
    assert_eq!(publisher.ask("idle 10"), "idle");
    // More often than there are slots for subscribers.
    for _ in 0..topic::Map::MAX_SUBSCRIBERS + 2 {
        let mut subscriber = Member::start(isolated.name(), "subscriber");
        assert_eq!(subscriber.ask("subscribe"), "subscribed");
        assert!(subscriber.ask("receive").starts_with("7 "));
        subscriber.kill();
    }
    publisher.stop(Signal::SIGTERM);
}

#[test]
fn a_graph_that_ended_in_order_leaves_nothing() {
    let isolated = Isolated::new("clean");
    let mut publisher = Member::start(isolated.name(), "publisher");
    let mut subscriber = Member::start(isolated.name(), "subscriber");
    subscriber.ask("subscribe");
    publisher.ask("publish 1 1000");
    subscriber.ask("receive");
    assert!(!isolated.files().is_empty());
    publisher.end();
    subscriber.end();
    remove_leftovers(isolated.name()).unwrap();
    assert_eq!(isolated.files(), Vec::<std::path::PathBuf>::new());
}

#[test]
fn a_killed_graph_leaves_nothing_and_a_living_one_is_left_alone() {
    let (isolated, neighbour) = (Isolated::new("killall"), Isolated::new("neighbour"));
    let _neighbour = neighbour.join("tester");
    let mut publisher = Member::start(isolated.name(), "publisher");
    let mut subscriber = Member::start(isolated.name(), "subscriber");
    subscriber.ask("subscribe");
    publisher.ask("publish 1 1000");
    subscriber.ask("receive");

    let error = remove_leftovers(isolated.name()).unwrap_err();
    let text = error.to_string();
    assert!(matches!(error, TransportError::StillRunning { .. }));
    for (node, member) in [("publisher", &publisher), ("subscriber", &subscriber)] {
        let process = format!("{node} (process {})", member.id());
        assert!(text.contains(&process), "{text}");
    }
    publisher.ask("publish 2 1000");
    assert!(subscriber.ask("receive").starts_with("2 "));

    let kept = neighbour.files();
    publisher.kill();
    subscriber.kill();
    assert!(!isolated.files().is_empty());
    remove_leftovers(isolated.name()).unwrap();
    assert_eq!(isolated.files(), Vec::<std::path::PathBuf>::new());
    assert!(!kept.is_empty());
    assert_eq!(neighbour.files(), kept);
}

#[test]
fn a_supervisor_frees_what_a_killed_node_left() {
    let isolated = Isolated::new("supervise");
    let supervisor = isolated.join("tester");
    let publisher = supervisor.publisher::<topic::Map>().unwrap();
    let mut subscriber = Member::start(isolated.name(), "subscriber");
    subscriber.ask("subscribe");
    assert!(publisher.has_subscribers());
    assert_eq!(supervisor.cleanup_dead_nodes(), 0);
    subscriber.kill();
    assert_eq!(supervisor.cleanup_dead_nodes(), 1);
    assert!(!publisher.has_subscribers());
}
