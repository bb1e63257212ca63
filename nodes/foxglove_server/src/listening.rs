//! The server's socket, opened again when the library has given it up.
//!
//! The library stops listening for good at the first connection that it cannot accept (foxglove
//! 0.30.3, `Server::accept_connections`), as when connections that say nothing have taken all file
//! descriptors. It also never ends such a connection.

use std::io::ErrorKind;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::time::{Duration, Instant};

use foxglove::{Context, WebSocketServerHandle};
use tokio::runtime::Handle;
use transport::with_causes;

use crate::channels::Channels;
use crate::{Config, ServerError};

/// Interval of the checks, and longest wait for viewers at the end.
const SECOND: Duration = Duration::from_secs(1);

/// Number of messages queued for each viewer; beyond it the oldest ones are dropped.
const BACKLOG: usize = 256;

pub(crate) struct Listening {
    context: Arc<Context>,
    handle: Handle,
    channels: Arc<Channels>,
    robot: String,
    address: SocketAddr,
    /// `None` while it cannot listen.
    server: Option<WebSocketServerHandle>,
    checked: Instant,
}

impl Listening {
    pub(crate) fn start(
        context: &Arc<Context>,
        handle: &Handle,
        channels: &Arc<Channels>,
        config: &Config,
    ) -> Result<Self, ServerError> {
        let mut listening = Listening {
            context: Arc::clone(context),
            handle: handle.clone(),
            channels: Arc::clone(channels),
            robot: config.robot.clone(),
            address: config.listen,
            server: None,
            checked: Instant::now(),
        };
        let server = listening.listen()?;
        listening.address.set_port(server.port());
        listening.server = Some(server);
        let address = listening.address;
        tracing::info!("watch it in Foxglove or Lichtblick: open a connection to ws://{address}");
        Ok(listening)
    }

    fn listen(&self) -> Result<WebSocketServerHandle, ServerError> {
        let address = self.address;
        let server = self
            .context
            .websocket_server()
            .name(&self.robot)
            .bind(address.ip().to_string(), address.port())
            .listener(Arc::clone(&self.channels) as _)
            .message_backlog_size(BACKLOG)
            .tokio_runtime(&self.handle)
            .start_blocking();
        server.map_err(|source| ServerError::Listen { address, source })
    }

    /// Opens the socket again if the library has given it up, and closes all connections before;
    /// returns the reason. Checks once a second.
    pub(crate) fn check(&mut self) -> Option<String> {
        if self.checked.elapsed() < SECOND {
            return None;
        }
        self.checked = Instant::now();
        if self.server.is_some() && is_open(self.address) {
            return None;
        }
        // Dropping its tasks closes their sockets.
        drop(self.server.take().map(WebSocketServerHandle::stop));
        match self.listen() {
            Ok(server) => self.server = Some(server),
            // Its sockets may not be closed yet.
            Err(error) => return Some(with_causes(&error)),
        }
        Some("too many connections: all were closed".into())
    }

    /// Closes all connections. A viewer that does not read cannot delay that for long.
    pub(crate) fn stop(self) {
        if let Some(server) = self.server {
            let ended = server.stop().wait();
            let waiting = async { tokio::time::timeout(SECOND, ended).await };
            // Dropping its tasks ends what is left.
            let _ = self.handle.block_on(waiting);
        }
    }
}

/// Returns true if this address is in use, and there is a file descriptor for a connection.
fn is_open(address: SocketAddr) -> bool {
    let bound = TcpListener::bind(address);
    bound.is_err_and(|error| error.kind() == ErrorKind::AddrInUse)
}
