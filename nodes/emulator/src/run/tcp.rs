//! Serves a CoLa device on a socket, for any number of clients.

use std::io::{ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::os::fd::AsFd;
use std::process::ExitCode;
use std::time::Duration;

use nix::errno::Errno;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use sick::SickError;
use sick::cola::{Answer, Encoding, Fault, Framer, Telegram};
use transport::{TransportError, monotonic_ns};

use super::{Common, TIMEOUT_NS};
use crate::EmulatorError;
use crate::cola_device::{ColaDevice, Model, Session};
use crate::faults::Faults;

/// Largest number of unread bytes before a client is disconnected.
const MAX_UNREAD: usize = 1 << 22;

pub(super) fn run(
    address: &str,
    model: &Model,
    encoding: Encoding,
    mut common: Common,
) -> Result<ExitCode, EmulatorError> {
    let failed = |error| EmulatorError::io(format!("cannot listen on {address}"), error);
    let listener = TcpListener::bind(address).map_err(failed)?;
    listener.set_nonblocking(true).map_err(failed)?;
    let local = listener.local_addr().map_err(failed)?;
    let mut device = ColaDevice::new(*model, encoding, &common.sweep);
    tracing::info!(address = %local, ?encoding, scans = common.sweep.scans.len(), "listening");
    let mut clients: Vec<Client> = Vec::new();
    let started_ns = monotonic_ns();
    let mut over_ns = None;
    while !common.stopped() {
        wait(&listener, &clients, common.pause())?;
        accept(&listener, encoding, &mut clients);
        let now_ns = monotonic_ns();
        if common.faults.resets(now_ns) {
            tracing::info!("restarted: all clients are disconnected");
            device = ColaDevice::new(*model, encoding, &common.sweep);
            clients.clear();
        }
        for client in &mut clients {
            client.receive(&mut device, &mut common, now_ns);
        }
        if clients.iter().any(|client| client.session.subscribed) {
            common.start()?;
        }
        let now_us = (now_ns - started_ns).unsigned_abs() / 1000;
        play(&mut device, &mut clients, &mut common, (now_ns, now_us))?;
        let is_over = common.player.is_over();
        for client in &mut clients {
            client.write(&mut common.faults, is_over);
        }
        clients.retain(Client::is_there);
        common.health.tick()?;
        if is_over {
            let over_ns = *over_ns.get_or_insert(now_ns);
            let unread = clients.iter().any(|client| !client.unsent.is_empty());
            if !unread || now_ns - over_ns > TIMEOUT_NS {
                return Ok(common.conclude(true));
            }
        }
    }
    Ok(common.conclude(false))
}

/// Sends each due scan to all subscribed clients.
fn play(
    device: &mut ColaDevice,
    clients: &mut [Client],
    common: &mut Common,
    (now_ns, now_us): (i64, u64),
) -> Result<(), TransportError> {
    while let Some(scan) = common.next_scan(now_ns)? {
        let counter = common.player.counter();
        let mut is_sent = false;
        for client in clients
            .iter_mut()
            .filter(|client| client.session.subscribed)
        {
            let start = client.unsent.len();
            device.write_scan(&common.sweep, scan, counter, now_us, &mut client.unsent);
            is_sent |= common.faults.damage(&mut client.unsent, start, now_ns);
            common.health.count_sent(1);
        }
        if is_sent {
            common.player.sent(now_ns);
        }
    }
    Ok(())
}

/// Waits for data, a new client, room to write, or the timeout.
fn wait(
    listener: &TcpListener,
    clients: &[Client],
    timeout: Duration,
) -> Result<(), EmulatorError> {
    let mut fds = vec![PollFd::new(listener.as_fd(), PollFlags::POLLIN)];
    fds.extend(clients.iter().map(|client| {
        let mut flags = PollFlags::POLLIN;
        flags.set(PollFlags::POLLOUT, client.is_full);
        PollFd::new(client.stream.as_fd(), flags)
    }));
    // Rounded up to milliseconds, so that it never wakes early and does not spin.
    let millis = timeout.as_micros().div_ceil(1000) as u16;
    match poll(&mut fds, PollTimeout::from(millis)) {
        Ok(_) | Err(Errno::EINTR) => Ok(()),
        Err(error) => Err(EmulatorError::io("cannot wait for clients", error)),
    }
}

fn accept(listener: &TcpListener, encoding: Encoding, clients: &mut Vec<Client>) {
    // A failed connection is already gone; there is nothing to wait for.
    while let Ok((stream, address)) = listener.accept() {
        let ready = stream
            .set_nonblocking(true)
            .and_then(|()| stream.set_nodelay(true));
        match ready {
            Ok(()) => {
                tracing::info!(client = %address, "connected");
                clients.push(Client::new(stream, address, encoding));
            }
            Err(error) => tracing::warn!(client = %address, %error, "cannot be served"),
        }
    }
}

struct Client {
    stream: TcpStream,
    address: SocketAddr,
    encoding: Encoding,
    framer: Framer,
    session: Session,
    unsent: Vec<u8>,
    /// True if the client's buffer is full.
    is_full: bool,
    has_gone: bool,
}

impl Client {
    fn new(stream: TcpStream, address: SocketAddr, encoding: Encoding) -> Self {
        Client {
            stream,
            address,
            encoding,
            framer: Framer::new(encoding),
            session: Session::default(),
            unsent: Vec::new(),
            is_full: false,
            has_gone: false,
        }
    }

    fn receive(&mut self, device: &mut ColaDevice, common: &mut Common, now_ns: i64) {
        let mut piece = [0; 1 << 12];
        loop {
            match self.stream.read(&mut piece) {
                Ok(0) => {
                    self.has_gone = true;
                    break;
                }
                Ok(count) => self.framer.push(piece.get(..count).unwrap_or_default()),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                Err(_) => {
                    self.has_gone = true;
                    break;
                }
            }
        }
        while let Some(next) = self.framer.next_frame() {
            let answer = match next {
                Ok(frame) => device.receive(&mut self.session, &frame.telegram),
                Err(SickError::Unreadable { .. }) => Some(Answer::Fault(Fault::INVALID_DATA)),
                Err(_) => None,
            };
            let Some(answer) = answer else { continue };
            tracing::debug!(client = %self.address, ?answer, "answered");
            let start = self.unsent.len();
            self.encoding
                .frame(&Telegram::Answer(answer), &mut self.unsent);
            common.faults.damage(&mut self.unsent, start, now_ns);
            common.health.count_received(1);
        }
    }

    fn write(&mut self, faults: &mut Faults, is_over: bool) {
        self.is_full = false;
        if !is_over && faults.holds_back() {
            return;
        }
        let mut sent = 0;
        while let Some(rest) = self.unsent.get(sent..)
            && !rest.is_empty()
        {
            let piece = rest.get(..faults.piece(rest.len())).unwrap_or(rest);
            match self.stream.write(piece) {
                Ok(count) => sent += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    self.is_full = true;
                    break;
                }
                Err(_) => {
                    self.has_gone = true;
                    break;
                }
            }
        }
        self.unsent.drain(..sent);
        if self.unsent.len() > MAX_UNREAD {
            tracing::warn!(client = %self.address, "too slow, disconnected");
            self.has_gone = true;
        }
    }

    fn is_there(&self) -> bool {
        if self.has_gone {
            tracing::info!(client = %self.address, "disconnected");
        }
        !self.has_gone
    }
}
