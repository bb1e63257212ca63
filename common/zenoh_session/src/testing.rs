//! Other clients of the network, for tests.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use zenoh::{Config, Session, Wait};

use crate::session::{CONNECT, MODE, SCOUTING};

/// Opens the session of a client that is connected to `endpoint`.
pub fn client(endpoint: &str) -> Session {
    let mut config = Config::default();
    let endpoints = format!("['{endpoint}']");
    for (key, value) in [
        (MODE, "'client'"),
        (CONNECT, &endpoints),
        (SCOUTING, "false"),
    ] {
        config.insert_json5(key, value).unwrap();
    }
    zenoh::open(config).wait().unwrap()
}
