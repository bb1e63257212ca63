//! Network namespaces with cables between them: each is a separate machine on the network.
//!
//! They are anonymous and end with the test, even if it is killed. Shared memory and files are
//! those of the machine that runs the test.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use transport::Graph;
use transport::testing::NodeProcess;

use crate::Killed;
use crate::needs::Need;

/// Set for a test that runs in a user namespace of its own.
const INSIDE: &str = "BACKCAST_TEST_INSIDE";

/// A network namespace, which exists until this is dropped.
pub struct Namespace {
    /// Process in the namespace. It ends with the test, which holds the other end of its standard
    /// input.
    holder: Killed,
}

/// True if the calling test, named `test`, may make namespaces and is to go on. Otherwise it has
/// already been run in a user namespace, where it may, or the kernel forbids those, which is
/// reported.
pub fn is_allowed(test: &str) -> bool {
    if succeeds("unshare", &["--net", "true"]) {
        return true;
    }
    let alone = [
        "--user",
        "--map-current-user",
        "--keep-caps",
        "--net",
        "true",
    ];
    if std::env::var_os(INSIDE).is_some() || !succeeds("unshare", &alone) {
        Need::Namespaces.is_missing(test, "this kernel lets this user make none for networks");
        return false;
    }
    let status = Command::new("unshare")
        .args(&alone[..3])
        .arg(std::env::current_exe().unwrap())
        .args([test, "--exact", "--nocapture"])
        .env(INSIDE, "1")
        .status();
    assert!(
        status.unwrap().success(),
        "{test} fails in a user namespace"
    );
    false
}

fn succeeds(program: &str, arguments: &[&str]) -> bool {
    let mut command = Command::new(program);
    let outcome = command.args(arguments).stderr(Stdio::null()).status();
    outcome.is_ok_and(|status| status.success())
}

impl Default for Namespace {
    fn default() -> Self {
        Self::new()
    }
}

impl Namespace {
    /// Makes a namespace with nothing but its own loopback.
    pub fn new() -> Self {
        let mut holder = Command::new("unshare")
            .args(["--net", "sh", "-c", "ip link set lo up && echo up && cat"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let output = holder.stdout.take().unwrap();
        BufReader::new(output).read_line(&mut line).unwrap();
        assert_eq!(line, "up\n", "no namespace; is iproute2 installed?");
        Namespace {
            holder: Killed(holder),
        }
    }

    /// Adds a cable called `name` to another namespace; the ends have these addresses, such as
    /// `10.0.1.1/24`.
    pub fn connect(&self, other: &Namespace, name: &str, ends: [&str; 2]) {
        let there = other.holder.0.id();
        self.ip(&format!(
            "link add name {name} type veth peer name {name} netns {there}"
        ));
        for (namespace, end) in [(self, ends[0]), (other, ends[1])] {
            namespace.ip(&format!("address add {end} dev {name}"));
            namespace.plug(name);
        }
    }

    /// Unplugs the cable of that name.
    pub fn pull(&self, name: &str) {
        self.ip(&format!("link set {name} down"));
    }

    /// Plugs the cable of that name in again.
    pub fn plug(&self, name: &str) {
        self.ip(&format!("link set {name} up"));
    }

    pub fn start(&self, graph: &Graph, executable: &str, arguments: &[&str]) -> NodeProcess {
        let place = self.place();
        let inside = [place.as_str(), executable].into_iter();
        NodeProcess::start("nsenter", graph, inside.chain(arguments.iter().copied()))
    }

    pub fn command(&self, program: &str) -> Command {
        let mut command = Command::new("nsenter");
        command.args([&self.place(), program]);
        command
    }

    /// Returns the option by which `nsenter` enters.
    fn place(&self) -> String {
        format!("--net=/proc/{}/ns/net", self.holder.0.id())
    }

    /// Runs `ip` with these arguments.
    fn ip(&self, arguments: &str) {
        let mut ip = self.command("ip");
        let status = ip.args(arguments.split_whitespace()).status();
        assert!(status.unwrap().success(), "ip {arguments}");
    }
}
