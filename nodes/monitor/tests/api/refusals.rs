//! Requests that are refused.

use crate::world::World;

#[test]
fn other_sites_are_refused() {
    let world = World::new("sites");
    let ask = |headers: &[&str]| world.site.ask("GET", "/api/v1/robots", headers, "").0;
    assert_eq!(ask(&["Origin: http://evil.example"]), 403);
    assert_eq!(ask(&[&format!("Origin: http://{}", world.site.0)]), 200);
    assert_eq!(ask(&["Host: evil.example"]), 421);
    // Browsers do not block WebSockets from other sites.
    let upgrade = [
        "Connection: Upgrade",
        "Upgrade: websocket",
        "Sec-WebSocket-Version: 13",
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
        "Origin: http://evil.example",
    ];
    let site = &world.site;
    let (status, _) = site.ask("GET", "/api/v1/robots/r/stream", &upgrade, "");
    assert_eq!(status, 403);
    let host = format!("Host: {}\r\nConnection: close", site.0);
    let (_, head, _) = site.raw(format!("GET / HTTP/1.1\r\n{host}\r\n\r\n").as_bytes());
    let policy = "content-security-policy: default-src 'none'";
    assert!(head.contains(policy), "{head}");
}
