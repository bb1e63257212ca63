//! Formats a scan and its place as a row of the table that `backcast run` prints. Pure.

use geometry::Pose;
use messages::Verdict;
use offline::{Reply, TakenScan};
use pose_table::{Frame, Line};

/// The row without a line break; for a rejected scan the reason is appended.
pub(super) fn text(scan: &TakenScan, reply: &Reply<'_>) -> String {
    let mut line = Line {
        stamp_ns: scan.stamp_ns,
        of: frame(scan),
        map: None,
        x: None,
        y: None,
        heading_deg: None,
        map_from_laser: None,
        score: None,
        verdict: Verdict::NoScan.as_str(),
        alternatives: 0,
        says: String::new(),
        // Without a graph, CPU time is the only latency.
        latency_ms: reply.cpu_ms,
        engine_ms: reply.cpu_ms,
    };
    let answer = match &reply.answer {
        Ok(answer) => answer,
        Err(refusal) => return format!("{}  {refusal:#}", line.text()),
    };
    let places = answer.places;
    line.verdict = places.verdict.as_str();
    line.alternatives = places.alternatives;
    line.says = places.sentence();
    if let Some(best) = places.places.first() {
        let laser_from_base = scan.base_from_laser.map_or(Pose::IDENTITY, Pose::inverse);
        let pose = best.map_from_laser.then(laser_from_base);
        line.x = Some(pose.x);
        line.y = Some(pose.y);
        line.heading_deg = Some(pose.yaw.to_degrees());
        line.score = Some(best.score as f32);
        line.map = Some(answer.map.name.clone()).filter(|name| !name.is_empty());
    }
    line.text()
}

/// Frame whose pose the row has.
pub(super) fn frame(scan: &TakenScan) -> Frame {
    Frame::of(scan.base_from_laser.is_some())
}
