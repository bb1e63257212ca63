//! A socket or serial line: writes bytes, and reads bytes until a deadline.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::path::Path;
use std::time::{Duration, Instant};

use serialport::{ClearBuffer, SerialPort, TTYPort};
use sick::lms2xx::Baud;

const ATTEMPT: Duration = Duration::from_secs(2);
const SLICE: Duration = Duration::from_millis(20);
/// Gap between two bytes: an LMS2xx needs 55 µs when it receives.
const BYTE_GAP: Duration = Duration::from_micros(60);

pub(super) enum Line {
    Socket(TcpStream),
    Serial(TTYPort),
}

impl Line {
    /// Tries all addresses of a name; returns the last error.
    pub(super) fn connect(address: &str) -> io::Result<Self> {
        let mut failure = ErrorKind::AddrNotAvailable.into();
        for candidate in address.to_socket_addrs()? {
            match TcpStream::connect_timeout(&candidate, ATTEMPT) {
                Ok(stream) => {
                    stream.set_read_timeout(Some(SLICE))?;
                    stream.set_write_timeout(Some(ATTEMPT))?;
                    return Ok(Line::Socket(stream));
                }
                Err(error) => failure = error,
            }
        }
        Err(failure)
    }

    pub(super) fn open(path: &Path) -> io::Result<Self> {
        let path = path.to_string_lossy();
        let builder = serialport::new(path, Baud::B9600.rate()).timeout(SLICE);
        Ok(Line::Serial(builder.open_native()?))
    }

    /// Changes the baud rate and discards input received at the old one.
    pub(super) fn switch(&mut self, baud: Baud) -> io::Result<()> {
        if let Line::Serial(port) = self {
            port.set_baud_rate(baud.rate())?;
            port.clear(ClearBuffer::Input)?;
        }
        Ok(())
    }

    /// Sends bytes and passes what is received to `take` until it finds something, or too late.
    pub(super) fn ask<R>(
        &mut self,
        bytes: &[u8],
        patience: Duration,
        mut take: impl FnMut(&[u8]) -> Option<R>,
    ) -> io::Result<Option<R>> {
        self.say(bytes)?;
        let deadline = Instant::now() + patience;
        let mut buffer = [0; 1 << 14];
        let mut received = Some(&buffer[..0]);
        while let Some(piece) = received {
            if let Some(found) = take(piece) {
                return Ok(Some(found));
            }
            received = self.receive(&mut buffer, deadline)?;
        }
        Ok(None)
    }

    fn say(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Line::Socket(stream) => stream.write_all(bytes),
            Line::Serial(port) => bytes.iter().try_for_each(|byte| {
                port.write_all(std::slice::from_ref(byte))?;
                std::thread::sleep(BYTE_GAP);
                Ok(())
            }),
        }
    }

    /// Returns received bytes, at least one; `None` after the deadline.
    fn receive<'b>(
        &mut self,
        buffer: &'b mut [u8],
        deadline: Instant,
    ) -> io::Result<Option<&'b [u8]>> {
        while Instant::now() < deadline {
            let outcome = match self {
                Line::Socket(stream) => stream.read(buffer),
                Line::Serial(port) => port.read(buffer),
            };
            match outcome {
                Ok(0) => return Err(ErrorKind::ConnectionAborted.into()),
                Ok(count) => return Ok(buffer.get(..count)),
                Err(error) if is_pause(error.kind()) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(None)
    }
}

fn is_pause(kind: ErrorKind) -> bool {
    matches!(
        kind,
        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
    )
}
