//! Comparison of the documents with the code: links, table of contents, options, exit codes,
//! messages and JSON.
//!
//! Tables of options and exit codes are written from `--help`:
//! `BACKCAST_ACCEPT=1 cargo test --release -p tests --test documents`.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

mod links;
mod options;
mod structs;

use std::path::Path;

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
