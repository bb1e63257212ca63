//! The processes of a graph, and the topics that flow between them.
//!
//! A node joins a [`Graph`], takes the ends of its topics from it and runs its
//! event loop. Everything about iceoryx2, which carries the samples, stays in
//! this crate; what the samples hold is the business of `messages`.
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
//! # Files
//!
//! | file | what it is about |
//! |---|---|
//! | `graph_name`, `membership`, `root` | which graph; what keeps it apart from others; the user's folder |
//! | `graph` | joining, and making the ends of topics |
//! | `service`, `header` | a topic in terms of iceoryx2: quality of service, types |
//! | `publisher` (`loan`), `idle` | sending; filling in place; late joiners |
//! | `subscriber`, `gaps` | receiving; counting what was lost |
//! | `peers` | who is at the other end of a topic |
//! | `event_loop`, `signals`, `waker` | waiting for inputs, ticks, SIGINT, SIGTERM and SIGHUP, other threads |
//! | `health`, `clock` | a node's report on itself; the clocks |
//! | `node`, `log` | `main` of a node: logging, exit code |
//! | `log_lines`, `log_sender`, `log_limit` | what a node logs, on its way to topic `log`; what repeats too fast |
//! | `space`, `losses` | room in shared memory, looked up before it is used; what was lost without it |
//! | `membership/alive`, `leftovers` | who lives, by locks; removing what a graph leaves |
//! | `descriptors` | whether the process may open enough files |
//! | `error`, `causes` | what can go wrong; an error with its causes on one line |
//! | `testing` | for tests of nodes: a graph of their own, the node as a process |
//!
//! # Invariants
//!
//! - **Nothing is copied.** A loan is filled in shared memory, and a sample is
//!   read there, in the same file at the same offset. A sample never changes
//!   while somebody holds it, even if its publisher is killed.
//! - **Nobody waits for a slow subscriber.** It loses its oldest samples beyond
//!   [`messages::Topic::DEPTH`]; [`GapCounter`] counts them.
//! - **No sample stays unseen for longer than a tick.** Each send is followed by
//!   a wake-up, and wake-ups are taken before samples are. Where one is missing
//!   all the same (the publisher was killed in between), the next tick finds the
//!   sample. It does not matter who starts first: an end that comes is connected
//!   by the next send, receive or tick of the other one.
//! - **Late joiners get the newest sample of a latched topic**, or the newest
//!   [`messages::Topic::HISTORY`], within a tick of its publisher, which must be
//!   in [`Graph::run`]; the topic has none any more when its publisher has gone.
//! - **Graphs do not receive each other's messages**, nor do users: the prefix of every file
//!   holds user and graph, and no prefix begins another one.
//! - **The dead make way.** Whoever joins cleans up after members that were
//!   killed, and so do members that leave and [`Graph::cleanup_dead_nodes`].
//!   Until then a dead subscriber counts as one.
//! - **Full shared memory ends nothing.** A sample that finds no room is lost and
//!   counted, and so are log lines and reports of health; only a sender of a latched topic
//!   gets an error. iceoryx2 would be killed by SIGBUS, so room is looked up before.
//! - **iceoryx2 handles no signals and prints nothing**; both are done here.
//!
//! One loss remains: a publisher that goes takes along what it sent to a
//! subscriber that has not looked since the publisher came, or since it last grew
//! its memory. A source that ends by itself waits for [`Publisher::is_settled`].
//!
//! # Memory
//!
//! A publisher has one segment in `/dev/shm` for
//! `MAX_SUBSCRIBERS · (DEPTH + 4) + HISTORY + 2 + 1` chunks, each as large as
//! its largest sample so far, rounded up to a power of two. The file is sparse:
//! chunks are taken last in, first out, and only those count that were ever in
//! use at the same time. For a map of 8 million cells that is 43 chunks of 8 MiB:
//! the file claims 344 MiB, and takes 8 MiB at first, 16 MiB once a second map
//! was filled while the first was kept, and 8 MiB more for each further map that
//! a subscriber holds. The worst case, all that the file claims, needs every
//! subscriber to hold four different maps. A larger sample begins a new segment;
//! the old one goes with its last sample. Wake-ups and connections take about
//! 20 KiB for each pair of publisher and subscriber.

mod causes;
mod clock;
mod descriptors;
mod error;
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
pub use clock::{monotonic_ns, wall_ns};
pub use error::TransportError;
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
