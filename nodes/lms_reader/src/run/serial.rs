//! Reads scans from an LMS2xx on a serial line.

use std::io::{ErrorKind, Read, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use serialport::{ClearBuffer, SerialPort, TTYPort};
use sick::lms2xx::{Answer, Baud, Command, PartialScans, Reply, ReplyFramer, Scan};

use super::failed;
use super::outlet::{Outlet, SLICE};
use crate::lms2xx_scan::WholeScan;
use crate::lms2xx_setup::{Device, Format, Wanted, find_baud, set_up};
use crate::scan::Received;
use crate::{Config, LmsError, TRIES};

/// Pause after each byte sent; the device needs 55 µs between two bytes.
const BYTE_GAP: Duration = Duration::from_micros(60);

/// Keeps the line open until the stop flag is set.
pub(super) fn run(device: &Path, config: &Config, outlet: &mut Outlet) -> Result<(), LmsError> {
    let mut last_baud = None;
    super::keep(outlet, |outlet| {
        let mut line = Line::open(device, config, outlet)?;
        let outcome = line.listen(config, last_baud);
        last_baud = line.baud.or(last_baud);
        outcome
    })
}

struct Line<'a> {
    name: &'a Path,
    silence_s: f64,
    port: TTYPort,
    /// Baud rate of the device, once it is known.
    baud: Option<Baud>,
    /// Format of the scans, once they are sent.
    format: Option<Format>,
    framer: ReplyFramer,
    parts: Option<PartialScans>,
    last_data: Instant,
    /// Time of the last read.
    received: Received,
    outlet: &'a mut Outlet,
}

impl<'a> Line<'a> {
    fn open(name: &'a Path, config: &Config, outlet: &'a mut Outlet) -> Result<Self, LmsError> {
        let path = name.to_string_lossy();
        let builder = serialport::new(path, Baud::B9600.rate()).timeout(SLICE);
        let port = builder
            .open_native()
            .map_err(|error| failed(name.display(), "open it", error))?;
        Ok(Line {
            name,
            silence_s: config.silence,
            port,
            baud: None,
            format: None,
            framer: ReplyFramer::default(),
            parts: None,
            last_data: Instant::now(),
            received: super::now(),
            outlet,
        })
    }

    /// Reads until the stop flag is set; any other end is an error.
    fn listen(&mut self, config: &Config, last_baud: Option<Baud>) -> Result<(), LmsError> {
        let wanted = Wanted {
            baud: config.baud,
            width_deg: config.field.map(|deg| deg as u16),
            resolution_raw_1e2_deg: config.resolution.map(|deg| (deg * 100.0) as u16),
            reach: config.range,
        };
        self.baud = Some(find_baud(self, wanted.baud, last_baud)?);
        self.format = Some(set_up(self, wanted)?);
        while !self.outlet.stopped() {
            self.step(|_| None::<()>)?;
            if self.last_data.elapsed().as_secs_f64() > self.silence_s {
                return Err(LmsError::Silent {
                    address: self.name.display().to_string(),
                    seconds: self.silence_s,
                });
            }
        }
        Ok(())
    }

    /// Publishes the scans that have arrived, up to the first answer that `pick` takes, whose result
    /// it returns; if there is none, reads once.
    fn step<R>(
        &mut self,
        mut pick: impl FnMut(&Answer<'_>) -> Option<R>,
    ) -> Result<Option<R>, LmsError> {
        while let Some(next) = self.framer.next_frame() {
            let reply = match self.baud {
                Some(_) => self.outlet.take(next)?,
                // Before the baud rate is known, anything received may be garbage.
                None => next.ok().map(|frame| frame.telegram),
            };
            let Some(Reply::Answer(answer, status)) = reply else {
                continue;
            };
            self.last_data = Instant::now();
            match (answer, self.baud, self.format) {
                (Answer::Started(_), Some(_), _) => {
                    return Err(LmsError::Other("the device was restarted".into()));
                }
                (Answer::Scan(scan), Some(baud), Some(format)) => {
                    // A byte has ten bits with start and stop; a scan has ten bytes and two per
                    // reading.
                    let bytes = 10 + 2 * scan.readings.len() as i64;
                    let line_ns = bytes * 10 * 1_000_000_000 / i64::from(baud.rate());
                    let Some(scan) = whole(scan, format, &mut self.parts) else {
                        continue;
                    };
                    let whole = WholeScan {
                        format,
                        scan,
                        line_ns,
                    };
                    self.outlet.publish_lms2xx(&whole, status, self.received)?;
                }
                _ => {
                    if let Some(found) = pick(&answer) {
                        return Ok(Some(found));
                    }
                }
            }
        }
        let mut piece = [0; 1 << 12];
        match self.port.read(&mut piece) {
            Ok(count) => {
                self.received = super::now();
                self.framer.push(piece.get(..count).unwrap_or_default());
            }
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => {}
            Err(error) => return Err(failed(self.name.display(), "read", error)),
        }
        self.outlet.tick()?;
        Ok(None)
    }
}

impl Device for Line<'_> {
    fn ask<R>(
        &mut self,
        command: &Command<'static>,
        patience: Duration,
        mut pick: impl FnMut(&Answer<'_>) -> Option<R>,
    ) -> Result<Option<R>, LmsError> {
        let mut bytes = Vec::new();
        command.frame(&mut bytes);
        let mut found = None;
        for _ in 0..TRIES {
            let deadline = Instant::now() + patience;
            if found.is_none() && !self.outlet.stopped() {
                for byte in &bytes {
                    self.port
                        .write_all(std::slice::from_ref(byte))
                        .map_err(|error| failed(self.name.display(), "write", error))?;
                    std::thread::sleep(BYTE_GAP);
                }
            }
            while found.is_none() && Instant::now() < deadline && !self.outlet.stopped() {
                found = self.step(&mut pick)?;
            }
        }
        Ok(found)
    }

    /// Sets the baud rate and drops bytes received at the old one.
    fn switch(&mut self, baud: Baud) -> Result<(), LmsError> {
        self.port
            .set_baud_rate(baud.rate())
            .and_then(|()| self.port.clear(ClearBuffer::Input))
            .map_err(|error| failed(self.name.display(), "set the baud rate", error))?;
        self.framer = ReplyFramer::default();
        Ok(())
    }
}

/// Returns the whole scan of a telegram; a partial scan is stored until it is complete.
fn whole<'a>(
    scan: Scan<'a>,
    Format {
        width_deg,
        resolution_raw_1e2_deg,
        ..
    }: Format,
    parts: &'a mut Option<PartialScans>,
) -> Option<Scan<'a>> {
    if scan.part.is_none() {
        return Some(scan);
    }
    if parts.is_none() {
        *parts = PartialScans::new(width_deg, resolution_raw_1e2_deg);
    }
    let readings = parts.as_mut()?.add(&scan)?.into();
    Some(Scan { readings, ..scan })
}
