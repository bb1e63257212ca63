//! Formats a scan and its place as a row of the table that `backcast run` prints. Pure.

use messages::Verdict;
use offline::Reply;
use pose_table::Line;

/// The row without a line break; for a rejected scan the reason is appended.
pub(super) fn text(stamp_ns: i64, reply: &Reply<'_>) -> String {
    let mut line = Line {
        stamp_ns,
        x: None,
        y: None,
        heading_deg: None,
        score: None,
        verdict: Verdict::NoScan.as_str(),
        alternatives: 0,
        says: String::new(),
        // Without a graph, CPU time is the only latency.
        latency_ms: reply.cpu_ms,
        engine_ms: reply.cpu_ms,
    };
    let places = match &reply.answer {
        Ok(answer) => &answer.places,
        Err(refusal) => return format!("{}  {refusal:#}", line.text()),
    };
    line.verdict = places.verdict.as_str();
    line.alternatives = places.alternatives;
    line.says = places.sentence();
    if let Some(best) = places.places.first() {
        line.x = Some(best.map_from_laser.x);
        line.y = Some(best.map_from_laser.y);
        line.heading_deg = Some(best.map_from_laser.yaw.to_degrees());
        line.score = Some(best.score as f32);
    }
    match &reply.answer {
        // The verdict is the end of the line's text; the name of the map follows.
        Ok(answer) if !answer.map.name.is_empty() && !places.places.is_empty() => {
            format!("{}  on {}", line.text(), answer.map.name)
        }
        _ => line.text(),
    }
}
