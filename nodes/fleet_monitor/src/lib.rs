//! Node `fleet_monitor`: one web page to watch all robots of a network, and its API.
//!
//! | file | content |
//! |---|---|
//! | `feed` | a topic of one robot or of all robots, from the network to this thread |
//! | `fleet` | the robots that were discovered, and their data |
//! | `requests` | requests of users with the token, sent to a robot |
//! | `run` | the event loop |
//!
//! Crate `dashboard` implements the page and the API; the messages are those of bridges. A robot is
//! listed once a valid message of it was received. Messages from unknown senders are validated,
//! limited and counted before anything is shown.

mod config;
mod error;
mod feed;
mod fleet;
mod requests;
mod run;

pub use config::Config;
pub use error::FleetError;
pub use run::run;
