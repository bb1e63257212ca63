//! Tests of the reader as a process.
#![allow(clippy::unwrap_used, reason = "the lint spares test functions alone")]

mod angles;
mod node;

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};

use sick::cola::{Answer, Command, Encoding, Fault, Framer, Telegram, Value, Variable};
use transport::Graph;
use transport::testing::NodeProcess;

fn start(graph: &Graph, arguments: &[&str]) -> NodeProcess {
    NodeProcess::start(env!("CARGO_BIN_EXE_lms_reader"), graph, arguments)
}

/// Listens on a free port; returns the listener and its address.
fn listen() -> (TcpListener, String) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    (listener, address)
}

fn framed(telegram: &Telegram<'_>) -> Vec<u8> {
    let mut bytes = Vec::new();
    Encoding::Binary.frame(telegram, &mut bytes);
    bytes
}

/// Returns the answer of a device that reports its name.
fn ident(name: &str) -> Answer<'_> {
    Answer::Value(Value::DeviceIdent {
        name: name.as_bytes(),
        version: b"V1.0",
    })
}

/// Accepts the node's connection; sends `early` at once, the name on the second request, and returns
/// once the node subscribes to scans. All other commands are rejected.
fn accept(listener: &TcpListener, name: Option<&str>, early: &[u8]) -> TcpStream {
    let (mut stream, _) = listener.accept().unwrap();
    stream.write_all(early).unwrap();
    let mut framer = Framer::new(Encoding::Binary);
    let mut piece = [0; 1000];
    let mut requests = 0;
    loop {
        let count = stream.read(&mut piece).unwrap();
        assert!(count > 0, "the node has gone");
        framer.push(&piece[..count]);
        while let Some(next) = framer.next_frame() {
            let Telegram::Command(command) = next.unwrap().telegram else {
                panic!("no command");
            };
            let answer = match (command, name) {
                (Command::Read(Variable::DeviceIdent), Some(name)) => {
                    requests += 1;
                    if requests == 1 {
                        continue;
                    }
                    ident(name)
                }
                (Command::SubscribeScans(true), _) => Answer::ScansSubscribed(true),
                _ => Answer::Fault(Fault::UNKNOWN_VARIABLE),
            };
            let bytes = framed(&Telegram::Answer(answer));
            stream.write_all(&bytes).unwrap();
            if command == Command::SubscribeScans(true) {
                return stream;
            }
        }
    }
}
