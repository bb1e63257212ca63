//! The monitor's page in a browser, with a whole graph behind it.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::io::{BufRead, BufReader};
use std::process::{Child, Stdio};

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use recording::Recording;
use serde_json::{Value, json};
use tempfile::TempDir;
use tests::axe;
use tests::browser::Browser;
use tests::executables;
use tests::http::{Site, token_file};
use tests::recorded::graph_with;
use tests::world::World;

const TOKEN: &str = "0123456789abcdef";

/// A graph that plays a recording in a loop, with a monitor.
struct Graph {
    launcher: Child,
    url: String,
    _folder: TempDir,
}

impl Graph {
    fn start(world: &World) -> Graph {
        let folder = TempDir::new().unwrap();
        let token = token_file(folder.path(), TOKEN);
        let descriptor = folder.path().join("g.yaml");
        std::fs::write(&descriptor, nodes(world, &token.display().to_string())).unwrap();
        let mut launcher = executables::backcast()
            .args(["run", "--loop"])
            .arg(&descriptor)
            .current_dir(&folder)
            .env_remove("BACKCAST_GRAPH")
            .env_remove("RUST_LOG")
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(launcher.stderr.take().unwrap()).lines();
        let url = lines.find_map(|line| {
            let line = line.unwrap();
            line.split("watch it on ").nth(1).map(str::to_owned)
        });
        // The rest is read as well, or its writers would wait.
        std::thread::spawn(move || lines.for_each(drop));
        Graph {
            launcher,
            url: url.unwrap(),
            _folder: folder,
        }
    }

    fn stop(&mut self) {
        if let Ok(None) = self.launcher.try_wait() {
            let launcher = Pid::from_raw(self.launcher.id().cast_signed());
            let _ = kill(launcher, Signal::SIGINT);
            let _ = self.launcher.wait();
        }
    }
}

impl Drop for Graph {
    fn drop(&mut self) {
        self.stop();
    }
}

/// Returns a descriptor in which the accumulator, which is killed here, is not restarted before the
/// test is over.
fn nodes(world: &World, token: &str) -> String {
    let later = "    restart_policy: on-failure\n    restart_delay: 3600\n";
    let graph = graph_with(&world.recording(), &world.map(), later);
    let monitor = executables::path("monitor").display().to_string();
    format!(
        "{graph}  - id: monitor
    path: {monitor}
    args: --listen 127.0.0.1:0 --robot r7 --token-file {token}
"
    )
}

/// Returns the process of a node, as the API reports it.
fn process(browser: &Browser, node: &str) -> Pid {
    browser.wait_until(&format!(
        "(window.asked ??= fetch('/api/v1/robots/r7').then((r) => r.json()).then((known) => {{
            window.pid = known.nodes.find((n) => n.name === '{node}').pid;
            window.asked = undefined;
            window.of = '{node}';
        }})) && window.of === '{node}'"
    ));
    let pid = browser.run("return window.pid").as_i64().unwrap();
    Pid::from_raw(pid.try_into().unwrap())
}

/// Colours of the canvas in a coarse raster.
const COLORS: &str = "(() => {
    const canvas = document.getElementById('map');
    const c = canvas.getContext('2d');
    const found = new Set();
    for (let x = 3; x < canvas.width; x += 7) {
        for (let y = 3; y < canvas.height; y += 7) {
            found.add(c.getImageData(x, y, 1, 1).data.slice(0, 3).join());
        }
    }
    return found;
})()";

const POSE: &str = "document.getElementById('pose-x').textContent";

#[test]
fn an_operator_sees_the_graph_and_what_befalls_it() {
    let test = "an_operator_sees_the_graph_and_what_befalls_it";
    let Some(browser) = Browser::open(test, 1280, 800) else {
        return;
    };
    let world = World::of("malaga_corridor");
    let graph = Graph::start(&world);
    browser.visit(&format!("{}/#token={TOKEN}", graph.url));

    // The map shows free space, walls and the places found.
    browser.wait_until("document.getElementById('verdict').dataset.verdict === 'Unique'");
    browser.wait_until(&format!(
        "{COLORS}.has('252,253,253') && {COLORS}.size > 10"
    ));
    assert_eq!(
        browser.run("return location.hash"),
        "",
        "no token stays in the address"
    );

    // The pose moves, and all nodes are ready.
    let first = browser.run(&format!("return {POSE}"));
    browser.wait_until(&format!("{POSE} !== {first} && {POSE} !== '–'"));
    // Six nodes, and the launcher, which reports on itself.
    browser.wait_until("document.querySelectorAll('.nodes [data-state=ready]').length === 7");

    // A region in which to search, chosen by keyboard.
    browser.wait_until("!document.getElementById('region').disabled");
    let _ = browser.run(
        "document.getElementById('region').click();
         document.getElementById('map').dispatchEvent(
             new KeyboardEvent('keydown', { key: 'Enter', bubbles: true }))",
    );
    browser.wait_until("!document.getElementById('everywhere').disabled");

    // The page fits a telephone.
    let telephone = Browser::open(test, 375, 800).unwrap();
    telephone.visit(&graph.url);
    telephone.wait_until("document.getElementById('verdict').dataset.verdict === 'Unique'");
    assert_eq!(telephone.run("return innerWidth"), 375);
    let width = "return document.documentElement.scrollWidth";
    assert_eq!(telephone.run(width), 375);
    drop(telephone);

    // A node that was killed turns red.
    kill(process(&browser, "accumulator"), Signal::SIGKILL).unwrap();
    browser.wait_until(
        "(() => {
            const name = document.querySelector('[data-node=accumulator][data-state=silent] .name span');
            if (!name) return false;
            const [red, green, blue] = getComputedStyle(name).color.match(/\\d+/g).map(Number);
            return red > 2 * green && red > 2 * blue;
        })()",
    );
    browser.wait_until("document.getElementById('verdict').textContent === 'No data'");
    browser.wait_until(
        "document.getElementById('todo').textContent.includes('accumulator does not report')",
    );

    // A monitor that hangs is shown as a lost connection until it continues.
    let monitor = process(&browser, "monitor");
    kill(monitor, Signal::SIGSTOP).unwrap();
    browser.wait_until(
        "!document.getElementById('lost').hidden && document.body.dataset.link === 'lost'
         && getComputedStyle(document.querySelector('.halves')).filter === 'grayscale(1)'
         && document.getElementById('verdict').textContent === 'Disconnected'",
    );
    kill(monitor, Signal::SIGCONT).unwrap();
    browser.wait_until(
        "document.getElementById('lost').hidden && document.body.dataset.link === 'live'",
    );
}

