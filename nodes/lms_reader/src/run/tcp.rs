//! Reads scans from a device on the network.

use std::io::{ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};

use sick::cola::{Answer, Command, Encoding, Framer, Telegram, Value};

use super::failed;
use super::outlet::{Outlet, SLICE};
use crate::cola_setup::{Device, Wanted, set_up};
use crate::scan::{Received, Stamps};
use crate::{Config, LmsError, TRIES};

/// Timeout for connecting and for sending a command: a device is near, and a stop must not wait
/// long.
const ATTEMPT: Duration = Duration::from_millis(500);

/// Keeps a connection until the stop flag is set. (Resolving a host name may take as long as the
/// system's resolver; an IP address needs no look-up.)
pub(super) fn run(address: &str, config: &Config, outlet: &mut Outlet) -> Result<(), LmsError> {
    super::keep(outlet, |outlet| {
        let opened = Connection::open(address, config, outlet);
        let outcome = opened.and_then(|mut connection| connection.listen(config));
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
    framer: Framer,
    /// True until the device has been asked for its name: the angle convention may depend on it.
    is_identifying: bool,
    last_data: Instant,
    /// Time of the last read.
    received: Received,
    outlet: &'a mut Outlet,
}

impl<'a> Connection<'a> {
    fn open(address: &'a str, config: &Config, outlet: &'a mut Outlet) -> Result<Self, LmsError> {
        let failed = |what| move |error: std::io::Error| failed(address, what, error);
        let stream = try_each(address).map_err(failed("connect"))?;
        stream
            .set_read_timeout(Some(SLICE))
            .and_then(|()| stream.set_write_timeout(Some(ATTEMPT)))
            .map_err(failed("set up the connection"))?;
        Ok(Connection {
            address,
            silence_s: config.silence,
            encoding: config.protocol,
            stream,
            framer: Framer::new(config.protocol),
            is_identifying: config.start_stream,
            last_data: Instant::now(),
            received: super::now(),
            outlet,
        })
    }

    /// Reads until the stop flag is set; any other end is an error.
    fn listen(&mut self, config: &Config) -> Result<(), LmsError> {
        if config.start_stream {
            let time = config.stamps == Stamps::Device;
            let wanted = Wanted::of(config.field, config.resolution, time);
            set_up(self, wanted, config.stated_angles())?;
            tracing::info!("the device has started to send scans");
        }
        while !self.outlet.stopped() {
            self.step(|_| None::<()>)?;
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
            match self.outlet.take(next)? {
                Some(Telegram::ScanData(_)) if self.is_identifying => {}
                Some(Telegram::ScanData(data)) => self.outlet.publish_cola(&data, self.received)?,
                Some(Telegram::Answer(answer)) => {
                    if let Answer::Value(Value::DeviceIdent { name, .. }) = answer {
                        self.outlet.angles.on_name(name);
                    }
                    if let Some(found) = pick(&answer) {
                        return Ok(Some(found));
                    }
                }
                Some(other) => tracing::debug!(?other, "skipped a telegram"),
                None => {}
            }
        }
        self.read()?;
        self.outlet.tick()?;
        Ok(None)
    }

    fn read(&mut self) -> Result<(), LmsError> {
        let mut piece = [0; 1 << 14];
        let address = || self.address.to_owned();
        match self.stream.read(&mut piece) {
            Ok(0) => return Err(LmsError::Closed { address: address() }),
            Ok(count) => {
                self.last_data = Instant::now();
                self.received = super::now();
                self.framer.push(piece.get(..count).unwrap_or_default());
            }
            Err(error) if is_pause(error.kind()) => {
                if self.last_data.elapsed().as_secs_f64() > self.silence_s {
                    return Err(LmsError::Silent {
                        address: address(),
                        seconds: self.silence_s,
                    });
                }
            }
            Err(source) => return Err(failed(self.address, "read", source)),
        }
        Ok(())
    }
}

impl Device for Connection<'_> {
    fn ask<R>(
        &mut self,
        command: Command<'static>,
        patience: Duration,
        mut pick: impl FnMut(&Answer<'_>) -> Option<R>,
    ) -> Result<Option<R>, LmsError> {
        let mut bytes = Vec::new();
        self.encoding.frame(&Telegram::Command(command), &mut bytes);
        let mut found = None;
        for _ in 0..TRIES {
            let deadline = Instant::now() + patience;
            if found.is_none() && !self.outlet.stopped() {
                self.stream
                    .write_all(&bytes)
                    .map_err(|source| failed(self.address, "send a command", source))?;
            }
            while found.is_none() && Instant::now() < deadline && !self.outlet.stopped() {
                found = self.step(&mut pick)?;
            }
        }
        self.is_identifying = false;
        Ok(found)
    }
}

fn is_pause(kind: ErrorKind) -> bool {
    matches!(
        kind,
        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
    )
}
