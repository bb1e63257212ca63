//! The state of a graph, line by line, as the terminal and the snapshot show it.

use ratatui::style::{Color, Style, Stylize};
use ratatui::text::{Line, Span, Text};

use super::known::{Answer, Known, Node, Place};

/// Places that are shown.
const PLACES: usize = 5;

/// Eight heights of a bar.
const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// All of it.
pub(super) fn text(known: &Known) -> Text<'static> {
    let mut lines = vec![title(known), Line::default()];
    match &known.answer {
        None => lines.push(Line::from("no scan was answered yet")),
        Some(answer) => {
            lines.push(Line::from(format!("{}.", answer.says)));
            lines.push(Line::default());
            lines.push(head(
                "   place        x m       y m  heading deg  score  probability",
            ));
            let places = answer.hypotheses.iter().take(PLACES).enumerate();
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

/// The same without colours.
pub(super) fn plain(known: &Known) -> String {
    let lines = text(known).lines;
    lines
        .iter()
        .map(|line| format!("{}\n", line.to_string().trim_end()))
        .collect()
}

fn title(known: &Known) -> Line<'static> {
    let verdict = known.answer.as_ref().map_or("", |answer| &answer.verdict);
    let color = match verdict {
        "Unique" => Color::Green,
        "Ambiguous" => Color::Yellow,
        _ => Color::Red,
    };
    let mut spans = vec![
        Span::from(known.robot.clone()).bold(),
        Span::from("  "),
        Span::from(verdict.to_owned()).fg(color).bold(),
    ];
    if let Some(answer) = &known.answer {
        spans.push(Span::from(format!("  scan {}", answer.counter)).dim());
    }
    if let Some(problem) = &known.lost {
        let text = format!("  DISCONNECTED: {problem}");
        spans.push(Span::from(text).fg(Color::Red).bold());
    }
    Line::from(spans)
}

fn head(text: &'static str) -> Line<'static> {
    Line::from(text.dim())
}

fn place_line(at: usize, place: &Place) -> Line<'static> {
    let Place {
        laser,
        score,
        probability,
    } = place;
    let text = format!(
        "{:>8}  {:>9.3} {:>9.3}  {:>11.2}  {score:>5.2}  {:>9.1} %",
        at + 1,
        laser.x,
        laser.y,
        laser.yaw.to_degrees(),
        100.0 * probability,
    );
    let style = match at {
        0 => Style::new().bold(),
        _ => Style::new().dim(),
    };
    Line::styled(text, style)
}

fn timing(known: &Known, answer: &Answer) -> [Line<'static>; 2] {
    let highest = known.latencies_ms.iter().copied().fold(1.0, f64::max);
    let bar = |ms: &f64| {
        let step = (ms / highest * 7.0).round().clamp(0.0, 7.0) as usize;
        BARS[step]
    };
    let bars: String = known.latencies_ms.iter().map(bar).collect();
    let text = format!(
        "scan to pose {:.1} ms: search {:.1} ms, fit {:.1} ms",
        answer.latency_ms, answer.search_ms, answer.extract_ms
    );
    [Line::from(text), Line::from(bars.fg(Color::Cyan))]
}

fn node_lines(node: &Node) -> Vec<Line<'static>> {
    let color = match node.state.as_str() {
        "ready" => Color::Green,
        "silent" => Color::Red,
        "degraded" => Color::Yellow,
        _ => Color::Gray,
    };
    let counts = format!(
        "{:>6.1}  {:>6.1}  {:>5}  {:>7}  {:>8}",
        node.received_hz, node.sent_hz, node.dropped, node.refused, node.restarts
    );
    let mut lines = vec![Line::from(vec![
        Span::from(format!("   {:<20}  ", node.name)),
        Span::from(format!("{:<9}", node.state)).fg(color),
        Span::from(counts),
    ])];
    if !node.last_error.is_empty() {
        let (past, color) = match node.state.as_str() {
            "ready" => ("earlier: ", Color::DarkGray),
            _ => ("", Color::Yellow),
        };
        let error = format!("     {past}{}", node.last_error);
        lines.push(Line::from(error).fg(color));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::top::known::Message;

    fn known(messages: &[&str]) -> Known {
        let mut known = Known::default();
        for text in messages {
            known.hear(serde_json::from_str::<Message>(text).unwrap());
        }
        known
    }

    #[test]
    fn a_graph_fits_a_terminal_of_80_columns() {
        let known = known(&[
            r#"{"type":"snapshot","robot":"r7","nodes":[
                {"name":"boundary_extractor","state":"degraded","received_hz":12345.6,
                 "dropped":12345,"refused":1234567,"restarts":3,"last_error":"no map"}]}"#,
            r#"{"type":"answer","counter":7,"verdict":"Unique","says":"one place fits",
                "latency_ms":20.5,"search_ms":15.0,"extract_ms":4.0,"hypotheses":[
                {"laser":{"x":-1234.5,"y":2.0,"yaw":-3.1},"score":0.97,"probability":1.0}]}"#,
        ]);
        let text = plain(&known);
        for expected in [
            "r7  Unique  scan 7\n",
            "one place fits.\n",
            "-1234.500     2.000      -177.62   0.97      100.0 %",
            "scan to pose 20.5 ms",
            "   boundary_extractor    degraded",
            "     no map\n",
        ] {
            assert!(text.contains(expected), "{expected:?} in\n{text}");
        }
        assert!(
            text.lines().all(|line| line.chars().count() <= 80),
            "{text}"
        );
    }

    #[test]
    fn a_lost_monitor_is_said() {
        let mut known = known(&[]);
        known.lost = Some("it is gone".to_owned());
        assert!(plain(&known).contains("DISCONNECTED: it is gone"));
        known.hear(Message::Other);
        assert!(!plain(&known).contains("DISCONNECTED"));
    }
}
