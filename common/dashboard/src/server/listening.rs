//! Listens on the port and serves each connection.

use std::io;
use std::net::{SocketAddr, TcpListener as StdListener};
use std::time::Duration;

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::TcpListener;

use super::connections::Connections;
use crate::DashboardError;

const NEXT_PORTS: u16 = 100;

/// Timeout for the head of a request, counted from the end of the previous one.
const HEAD_TIMEOUT: Duration = Duration::from_secs(15);

/// Delay before the next accept after one failed (out of file descriptors).
const SHORTAGE: Duration = Duration::from_millis(500);

/// Listens on the address or, if its port is taken, on the next free one.
/// Fails if no port is free, or the address does not belong to this machine.
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

/// Registers the listener with the current tokio runtime.
pub(super) fn in_runtime(listener: StdListener) -> io::Result<TcpListener> {
    listener.set_nonblocking(true)?;
    TcpListener::from_std(listener)
}

/// Serves `app` on each connection; never ends.
pub(super) async fn serve(listener: TcpListener, app: Router) {
    let connections = Connections::default();
    loop {
        let (stream, peer) = match listener.accept().await {
            Ok(accepted) => accepted,
            Err(error) => {
                tracing::warn!("cannot accept a connection: {error}");
                tokio::time::sleep(SHORTAGE).await;
                continue;
            }
        };
        // Small messages must not wait for each other.
        let _ = stream.set_nodelay(true);
        let stream = TokioIo::new(connections.admit(stream, peer.ip()));
        let answered = http1::Builder::new()
            .timer(TokioTimer::new())
            .header_read_timeout(HEAD_TIMEOUT)
            .serve_connection(stream, TowerToHyperService::new(app.clone()))
            .with_upgrades();
        // A connection that fails or is closed affects no other.
        tokio::spawn(async { answered.await.ok() });
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
        // A network for documentation (RFC 5737): no machine has it.
        let error = bind("192.0.2.1:7440".parse().unwrap()).unwrap_err();
        assert!(error.to_string().contains("192.0.2.1:7440"), "{error}");
    }
}
