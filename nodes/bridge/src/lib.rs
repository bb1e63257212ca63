//! Joins graphs on several machines over Zenoh.
//!
//! `dataflow.yaml` defines which topics leave this graph and which enter it: inputs of the bridge
//! are sent, its outputs are received. A topic has the key `backcast/<robot>/<topic>` and the
//! format of crate `network_payload`, so that any Zenoh program can read it. Maps, boundaries and
//! regions are kept for late joiners. Messages from the network are checked before they enter the
//! graph, refused if invalid, and counted in `health`.
//!
//! It neither trusts senders nor hides data: users and access rules belong to the configuration of
//! Zenoh.

mod alive;
mod config;
mod error;
mod exit;
mod incoming;
mod json;
mod outgoing;
mod plain;
mod ports;
mod rates;
mod route;
mod run;

pub use config::Config;
pub use error::BridgeError;
pub use ports::Ports;
pub use rates::Rate;
pub use run::run;
