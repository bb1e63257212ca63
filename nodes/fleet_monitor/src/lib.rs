//! Node `fleet_monitor`: one web page to watch all robots of a network, and the API
//! behind it.
//!
//! | file | what it is about |
//! |---|---|
//! | `feed` | a topic of one robot or of all, from the network to our thread |
//! | `fleet` | the robots that were discovered, and what each is sent |
//! | `requests` | what those with the token want, on its way to a robot |
//! | `run` | the event loop |
//!
//! The page and the API are `dashboard`'s, the messages those that bridges send. A
//! robot is listed once something valid was received from it. Strangers may send what they
//! like: it is checked, bounded and counted before anything is shown.

mod config;
mod error;
mod feed;
mod fleet;
mod requests;
mod run;

pub use config::Config;
pub use error::FleetError;
pub use run::run;
