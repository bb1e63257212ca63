//! Posts state changes of the robots to a server of the user.
//!
//! A separate thread posts one after the other over plain HTTP, without retries. If the server is
//! too slow, the oldest waiting ones are dropped, since the newest matter most. Losses are counted
//! and logged now and then.

use std::thread;
use std::time::{Duration, Instant};

use axum::http::Uri;
use tokio::sync::broadcast::error::RecvError;
use tokio::sync::broadcast::{Receiver, Sender};
use ureq::Agent;

use crate::DashboardError;

const QUEUE: usize = 64;

/// Timeout of one post, from the DNS look-up to the response.
const TIMEOUT: Duration = Duration::from_secs(5);

/// Minimum time between two log lines about losses.
const SILENCE: Duration = Duration::from_secs(60);

/// Queue of states to post; the thread ends with its last clone.
#[derive(Debug, Clone)]
pub(crate) struct Webhook(Sender<String>);

impl Webhook {
    pub(crate) fn start(server: &Uri) -> Result<Self, DashboardError> {
        let (states, waiting) = tokio::sync::broadcast::channel(QUEUE);
        let server = server.to_string();
        thread::Builder::new()
            .name("webhook".into())
            .spawn(move || post_all(&server, waiting))
            .map_err(DashboardError::Server)?;
        Ok(Webhook(states))
    }

    /// Queues a JSON object without blocking.
    pub(crate) fn post(&self, state: String) {
        // The thread lives as long as this sender.
        let _ = self.0.send(state);
    }
}

/// Posts until all senders are gone.
fn post_all(server: &str, mut waiting: Receiver<String>) {
    let agent: Agent = Agent::config_builder()
        .timeout_global(Some(TIMEOUT))
        .build()
        .into();
    let mut losses = Losses::default();
    loop {
        let outcome = match waiting.blocking_recv() {
            Ok(state) => post(&agent, server, &state).map_err(|reason| (1, reason)),
            Err(RecvError::Lagged(states)) => Err((states, "the server is too slow".to_owned())),
            Err(RecvError::Closed) => return,
        };
        let line = match outcome {
            Ok(()) => losses.end(),
            Err((states, reason)) => losses.add(states, &reason, Instant::now()),
        };
        // The address may contain a secret, so it is not logged.
        if let Some(line) = line {
            tracing::warn!("webhook: {line}");
        }
    }
}

fn post(agent: &Agent, server: &str, state: &str) -> Result<(), String> {
    let request = agent.post(server).content_type("application/json");
    request.send(state).map(drop).map_err(|it| it.to_string())
}

/// Counts lost states and limits the log lines about them: one at the first loss, then at most one
/// per minute, and one when posting works again.
#[derive(Debug, Default)]
struct Losses {
    states: u64,
    logged: Option<Instant>,
}

impl Losses {
    fn add(&mut self, states: u64, reason: &str, now: Instant) -> Option<String> {
        self.states += states;
        if self.logged.is_some_and(|at| now - at < SILENCE) {
            return None;
        }
        self.logged = Some(now);
        let states = self.states;
        Some(format!("{states} not posted: {reason}"))
    }

    fn end(&mut self) -> Option<String> {
        let states = std::mem::take(self).states;
        (states > 0).then(|| format!("posts again, after {states} not posted"))
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufRead, BufReader, Read, Write};
    use std::net::TcpListener;

    use super::*;

    #[test]
    fn losses_are_counted_and_logged_now_and_then() {
        let mut losses = Losses::default();
        let begin = Instant::now();
        let line = losses.add(1, "refused", begin);
        assert_eq!(line.unwrap(), "1 not posted: refused");
        assert_eq!(losses.add(2, "refused", begin + SILENCE / 2), None);
        let line = losses.add(1, "timeout", begin + SILENCE);
        assert_eq!(line.unwrap(), "4 not posted: timeout");
        assert_eq!(losses.end().unwrap(), "posts again, after 4 not posted");
        assert_eq!(losses.end(), None, "all is well");
        assert!(losses.add(1, "refused", begin + SILENCE).is_some());
    }

    /// Accepts one request and responds after `ready` has returned.
    fn take(listener: &TcpListener, ready: impl FnOnce()) -> String {
        let (mut stream, _) = listener.accept().unwrap();
        let mut reader = BufReader::new(stream.try_clone().unwrap());
        let mut length = 0;
        loop {
            let mut line = String::new();
            reader.read_line(&mut line).unwrap();
            if let Some(given) = line.to_lowercase().strip_prefix("content-length:") {
                length = given.trim().parse().unwrap();
            }
            if line == "\r\n" {
                break;
            }
        }
        let mut body = vec![0; length];
        reader.read_exact(&mut body).unwrap();
        ready();
        let answer = b"HTTP/1.1 204 No Content\r\nConnection: close\r\n\r\n";
        stream.write_all(answer).unwrap();
        String::from_utf8(body).unwrap()
    }

    #[test]
    fn a_slow_server_gets_the_newest() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let server = format!("http://{}/", listener.local_addr().unwrap());
        let webhook = Webhook::start(&server.parse().unwrap()).unwrap();
        webhook.post("first".to_owned());
        let first = take(&listener, || {
            for state in 0..QUEUE + 100 {
                webhook.post(state.to_string());
            }
        });
        assert_eq!(first, "first");
        let posted: Vec<String> = (0..QUEUE).map(|_| take(&listener, || {})).collect();
        let expected: Vec<String> = (100..QUEUE + 100).map(|state| state.to_string()).collect();
        assert_eq!(posted, expected);
    }
}
