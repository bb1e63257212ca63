//! The descriptor of a graph, `dataflow.yaml`: its processes, how they are built and started, and
//! the topics that connect them.
//!
//! It is a strict subset of dora's descriptor: everything accepted here, `dora validate` and `dora
//! run` accept with the same meaning. Where dora guesses, replaces or ignores, this crate reports
//! an error. Every problem names its line and column, and all problems that can be found at once
//! are reported at once. The crate starts no process.
//!
//! | key | value | default |
//! |---|---|---|
//! | `id` | 1 to 32 of `a-z A-Z 0-9 _ . -`, not `dora` | required |
//! | `path` | executable, relative to the descriptor's folder | required |
//! | `args` | words, quoted as in a shell; no expansion | no arguments |
//! | `env` | map of names to strings, integers, decimals or booleans | none |
//! | `build` | commands, one per line, split at spaces; run in the descriptor's folder | none |
//! | `inputs` | map of topic to `node/topic` | none |
//! | `outputs` | list of topics | none |
//! | `restart_policy` | `never`, `on-failure`, `always` | `never` |
//! | `max_restarts` | maximum number within `restart_window`, 0 for no limit | 0 |
//! | `restart_delay` | seconds before the first restart; doubles with each restart | 0 |
//! | `max_restart_delay` | maximum delay in seconds | 5, or `restart_delay` if that is more |
//! | `restart_window` | seconds | 60 |
//! | `health_check_timeout` | seconds without a heartbeat until the node is killed, at least 2 | 15 |
//!
//! Without the last three keys, dora lets delays grow without limit, counts all restarts, and does
//! not check health.

mod descriptor;
mod error;
mod files;
mod node;
mod place;
mod raw;
mod scalar;
mod wiring;
mod words;

pub use descriptor::{Command, Dataflow, Input, Node, Restart, RestartPolicy};
pub use error::DataflowError;
pub use files::check_executables;
pub use place::{Place, Problem};

use std::path::Path;

pub const MAX_FILE_BYTES: u64 = 1 << 20;
pub const MAX_NODES: usize = 64;
pub const MAX_ID_BYTES: usize = 32;

/// Reads and checks the descriptor at `path`, of at most [`MAX_FILE_BYTES`].
pub fn load(path: &Path) -> Result<Dataflow, DataflowError> {
    let text = files::read(path)?;
    parse(&text).map_err(|problems| DataflowError::Wrong {
        file: path.to_owned(),
        problems,
    })
}

/// Checks a descriptor; returns its problems in the order of the text, or why it is none.
pub fn parse(text: &str) -> Result<Dataflow, Vec<Problem>> {
    let raw = raw::parse(text).map_err(|problem| vec![problem])?;
    let mut problems = Vec::new();
    let dataflow = node::read_all(&raw, text, &mut problems);
    wiring::check(&raw, &mut problems);
    if problems.is_empty() {
        return Ok(dataflow);
    }
    problems.sort_by_key(|p| p.place);
    Err(problems)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const SOUND: &str = "nodes:
  - id: a
    path: x
    args: --flag 'two words'
    env: { RUST_LOG: debug, N: 3 }
    build: make x
    outputs: [scan]
    restart_policy: on-failure
    max_restarts: 3
    restart_delay: 0.5
  - id: b
    path: y
    inputs: { scan: a/scan }
";

    #[test]
    fn the_descriptor_that_the_properties_damage_is_sound() {
        assert_eq!(parse(SOUND).map(|d| d.nodes.len()), Ok(2));
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in any::<String>()) {
            let _ = parse(&text);
        }

        /// Every problem refers to a line of the text.
        #[test]
        fn a_damaged_descriptor_is_read_or_refused_in_place(
            at in 0..SOUND.len(),
            length in 0..12usize,
            patch in "[-a-z:{}\\[\\],'\"#&*!|> \n0-9.]{0,6}",
        ) {
            let end = (at + length).min(SOUND.len());
            let text = format!("{}{patch}{}", &SOUND[..at], &SOUND[end..]);
            for problem in parse(&text).err().unwrap_or_default() {
                let lines = text.lines().count() as u64;
                prop_assert!((1..=lines + 1).contains(&problem.place.line), "{problem}");
            }
        }
    }
}
