//! Errors in a descriptor.

use std::{fmt::Write as _, io, path::PathBuf};

use crate::{MAX_FILE_BYTES, MAX_ID_BYTES, MAX_NODES, Problem};

/// Error of a descriptor.
#[derive(Debug, thiserror::Error)]
pub enum DataflowError {
    /// The file could not be read.
    #[error("cannot read {}", file.display())]
    Unreadable {
        /// Path as given.
        file: PathBuf,
        source: io::Error,
    },
    /// The file is too large to be a descriptor.
    #[error("{} has more than {MAX_FILE_BYTES} bytes, which is the most that is read", file.display())]
    TooLarge {
        /// Path as given.
        file: PathBuf,
    },
    /// The file has errors.
    #[error("{}", lines(file, problems))]
    Wrong {
        /// Path as given.
        file: PathBuf,
        /// Problems in the order of the file, at least one.
        problems: Vec<Problem>,
    },
}

/// Formats a line for each problem: `file:line:column: what`.
fn lines(file: &std::path::Path, problems: &[Problem]) -> String {
    let mut text = String::new();
    for (i, problem) in problems.iter().enumerate() {
        let separator = if i == 0 { "" } else { "\n" };
        // Writing to a string cannot fail.
        let _ = write!(text, "{separator}{}:{problem}", file.display());
    }
    text
}

/// An error at one place: what was found and what is allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Fault {
    /// The text is not YAML, or uses more of YAML than a descriptor may.
    #[error("not a descriptor: {what}")]
    Yaml {
        /// Message of the parser.
        what: String,
    },
    /// The descriptor has an unknown key.
    #[error("unknown key `{key}`; allowed are {allowed}")]
    UnknownKey {
        key: String,
        /// Allowed keys.
        allowed: String,
    },
    /// A key appears twice in one map.
    #[error("the key `{key}` appears a second time here; each may appear once")]
    DuplicateKey {
        /// Name of the key.
        key: String,
    },
    /// A required key is missing.
    #[error("`{key}` is missing")]
    MissingKey {
        /// Name of the key.
        key: &'static str,
    },
    /// The value has the wrong type for its key.
    #[error("found `{found}` where {allowed} belongs")]
    WrongType {
        /// First characters of the value.
        found: String,
        /// Allowed type.
        allowed: &'static str,
    },
    /// The value is not a number or out of range.
    #[error("`{key}` is `{found}`; allowed is {allowed}, without quotes")]
    BadNumber {
        key: &'static str,
        found: String,
        /// Allowed range.
        allowed: &'static str,
    },
    /// The restart policy is unknown.
    #[error("unknown restart_policy `{found}`; allowed are never, on-failure and always")]
    UnknownPolicy {
        /// Text as found.
        found: String,
    },
    /// The descriptor has no node.
    #[error("the list of nodes is empty; a graph has at least one")]
    NoNodes,
    /// The descriptor has too many nodes.
    #[error("{found} nodes; at most {MAX_NODES} are allowed")]
    TooManyNodes {
        /// Number of nodes found.
        found: usize,
    },
    /// The id of a node is invalid.
    #[error(
        "`{found}` cannot be a node's id; allowed are 1 to {MAX_ID_BYTES} of a-z A-Z 0-9 _ . - except the reserved `dora`"
    )]
    BadId {
        /// Text as found.
        found: String,
    },
    /// Two nodes have the same id.
    #[error("a second node with the id `{id}`, first used in line {first}; ids are unique")]
    DuplicateId {
        id: String,
        /// Line of the first one.
        first: u64,
    },
    /// The path is one that dora would not treat as a path.
    #[error(
        "`{found}` cannot be a path: {why}; allowed is a file, absolute or from the descriptor's folder"
    )]
    BadPath {
        found: String,
        /// Meaning for dora.
        why: &'static str,
    },
    /// The executable does not exist and is not built.
    #[error("`{path}` {state}, and nothing builds it")]
    NoExecutable {
        /// Path as in the descriptor.
        path: String,
        /// Actual state, e.g. `is not a file`.
        state: &'static str,
    },
    /// The arguments have an unclosed quote.
    #[error(
        "`args` cannot be split in words: a quote is not closed or a backslash ends the text in `{found}`"
    )]
    BadQuotes {
        /// Text as found.
        found: String,
    },
    /// The build line has characters other than plain words.
    #[error("the build line `{found}` {why}; allowed are plain words with spaces between")]
    BadBuild {
        found: String,
        /// Reason.
        why: &'static str,
    },
    /// The name of an environment variable is invalid.
    #[error("`{found}` cannot name an environment variable; allowed is a text without `=`")]
    BadEnvName {
        /// Text as found.
        found: String,
    },
    /// The value of an environment variable would not reach the process as written.
    #[error("the value `{found}` would not reach the process as written: {why}")]
    BadEnvValue {
        found: String,
        /// Value that would result, and what to write instead.
        why: String,
    },
    /// A port is not a topic.
    #[error("there is no topic `{found}`; allowed are {allowed}")]
    UnknownTopic {
        found: String,
        /// All topics.
        allowed: String,
    },
    /// A node lists an output twice.
    #[error("the output `{topic}` is listed a second time; each may be listed once")]
    DuplicateOutput {
        /// Name of the topic.
        topic: String,
    },
    /// A topic has two publishers.
    #[error(
        "`{topic}` is already sent by `{first}`, and a topic has one sender in a graph; remove it from one of them"
    )]
    SecondSender {
        topic: String,
        /// Id of the first publisher.
        first: String,
    },
    /// The source of an input is not `node/topic`.
    #[error("the input `{input}` comes from `{found}`; allowed is `node/topic`")]
    BadSource {
        /// Name of the input.
        input: String,
        found: String,
    },
    /// The source of an input is an unknown node.
    #[error("the input `{input}` comes from `{found}`, which is no node; the nodes are {allowed}")]
    NoSuchNode {
        input: String,
        /// Unknown node id.
        found: String,
        /// All node ids.
        allowed: String,
    },
    /// The source of an input is not an output of its node.
    #[error(
        "the input `{input}` takes `{found}` from `{from}`, which does not list it; its outputs are {allowed}"
    )]
    NoSuchOutput {
        input: String,
        /// Publishing node.
        from: String,
        /// Unknown output.
        found: String,
        /// Outputs of the publishing node.
        allowed: String,
    },
    /// The name of an input differs from its topic.
    #[error(
        "the input `{input}` takes the topic `{topic}`; nodes find topics by the names of their ports, so write `{topic}: {from}/{topic}`"
    )]
    RenamedInput {
        input: String,
        /// Topic that it is wired to.
        topic: String,
        /// Publishing node.
        from: String,
    },
    /// A node subscribes to its own output.
    #[error("the input `{input}` of `{node}` comes from `{node}` itself")]
    OwnOutput {
        /// Name of the input.
        input: String,
        node: String,
    },
    /// A node that is never restarted has restart settings.
    #[error(
        "`{key}` without a `restart_policy` of on-failure or always: the node is never restarted"
    )]
    NeverRestarted {
        /// Name of the key.
        key: &'static str,
    },
}
