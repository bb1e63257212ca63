//! SIGINT, SIGTERM and SIGHUP as a flag and, by a socket pair, as an event to wait for; a flag
//! alone would be seen a tick late. Other threads end the sleep in the same way.

use std::io::Read;
use std::os::fd::AsRawFd;
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use iceoryx2::prelude::{FileDescriptor, FileDescriptorBased, SynchronousMultiplexing};
use signal_hook::SigId;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};

use crate::TransportError;
use crate::waker::Waker;

#[derive(Debug)]
pub(crate) struct Signals {
    stop: Arc<AtomicBool>,
    woken: UnixStream,
    waker: UnixStream,
    descriptor: FileDescriptor,
    registrations: Vec<SigId>,
}

impl Signals {
    pub(crate) fn catch() -> Result<Self, TransportError> {
        Self::try_catch().map_err(TransportError::Signals)
    }

    fn try_catch() -> Result<Self, std::io::Error> {
        let (woken, waker) = UnixStream::pair()?;
        woken.set_nonblocking(true)?;
        waker.set_nonblocking(true)?;
        let descriptor = FileDescriptor::non_owning_new(woken.as_raw_fd())
            .ok_or_else(|| std::io::Error::other("the socket has no valid descriptor"))?;
        let mut signals = Signals {
            stop: Arc::new(AtomicBool::new(false)),
            woken,
            waker,
            descriptor,
            registrations: Vec::new(),
        };
        for signal in [SIGINT, SIGTERM, SIGHUP] {
            if signal == SIGHUP && hangups_are_ignored() {
                continue;
            }
            // Actions run in this order: the flag is set before the event loop wakes.
            let flag = signal_hook::flag::register(signal, Arc::clone(&signals.stop))?;
            signals.registrations.push(flag);
            let end = signals.waker.try_clone()?;
            let pipe = signal_hook::low_level::pipe::register(signal, end)?;
            signals.registrations.push(pipe);
        }
        Ok(signals)
    }

    pub(crate) fn flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.stop)
    }

    pub(crate) fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    pub(crate) fn waker(&self) -> Result<Waker, TransportError> {
        let end = self.waker.try_clone();
        end.map(|end| Waker(end.into()))
            .map_err(TransportError::Signals)
    }

    /// Reads what signals and wakers wrote, so that the next wait sleeps; true if there was any.
    pub(crate) fn drain(&self) -> bool {
        let mut bytes = [0; 256];
        let mut any = false;
        while (&self.woken).read(&mut bytes).is_ok_and(|read| read > 0) {
            any = true;
        }
        any
    }
}

/// True if SIGHUP is ignored, e.g. with `nohup`: the process should outlive the terminal.
fn hangups_are_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status
        .lines()
        .find_map(|line| line.strip_prefix("SigIgn:"))
        .and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask & (1 << (SIGHUP - 1)) != 0)
}

impl Drop for Signals {
    fn drop(&mut self) {
        for id in self.registrations.drain(..) {
            signal_hook::low_level::unregister(id);
        }
    }
}

impl FileDescriptorBased for Signals {
    fn file_descriptor(&self) -> &FileDescriptor {
        &self.descriptor
    }
}

impl SynchronousMultiplexing for Signals {}
