//! Opens the Zenoh session.

use std::ffi::OsStr;
use std::path::Path;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

use serde_json::Value;
use transport::{Flow, Graph, TransportError};
use zenoh::{Config, Session, Wait};

use crate::{Cause, NetworkError, Options};

/// Polling interval while opening, and tick of health meanwhile.
const TICK: Duration = Duration::from_millis(100);

pub(crate) const MODE: &str = "mode";
const LISTEN: &str = "listen/endpoints";
pub(crate) const CONNECT: &str = "connect/endpoints";
pub(crate) const SCOUTING: &str = "scouting/multicast/enabled";

/// Default log filter of a node that joins a network, in the syntax of `RUST_LOG`. It includes
/// accepted and rejected connections with the reason, which Zenoh would not log.
pub const LOG: &str = "info,zenoh_transport::unicast::establishment::accept=debug";

/// Default endpoint to listen on: this machine only.
const LOOPBACK: &str = r#"["tcp/127.0.0.1:7447"]"#;

const EXTENSIONS: [&str; 2] = ["json5", "json"];

/// Settings used unless the user's file has them.
const DEFAULTS: [(&str, &str); 7] = [
    // Clients of one machine must reach each other, and peers do not forward.
    (MODE, "'router'"),
    // No connections to machines that were not named.
    (SCOUTING, "false"),
    ("scouting/delay", "0"),
    // Named endpoints are retried without end, at least once a second.
    ("connect/timeout_ms", "-1"),
    (
        "connect/retry",
        "{ period_init_ms: 500, period_max_ms: 1000, period_increase_factor: 2 }",
    ),
    // Milliseconds after which a pulled cable is detected. Zenoh's default is ten seconds, and TCP
    // alone would then also retry that late.
    ("transport/link/tx/lease", "4000"),
    // Largest reassembled message in bytes: a map and its frame. Zenoh's default is 1 GiB.
    ("transport/link/rx/max_message_size", "67174400"),
];

/// Opens the session, however long that takes: as a client, Zenoh waits until it is connected.
/// Meanwhile `tick` is called regularly. Returns `None` if the process is stopped before.
pub fn open(
    graph: &Graph,
    options: &Options,
    mut tick: impl FnMut() -> Result<(), TransportError>,
) -> Result<Option<Session>, NetworkError> {
    let settings = settings(options)?;
    let [mode, listen, connect] =
        [MODE, LISTEN, CONNECT].map(|key| settings.get_json(key).unwrap_or_default());
    tracing::info!(%mode, %listen, %connect, "joining the network");
    let opening = start(graph, settings)?;
    let mut opened = None;
    graph.run(&[], TICK, |_| {
        tick()?;
        opened = match opening.try_recv() {
            Ok(outcome) => Some(outcome),
            Err(TryRecvError::Empty) => return Ok::<_, NetworkError>(Flow::Continue),
            Err(TryRecvError::Disconnected) => Some(Err("it was given up".into())),
        };
        Ok(Flow::Stop)
    })?;
    let session = opened.transpose().map_err(NetworkError::Session)?;
    if let Some(session) = &session {
        tracing::info!(session = %session.zid(), "joined the network");
    }
    Ok(session)
}

fn start(
    graph: &Graph,
    settings: Config,
) -> Result<Receiver<Result<Session, Cause>>, TransportError> {
    let (sender, opening) = channel();
    let waker = graph.waker()?;
    std::thread::spawn(move || {
        // The receiver is gone if the process ends meanwhile.
        let _ = sender.send(zenoh::open(settings).wait());
        waker.wake();
    });
    Ok(opening)
}

/// Returns the configuration that [`open`] passes to Zenoh.
pub fn settings(options: &Options) -> Result<Config, NetworkError> {
    let (mut settings, named) = match &options.config {
        None => (Config::default(), Value::Null),
        Some(file) => read(file)?,
    };
    let mut defaults = DEFAULTS.to_vec();
    for (key, given) in [(CONNECT, &options.connect), (LISTEN, &options.listen)] {
        if !given.is_empty() {
            set(&mut settings, key, &list(given))?;
        }
    }
    if options.listen.is_empty() {
        let calls = settings.get_json(CONNECT).ok() != Config::default().get_json(CONNECT).ok();
        defaults.push((LISTEN, if calls { "[]" } else { LOOPBACK }));
    }
    for (key, value) in defaults {
        if !is_named(&named, key) {
            set(&mut settings, key, value)?;
        }
    }
    Ok(settings)
}

/// Returns the settings in a file, and its content: a setting in the file overrides our default,
/// even if it equals Zenoh's.
fn read(file: &Path) -> Result<(Config, Value), NetworkError> {
    let extension = file.extension().and_then(OsStr::to_str);
    if !extension.is_some_and(|found| EXTENSIONS.contains(&found)) {
        let file = file.to_owned();
        return Err(NetworkError::Format { file });
    }
    let failed = |source| NetworkError::ConfigFile {
        file: file.to_owned(),
        source,
    };
    let text = std::fs::read_to_string(file).map_err(|source| failed(source.into()))?;
    let named = json5::from_str(&text).map_err(|source| failed(source.into()))?;
    Ok((Config::from_file(file).map_err(failed)?, named))
}

