//! Comparison of the documents with the code: links, table of contents, options, exit codes,
//! messages, JSON and figures of the shipped recordings.
//!
//! Tables of options and exit codes are written from `--help` by
//! `BACKCAST_ACCEPT=1 cargo test --release -p tests --test documents`, and the figures by
//! `backcast bench docs`.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod figures;
mod links;
mod options;
mod structs;

use std::path::Path;

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
