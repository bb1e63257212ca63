//! Reads scans from an LMS2xx on a serial line.

use std::io::{ErrorKind, Read, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use serialport::{ClearBuffer, SerialPort, TTYPort};
use sick::lms2xx::{Answer, Baud, Command, PartialScans, Reply, ReplyFramer, Scan};

use super::failed;
use super::outlet::{Outlet, SLICE};
use crate::lms2xx_scan::WholeScan;
use crate::lms2xx_setup::{Action, Format, Setup, Wanted};
use crate::{Config, LmsError};

/// Pause after each byte sent; the device needs 55 µs between two bytes.
const BYTE_GAP: Duration = Duration::from_micros(60);

/// Keeps the line open until the stop flag is set.
pub(super) fn run(device: &Path, config: &Config, outlet: &mut Outlet) -> Result<(), LmsError> {
    let mut last_baud = None;
    super::keep(outlet, |outlet| {
        let mut line = Line::open(device, config, last_baud)?;
        let outcome = line.listen(outlet);
        last_baud = line.setup.baud().or(last_baud);
        outcome
    })
}

fn wanted(config: &Config) -> Wanted {
    Wanted {
        baud: config.baud,
        width_deg: config.field.map(|deg| deg as u16),
        resolution_raw_1e2_deg: config.resolution.map(|deg| (deg * 100.0) as u16),
        reach: config.range,
    }
}

struct Line<'a> {
    name: &'a Path,
    silence_s: f64,
    port: TTYPort,
    setup: Setup,
    framer: ReplyFramer,
    parts: Option<PartialScans>,
    last_data: Instant,
    /// Buffer of the command to send, reused.
    command: Vec<u8>,
}

impl<'a> Line<'a> {
    fn open(name: &'a Path, config: &Config, last_baud: Option<Baud>) -> Result<Self, LmsError> {
        let path = name.to_string_lossy();
        let builder = serialport::new(path, Baud::B9600.rate()).timeout(SLICE);
        let port = builder
            .open_native()
            .map_err(|error| failed(name.display(), "open it", error))?;
        Ok(Line {
            name,
            silence_s: config.silence,
            port,
            setup: Setup::new(wanted(config), last_baud),
            framer: ReplyFramer::default(),
            parts: None,
            last_data: Instant::now(),
            command: Vec::new(),
        })
    }

    /// Reads until the stop flag is set; any other end is an error.
    fn listen(&mut self, outlet: &mut Outlet) -> Result<(), LmsError> {
        let mut piece = [0; 1 << 12];
        while !outlet.stopped() {
            match self.setup.next(transport::monotonic_ns())? {
                Action::Send(command) => self.send(&command)?,
                Action::Baud(baud) => self.switch(baud)?,
                Action::Wait => {}
            }
            match self.port.read(&mut piece) {
                Ok(count) => {
                    let received = super::now();
                    self.framer.push(piece.get(..count).unwrap_or_default());
                    self.receive(outlet, received)?;
                }
                Err(error)
                    if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => {}
                Err(error) => return Err(failed(self.name.display(), "read", error)),
            }
            if self.setup.format().is_some()
                && self.last_data.elapsed().as_secs_f64() > self.silence_s
            {
                return Err(LmsError::Silent {
                    address: self.name.display().to_string(),
                    seconds: self.silence_s,
                });
            }
            outlet.tick()?;
        }
        Ok(())
    }

    fn receive(
        &mut self,
        outlet: &mut Outlet,
        received: crate::scan::Received,
    ) -> Result<(), LmsError> {
        while let Some(next) = self.framer.next_frame() {
            // Before the baud rate is known, anything received may be garbage.
            let Some(baud) = self.setup.baud() else {
                if let Ok(frame) = next
                    && let Reply::Answer(answer, _) = frame.telegram
                {
                    self.setup.receive(&answer)?;
                }
                self.last_data = Instant::now();
                continue;
            };
            let Some(Reply::Answer(answer, status)) = outlet.take(next)? else {
                continue;
            };
            self.last_data = Instant::now();
            match (answer, self.setup.format()) {
                (Answer::Started(_), _) => return Err(LmsError::Restarted),
                (Answer::Scan(scan), Some(format)) => {
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
                    outlet.publish_lms2xx(&whole, status, received)?;
                }
                _ => self.setup.receive(&answer)?,
            }
        }
        Ok(())
    }

    fn send(&mut self, command: &Command<'_>) -> Result<(), LmsError> {
        self.command.clear();
        command.frame(&mut self.command);
        for byte in &self.command {
            self.port
                .write_all(std::slice::from_ref(byte))
                .map_err(|error| failed(self.name.display(), "write", error))?;
            std::thread::sleep(BYTE_GAP);
        }
        Ok(())
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
