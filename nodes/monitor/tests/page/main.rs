//! Tests of the page in a browser, in each state of the robot: its text, and accessibility.
#![allow(clippy::unwrap_used, reason = "the lint spares test functions alone")]

mod stage;
mod telling;

use messages::TrackState;
use serde_json::{Value, json};
use stage::{BEHIND_M, PLACES, Scene, Stage};
use tests::axe;
use tests::browser::Browser;
use tests::needs::Need;

const LOST: Scene = Scene::Tracked(TrackState::Lost);
const UNIQUE: Scene = Scene::Tracked(TrackState::Unique);

/// Waits until the card shows this word.
fn wait_for(browser: &Browser, word: &str) {
    let is_said = format!("document.getElementById('verdict').textContent === '{word}'");
    browser.wait_until(&is_said);
}

fn text(browser: &Browser, id: &str) -> String {
    let script = format!("return document.getElementById('{id}').textContent");
    browser.run(&script).as_str().unwrap().to_owned()
}

fn is_shown(browser: &Browser, id: &str) -> bool {
    let script = format!("return document.getElementById('{id}').checkVisibility()");
    browser.run(&script).as_bool().unwrap()
}

fn click(browser: &Browser, selector: &str) {
    let script = format!("document.querySelector(\"{selector}\").click()");
    let _ = browser.run(&script);
}

/// Returns the centres of groups of pixels of this colour on the map, in pixels of the page.
fn spots(browser: &Browser, color: [u8; 3]) -> Vec<(f64, f64)> {
    let [red, green, blue] = color;
    let found = browser.run(&format!(
        "const canvas = document.getElementById('map');
         const {{ width, height, clientWidth }} = canvas;
         const ratio = width / clientWidth;
         const {{ data }} = canvas.getContext('2d').getImageData(0, 0, width, height);
         const groups = [];
         for (let i = 0; i < width * height; i++) {{
             const [r, g, b] = data.subarray(4 * i, 4 * i + 3);
             if (r !== {red} || g !== {green} || b !== {blue}) continue;
             const [x, y] = [i % width, Math.floor(i / width)];
             const group = groups.find((one) => Math.hypot(one.x - x, one.y - y) < 60 * ratio);
             if (!group) groups.push({{ x, y, n: 1, sx: x, sy: y }});
             else {{ group.n++; group.sx += x; group.sy += y; }}
         }}
         return groups.map(({{ n, sx, sy }}) => [sx / n / ratio, sy / n / ratio]);"
    ));
    let pair = |spot: &Value| Some((spot[0].as_f64()?, spot[1].as_f64()?));
    found.as_array().unwrap().iter().filter_map(pair).collect()
}

/// Clicks on the map like a pointer.
fn click_map(browser: &Browser, (x, y): (f64, f64)) {
    let _ = browser.run(&format!(
        "const canvas = document.getElementById('map');
         const {{ left, top }} = canvas.getBoundingClientRect();
         canvas.setPointerCapture = () => {{}};
         for (const type of ['pointermove', 'pointerdown', 'pointerup']) {{
             canvas.dispatchEvent(new PointerEvent(type, {{
                 clientX: left + {x}, clientY: top + {y}, pointerId: 7, isPrimary: true, bubbles: true }}));
         }}"
    ));
}

const OTHER: [u8; 3] = [107, 79, 176];
const HIT: [u8; 3] = [15, 148, 136];

#[test]
fn while_several_places_fit_none_of_them_leads() {
    let test = "while_several_places_fit_none_of_them_leads";
    let Some(browser) = Browser::open(test, 1280, 800) else {
        return;
    };
    let stage = Stage::new("ambiguous");
    stage.show(Scene::Ambiguous);
    browser.visit(&stage.url());
    wait_for(&browser, "Ambiguous");
    assert!(!is_shown(&browser, "pose"), "no coordinates are bold");
    let places = "document.querySelectorAll('#places tr')";
    browser.wait_until(&format!("{places}.length === 3"));
    let shares = browser.run(&format!(
        "return Array.from({places}, (row) => row.lastElementChild.textContent)"
    ));
    assert_eq!(shares, json!(["50 %", "30 %", "15 %"]));
    let trust = text(&browser, "trust");
    assert!(
        trust.contains("50 % probable, the best of 3 places"),
        "{trust}"
    );
    assert!(text(&browser, "todo").contains("Drive a few metres"));

    // All places are in view although they are 90 m apart; the initial view covers about 34 m.
    let spots = loop {
        let spots = spots(&browser, OTHER);
        if spots.len() == PLACES.len() {
            break spots;
        }
    };
    let apart = |a: usize, b: usize| (spots[a].0 - spots[b].0).abs();
    assert!(
        apart(0, 1).max(apart(1, 2)).max(apart(0, 2)) > 500.0,
        "{spots:?}"
    );
    // A click shows the numbers of a place, and the position of the pointer.
    click_map(&browser, spots[0]);
    assert!(text(&browser, "inspect-title").ends_with(" of 3"));
    // Of the base: 2 cm, plus the effect of 0.01 radians half a metre behind the laser.
    assert!(text(&browser, "inspect-facts").contains("95 % along5.0 cm"));
    assert!(text(&browser, "cursor").starts_with("x "));
    click(&browser, "#inspect-close");
    assert!(!is_shown(&browser, "inspect"));
}

