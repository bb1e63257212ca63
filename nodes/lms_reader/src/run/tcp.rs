//! Scans from a device on the network.

use std::io::{ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};

use super::outlet::{Outlet, SLICE};
use crate::backoff::Backoff;
use crate::cola_b::{Framer, START_SCAN_DATA, frame};
use crate::{Config, LmsError};

/// How long an attempt to connect, or to send the request, may take. A device
/// is near, and a stop must not wait for long.
const ATTEMPT: Duration = Duration::from_millis(500);

/// Keeps a connection until the stop flag is set. (Looking up a host's name
/// may take as long as the system's resolver does; a number needs no look-up.)
pub(super) fn run(address: &str, config: &Config, outlet: &mut Outlet) -> Result<(), LmsError> {
    let mut backoff = Backoff::default();
    while !outlet.stopped() {
        let before = outlet.sent;
        let outcome = connect(address, config.start_stream)
            .and_then(|stream| listen(stream, address, config.silence, outlet));
        match outcome {
            Ok(()) => break,
            Err(error @ LmsError::Transport(_)) => return Err(error),
            Err(error) => outlet.lost(&error)?,
        }
        if outlet.sent > before {
            backoff.reset();
        }
        outlet.wait_until(Instant::now() + backoff.next_wait())?;
    }
    Ok(())
}

fn connect(address: &str, start_stream: bool) -> Result<TcpStream, LmsError> {
    let failed = |what| {
        move |source| LmsError::Device {
            address: address.into(),
            what,
            source,
        }
    };
    let mut stream = try_each(address).map_err(failed("connect"))?;
    stream
        .set_read_timeout(Some(SLICE))
        .and_then(|()| stream.set_write_timeout(Some(ATTEMPT)))
        .map_err(failed("set up the connection"))?;
    if start_stream {
        stream
            .write_all(&frame(START_SCAN_DATA))
            .map_err(failed("ask for scans"))?;
    }
    Ok(stream)
}

/// Tries all that a name stands for; the last failure counts.
fn try_each(address: &str) -> std::io::Result<TcpStream> {
    let mut failure = ErrorKind::AddrNotAvailable.into();
    for candidate in address.to_socket_addrs()? {
        match TcpStream::connect_timeout(&candidate, ATTEMPT) {
            Ok(stream) => return Ok(stream),
            Err(error) => failure = error,
        }
    }
    Err(failure)
}

/// Reads until the stop flag is set, which alone is a success.
fn listen(
    mut stream: TcpStream,
    address: &str,
    silence_s: f64,
    outlet: &mut Outlet,
) -> Result<(), LmsError> {
    let mut framer = Framer::default();
    let mut piece = [0; 1 << 14];
    let mut heard = Instant::now();
    while !outlet.stopped() {
        match stream.read(&mut piece) {
            Ok(0) => {
                return Err(LmsError::Closed {
                    address: address.into(),
                });
            }
            Ok(count) => {
                let received = super::now();
                heard = Instant::now();
                framer.push(piece.get(..count).unwrap_or_default());
                while let Some(next) = framer.next_frame() {
                    if let Some(data) = outlet.hear(next)? {
                        outlet.publish(&data, received)?;
                    }
                }
            }
            Err(error) if is_pause(error.kind()) => {
                if heard.elapsed().as_secs_f64() > silence_s {
                    return Err(LmsError::Silent {
                        address: address.into(),
                        seconds: silence_s,
                    });
                }
            }
            Err(source) => {
                return Err(LmsError::Device {
                    address: address.into(),
                    what: "read",
                    source,
                });
            }
        }
        outlet.tick()?;
    }
    Ok(())
}

fn is_pause(kind: ErrorKind) -> bool {
    matches!(
        kind,
        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
    )
}
