//! Requests that one server forwards to another.

use super::*;

#[test]
fn what_was_handed_on_comes_back_when_the_other_leaves() {
    let server = Server::start("leaves", &["--workers", "1", "--waiting", "1000"]);
    let caller = caller(&[&server]);
    // Simulated server that claims the same map and many workers but never answers.
    let other = session(&[], &[server.endpoint()]);
    let me = other.zid();
    let (_silent, kept) = stand_silent(&other, &format!("backcast/locate/corridor/{me}"));
    let map_id = map::load(world().map()).unwrap().id();
    let log = server.graph.subscriber::<topic::Log>().unwrap();
    let token = format!("backcast/locate/corridor/{me}/{map_id:016x}/ffffffffffffffff/64");
    let token = other.liveliness().declare_token(token).wait().unwrap();
    // The server logs the servers to which it may forward requests.
    let me = me.to_string();
    wait_until(&server.graph, &log, |_, text| {
        String::from_utf8_lossy(text).contains(&me)
    });
    // All at the same time, so that they exceed what the server searches at once.
    let scan = &scans()[0];
    let asked: Vec<_> = (0..20).map(|_| ask_json(&caller, scan)).collect();
    let _held = kept.recv_timeout(TIMEOUT).expect("none was handed on");
    token.undeclare().wait().unwrap();
    for replies in asked {
        replies.recv().unwrap().into_result().unwrap();
    }
    server.process.stop();
}

#[test]
fn a_server_gives_back_what_it_does_not_know() {
    let server = Server::start("older", &[]);
    let session = caller(&[&server]);
    let tokens = session.liveliness().get("backcast/locate/corridor/**");
    let token = tokens.wait().unwrap().recv().unwrap();
    let token = token.into_result().unwrap();
    let me = token.key_expr().as_str().split('/').nth(3).unwrap();
    // The forwarding server may be newer; it takes back requests that are answered with "busy".
    for (asked, expected) in [(format!("/{me}"), BUSY), (String::new(), REFUSED)] {
        let reply = ask_raw(&session, &asked, "of/tomorrow", Vec::new());
        failed_as(reply, expected);
    }
    server.process.stop();
}
