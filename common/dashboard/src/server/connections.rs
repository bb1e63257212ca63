//! Limits the number of connections, in total and per peer.
//!
//! Idle connections cannot lock out others: at either limit, the connection that was idle for
//! longest is closed, and connections that were sent data, such as viewers, are closed last. A
//! connection whose peer does not read is closed as well.

use std::collections::BTreeMap;
use std::io;
use std::net::IpAddr;
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, ready};
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio::sync::oneshot;
use tokio::time::{Instant, Sleep, sleep};

const MAX_CONNECTIONS: usize = 256;

/// Maximum number per peer address; it may be a proxy for many users.
const MAX_OF_PEER: usize = 128;

/// Longest time for which a peer may accept no data.
const WRITE_TIMEOUT: Duration = Duration::from_secs(10);

#[derive(Clone, Default)]
pub(super) struct Connections(Arc<Mutex<Open>>);

#[derive(Default)]
struct Open {
    next: u64,
    entries: BTreeMap<u64, Entry>,
}

struct Entry {
    peer: IpAddr,
    /// True if data was sent to it.
    answered: bool,
    /// Time of the last byte in either direction.
    active: Instant,
    _close: oneshot::Sender<()>,
}

/// A connection that is counted until it is dropped.
pub(super) struct Connection<S = TcpStream> {
    stream: S,
    number: u64,
    all: Connections,
    /// Completes when the connection must close to make room.
    closed: oneshot::Receiver<()>,
    /// Write timeout, which runs while the peer accepts no data.
    waiting: Option<Pin<Box<Sleep>>>,
}

impl Connections {
    /// Registers a new connection; closes another one if a limit is reached.
    pub(super) fn admit<S>(&self, stream: S, peer: IpAddr) -> Connection<S> {
        let (close, closed) = oneshot::channel();
        let number = self.open().admit(peer, close);
        Connection {
            stream,
            number,
            all: self.clone(),
            closed,
            waiting: None,
        }
    }

    fn open(&self) -> MutexGuard<'_, Open> {
        // Each change under the lock is complete even after a panic.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Open {
    fn admit(&mut self, peer: IpAddr, close: oneshot::Sender<()>) -> u64 {
        let of_peer = |entry: &Entry| entry.peer == peer;
        if self.entries.values().filter(|entry| of_peer(entry)).count() >= MAX_OF_PEER {
            self.close_one(of_peer);
        } else if self.entries.len() >= MAX_CONNECTIONS {
            self.close_one(|_| true);
        }
        let number = self.next;
        self.next += 1;
        let entry = Entry {
            peer,
            answered: false,
            active: Instant::now(),
            _close: close,
        };
        self.entries.insert(number, entry);
        number
    }

    /// Closes the connection that was idle for longest among those that `meant` accepts.
    fn close_one(&mut self, meant: impl Fn(&Entry) -> bool) {
        let meant = self.entries.iter().filter(|(_, entry)| meant(entry));
        if let Some((&number, _)) = meant.min_by_key(|(_, entry)| (entry.answered, entry.active)) {
            // Dropping its sender closes it.
            self.entries.remove(&number);
        }
    }
}

impl<S> Connection<S> {
    fn was_active(&mut self, answered: bool) {
        if let Some(entry) = self.all.open().entries.get_mut(&self.number) {
            entry.answered |= answered;
            entry.active = Instant::now();
        }
    }

    /// Fails once the connection must make room.
    fn check(&mut self, context: &mut Context<'_>) -> io::Result<()> {
        match Pin::new(&mut self.closed).poll(context) {
            Poll::Pending => Ok(()),
            Poll::Ready(_) => Err(io::ErrorKind::ConnectionAborted.into()),
        }
    }

