//! The test's own executable as another process, which executes commands line by line.

use std::io::{BufRead, BufReader, Write};
use std::os::unix::fs::MetadataExt;
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitCode, Stdio};
use std::time::Duration;

use messages::topic;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use transport::{Flow, GRAPH_VARIABLE, Graph, GraphName, Publisher, Subscriber, TransportError};

/// Environment variable of such a process: the name under which it joins.
const NODE_VARIABLE: &str = "TRANSPORT_TEST_NODE";
const ANSWER: &str = "answer:";

pub(crate) struct Member {
    process: Child,
    commands: Option<ChildStdin>,
    answers: BufReader<ChildStdout>,
}

impl Member {
    /// Starts a process that joins `graph` as `node`, by a test `member` of this executable.
    pub(crate) fn start(graph: &GraphName, node: &str) -> Self {
        let mut process = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "member", "--nocapture"])
            .env(GRAPH_VARIABLE, graph.as_str())
            .env(NODE_VARIABLE, node)
            .env("RUST_LOG", "off")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        Member {
            commands: process.stdin.take(),
            answers: BufReader::new(process.stdout.take().unwrap()),
            process,
        }
    }

    pub(crate) fn command(&mut self, command: &str) {
        writeln!(self.commands.as_mut().unwrap(), "{command}").unwrap();
    }

    pub(crate) fn answer(&mut self) -> String {
        let mut line = String::new();
        loop {
            line.clear();
            let read = self.answers.read_line(&mut line).unwrap();
            assert!(read > 0, "the member ended without an answer");
            if let Some((_, answer)) = line.split_once(ANSWER) {
                return answer.trim().to_owned();
            }
        }
    }

    pub(crate) fn ask(&mut self, command: &str) -> String {
        self.command(command);
        self.answer()
    }

    pub(crate) fn id(&self) -> u32 {
        self.process.id()
    }

    /// Ends the wait of an idle member by a signal, and then the member.
    pub(crate) fn stop(mut self, signal: Signal) {
        kill(Pid::from_raw(self.id().cast_signed()), signal).unwrap();
        assert_eq!(self.answer(), "stopped");
        self.end();
    }

    pub(crate) fn kill(mut self) {
        self.process.kill().unwrap();
        self.process.wait().unwrap();
    }

    pub(crate) fn end(mut self) {
        drop(self.commands.take());
        assert!(self.process.wait().unwrap().success());
    }
}

impl Drop for Member {
    fn drop(&mut self) {
        // A test that fails half-way must not leave the process behind.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// In a process of [`Member::start`], executes commands until the input ends; returns true.
pub(crate) fn serve_if_asked() -> bool {
    let Ok(node) = std::env::var(NODE_VARIABLE) else {
        return false;
    };
    let mut served = Served {
        graph: Graph::join(&node).unwrap(),
        publisher: None,
        subscriber: None,
        held: Vec::new(),
    };
    for line in std::io::stdin().lines() {
        let line = line.unwrap();
        let words: Vec<&str> = line.split(' ').collect();
        println!("{ANSWER}{}", served.obey(&words));
    }
    true
}

struct Served {
    graph: Graph,
    publisher: Option<Publisher<topic::Map>>,
    subscriber: Option<Subscriber<topic::Map>>,
    held: Vec<transport::Sample<topic::Map>>,
}

impl Served {
    fn obey(&mut self, words: &[&str]) -> String {
        match words {
            ["name"] => self.graph.node_name().to_owned(),
            ["main", outcome] => format!("{:?}", run_main(outcome)),
            ["publish", id, cells] => self.publish(id.parse().unwrap(), cells.parse().unwrap()),
            ["subscribe"] => {
                self.subscriber = Some(self.graph.subscriber().unwrap());
                "subscribed".into()
            }
            ["receive"] => self.receive(),
            ["idle", tick_ms] => self.idle(tick_ms.parse().unwrap()),
            other => panic!("unknown command {other:?}"),
        }
    }

    /// Publishes a map whose id and cells are `id`; returns the place of its cells.
    fn publish(&mut self, id: u8, cells: usize) -> String {
        let publisher = self
            .publisher
            .get_or_insert_with(|| self.graph.publisher().unwrap());
        let mut loan = publisher.loan(cells).unwrap();
        loan.header_mut().map_id = id.into();
        loan.items_mut().fill(id);
        let place = place_of(loan.items_mut());
        loan.send().unwrap();
        place
    }

    fn receive(&mut self) -> String {
        let subscriber = self.subscriber.as_ref().unwrap();
        let sample = wait_for_map(&self.graph, subscriber);
        let answer = format!("{} {}", sample.header().map_id, place_of(sample.items()));
        self.held.push(sample);
        answer
    }

    fn idle(&self, tick_ms: u64) -> String {
        let tick = Duration::from_millis(tick_ms);
        let mut first = true;
        let step = |_| {
            if std::mem::take(&mut first) {
                println!("{ANSWER}idle");
            }
            Ok::<_, TransportError>(Flow::Continue)
        };
        self.graph.run(&[], tick, step).unwrap();
        "stopped".into()
    }
}

/// Runs `main` of a node with this outcome; a second call starts logging twice.
fn run_main(outcome: &str) -> ExitCode {
    transport::node::main("inner", |graph| match outcome {
        "ok" => Ok(()),
        other => Err(TransportError::GraphName {
            name: format!("{other} in {}", graph.name()),
        }),
    })
}

/// Waits until a map comes; the tick is so long that only a wake-up can end the wait.
pub(crate) fn wait_for_map(
    graph: &Graph,
    subscriber: &Subscriber<topic::Map>,
) -> transport::Sample<topic::Map> {
    let mut received = None;
    graph
        .run(&[subscriber], Duration::from_secs(86_400), |_| {
            received = subscriber.newest()?;
            Ok::<_, TransportError>(match received {
                Some(_) => Flow::Stop,
                None => Flow::Continue,
            })
        })
        .unwrap();
    received.unwrap()
}

/// Returns the mapped file and the offset of bytes, equal in all processes.
pub(crate) fn place_of(bytes: &[u8]) -> String {
    let address = bytes.as_ptr().addr();
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    for line in maps.lines() {
        let fields: Vec<&str> = line.split_whitespace().collect();
        let (start, end) = fields[0].split_once('-').unwrap();
        let hex = |text| usize::from_str_radix(text, 16).unwrap();
        if (hex(start)..hex(end)).contains(&address) {
            let offset = address - hex(start) + hex(fields[2]);
            let file = std::fs::metadata(fields[5]).unwrap();
            assert_eq!(
                file.ino().to_string(),
                fields[4],
                "the file is the mapped one"
            );
            return format!("{}+{offset}", fields[5]);
        }
    }
    panic!("{address:x} is not mapped");
}
