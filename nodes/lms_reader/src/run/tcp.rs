//! Reads scans from a device on the network.

use std::io::{ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};

use sick::cola::{Answer, Encoding, Framer, Telegram, Value};

use super::failed;
use super::outlet::{Outlet, SLICE};
use crate::cola_setup::{Setup, Wanted};
use crate::scan::Stamps;
use crate::{Config, LmsError};

/// Timeout for connecting and for sending a command: a device is near, and a stop must not wait
/// long.
const ATTEMPT: Duration = Duration::from_millis(500);

/// Keeps a connection until the stop flag is set. (Resolving a host name may take as long as the
/// system's resolver; an IP address needs no look-up.)
pub(super) fn run(address: &str, config: &Config, outlet: &mut Outlet) -> Result<(), LmsError> {
    super::keep(outlet, |outlet| {
        let outcome = Connection::open(address, config).and_then(|mut c| c.listen(outlet));
        match outcome {
            Err(LmsError::Closed { .. }) if config.until_closed && outlet.sent > 0 => {
                tracing::info!(
                    sent = outlet.sent,
                    "the device closed the connection after its last scan"
                );
                outlet.finish()
            }
            other => other,
        }
    })
}

/// Tries all addresses of a name and returns the last error if none connects.
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

struct Connection<'a> {
    address: &'a str,
    silence_s: f64,
    encoding: Encoding,
    stream: TcpStream,
    /// Dialogue with the device; `None` once it is done or if the node only listens.
    setup: Option<Setup>,
    framer: Framer,
    /// Buffer of the command to send, reused.
    command: Vec<u8>,
}

impl<'a> Connection<'a> {
    fn open(address: &'a str, config: &Config) -> Result<Self, LmsError> {
        let failed = |what| move |error: std::io::Error| failed(address, what, error);
        let stream = try_each(address).map_err(failed("connect"))?;
        stream
            .set_read_timeout(Some(SLICE))
            .and_then(|()| stream.set_write_timeout(Some(ATTEMPT)))
            .map_err(failed("set up the connection"))?;
        let encoding = config.protocol;
        let wanted = Wanted::of(
            config.field,
            config.resolution,
            config.stamps == Stamps::Device,
        );
        Ok(Connection {
            address,
            silence_s: config.silence,
            encoding,
            stream,
            setup: config
                .start_stream
                .then(|| Setup::new(wanted, config.stated_angles())),
            framer: Framer::new(encoding),
            command: Vec::new(),
        })
    }

    /// Reads until the stop flag is set; any other end is an error.
    fn listen(&mut self, outlet: &mut Outlet) -> Result<(), LmsError> {
        let mut piece = [0; 1 << 14];
        let mut last_data = Instant::now();
        while !outlet.stopped() {
            self.speak()?;
            match self.stream.read(&mut piece) {
                Ok(0) => {
                    return Err(LmsError::Closed {
                        address: self.address.into(),
                    });
                }
                Ok(count) => {
                    last_data = Instant::now();
                    self.receive(piece.get(..count).unwrap_or_default(), outlet)?;
                }
                Err(error) if is_pause(error.kind()) => {
                    if last_data.elapsed().as_secs_f64() > self.silence_s {
                        return Err(LmsError::Silent {
                            address: self.address.into(),
                            seconds: self.silence_s,
                        });
                    }
                }
                Err(source) => return Err(failed(self.address, "read", source)),
            }
            outlet.tick()?;
        }
        Ok(())
    }

    /// Sends the next command of the dialogue, if one is due.
    fn speak(&mut self) -> Result<(), LmsError> {
        let Some(setup) = &mut self.setup else {
            return Ok(());
        };
        if let Some(command) = setup.next(transport::monotonic_ns())? {
            self.command.clear();
            self.encoding
                .frame(&Telegram::Command(command), &mut self.command);
            self.stream
                .write_all(&self.command)
                .map_err(|source| failed(self.address, "send a command", source))?;
        }
        if setup.is_done() {
            tracing::info!("the device has started to send scans");
            self.setup = None;
        }
        Ok(())
    }

    fn receive(&mut self, piece: &[u8], outlet: &mut Outlet) -> Result<(), LmsError> {
        let received = super::now();
        self.framer.push(piece);
        while let Some(next) = self.framer.next_frame() {
            match (outlet.take(next)?, &mut self.setup) {
                // The angle convention may depend on the name that the device is about to report.
                (Some(Telegram::ScanData(_)), Some(setup)) if setup.is_identifying() => {}
                (Some(Telegram::ScanData(data)), _) => outlet.publish_cola(&data, received)?,
                (Some(Telegram::Answer(answer)), Some(setup)) => {
                    setup.receive(&answer)?;
                    if let Answer::Value(Value::DeviceIdent { name, .. }) = answer {
                        outlet.angles.on_name(name);
                    }
                }
                (Some(other), _) => tracing::debug!(?other, "skipped a telegram"),
                (None, _) => {}
            }
        }
        Ok(())
    }
}

fn is_pause(kind: ErrorKind) -> bool {
    matches!(
        kind,
        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
    )
}
