//! SIGINT and SIGTERM as a flag and as something to wait for.
//!
//! A flag alone would be seen a tick late, and a signal between looking at the
//! flag and falling asleep would interrupt nothing. So each signal also writes
//! to a socket pair whose other end the event loop waits on. Other threads end its
//! sleep in the same way.

use std::io::Read;
use std::os::fd::AsRawFd;
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use iceoryx2::prelude::{FileDescriptor, FileDescriptorBased, SynchronousMultiplexing};
use signal_hook::SigId;
use signal_hook::consts::{SIGINT, SIGTERM};

use crate::TransportError;
use crate::waker::Waker;

/// Catches the signals until it is dropped.
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
        for signal in [SIGINT, SIGTERM] {
            // Actions run in this order: whoever is woken finds the flag set.
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

    /// An end for another thread.
    pub(crate) fn waker(&self) -> Result<Waker, TransportError> {
        let end = self.waker.try_clone();
        end.map(Waker::new).map_err(TransportError::Signals)
    }

    /// Takes what signals and wakers wrote, so that the next wait can sleep;
    /// returns whether there was something.
    pub(crate) fn drain(&self) -> bool {
        let mut bytes = [0; 256];
        let mut any = false;
        while (&self.woken).read(&mut bytes).is_ok_and(|read| read > 0) {
            any = true;
        }
        any
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
