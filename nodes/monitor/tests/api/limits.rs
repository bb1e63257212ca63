//! Limits on number, size and speed.

use std::io::Read;
use std::net::TcpStream;

use serde_json::json;
use tungstenite::{Message, client};

use crate::world::{World, next};

#[test]
fn silent_connections_lock_nobody_out() {
    let world = World::new("silent");
    let mut watcher = world.stream();
    assert_eq!(next(&mut watcher)["type"], "snapshot");
    // More connections than are allowed at the same time, all of them silent.
    let mut silent: Vec<_> = (0..300)
        .map(|_| TcpStream::connect(world.site.0).unwrap())
        .collect();
    assert_eq!(world.site.get("/api/v1/robots")["robots"], json!(["r"]));
    // The first one was closed to make room.
    assert_eq!(silent[0].read(&mut [0]).unwrap_or(0), 0);
    // The remaining ones have a few seconds for a request and are then closed.
    assert_eq!(silent[299].read(&mut [0]).unwrap_or(0), 0);
    // The watcher is not silent, so it was not closed.
    world.answer(1, 1.0);
    while next(&mut watcher)["type"] != "answer" {}
}

#[test]
fn hostile_sizes_end_the_connection_and_nothing_else() {
    let world = World::new("hostile");
    let mut socket = world.stream();
    next(&mut socket);
    // Larger than a message to the monitor may be.
    let sent = socket.send(Message::text("x".repeat(1 << 20)));
    let ended =
        sent.is_err() || std::iter::from_fn(|| Some(socket.read())).any(|read| read.is_err());
    assert!(ended);
    let mut socket = world.stream();
    socket.send(Message::text("{\"type\":\"reboot\"}")).unwrap();
    let closed = loop {
        if let Message::Close(frame) = socket.read().unwrap() {
            break frame.unwrap();
        }
    };
    assert_eq!(u16::from(closed.code), 1008);
    assert!(closed.reason.contains("reboot"), "{}", closed.reason);
    // A header without end is cut off, and garbage is not a request.
    let long = "x".repeat(1 << 20);
    let head = format!("GET / HTTP/1.1\r\nHost: x\r\nX: {long}\r\n\r\n");
    assert!((400..500).contains(&world.site.raw(head.as_bytes()).0));
    assert_eq!(world.site.raw(b"\x16\x03\x01 hello\r\n\r\n").0, 400);
    assert_eq!(world.site.get("/api/v1/robots")["robots"], json!(["r"]));
}

#[test]
fn as_many_watch_as_may() {
    let world = World::new("many");
    let sockets: Vec<_> = (0..64).map(|_| world.stream()).collect();
    let url = format!("ws://{}/api/v1/robots/r/stream", world.site.0);
    let refused = client(url, TcpStream::connect(world.site.0).unwrap());
    assert!(refused.is_err(), "the 65th is refused");
    drop(sockets);
}
