//! Formats the state of a graph in lines, for the terminal and for `--once`.

use std::time::Instant;

use geometry::{ANGLE_95, Covariance, ELLIPSE_95, Pose};
use ratatui::style::{Color, Style, Stylize};
use ratatui::text::{Line, Span, Text};
use serde::Deserialize;
use serde_json::Value;

use super::known::{Known, is_from_scan, number, text as word};

const PLACES: usize = 5;

const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

pub(super) fn text(known: &Known, now: Instant) -> Text<'static> {
    let mut lines = vec![title(known, now), Line::default()];
    if let Some(pose) = &known.pose {
        lines.extend(pose_lines(pose));
    }
    match &known.answer {
        None => lines.push(Line::from("no scan has been answered yet")),
        Some(answer) => {
            let verdict = match known.pose {
                Some(_) => format!("This scan alone, {}: ", word(answer, "verdict")),
                None => String::new(),
            };
            lines.push(Line::from(format!("{verdict}{}.", word(answer, "says"))));
            lines.push(Line::default());
            let places = answer["hypotheses"]
                .as_array()
                .map_or(&[][..], Vec::as_slice);
            let is_base = places.iter().any(|place| !place["base"].is_null());
            let [x, y] = ["x", "y"].map(|axis| format!("{} {axis} m", frame(is_base)));
            lines.push(head(format!(
                "   place  {x:>9} {y:>9}  heading deg  score  probability"
            )));
            let places = places.iter().take(PLACES).enumerate();
            lines.extend(places.map(|(at, place)| place_line(at, place)));
            lines.push(Line::default());
            lines.extend(timing(known, answer));
        }
    }
    lines.push(Line::default());
    lines.push(head(
        "   node                  state      in/s   out/s   lost  refused  restarts",
    ));
    for node in known.nodes.values() {
        lines.extend(node_lines(node));
    }
    Text::from(lines)
}

pub(super) fn plain(known: &Known, now: Instant) -> String {
    let lines = text(known, now).lines;
    lines
        .iter()
        .map(|line| format!("{}\n", line.to_string().trim_end()))
        .collect()
}

fn title(known: &Known, now: Instant) -> Line<'static> {
    let silence = known.silence(now);
    let (state, scan) = match (&known.pose, &known.answer) {
        (Some(pose), _) => (
            word(pose, "state"),
            Some(pose).filter(|pose| is_from_scan(pose)),
        ),
        (None, Some(answer)) => (word(answer, "verdict"), Some(answer)),
        (None, None) => ("", None),
    };
    let color = match &silence {
        // Old data must not look current.
        Some(_) => Color::DarkGray,
        None => color_of(state),
    };
    let mut spans = vec![
        Span::from(known.robot.clone()).bold(),
        Span::from("  "),
        Span::from(state.to_owned()).fg(color).bold(),
    ];
    if let Some(scan) = scan {
        let counter = number(scan, "counter");
        spans.push(Span::from(format!("  scan {counter}")).dim());
    }
    if let Some(name) = known.map_name() {
        spans.push(Span::from(format!("  on {name}")));
    }
    if let Some(silence) = silence {
        let text = format!("  {}", silence.to_uppercase());
        spans.push(Span::from(text).fg(Color::Red).bold());
    }
    if let Some(problem) = &known.lost {
        let text = format!("  DISCONNECTED: {problem}");
        spans.push(Span::from(text).fg(Color::Red).bold());
    }
    Line::from(spans)
}

fn color_of(state: &str) -> Color {
    match state {
        "Unique" => Color::Green,
        "Ambiguous" | "Doubtful" | "Searching" => Color::Yellow,
        _ => Color::Red,
    }
}

