//! Tests of the reader as a process.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

mod angles;
mod node;

use std::net::TcpListener;

/// Listens on a free port; returns the listener and its address.
fn listen() -> (TcpListener, String) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    (listener, address)
}