/// True if the file has a setting, or a part of it.
fn is_named(file: &Value, key: &str) -> bool {
    file.pointer(&format!("/{key}")).is_some()
}

fn set(settings: &mut Config, key: &'static str, value: &str) -> Result<(), NetworkError> {
    let failed = |source: Cause| NetworkError::Setting {
        key,
        value: value.to_owned(),
        source,
    };
    settings.insert_json5(key, value).map_err(failed)
}

/// Formats endpoints as JSON; `Debug` has the same escapes.
fn list(endpoints: &[String]) -> String {
    format!("{endpoints:?}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the settings with this file and this command-line option.
    fn check(option: [&str; 2], file: Option<&str>, expected: [&str; 4]) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("zenoh.json5");
        let endpoints = |name| (option[0] == name).then(|| option[1].to_owned());
        let mut options = Options {
            config: None,
            listen: endpoints("--listen").into_iter().collect(),
            connect: endpoints("--connect").into_iter().collect(),
        };
        if let Some(text) = file {
            std::fs::write(&path, text).unwrap();
            options.config = Some(path);
        }
        let settings = settings(&options).unwrap();
        let keys = [MODE, LISTEN, CONNECT, SCOUTING];
        let found = keys.map(|key| settings.get_json(key).unwrap());
        assert_eq!(found, expected, "{option:?} {file:?}");
    }

    const NONE: [&str; 2] = ["", ""];
    const ROUTER: &str = r#""router""#;

    #[test]
    fn nothing_listens_beyond_this_machine_by_default() {
        let here = r#"["tcp/127.0.0.1:7447"]"#;
        check(NONE, None, [ROUTER, here, "[]", "false"]);
        let peer = Some("{ mode: 'peer' }");
        check(NONE, peer, [r#""peer""#, here, "[]", "false"]);
        let there = r#"["tcp/10.0.0.1:7447"]"#;
        let connect = ["--connect", "tcp/10.0.0.1:7447"];
        check(connect, None, [ROUTER, "[]", there, "false"]);
        let listen = ["--listen", "tcp/10.0.0.1:7447"];
        check(listen, None, [ROUTER, there, "[]", "false"]);
    }

    #[test]
    fn the_file_counts_and_options_count_more() {
        let file = Some(
            "{ listen: { endpoints: ['tcp/0.0.0.0:1'] }, \
             scouting: { multicast: { enabled: true } } }",
        );
        let everywhere = r#"["tcp/0.0.0.0:1"]"#;
        check(NONE, file, [ROUTER, everywhere, "[]", "true"]);
        let option = ["--listen", "tcp/127.0.0.1:2"];
        let here = r#"["tcp/127.0.0.1:2"]"#;
        check(option, file, [ROUTER, here, "[]", "true"]);
    }

    /// A setting in the file stays, even if it is Zenoh's default.
    #[test]
    fn what_the_file_names_stays_as_it_is() {
        let file = "{ mode: 'peer', scouting: { multicast: { enabled: true } }, \
             listen: { endpoints: { router: ['tcp/[::]:7447'], peer: ['tcp/[::]:0'] } }, \
             transport: { link: { tx: { lease: 10000 } } }, connect: { retry: {} } }";
        let settings = with_file("zenoh.json5", file).unwrap();
        let found = |key| settings.get_json(key).unwrap();
        assert_eq!(found(LISTEN), Config::default().get_json(LISTEN).unwrap());
        for (key, expected) in [
            (MODE, "\"peer\""),
            (SCOUTING, "true"),
            ("transport/link/tx/lease", "10000"),
        ] {
            assert_eq!(found(key), expected);
        }
        let retry = found("connect/retry");
        assert!(!retry.contains("500"), "{retry}");
        // Settings not in the file have our defaults.
        assert_eq!(found("transport/link/rx/max_message_size"), "67174400");
    }

    fn with_file(name: &str, text: &str) -> Result<Config, NetworkError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        settings(&Options {
            config: Some(path),
            ..Options::default()
        })
    }

    #[test]
    fn a_file_that_is_none_of_zenohs_is_refused_by_name() {
        for (name, text) in [
            ("zenoh.json5", "{ listne: {} }"),
            ("zenoh.json5", "{ mode:"),
            ("zenoh.json5", ""),
            ("zenoh.yaml", "mode: peer"),
            ("zenoh", "{}"),
        ] {
            let error = with_file(name, text).unwrap_err();
            assert!(error.to_string().contains(name), "{error}");
        }
    }

    #[test]
    fn an_endpoint_that_is_none_is_refused() {
        let options = Options {
            listen: vec!["somewhere".into()],
            ..Options::default()
        };
        let error = settings(&options).unwrap_err();
        assert!(error.to_string().contains("somewhere"), "{error}");
    }
}
