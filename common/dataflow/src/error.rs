//! Errors in a descriptor.

use std::{fmt::Write as _, io, path::PathBuf};

use crate::{MAX_FILE_BYTES, MAX_ID_BYTES, MAX_NODES, Problem};

/// Why a descriptor could not be used.
#[derive(Debug, thiserror::Error)]
pub enum DataflowError {
    /// The file could not be read.
    #[error("cannot read {}", file.display())]
    Unreadable {
        /// As it was given.
        file: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// The file is too large to be a descriptor.
    #[error("{} has more than {MAX_FILE_BYTES} bytes, which is the most that is read", file.display())]
    TooLarge {
        /// As it was given.
        file: PathBuf,
    },
    /// The file is wrong in these places.
    #[error("{}", lines(file, problems))]
    Wrong {
        /// As it was given.
        file: PathBuf,
        /// In the order of the file, at least one.
        problems: Vec<Problem>,
    },
}

/// A line for each problem: `file:line:column: what`.
fn lines(file: &std::path::Path, problems: &[Problem]) -> String {
    let mut text = String::new();
    for (i, problem) in problems.iter().enumerate() {
        let separator = if i == 0 { "" } else { "\n" };
        // Writing to a string cannot fail.
        let _ = write!(text, "{separator}{}:{problem}", file.display());
    }
    text
}

/// What is wrong in one place: what was found and what is allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Fault {
    /// The text is not YAML, or uses more of YAML than a descriptor may.
    #[error("not a descriptor: {what}")]
    Yaml {
        /// In the words of the parser.
        what: String,
    },
    /// A key that a descriptor does not have.
    #[error("unknown key `{key}`; allowed are {allowed}")]
    UnknownKey {
        /// As found.
        key: String,
        /// All that may stand there.
        allowed: String,
    },
    /// A key that stands twice in one map.
    #[error("the key `{key}` appears a second time here; each may appear once")]
    DuplicateKey {
        /// As found.
        key: String,
    },
    /// A key without which nothing can be done.
    #[error("`{key}` is missing")]
    MissingKey {
        /// The key.
        key: &'static str,
    },
    /// Another kind of value than the key takes.
    #[error("found `{found}` where {allowed} belongs")]
    WrongType {
        /// The beginning of what stands there.
        found: String,
        /// The kind that is allowed.
        allowed: &'static str,
    },
    /// A number that is not one, or out of its range.
    #[error("`{key}` is `{found}`; allowed is {allowed}, without quotes")]
    BadNumber {
        /// The key.
        key: &'static str,
        /// As found.
        found: String,
        /// The range.
        allowed: &'static str,
    },
    /// Not a restart policy.
    #[error("unknown restart_policy `{found}`; allowed are never, on-failure and always")]
    UnknownPolicy {
        /// As found.
        found: String,
    },
    /// No node at all.
    #[error("the list of nodes is empty; a graph has at least one")]
    NoNodes,
    /// More nodes than a graph may have.
    #[error("{found} nodes; at most {MAX_NODES} are allowed")]
    TooManyNodes {
        /// How many there are.
        found: usize,
    },
    /// An id that cannot name a node.
    #[error(
        "`{found}` cannot be a node's id; allowed are 1 to {MAX_ID_BYTES} of a-z A-Z 0-9 _ . - except the reserved `dora`"
    )]
    BadId {
        /// As found.
        found: String,
    },
    /// Two nodes with one id.
    #[error("a second node with the id `{id}`, first used in line {first}; ids are unique")]
    DuplicateId {
        /// The id.
        id: String,
        /// The line of the first.
        first: u64,
    },
    /// A path that dora would not take as a path.
    #[error(
        "`{found}` cannot be a path: {why}; allowed is a file, absolute or from the descriptor's folder"
    )]
    BadPath {
        /// As found.
        found: String,
        /// What else it would mean.
        why: &'static str,
    },
    /// No executable there, and nothing that would build it.
    #[error("`{path}` {state}, and nothing builds it")]
    NoExecutable {
        /// As in the descriptor.
        path: String,
        /// What is there instead.
        state: &'static str,
    },
    /// Quotes that do not close.
    #[error(
        "`args` cannot be split in words: a quote is not closed or a backslash ends the text in `{found}`"
    )]
    BadQuotes {
        /// As found.
        found: String,
    },
    /// A build line that is not just words.
    #[error("the build line `{found}` {why}; allowed are plain words with spaces between")]
    BadBuild {
        /// As found.
        found: String,
        /// What is wrong with it.
        why: &'static str,
    },
    /// A name that no environment variable can have.
    #[error("`{found}` cannot name an environment variable; allowed is a text without `=`")]
    BadEnvName {
        /// As found.
        found: String,
    },
    /// A value that would not reach the process as it is written.
    #[error("the value `{found}` would not reach the process as written: {why}")]
    BadEnvValue {
        /// As found.
        found: String,
        /// What would become of it, and what to write instead.
        why: String,
    },
    /// A port that is no topic.
    #[error("there is no topic `{found}`; allowed are {allowed}")]
    UnknownTopic {
        /// As found.
        found: String,
        /// All topics.
        allowed: String,
    },
    /// A node that lists an output twice.
    #[error("the output `{topic}` is listed a second time; each may be listed once")]
    DuplicateOutput {
        /// The topic.
        topic: String,
    },
    /// A topic with two senders.
    #[error(
        "`{topic}` is already sent by `{first}`, and a topic has one sender in a graph; remove it from one of them"
    )]
    SecondSender {
        /// The topic.
        topic: String,
        /// The id of the first.
        first: String,
    },
    /// An input's source that is not `node/topic`.
    #[error("the input `{input}` comes from `{found}`; allowed is `node/topic`")]
    BadSource {
        /// The input.
        input: String,
        /// As found.
        found: String,
    },
    /// An input from a node that is not there.
    #[error("the input `{input}` comes from `{found}`, which is no node; the nodes are {allowed}")]
    NoSuchNode {
        /// The input.
        input: String,
        /// The id as found.
        found: String,
        /// All ids.
        allowed: String,
    },
    /// An input from an output that is not there.
    #[error(
        "the input `{input}` takes `{found}` from `{from}`, which does not list it; its outputs are {allowed}"
    )]
    NoSuchOutput {
        /// The input.
        input: String,
        /// The sender.
        from: String,
        /// The output as found.
        found: String,
        /// What the sender lists.
        allowed: String,
    },
    /// An input under another name than its topic.
    #[error(
        "the input `{input}` takes the topic `{topic}`; nodes find topics by the names of their ports, so write `{topic}: {from}/{topic}`"
    )]
    RenamedInput {
        /// The input's name.
        input: String,
        /// The topic that it is wired to.
        topic: String,
        /// The sender.
        from: String,
    },
    /// A node that takes its own output.
    #[error("the input `{input}` of `{node}` comes from `{node}` itself")]
    OwnOutput {
        /// The input.
        input: String,
        /// The node.
        node: String,
    },
    /// Restart settings of a node that is never restarted.
    #[error(
        "`{key}` without a `restart_policy` of on-failure or always: the node is never restarted"
    )]
    NeverRestarted {
        /// The key.
        key: &'static str,
    },
}
