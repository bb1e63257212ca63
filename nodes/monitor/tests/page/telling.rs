//! Information for users who do not watch the page closely: causes and notifications.

use serde_json::{Value, json};
use tests::browser::Browser;

use crate::stage::{Scene, Stage};
use crate::{LOST, UNIQUE, click, wait_for};

#[test]
fn the_first_cause_is_named_first() {
    let Some(browser) = Browser::open("the_first_cause_is_named_first", 1280, 800) else {
        return;
    };
    let stage = Stage::new("causes");
    browser.visit(&stage.url());
    let causes = |nodes: Value, map: Value| {
        let found = browser.finish(&format!(
            "import('/what_to_check.js').then(({{ whatToCheck }}) => {{
                 const nodes = new Map({nodes}.map((node) => [node.name, node]));
                 done(whatToCheck({{ nodes, map: {map} }}));
             }}, (error) => done(String(error)))"
        ));
        let lines = found.as_array().expect("sentences").iter();
        let lines: Vec<String> = lines.map(|line| line.as_str().unwrap().into()).collect();
        lines
    };
    let node = |name: &str, state: &str, sent_hz: f64, last_error: &str| json!({ "name": name, "state": state, "sent_hz": sent_hz, "last_error": last_error });
    let laser = node("lms_reader", "ready", 10.0, "");
    let check = |nodes: &[&Value], map: Value, expected: &[&str]| {
        let found = causes(json!(nodes), map);
        let same = found.len() == expected.len();
        let all = found.iter().zip(expected);
        assert!(
            same && all.clone().all(|(line, part)| line.contains(part)),
            "{found:?}, expected {expected:?}"
        );
    };
    check(&[], Value::Null, &["is the graph started?"]);
    // Later nodes wait for the output of the first one.
    let tracker = node("tracker", "waiting", 0.0, "");
    let dead = node("lms_reader", "silent", 0.0, "");
    let expected = ["lms_reader does not report", "tracker waits"];
    check(&[&tracker, &dead], json!({}), &expected);
    check(&[&laser], Value::Null, &["No map has come"]);
    let why = "waiting for /map: no publisher";
    let gateway = node("ros2_gateway", "waiting", 0.0, why);
    let expected = ["ros2_gateway is waiting for /map: no publisher: check the ROS 2 robot"];
    check(&[&gateway], Value::Null, &expected);
    let quiet = node("lms_reader", "ready", 0.0, "");
    let expected = ["lms_reader sends no scans: check the laser"];
    check(&[&quiet], json!({}), &expected);
    check(&[&laser], json!({}), &["Scans come, and no pose"]);
    let player = node("replayer", "stopped", 0.0, "");
    check(&[&player], json!({}), &["The recording has ended."]);
    let accumulator = node("accumulator", "ready", 0.0, "");
    check(&[&accumulator], json!({}), &["No node that reads a laser"]);
}

#[test]
fn the_card_knows_the_graph_and_not_the_tracker_alone() {
    let test = "the_card_knows_the_graph_and_not_the_tracker_alone";
    let Some(browser) = Browser::open(test, 1280, 800) else {
        return;
    };
    let stage = Stage::new("situation");
    browser.visit(&stage.url());
    let card = |store: Value| {
        let found = browser.finish(&format!(
            "Promise.all([import('/store.js'), import('/situation.js')]).then(([a, b]) => {{
                 const {{ nodes, heard, ...known }} = {store};
                 const store = Object.assign(new a.Store(), known);
                 store.nodes = new Map((nodes ?? []).map((node) => [node.name, node]));
                 if (heard) store.rawScanAt = performance.now();
                 store.scanAt = store.posedAt = known.pose ? performance.now() - (known.fresh ? 0 : 5000) : null;
                 const is = b.situation(store);
                 done([is.word, is.means, is.todo.join(' '), String(Boolean(is.well))]);
             }}, (error) => done([String(error)]))"
        ));
        let words = found.as_array().expect("words").iter();
        let words: Vec<String> = words.map(|word| word.as_str().unwrap().into()).collect();
        words.join(" | ")
    };
    let pose = |state: &str, why: &str, since_m: f64, age_ms: f64| json!({ "state": state, "why": why, "advice": "", "since_m": since_m, "age_ms": age_ms, "from_scan": true });
    let node = |state: &str| json!([{ "name": "recorder", "state": state, "last_error": "no space", "sent_hz": 1.0 }]);
    let unique = || pose("Unique", "one place", 3.0, 20.0);
    let says = |store: Value, parts: &[&str]| {
        let words = card(store.clone());
        assert!(
            parts.iter().all(|part| words.contains(part)),
            "{store}: {words}"
        );
    };
    says(
        json!({ "fresh": true, "pose": unique(), "nodes": node("ready") }),
        &["Unique | ", " | true"],
    );
    says(
        json!({ "fresh": true, "pose": unique(), "nodes": node("degraded") }),
        &["recorder is degraded: no space", " | false"],
    );
    let late = pose("Unique", "one place", 3.0, 2500.0);
    says(
        json!({ "fresh": true, "pose": late }),
        &["2 s after their scans"],
    );
    let lost = |why: &str, since_m: f64| pose("Searching", why, since_m, 20.0);
    says(
        json!({ "fresh": true, "pose": lost("3 places fit", 27.0), "region": [[0, 0], [1, 1]] }),
        &["Nothing has fitted for 27 m", "Only a region is searched"],
    );
    says(
        json!({ "fresh": true, "pose": lost("waiting for a map", 0.0), "nodes": node("ready") }),
        &["No map has come"],
    );
    says(json!({ "heard": true }), &["Scans come, and no answer yet"]);
    says(
        json!({ "heard": true, "pose": unique() }),
        &["No data | Scans come, but no pose"],
    );
}

#[test]
fn who_wishes_is_notified_when_it_is_lost_and_once() {
    let test = "who_wishes_is_notified_when_it_is_lost_and_once";
    let Some(browser) = Browser::open(test, 1280, 800) else {
        return;
    };
    let stage = Stage::new("notify");
    stage.show(UNIQUE);
    browser.visit(&stage.url());
    wait_for(&browser, "Unique");
    // Replaces the browser's notifications, which would ask the user.
    let _ = browser.run(
        "window.notified = [];
         window.Notification = class {
             static permission = 'granted';
             static requestPermission = async () => 'granted';
             constructor(title, { body }) { window.notified.push(`${title}: ${body}`); }
         }",
    );
    stage.show(LOST);
    wait_for(&browser, "Lost");
    stage.show(UNIQUE);
    wait_for(&browser, "Unique");
    let notified = browser.run("return window.notified");
    assert_eq!(notified, json!([]), "notifications were not asked for");
    click(&browser, "#notify");
    browser.wait_until("document.getElementById('notify').ariaPressed === 'true'");
    stage.show(LOST);
    browser.wait_until("window.notified.length === 1");
    let expected = "r7: lost: only fit 0.14.";
    assert_eq!(browser.run("return window.notified[0]"), expected);
    stage.show(Scene::Silent);
    browser.wait_until("window.notified.length === 2");
    let notified = browser.run("return window.notified[1]");
    assert!(
        notified.as_str().unwrap().starts_with("r7: no data: "),
        "{notified}"
    );
}
