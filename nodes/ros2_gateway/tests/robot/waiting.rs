//! Inputs that the gateway waits for, as the page shows them.

use super::client::active;
use super::*;

#[test]
fn a_router_that_is_not_there_is_named_until_it_is() {
    let isolated = Isolated::new("ros-router");
    let graph = isolated.join("test");
    let endpoint = format!("tcp/{}:7447", isolated.name().loopback());
    let gateway = start_gateway(&graph, &["--connect".to_owned(), endpoint.clone()]);
    wait_until_waiting(&graph, &format!("waiting for a router: none at {endpoint}"));
    // Another gateway is a router.
    let elsewhere = Isolated::new("ros-elsewhere");
    let other = elsewhere.join("other");
    let router = start_gateway(&other, &["--listen".to_owned(), endpoint.clone()]);
    wait_until_waiting(
        &graph,
        "waiting for /map: no publisher, /scan: no publisher",
    );
    // The router stops again.
    router.stop();
    wait_until_waiting(&graph, &format!("waiting for a router: none at {endpoint}"));
    gateway.stop();
}

#[test]
fn inputs_that_do_not_come_are_named_and_the_node_is_ready_when_they_do() {
    let Some(mut joined) = active("ros-waiting", "/", &["save_pose_rate: 0.0"], &[]) else {
        return;
    };
    let graph = &joined.graph;
    let robot = &mut joined.robot;
    robot.order("humble", json!({ "topic": "scan" }));
    // Its types have no hashes.
    let humble = "/scan: a publisher, and no message yet";
    wait_until_waiting(graph, &format!("/map: no publisher, {humble}"));
    robot.order("arrive", json!({}));
    wait_until_waiting(graph, &format!("waiting for {humble}"));
    // Subscribed in advance, because this state lasts no longer than the scan.
    let health = graph.subscriber::<topic::Health>().unwrap();
    robot.order("drive", json!({ "index": 0 }));
    wait_until_green(graph, &health);
    // The laser is silent again.
    wait_until_waiting(graph, "waiting for /scan: no message any more");
    joined.stop();
}