    /// Passes on the outcome of a write; fails if the peer accepted no data for too long.
    fn written(
        &mut self,
        outcome: Poll<io::Result<usize>>,
        context: &mut Context<'_>,
    ) -> Poll<io::Result<usize>> {
        if outcome.is_ready() {
            self.waiting = None;
            self.was_active(true);
            return outcome;
        }
        let waiting = self
            .waiting
            .get_or_insert_with(|| Box::pin(sleep(WRITE_TIMEOUT)));
        ready!(waiting.as_mut().poll(context));
        Poll::Ready(Err(io::ErrorKind::TimedOut.into()))
    }
}

impl<S> Drop for Connection<S> {
    fn drop(&mut self) {
        self.all.open().entries.remove(&self.number);
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Connection<S> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        self.check(context)?;
        let before = buffer.filled().len();
        ready!(Pin::new(&mut self.stream).poll_read(context, buffer))?;
        if buffer.filled().len() > before {
            self.was_active(false);
        }
        Poll::Ready(Ok(()))
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for Connection<S> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        self.check(context)?;
        let outcome = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.written(outcome, context)
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
    use tokio::io::{AsyncReadExt, AsyncWriteExt, DuplexStream, duplex};

    use super::*;

    /// Returns a connection from the peer 10.0.0.`peer`, and its other end.
    fn connect(all: &Connections, peer: u8) -> (Connection<DuplexStream>, DuplexStream) {
        let (ours, theirs) = duplex(16);
        (all.admit(ours, IpAddr::from([10, 0, 0, peer])), theirs)
    }

    fn paused<T>(work: impl Future<Output = T>) -> T {
        tokio::runtime::Builder::new_current_thread()
            .enable_time()
            .start_paused(true)
            .build()
            .unwrap()
            .block_on(work)
    }

    async fn is_closed(connection: &mut Connection<DuplexStream>) -> bool {
        let read = connection.read_u8();
        match tokio::time::timeout(Duration::from_millis(1), read).await {
            Ok(read) => read.unwrap_err().kind() == io::ErrorKind::ConnectionAborted,
            Err(_) => false,
        }
    }

    #[test]
    fn the_one_of_a_peer_that_was_silent_for_longest_makes_room() {
        paused(async {
            let all = Connections::default();
            let mut other = connect(&all, 2);
            let mut own = Vec::new();
            for _ in 0..MAX_OF_PEER {
                own.push(connect(&all, 1));
                tokio::time::advance(Duration::from_secs(1)).await;
            }
            // The oldest one sends a byte, so that the second one is now idle for longest.
            own[0].1.write_u8(7).await.unwrap();
            assert_eq!(own[0].0.read_u8().await.unwrap(), 7);
            own.push(connect(&all, 1));
            for (at, (connection, _)) in own.iter_mut().enumerate() {
                assert_eq!(is_closed(connection).await, at == 1, "{at}");
            }
            assert!(!is_closed(&mut other.0).await);
        });
    }

    #[test]
    fn many_peers_make_room_for_one_another() {
        paused(async {
            let all = Connections::default();
            let mut silent = connect(&all, 0);
            let mut others = Vec::new();
            for number in 1..MAX_CONNECTIONS {
                tokio::time::advance(Duration::from_secs(1)).await;
                others.push(connect(&all, (number % 4) as u8 + 1));
            }
            assert!(!is_closed(&mut silent.0).await);
            others.push(connect(&all, 9));
            assert!(is_closed(&mut silent.0).await);
            drop(others);
            let open = all.open().entries.len();
            assert_eq!(open, 0, "those that end are not counted");
        });
    }

    #[test]
    fn one_that_takes_nothing_is_closed() {
        paused(async {
            let all = Connections::default();
            let (mut connection, mut theirs) = connect(&all, 1);
            // More than fits the buffer, and the peer reads slowly.
            let send = async { connection.write_all(&[0; 64]).await };
            let take = async {
                for _ in 0..3 {
                    sleep(WRITE_TIMEOUT - Duration::from_secs(1)).await;
                    theirs.read_exact(&mut [0; 16]).await.unwrap();
                }
            };
            let (sent, ()) = tokio::join!(send, take);
            sent.unwrap();
            let error = connection.write_all(&[0; 64]).await.unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::TimedOut);
        });
    }
}