#[test]
fn the_card_says_where_how_sure_and_how_exact() {
    let test = "the_card_says_where_how_sure_and_how_exact";
    let Some(browser) = Browser::open(test, 1280, 800) else {
        return;
    };
    let stage = Stage::new("unique");
    stage.show(UNIQUE);
    browser.visit(&stage.url());
    wait_for(&browser, "Unique");
    browser.wait_until("document.getElementById('why').textContent !== ''");
    assert_eq!(text(&browser, "why"), "one place, fit 0.90, since 3 m.");
    let trust = text(&browser, "trust");
    assert!(trust.contains("87 % probable"), "{trust}");
    // Two and a half deviations of 2 cm, and two of 0.6°.
    assert!(trust.contains("within 4.9 cm and 1.1° (95 %)"), "{trust}");
    let weight = "return Number(getComputedStyle(document.querySelector('#pose dd')).fontWeight)";
    assert!(browser.run(weight).as_i64().unwrap() > 500, "it is known");
    // Pose of the base, or of the laser on request.
    let [laser, _, _] = PLACES;
    let expected = format!("{:.2}", laser.x - BEHIND_M);
    assert_eq!(text(&browser, "pose-x"), expected);
    click(&browser, "[data-frame=laser]");
    let is_laser = format!(
        "document.getElementById('pose-x').textContent === '{:.2}'",
        laser.x
    );
    browser.wait_until(&is_laser);
    // Places with a very low probability are hidden.
    let found = browser.run("return document.querySelectorAll('#places tr').length");
    assert_eq!(found, 1);
    assert_eq!(text(&browser, "places-note"), "2 below 1 % are hidden");
    // Robot and graph are named.
    let title = browser.run("return document.title");
    assert_eq!(title, format!("unique · r7 · {} · Backcast", stage.graph));
    assert_eq!(text(&browser, "graph-name"), stage.graph.to_string());

    // A click on the end of a beam shows it, and the panel's buttons show the next one.
    let ends = loop {
        let ends = spots(&browser, HIT);
        if ends.len() > 1 {
            break ends;
        }
    };
    click_map(&browser, ends[0]);
    assert!(text(&browser, "inspect-title").starts_with("Beam "));
    let shown = text(&browser, "inspect-facts");
    assert!(
        shown.contains("reading4.000 m") && shown.contains("on the map"),
        "{shown}"
    );
    let first = text(&browser, "inspect-title");
    click(&browser, "#beam-after");
    assert_ne!(text(&browser, "inspect-title"), first);

    // A paused page shows the past.
    click(&browser, "#pause");
    wait_for(&browser, "Paused");
    assert_eq!(text(&browser, "link-text"), "Paused");
    assert_eq!(kind(&browser), "");
    click(&browser, "#pause");
    wait_for(&browser, "Unique");
}

/// Returns the kind that colours the state; empty for past states.
fn kind(browser: &Browser) -> String {
    let script = "return document.getElementById('verdict').dataset.verdict";
    browser.run(script).as_str().unwrap().to_owned()
}

#[test]
fn the_moments_when_it_was_lost_can_be_looked_at() {
    let test = "the_moments_when_it_was_lost_can_be_looked_at";
    let Some(browser) = Browser::open(test, 1280, 800) else {
        return;
    };
    let stage = Stage::new("lost");
    // The pose was lost before this page was opened.
    stage.show(UNIQUE);
    let early = Browser::open(test, 1280, 800).unwrap();
    early.visit(&stage.url());
    wait_for(&early, "Unique");
    stage.show(LOST);
    wait_for(&early, "Lost");
    stage.show(UNIQUE);
    wait_for(&early, "Unique");
    stage.show(LOST);
    browser.visit(&stage.url());
    wait_for(&browser, "Lost");
    assert!(!is_shown(&browser, "pose"), "no coordinates are bold");
    browser.wait_until("document.getElementById('why').textContent === 'only fit 0.14.'");
    let expected = "Drive a few metres, or mark a region.";
    assert_eq!(text(&browser, "todo"), expected);
    for page in [&early, &browser] {
        let moments = "document.querySelectorAll('#lost-moments button').length === 2";
        page.wait_until(moments);
    }
    click(&browser, "#lost-moments li:last-child button");
    browser.wait_until("document.getElementById('moment').checkVisibility()");
    assert!(text(&browser, "moment-title").starts_with("Lost at "));
    let places = text(&browser, "moment-places");
    assert!(places.contains("Last known place: x 49.50 m"), "{places}");
    assert!(places.contains("Found again: x 49.50 m"), "{places}");
    // With the keyboard: the state before it, and back to the present.
    let press = |key: &str| {
        let _ = browser.run(&format!(
            "document.getElementById('timeline').dispatchEvent(
                 new KeyboardEvent('keydown', {{ key: '{key}', bubbles: true }}))"
        ));
    };
    press("ArrowLeft");
    assert!(text(&browser, "moment-title").starts_with("Unique at "));
    press("Escape");
    assert!(!is_shown(&browser, "moment"));
}

