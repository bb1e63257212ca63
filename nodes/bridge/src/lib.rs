//! Joins graphs on several machines over Zenoh.
//!
//! Which topics leave this graph and which enter it is in `dataflow.yaml`: what
//! the bridge takes as inputs goes out, what it lists as outputs comes in. A topic
//! stands at `backcast/<robot>/<topic>`, as crate `network_payload` writes it, so that
//! whoever speaks Zenoh can read it. Maps, boundaries and regions are kept for late
//! joiners. What comes from the network is checked before it enters the graph,
//! refused if it is wrong, and counted in `health`.
//!
//! It trusts nobody and hides nothing: users and rules of access are Zenoh's own,
//! in its configuration.

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
