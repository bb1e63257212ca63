//! Helpers shared by the tests of several files.

use clap::Parser;
use dataflow::Dataflow;

use super::options::Options;

pub(crate) fn parsed(text: &str) -> Dataflow {
    dataflow::parse(text).unwrap()
}

#[derive(Parser)]
struct Line {
    #[command(flatten)]
    options: Options,
}

pub(crate) fn options(line: &str) -> Options {
    Line::parse_from(["run"].into_iter().chain(line.split(' '))).options
}
