//! Connects to the monitor: requests and stream of updates.

use std::net::TcpStream;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, anyhow};
use serde::Deserialize;
use serde_json::Value;
use tungstenite::client;

use super::known::Known;

/// Largest number of messages queued for the screen; the monitor queues more.
const WAITING: usize = 256;

const PAUSE: Duration = Duration::from_secs(1);

/// Timeout of the monitor: its nodes report every second.
const TIMEOUT: Duration = Duration::from_secs(5);

pub(super) type Update = Result<Value, String>;

pub(super) fn find(address: &str, robot: Option<&str>) -> anyhow::Result<String> {
    #[derive(Deserialize)]
    struct Robots {
        robots: Vec<String>,
    }
    let Robots { robots } = ask(address, "/api/v1/robots")?;
    let found = match robot {
        None => robots.first(),
        Some(wanted) => robots.iter().find(|robot| *robot == wanted),
    };
    found.cloned().ok_or_else(|| {
        let (robot, known) = (robot.unwrap_or_default(), robots.join(", "));
        anyhow!("the monitor at {address} knows no robot {robot:?}; it knows {known}")
    })
}

pub(super) fn snapshot(address: &str, robot: &str) -> anyhow::Result<Known> {
    let mut known = Known::default();
    let update = ask(address, &format!("/api/v1/robots/{robot}"))?;
    known.receive(update, Instant::now());
    Ok(known)
}

fn ask<A: serde::de::DeserializeOwned>(address: &str, path: &str) -> anyhow::Result<A> {
    let no_monitor = |error: ureq::Error| {
        let reason = match error {
            ureq::Error::Timeout(_) => format!("no answer within {TIMEOUT:?}"),
            error => error.to_string(),
        };
        anyhow!("no monitor answers at {address}: is a graph running? ({reason})")
    };
    let agent: ureq::Agent = ureq::Agent::config_builder()
        .timeout_global(Some(TIMEOUT))
        .build()
        .into();
    let mut response = agent
        .get(format!("http://{address}{path}"))
        .call()
        .map_err(no_monitor)?;
    response.body_mut().read_json().map_err(no_monitor)
}

/// Receives updates on a thread, which reconnects to a lost monitor.
pub(super) fn follow(address: &str, robot: &str) -> anyhow::Result<Receiver<Update>> {
    let (updates, received) = sync_channel(WAITING);
    let (address, robot) = (address.to_owned(), robot.to_owned());
    let body = move || {
        while let Err(problem) = listen(&address, &robot, &updates) {
            if updates.send(Err(problem)).is_err() {
                return;
            }
            thread::sleep(PAUSE);
        }
    };
    thread::Builder::new()
        .name("monitor".into())
        .spawn(body)
        .context("cannot start a thread")?;
    Ok(received)
}

fn listen(address: &str, robot: &str, updates: &SyncSender<Update>) -> Result<(), String> {
    let stream = TcpStream::connect(address).map_err(|error| error.to_string())?;
    let patience = stream.set_read_timeout(Some(TIMEOUT));
    patience.map_err(|error| error.to_string())?;
    let url = format!("ws://{address}/api/v1/robots/{robot}/stream");
    let (mut socket, _) = client(url, stream).map_err(|error| error.to_string())?;
    loop {
        match socket.read().map_err(|error| error.to_string())? {
            tungstenite::Message::Text(text) => {
                let message = serde_json::from_str(&text).map_err(|error| error.to_string())?;
                if updates.send(Ok(message)).is_err() {
                    return Ok(());
                }
            }
            tungstenite::Message::Close(_) => return Err("the monitor has ended".to_owned()),
            _ => {}
        }
    }
}