#[test]
fn without_scans_all_turns_grey_and_says_what_to_check() {
    let test = "without_scans_all_turns_grey_and_says_what_to_check";
    let Some(browser) = Browser::open(test, 1280, 800) else {
        return;
    };
    let stage = Stage::new("silent");
    stage.show(UNIQUE);
    browser.visit(&stage.url());
    wait_for(&browser, "Unique");
    stage.show(Scene::Silent);
    wait_for(&browser, "No data");
    assert_eq!(kind(&browser), "");
    browser.wait_until("document.getElementById('todo').textContent.includes('degraded')");
    let expected = "lms_reader is degraded: cannot connect to 192.168.0.1:2112: check the laser: \
                    power, cable, address (backcast probe).";
    assert_eq!(text(&browser, "todo"), expected);
    browser
        .wait_until("getComputedStyle(document.getElementById('map')).filter === 'grayscale(1)'");
    let weight = "return Number(getComputedStyle(document.querySelector('#pose dd')).fontWeight)";
    assert!(browser.run(weight).as_i64().unwrap() < 500, "it was known");
    let dot = "return getComputedStyle(document.querySelector('.link i')).backgroundColor";
    assert_ne!(browser.run(dot), "rgb(29, 138, 87)", "not green");
    assert!(text(&browser, "link-text").starts_with("no data for "));
    // The log of a single node.
    let set = |id: &str, value: &str| {
        let _ = browser.run(&format!(
            "const list = document.getElementById('{id}');
             list.value = '{value}';
             list.dispatchEvent(new Event('change'))"
        ));
    };
    let lines = "Array.from(document.querySelectorAll('#events li'), (line) => line.textContent)";
    browser.wait_until(&format!(
        "{lines}.some((line) => line.includes('connected'))"
    ));
    set("log-node", "lms_reader");
    browser.wait_until(&format!(
        "{lines}.length && {lines}.every((line) => line.includes('lms_reader'))"
    ));
    set("log-level", "4");
    browser.wait_until(&format!("!{lines}.length"));
    // Scans arrive again, and the colour returns.
    stage.show(UNIQUE);
    wait_for(&browser, "Unique");
    assert_eq!(kind(&browser), "Unique");
}

#[test]
fn everybody_can_read_and_reach_it() {
    let test = "everybody_can_read_and_reach_it";
    let script = match axe::script() {
        Ok(script) => script,
        Err(why) => return Need::Npm.is_missing(test, &why),
    };
    for width in [1440, 320] {
        let Some(browser) = Browser::open(test, width, 900) else {
            return;
        };
        let stage = Stage::new(&format!("axe{width}"));
        let scenes = [
            (Scene::Ambiguous, "Ambiguous"),
            (UNIQUE, "Unique"),
            (LOST, "Lost"),
            (Scene::Silent, "No data"),
        ];
        for (scene, word) in scenes {
            stage.show(scene);
            browser.visit(&stage.url());
            wait_for(&browser, word);
            if scene == LOST {
                click(&browser, "#lost-moments button");
            }
            click(&browser, "#places button");
            for theme in ["light", "dark"] {
                let is_so = format!("document.documentElement.dataset.theme === '{theme}'");
                if browser.run(&format!("return {is_so}")) == false {
                    click(&browser, "#theme");
                }
                browser.wait_until(&is_so);
                let found = axe::violations(&browser, &script);
                let found = found.join("\n");
                assert!(found.is_empty(), "{width} {word} {theme}:\n{found}");
            }
            let wide = browser.run("return document.documentElement.scrollWidth");
            assert_eq!(wide, width, "nothing is cut off at the side: {word}");
            assert_eq!(small_targets(&browser), json!([]), "{width} {word}");
        }
    }
}

/// Returns the controls smaller than 44 by 44 pixels, the size of a finger.
fn small_targets(browser: &Browser) -> Value {
    browser.run(
        "const all = [...document.querySelectorAll('button, select, input, [role=slider]')];
         return all.filter((one) => one.checkVisibility()).filter((one) => {
             const { width, height } = one.getBoundingClientRect();
             return width < 44 || height < 44;
         }).map((one) => one.outerHTML)",
    )
}
