//! Tests of the API from outside: over TCP, with a graph behind it.
#![allow(clippy::unwrap_used, reason = "the lint spares test functions alone")]

mod limits;
mod phone;
mod reading;
mod refusals;
mod webhook;
mod world;
mod writing;