fn pose_lines(tracked: &Value) -> Vec<Line<'static>> {
    let mut lines = vec![Line::from(format!("{}.", word(tracked, "says")))];
    let base = Pose::deserialize(&tracked["base"]).ok();
    let laser = || Pose::deserialize(&tracked["laser"]).ok();
    if let Some(shown) = base.or_else(laser) {
        let frame = frame(base.is_some());
        let rows = <[f64; 9]>::deserialize(&tracked[format!("{frame}_covariance")]);
        let spread = rows.map_or(String::new(), |rows| {
            let covariance = Covariance::from_rows(rows);
            let m = ELLIPSE_95 * covariance.ellipse().major_m;
            let deg = ANGLE_95 * covariance.to_rows()[8].max(0.0).sqrt().to_degrees();
            format!(" +- {m:.3} m, {deg:.2} deg (95 %)")
        });
        let text = format!(
            "{frame}: x {:.3} m, y {:.3} m, heading {:.2} deg{spread}",
            shown.x,
            shown.y,
            shown.yaw.to_degrees()
        );
        lines.push(Line::from(text.bold()));
        let share = 100.0 * number(tracked, "probability");
        let score = number(tracked, "score");
        let text = format!("probability {share:.1} %, score {score:.2}");
        lines.push(Line::from(text));
    }
    lines.push(Line::default());
    lines
}

/// Returns the frame whose poses are shown: that of the base, where the laser's mount is known.
fn frame(is_base: bool) -> &'static str {
    if is_base { "base" } else { "laser" }
}

fn head(text: impl Into<String>) -> Line<'static> {
    Line::from(text.into().dim())
}

fn place_line(at: usize, place: &Value) -> Line<'static> {
    let shown = Pose::deserialize(&place["base"]).or_else(|_| Pose::deserialize(&place["laser"]));
    let shown = shown.unwrap_or_default();
    let text = format!(
        "{:>8}  {:>9.3} {:>9.3}  {:>11.2}  {:>5.2}  {:>9.1} %",
        at + 1,
        shown.x,
        shown.y,
        shown.yaw.to_degrees(),
        number(place, "score"),
        100.0 * number(place, "probability"),
    );
    let style = match at {
        0 => Style::new().bold(),
        _ => Style::new().dim(),
    };
    Line::styled(text, style)
}

fn timing(known: &Known, answer: &Value) -> [Line<'static>; 2] {
    let highest = known.latencies_ms.iter().copied().fold(1.0, f64::max);
    let bar = |ms: &f64| {
        let step = (ms / highest * 7.0).round().clamp(0.0, 7.0) as usize;
        BARS[step]
    };
    let bars: String = known.latencies_ms.iter().map(bar).collect();
    let newest = known.latencies_ms.back().copied();
    let text = format!(
        "scan to pose {:.1} ms: search {:.1} ms, fit {:.1} ms",
        newest.unwrap_or_else(|| number(answer, "latency_ms")),
        number(answer, "search_cpu_ms"),
        number(answer, "extract_cpu_ms")
    );
    [Line::from(text), Line::from(bars.fg(Color::Cyan))]
}