#[test]
fn a_recording_is_started_and_stopped_from_the_page() {
    let test = "a_recording_is_started_and_stopped_from_the_page";
    let Some(browser) = Browser::open(test, 1280, 800) else {
        return;
    };
    let mut graph = Graph::start(&World::of("malaga_corridor"));
    let site = Site(graph.url["http://".len()..].parse().unwrap());
    let recording = |is_awaited: fn(&Value) -> bool| loop {
        let known = site.get("/api/v1/robots/r7")["recording"].take();
        if is_awaited(&known) {
            return known;
        }
    };
    let ask = |method: &str, token: &str| {
        let token = format!("Authorization: Bearer {token}");
        let path = "/api/v1/robots/r7/recording";
        site.ask(method, path, &[&token], "").0
    };
    let nothing = json!({"file": null, "size_mb": null, "refused": null});
    assert_eq!(recording(Value::is_object), nothing);
    assert_eq!(ask("POST", "another"), 403);
    assert_eq!(ask("DELETE", TOKEN), 409, "nothing is recorded");

    browser.visit(&format!("{}/#token={TOKEN}", graph.url));
    let button = "document.getElementById('record')";
    browser.wait_until(&format!("!{button}.disabled"));
    let _ = browser.run(&format!("{button}.click()"));
    browser.wait_until(&format!("{button}.textContent === 'Stop recording'"));
    let known = recording(|known| known["size_mb"].as_f64() > Some(0.0));
    let file = known["file"].as_str().unwrap().to_owned();
    browser.wait_until(&format!(
        "document.getElementById('recording').textContent.startsWith('Recording to {file}, ')"
    ));
    assert_eq!(ask("POST", TOKEN), 409, "one recording at a time");
    if let Ok(script) = axe::script() {
        assert_eq!(axe::violations(&browser, &script), [""; 0]);
    }
    let _ = browser.run(&format!("window.confirm = () => true; {button}.click()"));
    browser.wait_until(&format!("{button}.textContent === 'Record'"));
    assert_is_whole(&file);

    // The end of the graph finishes a recording, too.
    assert_eq!(ask("POST", TOKEN), 202);
    let known = recording(|known| known["size_mb"].as_f64() > Some(0.0));
    let second = known["file"].as_str().unwrap().to_owned();
    assert_ne!(second, file);
    drop(browser);
    graph.stop();
    assert_is_whole(&second);
}

/// Checks that the recording is complete and holds the map, from before it began.
fn assert_is_whole(file: &str) {
    let recording = Recording::open(file).unwrap();
    assert_eq!(recording.damage(), None);
    assert!(recording.map().unwrap().is_some(), "{file}");
    let topics = recording
        .raw_records()
        .map(|r| r.unwrap().channel.topic.to_string());
    assert_ne!(topics.filter(|topic| topic == "/scan").count(), 0, "{file}");
}

#[test]
fn a_terminal_sees_the_same() {
    let world = World::of("malaga_corridor");
    let graph = Graph::start(&world);
    let address = graph.url.strip_prefix("http://").unwrap();
    let top = |arguments: &[&str]| {
        let outcome = executables::backcast()
            .arg("top")
            .args(arguments)
            .output()
            .unwrap();
        let said = [outcome.stdout, outcome.stderr].concat();
        (outcome.status.code(), String::from_utf8(said).unwrap())
    };
    // The first scans come once the map is prepared, and nodes report once a second.
    let shown = loop {
        let (code, shown) = top(&["--once", address]);
        assert_eq!(code, Some(0), "{shown}");
        if shown.contains("Unique") && shown.contains("peak_extractor") {
            break shown;
        }
    };
    assert!(shown.starts_with("r7  Unique"), "{shown}");
    let (code, said) = top(&["--robot", "other", address]);
    assert_eq!(code, Some(1));
    assert!(
        said.contains("knows no robot \"other\"; it knows r7"),
        "{said}"
    );
    let (code, said) = top(&["127.0.0.1:1"]);
    assert_eq!(code, Some(1));
    assert!(said.contains("no monitor answers at 127.0.0.1:1"), "{said}");
}
