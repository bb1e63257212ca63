//! SIGINT and SIGTERM as a flag and as something to wait for.
//!
//! A flag alone would be seen a tick late, and a signal between looking at the
//! flag and falling asleep would interrupt nothing. So each signal also writes
//! to a socket pair whose other end the event loop waits on.

use std::io::Read;
use std::os::fd::AsRawFd;
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use iceoryx2::prelude::{FileDescriptor, FileDescriptorBased, SynchronousMultiplexing};
use signal_hook::SigId;
use signal_hook::consts::{SIGINT, SIGTERM};

use crate::TransportError;

/// Catches the signals until it is dropped.
#[derive(Debug)]
pub(crate) struct Signals {
    stop: Arc<AtomicBool>,
    woken: UnixStream,
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
        let descriptor = FileDescriptor::non_owning_new(woken.as_raw_fd())
            .ok_or_else(|| std::io::Error::other("the socket has no valid descriptor"))?;
        let mut signals = Signals {
            stop: Arc::new(AtomicBool::new(false)),
            woken,
            descriptor,
            registrations: Vec::new(),
        };
        for signal in [SIGINT, SIGTERM] {
            // Actions run in this order: whoever is woken finds the flag set.
            let flag = signal_hook::flag::register(signal, Arc::clone(&signals.stop))?;
            signals.registrations.push(flag);
            let pipe = signal_hook::low_level::pipe::register(signal, waker.try_clone()?)?;
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

    /// Takes what the signals wrote, so that the next wait can sleep.
    pub(crate) fn drain(&self) {
        let mut bytes = [0; 16];
        while (&self.woken).read(&mut bytes).is_ok_and(|read| read > 0) {}
    }
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