fn node_lines(node: &Value) -> Vec<Line<'static>> {
    let (name, state) = (word(node, "name"), word(node, "state"));
    let [received_hz, sent_hz, dropped, refused, restarts] =
        ["received_hz", "sent_hz", "dropped", "refused", "restarts"].map(|key| number(node, key));
    let color = match state {
        "ready" => Color::Green,
        "silent" => Color::Red,
        "degraded" => Color::Yellow,
        _ => Color::Gray,
    };
    let counts =
        format!("{received_hz:>6.1}  {sent_hz:>6.1}  {dropped:>5}  {refused:>7}  {restarts:>8}");
    let mut lines = vec![Line::from(vec![
        Span::from(format!("   {name:<20}  ")),
        Span::from(format!("{state:<9}")).fg(color),
        Span::from(counts),
    ])];
    let error = word(node, "last_error");
    if !error.is_empty() {
        let (past, color) = match state {
            "ready" => ("earlier: ", Color::DarkGray),
            _ => ("", Color::Yellow),
        };
        lines.push(Line::from(format!("     {past}{error}")).fg(color));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known(messages: &[&str]) -> Known {
        let mut known = Known::default();
        for text in messages {
            known.receive(serde_json::from_str(text).unwrap(), Instant::now());
        }
        known
    }

    /// Checks that these lines are shown, within 80 columns.
    fn check(messages: &[&str], lines: &[&str]) {
        let text = plain(&known(messages), Instant::now());
        for expected in lines {
            assert!(text.contains(expected), "{expected:?} in\n{text}");
        }
        let fits = text.lines().all(|line| line.chars().count() <= 80);
        assert!(fits, "{text}");
    }

    #[test]
    fn a_graph_fits_a_terminal_of_80_columns() {
        let messages = [
            r#"{"type":"snapshot","robot":"r7","nodes":[
                {"name":"boundary_extractor","state":"degraded","received_hz":12345.6,
                 "dropped":12345,"refused":1234567,"restarts":3,"last_error":"no map"}]}"#,
            r#"{"type":"answer","counter":7,"verdict":"Unique","says":"one place, fit 0.90",
                "latency_ms":20.5,"search_cpu_ms":15.0,"extract_cpu_ms":4.0,"hypotheses":[
                {"laser":{"x":-1234.5,"y":2.0,"yaw":-3.1},"score":0.97,"probability":1.0}]}"#,
        ];
        let lines = [
            "r7  Unique  scan 7\n",
            "one place, fit 0.90.\n",
            "-1234.500     2.000      -177.62   0.97      100.0 %",
            "scan to pose 20.5 ms",
            "   boundary_extractor    degraded",
            "     no map\n",
        ];
        check(&messages, &lines);
    }

    #[test]
    fn a_lost_monitor_is_said() {
        let mut known = known(&[]);
        known.lost = Some("it is gone".to_owned());
        assert!(plain(&known, Instant::now()).contains("DISCONNECTED: it is gone"));
        known.receive(Value::Null, Instant::now());
        assert!(!plain(&known, Instant::now()).contains("DISCONNECTED"));
    }

    #[test]
    fn a_pose_stands_before_the_single_scan() {
        let messages = [
            r#"{"type":"answer","counter":7,"verdict":"Ambiguous","says":"2 places fit",
                "latency_ms":20.5,"search_cpu_ms":15.0,"extract_cpu_ms":4.0,"hypotheses":[]}"#,
            r#"{"type":"pose","counter":7,"from_scan":true,"state":"Doubtful",
                "says":"the scans do not fit where the robot should be","probability":0.875,
                "score":0.5,"latency_ms":21.5,"laser":{"x":1.5,"y":-2.0,"yaw":0.5},
                "laser_covariance":[0.0625,0,0,0,0.01,0,0,0,0.0001]}"#,
        ];
        let lines = [
            "  Doubtful  scan 7\n",
            "the scans do not fit where the robot should be.\n",
            "laser: x 1.500 m, y -2.000 m, heading 28.65 deg +- 0.612 m, 1.12 deg (95 %)\n",
            "probability 87.5 %, score 0.50\n",
            "This scan alone, Ambiguous: 2 places fit.\n",
            "scan to pose 21.5 ms",
        ];
        check(&messages, &lines);
    }

    #[test]
    fn poses_are_those_of_the_base_where_it_is_known_and_the_map_is_named() {
        let messages = [
            r#"{"type":"snapshot","robot":"r7","map":{"map_id":"0a","name":"ground"}}"#,
            r#"{"type":"answer","counter":7,"verdict":"Unique","says":"one place","hypotheses":[
                {"laser":{"x":1,"y":0,"yaw":0},"base":{"x":2,"y":0,"yaw":0}}]}"#,
            r#"{"type":"pose","map_id":"0a","state":"Unique","says":"one place is left",
                "laser":{"x":1,"y":0,"yaw":0},"base":{"x":2.5,"y":0,"yaw":0},
                "laser_covariance":[9,0,0,0,9,0,0,0,9],
                "base_covariance":[0.0625,0,0,0,0.01,0,0,0,0]}"#,
        ];
        let lines = [
            "r7  Unique  on ground\n",
            "base: x 2.500 m, y 0.000 m, heading 0.00 deg +- 0.612 m",
            "   place   base x m  base y m  heading deg",
            "       1      2.000     0.000",
        ];
        check(&messages, &lines);
    }

    #[test]
    fn an_old_unique_is_not_green() {
        let known = known(&[r#"{"type":"snapshot","robot":"r7","ages":{"scan_s":12.5},
            "answer":{"counter":7,"verdict":"Unique","says":"one place, fit 0.90"}}"#]);
        let now = Instant::now();
        assert!(plain(&known, now).starts_with("r7  Unique  scan 7  NO DATA FOR 12 S\n"));
        let title = &text(&known, now).lines[0];
        let mut spans = title.spans.iter();
        assert!(spans.all(|span| span.style.fg != Some(Color::Green)));
    }
}
