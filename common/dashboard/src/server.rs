//! HTTP and WebSocket, on a thread of its own.
//!
//! | address | response |
//! |---|---|
//! | `GET /` | the page |
//! | `GET /api/v1/robots` | the robots' names |
//! | `GET /api/v1/robots/{robot}` | snapshot, the same as at the start of a stream |
//! | `GET /api/v1/robots/{robot}/map` | one byte per cell |
//! | `GET /api/v1/robots/{robot}/stream` | WebSocket: a snapshot, then each change |
//! | `PUT`, `DELETE /api/v1/robots/{robot}/region` | search region; needs the token |
//! | `POST /api/v1/robots/{robot}/save` | saves the last minutes; needs the token |

mod actions;
mod connections;
mod gate;
mod listening;
mod page;
mod phone;
mod reading;
mod refusal;
mod stream;

use std::net::SocketAddr;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::routing::{get, post, put};
use tokio::sync::{Semaphore, oneshot, watch};
use transport::{CONSOLE_ONLY, node};

use crate::token::Token;
use crate::webhook::Webhook;
use crate::{DashboardError, Options, Request, Robot, Robots};
use actions::plain;
use refusal::Refusal;

const MAX_BODY: usize = 64 * 1024;

const MAX_WATCHERS: usize = 64;

/// Longest time in which viewers are told that the server ends.
const FAREWELL: Duration = Duration::from_millis(500);

pub(crate) struct Site {
    robots: Robots,
    token: Token,
    /// Host names under which browsers may reach the page, in addition to addresses.
    hosts: Vec<String>,
    watchers: Arc<Semaphore>,
    /// Changes when the server ends.
    ended: watch::Sender<()>,
}

impl Site {
    /// Ends all streams, and waits until their viewers know or are too slow.
    async fn end(&self) {
        self.ended.send_replace(());
        let all = self.watchers.acquire_many(MAX_WATCHERS as u32);
        // A viewer that does not read finds out by itself.
        let _ = tokio::time::timeout(FAREWELL, all).await;
    }

    fn robot(&self, name: &str) -> Result<Arc<Robot>, Refusal> {
        let found = self.robots.get(name);
        found.ok_or_else(|| Refusal::unknown_robot(name, &self.robots.names()))
    }
}

fn router(site: Arc<Site>) -> Router {
    let robot = "/api/v1/robots/{robot}";
    Router::new()
        .route("/", get(page::index))
        .route("/{file}", get(page::file))
        .route("/api/v1/robots", get(reading::robots))
        .route(robot, get(reading::robot))
        .route(&format!("{robot}/map"), get(reading::map))
        .route(&format!("{robot}/stream"), get(stream::open))
        .route(
            &format!("{robot}/region"),
            put(actions::search_in).delete(plain(Request::Region(Vec::new()))),
        )
        .route(&format!("{robot}/save"), post(plain(Request::Save)))
        .route(&format!("{robot}/hint"), post(actions::hint))
        .route(
            &format!("{robot}/recording"),
            post(plain(Request::Record(true))).delete(plain(Request::Record(false))),
        )
        .route(
            &format!("{robot}/nodes/{{node}}/restart"),
            post(actions::restart),
        )
        .fallback(refusal::nothing_here)
        .layer(DefaultBodyLimit::max(MAX_BODY))
        .layer(axum::middleware::from_fn_with_state(
            Arc::clone(&site),
            gate::guard,
        ))
        .with_state(site)
}

/// The running server; dropping it stops the server.
#[derive(Debug)]
pub struct Server {
    address: SocketAddr,
    /// Random token, to be shown in the log; `None` if it was read from a file.
    token: Option<String>,
    /// First host name under which browsers may reach the page.
    host: Option<String>,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Server {
    /// Listens on the address or, if the port is taken, on the next free one, and starts the
    /// thread.
    /// Fails if it cannot listen or start a thread, or the token cannot be read.
    pub fn start(
        listen: SocketAddr,
        options: &Options,
        robots: Robots,
    ) -> Result<Self, DashboardError> {
        let token = match &options.token_file {
            Some(path) => Token::read(path)?,
            None => Token::random()?,
        };
        let shown = options
            .token_file
            .is_none()
            .then(|| token.reveal().to_owned());
        if let Some(server) = &options.webhook {
            robots.post_states_to(Webhook::start(server)?);
        }
        let listener = listening::bind(listen)?;
        let address = listener.local_addr().map_err(DashboardError::Server)?;
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .map_err(DashboardError::Server)?;
        let site = Arc::new(Site {
            robots,
            token,
            hosts: options.host.clone(),
            watchers: Arc::new(Semaphore::new(MAX_WATCHERS)),
            ended: watch::Sender::new(()),
        });
        let app = router(Arc::clone(&site));
        let (stop, stopped) = oneshot::channel();
        let listener = {
            let _inside = runtime.enter();
            listening::in_runtime(listener).map_err(DashboardError::Server)?
        };
        let work = move || {
            runtime.block_on(async {
                tokio::select! {
                    () = listening::serve(listener, app) => {}
                    _ = stopped => site.end().await,
                }
            });
            runtime.shutdown_background();
        };
        let thread = std::thread::Builder::new()
            .name("server".into())
            .spawn(work)
            .map_err(DashboardError::Server)?;
        Ok(Server {
            address,
            token: shown,
            host: options.host.first().cloned(),
            stop: Some(stop),
            thread: Some(thread),
        })
    }

    /// Logs the page's address, prefixed by `watch`, the link with the token, and warnings. `asked`
    /// is the address that the user chose.
    pub fn announce(&self, watch: &str, asked: SocketAddr) {
        let address = self.address;
        tracing::info!("{watch} on http://{address}");
        if let Some(token) = &self.token {
            let place = format!("http://{address}/#token={token}");
            tracing::info!(target: CONSOLE_ONLY, "to change something there: {place}");
        }
        if !address.ip().is_loopback() {
            tracing::warn!("whoever reaches {address} can read, and nothing is encrypted");
            self.announce_to_phones();
        }
        if asked.port() != 0 && address.port() != asked.port() {
            tracing::info!("port {} is taken", asked.port());
        }
    }

    /// Shows the page's link with the token as a QR code, on terminals only.
    fn announce_to_phones(&self) {
        if !node::logs_to_terminal() {
            return;
        }
        let Some(place) = phone::place(self.address, self.host.as_deref(), self.token.as_deref())
        else {
            tracing::info!("no route leads to other machines: --host names this one for phones");
            return;
        };
        match phone::code(&place) {
            Ok(code) => tracing::info!(target: CONSOLE_ONLY, "on a phone: {place}\n{code}"),
            Err(error) => tracing::warn!("no QR code holds the page's address: {error}"),
        }
    }

    /// Returns `Ok` while the server's thread runs.
    pub fn check(&self) -> Result<(), DashboardError> {
        if self.thread.as_ref().is_some_and(|t| !t.is_finished()) {
            return Ok(());
        }
        let ended = std::io::Error::other("its thread has ended");
        Err(DashboardError::Server(ended))
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            // A panic has been printed already.
            let _ = thread.join();
        }
    }
}
