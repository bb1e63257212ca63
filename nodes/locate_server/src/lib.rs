//! Localization as a service: any Zenoh client sends a scan to `backcast/locate/<map>` and receives
//! its places on that map. Any number of servers may answer for one map; Zenoh delivers a request
//! to one of them, which forwards it if it has no free worker, or answers "busy" if its queue is
//! full. Servers keep no state between requests.

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
