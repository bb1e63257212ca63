//! Locating as a service: whoever speaks Zenoh asks `backcast/locate/<map>` with a
//! scan, and gets its places on that map.
//!
//! Any number of servers may answer for one map, on any machines. Zenoh brings a
//! request to one of them, which hands on what it has no free worker for; the
//! caller gets one answer. Each takes on as much as its queue holds and says "busy"
//! beyond that; what cannot be answered before its deadline is not searched. Nothing
//! is kept from one request to the next: who wants to be tracked runs the graph.
//!
//! A server of several maps searches them together.

mod client;
mod config;
mod counts;
mod dispatcher;
mod error;
mod json;
mod locator;
mod request;
mod run;
mod team;
mod worker;

pub use client::ask;
pub use config::Config;
pub use error::{BUSY, LATE, LocateError, REFUSED};
pub use locator::{Answer, Locator, SearchedMap, Workspace};
pub use request::{Form, JSON, JSON_ANSWER, Request, read, write};
pub use run::run;
