//! A web page to watch robots, and the API behind it.
//!
//! | file | what it is about |
//! |---|---|
//! | `view` | what the page is sent, from the messages of a graph; pure |
//! | `robot` | what is known of one robot, and whoever watches it |
//! | `robots` | those that are known |
//! | `server` | HTTP and WebSocket: the gate, the API, the page |
//! | `webhook` | states of the robots, posted elsewhere |
//!
//! Where the messages come from is up to whoever uses it: a source gives a
//! [`Robot`] what happens, and takes the requests that it is given. Nobody waits for
//! those who watch: a message is written as text once and handed to all of them, and
//! who is too slow loses some and is sent their number. The crate localizes nothing, and
//! shows nothing that no node said.

mod error;
mod options;
mod robot;
mod robots;
mod server;
mod token;
mod view;
mod webhook;

pub use error::DashboardError;
pub use options::Options;
pub use robot::{Request, Robot};
pub use robots::Robots;
pub use server::Server;
pub use view::Abilities;
