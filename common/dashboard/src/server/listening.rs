//! The port, and how many may be connected to it.

use std::io;
use std::net::{SocketAddr, TcpListener as StdListener};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};

use axum::serve::Listener;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

use crate::DashboardError;

/// Ports that are tried beyond the one that was asked for.
const NEXT_PORTS: u16 = 100;

/// Most connections at the same time; the next ones wait.
const MAX_CONNECTIONS: usize = 256;

/// Listens there or, where the port is taken, on the next free one.
///
/// # Errors
/// None is free, or the address is not this machine's.
pub(super) fn bind(wanted: SocketAddr) -> Result<StdListener, DashboardError> {
    let mut address = wanted;
    loop {
        match StdListener::bind(address) {
            Err(error)
                if error.kind() == io::ErrorKind::AddrInUse
                    && address.port() < wanted.port().saturating_add(NEXT_PORTS) =>
            {
                address.set_port(address.port() + 1);
            }
            Err(source) => {
                return Err(DashboardError::Listen {
                    address: wanted,
                    tried: address.port() - wanted.port(),
                    source,
                });
            }
            Ok(listener) => return Ok(listener),
        }
    }
}

/// A listener that keeps the number of connections bounded.
pub(super) struct Guarded {
    listener: TcpListener,
    free: Arc<Semaphore>,
}

impl Guarded {
    /// To be called inside the runtime.
    pub(super) fn new(listener: StdListener) -> io::Result<Self> {
        listener.set_nonblocking(true)?;
        Ok(Guarded {
            listener: TcpListener::from_std(listener)?,
            free: Arc::new(Semaphore::new(MAX_CONNECTIONS)),
        })
    }
}

impl Listener for Guarded {
    type Io = Connection;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Connection, SocketAddr) {
        // It is never closed, so there always is one in the end.
        let permit = Arc::clone(&self.free).acquire_owned().await.ok();
        let (stream, address) = Listener::accept(&mut self.listener).await;
        // Messages are small and must not wait for each other.
        let _ = stream.set_nodelay(true);
        let connection = Connection {
            stream,
            _permit: permit,
        };
        (connection, address)
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

/// A connection that counts as long as it is there.
pub(super) struct Connection {
    stream: TcpStream,
    _permit: Option<OwnedSemaphorePermit>,
}

impl AsyncRead for Connection {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(context, buffer)
    }
}

impl AsyncWrite for Connection {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.stream).poll_write(context, bytes)
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_taken_port_gives_way_to_the_next_free_one() {
        let first = bind("127.0.0.1:0".parse().unwrap()).unwrap();
        let taken = first.local_addr().unwrap();
        let second = bind(taken).unwrap().local_addr().unwrap();
        assert!(second.port() > taken.port());
        assert_eq!(second.ip(), taken.ip());
    }

    #[test]
    fn a_foreign_address_is_refused_by_name() {
        // A network for documents: no machine has it.
        let error = bind("192.0.2.1:7440".parse().unwrap()).unwrap_err();
        assert!(error.to_string().contains("192.0.2.1:7440"), "{error}");
    }
}
