//! Processes of a graph, and the topics between them.
//!
//! A node joins a [`Graph`], creates its publishers and subscribers from it and runs its event
//! loop. Everything about iceoryx2, which carries the samples, stays in this crate; the content of
//! samples is defined in `messages`.
//!
//! ```no_run
//! use std::process::ExitCode;
//! use std::time::Duration;
//! use messages::topic;
//! use transport::{Flow, Graph, TransportError};
//!
//! fn run(graph: &Graph) -> Result<(), TransportError> {
//!     let scans = graph.subscriber::<topic::Scan>()?;
//!     let votes = graph.publisher::<topic::Votes>()?;
//!     let mut health = graph.health()?;
//!     graph.run(&[&scans], Duration::from_millis(100), |_| {
//!         while let Some(scan) = scans.receive()? {
//!             health.count_received(1);
//!             let mut loan = votes.loan(0)?;
//!             loan.header_mut().stamp = scan.header().stamp;
//!             loan.send()?;
//!             health.count_sent(1);
//!         }
//!         health.tick()?;
//!         Ok(Flow::Continue)
//!     })
//! }
//!
//! fn main() -> ExitCode {
//!     transport::node::main("example", run)
//! }
//! ```
//!
//! # Invariants
//!
//! - **Nothing is copied.** A loan is filled in shared memory, and a sample is read there, in the
//!   same file at the same offset. A sample never changes while a subscriber holds it, even if its
//!   publisher is killed.
//! - **Publishers do not wait for slow subscribers.** These lose their oldest samples beyond
//!   [`messages::Topic::DEPTH`]; [`GapCounter`] counts them.
//! - **No sample stays unseen for longer than a tick.** Each send is followed by a wake-up, and
//!   wake-ups are cleared before samples are received. If one is missing (the publisher was killed
//!   in between), the next tick finds the sample. The order of starts does not matter: a new port
//!   is connected by the next send, receive or tick of the other one.
//! - **Late joiners get the newest sample of a latched topic**, or the newest
//!   [`messages::Topic::HISTORY`], within a tick of its publisher, which must be in [`Graph::run`].
//!   The samples are gone when the publisher has ended.
//! - **Graphs do not receive each other's messages**, nor do users: the prefix of every file
//!   contains user and graph, and no prefix begins another one.
//! - **Slots of dead members are freed** by processes that join or leave and by
//!   [`Graph::cleanup_dead_nodes`]. Until then a dead subscriber counts as a subscriber.
//! - **Full shared memory ends no process.** A sample without room is lost and counted, and so are
//!   log lines and health messages; only the publisher of a latched topic gets an error. Room is
//!   checked before use, because iceoryx2 would be killed by SIGBUS.
//! - **iceoryx2 handles no signals and prints nothing**; both are done here.
//!
//! One kind of loss remains: when a publisher ends, a subscriber loses the samples of this
//! publisher if it has not received any since the publisher was created or last grew its memory. A
//! source that ends by itself waits for [`Publisher::is_settled`].
//!
//! # Memory
//!
//! A publisher has one sparse segment in `/dev/shm` for
//! `MAX_SUBSCRIBERS · (DEPTH + 4) + HISTORY + 2 + 1` chunks of its largest sample so far, rounded up to a power of two; only as many as are ever
//! in use at the same time take memory. A map of 8 million cells takes 8 MiB, and 8 MiB more for each
//! further map that a subscriber holds. A larger sample begins a new segment; the old one is freed
//! with its last sample. Each pair of publisher and subscriber takes about 20 KiB.

mod causes;
mod clock;
mod descriptors;
mod error;
mod error_limit;
mod event_loop;
mod gaps;
mod graph;
mod graph_name;
mod header;
mod health;
mod idle;
mod leftovers;
mod log;
mod log_limit;
mod log_lines;
mod log_sender;
mod losses;
mod membership;
pub mod node;
mod peers;
mod publisher;
mod root;
mod service;
mod signals;
mod space;
mod subscriber;
pub mod testing;
mod waker;

pub use causes::with_causes;
pub use clock::{monotonic_ns, stamp_now, wall_ns};
pub use error::TransportError;
pub use error_limit::ErrorLimit;
pub use event_loop::{Flow, Wake};
pub use gaps::GapCounter;
pub use graph::Graph;
pub use graph_name::{GRAPH_VARIABLE, GraphName};
pub use health::Health;
pub use leftovers::{files_of, remove_dead_graphs, remove_leftovers};
pub use log_lines::{CONSOLE_ONLY, log_in_graph};
pub use membership::{Claim, control_socket, graphs_of_others, is_launched, running_graphs};
pub use peers::Peers;
pub use publisher::{Loan, Publisher};
pub use space::shared_memory_has_room;
pub use subscriber::{Input, Sample, Subscriber};
pub use waker::Waker;
