//! Serves an LMS2xx on a pseudo-terminal.

use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use serialport::{SerialPort, TTYPort};
use sick::SickError;
use sick::lms2xx::{Baud, CommandFramer, Reply};
use transport::monotonic_ns;

use super::{Common, SLICE, TIMEOUT_NS};
use crate::EmulatorError;
use crate::lms2xx_device::Lms2xxDevice;

/// Largest number of unread bytes before data is dropped, as on a real line; the terminal counts up
/// to 4095.
const MAX_UNREAD: u32 = 3300;

/// Time for which nothing must be unread before the terminal is closed, nanoseconds. Closing
/// discards data that the terminal is still passing on in the background, which is not counted as
/// unread.
const REST_NS: i64 = 500_000_000;

pub(super) fn run(link: &Path, baud: Baud, common: Common) -> Result<ExitCode, EmulatorError> {
    let device = Lms2xxDevice::new(baud, &common.sweep)?;
    let mut terminal = Terminal::open(link, device, common)?;
    let mut over_ns = None;
    while !terminal.common.stopped() {
        terminal.listen()?;
        let now_ns = monotonic_ns();
        if terminal.common.faults.resets(now_ns) {
            tracing::info!("restarted");
            let start = terminal.unsent.len();
            terminal.device.restart().frame(&mut terminal.unsent);
            let faults = &mut terminal.common.faults;
            faults.damage(&mut terminal.unsent, start, now_ns);
        }
        if terminal.device.is_wanted() {
            terminal.common.start()?;
        }
        while let Some(scan) = terminal.common.next_scan(now_ns)? {
            terminal.say_scan(now_ns, scan);
        }
        let is_over = terminal.common.player.is_over();
        if is_over || !terminal.common.faults.holds_back() {
            terminal.write()?;
        }
        terminal.common.health.tick()?;
        if is_over {
            let over_ns = *over_ns.get_or_insert(now_ns);
            let rested_ns = now_ns - over_ns;
            if rested_ns > TIMEOUT_NS || rested_ns > REST_NS && terminal.unread()? == 0 {
                return Ok(terminal.common.conclude(true));
            }
        }
    }
    Ok(terminal.common.conclude(false))
}

struct Terminal {
    common: Common,
    device: Lms2xxDevice,
    framer: CommandFramer,
    master: TTYPort,
    /// Client side of the terminal; kept open, because otherwise the master would hang up while
    /// there is no client.
    slave: TTYPort,
    unsent: Vec<u8>,
    _link: Link,
}

impl Terminal {
    fn open(link: &Path, device: Lms2xxDevice, common: Common) -> Result<Self, EmulatorError> {
        let (mut master, slave) = TTYPort::pair().map_err(|error| failed("open it", error))?;
        master
            .set_timeout(SLICE)
            .map_err(|error| failed("set it up", error))?;
        let name = slave.name().unwrap_or_default();
        let link = Link::make(link, Path::new(&name))?;
        let (terminal, baud) = (link.0.display(), device.baud.rate());
        tracing::info!(%terminal, baud, scans = common.sweep.scans.len(), "listening");
        Ok(Terminal {
            common,
            device,
            framer: CommandFramer::default(),
            master,
            slave,
            unsent: Vec::new(),
            _link: link,
        })
    }

    /// Waits for commands until something else is due, and answers them.
    fn listen(&mut self) -> Result<(), EmulatorError> {
        self.master
            .set_timeout(self.common.pause())
            .map_err(|error| failed("set it up", error))?;
        let mut piece = [0; 1 << 10];
        match self.master.read(&mut piece) {
            Ok(count) if self.is_understood()? => {
                self.framer.push(piece.get(..count).unwrap_or_default());
            }
            // Data sent at another baud rate is not received.
            Ok(_) => {}
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => {}
            Err(error) => return Err(failed("read", error)),
        }
        self.answer()
    }

    fn answer(&mut self) -> Result<(), EmulatorError> {
        let now_ns = monotonic_ns();
        let mut next_baud = self.device.baud;
        while let Some(next) = self.framer.next_frame() {
            let start = self.unsent.len();
            match next {
                Ok(frame) => {
                    tracing::debug!(command = ?frame.telegram, "received");
                    next_baud = self.device.receive(&frame.telegram, &mut self.unsent);
                    self.common.health.count_received(1);
                }
                Err(SickError::Checksum { .. } | SickError::Unreadable { .. }) => {
                    Reply::Refused.frame(&mut self.unsent);
                }
                Err(_) => {}
            }
            self.common.faults.damage(&mut self.unsent, start, now_ns);
        }
        if next_baud != self.device.baud {
            // Earlier replies are sent at the old rate.
            self.write()?;
            self.device.baud = next_baud;
        }
        Ok(())
    }

    fn say_scan(&mut self, now_ns: i64, scan: usize) {
        let start = self.unsent.len();
        self.device
            .write_scan(&self.common.sweep, scan, &mut self.unsent);
        if self.unsent.len() > start {
            if self.common.faults.damage(&mut self.unsent, start, now_ns) {
                self.common.player.sent(now_ns);
            }
            self.common.health.count_sent(1);
        }
    }

    /// Sends all pending data; unread data beyond the limit is dropped.
    fn write(&mut self) -> Result<(), EmulatorError> {
        if self.unsent.is_empty() {
            return Ok(());
        }
        if !self.is_understood()? {
            self.unsent = self.common.faults.noise(self.unsent.len());
        }
        if self.unread()? < MAX_UNREAD {
            let mut rest = &self.unsent[..];
            while !rest.is_empty() {
                let piece = self.common.faults.piece(rest.len());
                let (piece, more) = rest.split_at(piece);
                self.master
                    .write_all(piece)
                    .map_err(|error| failed("write", error))?;
                rest = more;
            }
        }
        self.unsent.clear();
        Ok(())
    }

    /// Returns true if the client uses the device's baud rate.
    fn is_understood(&self) -> Result<bool, EmulatorError> {
        let baud = self.master.baud_rate();
        let baud = baud.map_err(|error| failed("read the baud rate", error))?;
        Ok(baud == self.device.baud.rate())
    }

    fn unread(&self) -> Result<u32, EmulatorError> {
        let unread = self.slave.bytes_to_read();
        unread.map_err(|error| failed("look at what is unread", error))
    }
}

fn failed(what: &str, error: impl Into<std::io::Error>) -> EmulatorError {
    EmulatorError::io(format!("pseudo-terminal: cannot {what}"), error)
}

/// Symbolic link that is removed when dropped.
struct Link(PathBuf);

impl Link {
    /// Creates the link; replaces an existing link, but no other kind of file.
    fn make(path: &Path, target: &Path) -> Result<Self, EmulatorError> {
        let failed = |error| {
            let path = path.display();
            EmulatorError::io(
                format!("{path}: cannot make the link to the pseudo-terminal"),
                error,
            )
        };
        if path.is_symlink() {
            std::fs::remove_file(path).map_err(failed)?;
        }
        std::os::unix::fs::symlink(target, path).map_err(failed)?;
        Ok(Link(path.into()))
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        // An error here cannot be reported.
        let _ = std::fs::remove_file(&self.0);
    }
}
