//! Probes an LMS2xx at any baud rate.

use std::path::Path;
use std::time::Duration;

use anyhow::Context;
use sick::lms2xx::{Answer, Baud, Command, DeviceStatus, Mode, Reply, ReplyFramer, Scan};

use super::error::{not_reached, not_understood};
use super::line::Line;
use super::picture::Seen;

/// Attempts at each rate: the first command may collide with a scan in transmission.
const TRIES: usize = 2;
/// Longest wait for an answer: two scans may be in transmission at 38400 baud.
const TIMEOUT: Duration = Duration::from_millis(700);

struct Device<'a> {
    path: &'a Path,
    line: Line,
    framer: ReplyFramer,
    received: usize,
}

pub(super) fn ask(path: &Path) -> anyhow::Result<()> {
    Device::open(path)?.find_rate().map(drop)
}

/// Probes the device on the line; returns lines for the user, and a scan.
pub(super) fn probe(path: &Path) -> anyhow::Result<(Vec<String>, Seen)> {
    let mut device = Device::open(path)?;
    let baud = device.find_rate()?;
    let name = path.display();
    let mut said = vec![format!("{name}: an LMS2xx at {} baud", baud.rate())];
    let named = device.ask(&Command::RequestType, |answer| match answer {
        Answer::Type(text) => Some(format!("device      {}", text.escape_ascii())),
        _ => None,
    })?;
    said.extend(named);
    let status = device.ask(&Command::RequestStatus, |answer| match answer {
        Answer::Status(status) => Some(*status),
        _ => None,
    })?;
    let none = "status      no answer".to_owned();
    said.push(status.as_ref().map_or(none, in_words));
    let seen = status.and_then(|status| device.scan(&status).transpose());
    let seen = seen.transpose()?.unwrap_or_default();
    said.push(format!("a scan with {} returns", seen.points.len()));
    Ok((said, seen))
}

impl<'a> Device<'a> {
    fn open(path: &'a Path) -> anyhow::Result<Self> {
        let line = Line::open(path).with_context(|| not_reached(&path.display()))?;
        Ok(Device {
            path,
            line,
            framer: ReplyFramer::default(),
            received: 0,
        })
    }

    /// Finds the baud rate with a command that every mode answers and that stops scans.
    fn find_rate(&mut self) -> anyhow::Result<Baud> {
        for baud in Baud::ALL {
            let switched = self.line.switch(baud);
            switched.with_context(|| not_reached(&self.path.display()))?;
            self.framer = ReplyFramer::default();
            for _ in 0..TRIES {
                let answer = self.ask(&Command::SetMode(Mode::OnRequest), |answer| {
                    matches!(answer, Answer::ModeSet(_)).then_some(())
                })?;
                if answer.is_some() {
                    return Ok(baud);
                }
            }
        }
        let rates = Baud::ALL.map(|baud| baud.rate().to_string()).join(", ");
        let tried = format!("an LMS2xx at {rates} baud");
        Err(not_understood(&self.path.display(), self.received, &tried))
    }

    fn ask<R>(
        &mut self,
        command: &Command<'_>,
        mut pick: impl FnMut(&Answer<'_>) -> Option<R>,
    ) -> anyhow::Result<Option<R>> {
        let mut bytes = Vec::new();
        command.frame(&mut bytes);
        let (framer, received) = (&mut self.framer, &mut self.received);
        let found = self.line.ask(&bytes, TIMEOUT, |piece| {
            *received += piece.len();
            framer.push(piece);
            while let Some(next) = framer.next_frame() {
                if let Ok(frame) = next
                    && let Reply::Answer(answer, _) = frame.telegram
                    && let Some(found) = pick(&answer)
                {
                    return Some(found);
                }
            }
            None
        });
        found.with_context(|| not_reached(&self.path.display()))
    }

    fn scan(&mut self, status: &DeviceStatus) -> anyhow::Result<Option<Seen>> {
        self.ask(&Command::RequestScan, |answer| match answer {
            Answer::Scan(scan) => Some(seen(scan, status)),
            _ => None,
        })
    }
}

fn seen(scan: &Scan<'_>, status: &DeviceStatus) -> Seen {
    let step_deg = f64::from(status.resolution_raw_1e2_deg) * 0.01;
    let start_deg = -0.5 * f64::from(status.width_deg);
    let points = scan.readings.enumerate().filter_map(|(beam, reading)| {
        let distance = status.range_mode.distance(reading)?;
        let bearing = (start_deg + beam as f64 * step_deg).to_radians();
        Some((bearing, f64::from(distance) * scan.unit.metres()))
    });
    Seen {
        points: points.collect(),
        up: "ahead is up".to_owned(),
    }
}

fn in_words(status: &DeviceStatus) -> String {
    let state = match status.has_error {
        true => "error",
        false => "in order",
    };
    format!(
        "state       {state}, version {}\nmeasures    {}° at {}°, {} turns a minute, unit {} m, {:?}",
        status.version.escape_ascii(),
        status.width_deg,
        f64::from(status.resolution_raw_1e2_deg) * 0.01,
        status.turns,
        status.unit.metres(),
        status.range_mode,
    )
}
