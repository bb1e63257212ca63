//! Joins a graph to a ROS 2 robot, with no ROS installed.
//!
//! It speaks the protocol of `rmw_zenoh`, or DDS. The robot's scan, odometry and map enter the
//! graph; the graph's results go to the robot, along with an initial pose for its particle filter
//! as soon as the verdict is Unique. The crate `ros` knows the message formats and nothing of
//! localization; `frames`, `seeding`, `waiting` and `vda5050` are pure. Messages from the network
//! are checked before they enter the graph; invalid ones are rejected and counted in `health`.
//!
//! It moves no robot and sets no parameter. Module `amcl` is the node in AMCL's place: it publishes
//! the tracker's pose in all of AMCL's forms, with AMCL's services and parameters.

mod amcl;
mod broadcast;
mod checks;
mod config;
mod diagnostics;
mod error;
mod frames;
mod incoming;
mod inputs;
mod joined;
mod look;
mod middleware;
mod outgoing;
mod outlet;
mod rmw;
mod role;
mod ros_args;
mod run;
mod seeding;
mod stamps;
mod topics;
mod vda5050;
mod verdict;
mod waiting;

pub use config::{Brought, Config, NODE, Seed};
pub use error::GatewayError;
pub use middleware::Rmw;
pub use role::{Options, Role};
pub use ros_args::translated;
pub use run::run;
