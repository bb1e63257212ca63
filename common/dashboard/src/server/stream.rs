//! A WebSocket: first a snapshot, then each change.
//!
//! The reader may open the intensity field, and send its clock, which is sent back. A reader that
//! stops reading is disconnected; a slow one loses messages, is told how many and gets a new
//! snapshot.

use std::sync::Arc;
use std::time::Duration;

use axum::body::Bytes;
use axum::extract::ws::{CloseFrame, Message as Frame, Utf8Bytes, WebSocket, WebSocketUpgrade};
use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::response::Response;
use serde::Deserialize;
use tokio::sync::broadcast::error::RecvError;
use tokio::sync::{OwnedSemaphorePermit, watch};

use super::{Refusal, Site};
use crate::robot::{FieldView, Robot, Watching, text};
use crate::view::Message;

/// Largest message from a reader, in bytes.
const MAX_MESSAGE: usize = 1024;

/// Longest time for sending one message to a reader.
const TIMEOUT: Duration = Duration::from_secs(10);

/// Close code for a message that is not understood (RFC 6455, section 7.4.1).
const POLICY_VIOLATION: u16 = 1008;

/// Close code of a server that ends (RFC 6455, section 7.4.1).
const GOING_AWAY: u16 = 1001;

#[derive(Debug, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
enum Said {
    Field {
        on: bool,
    },
    /// Time stamp to be sent back.
    Ping {
        t: f64,
    },
}

pub(super) async fn open(
    State(site): State<Arc<Site>>,
    Path(name): Path<String>,
    upgrade: WebSocketUpgrade,
) -> Result<Response, Refusal> {
    let robot = site.robot(&name)?;
    let permit = Arc::clone(&site.watchers).try_acquire_owned();
    let permit = permit.map_err(|_| {
        let problem = "the maximum number of viewers is connected";
        Refusal::new(StatusCode::SERVICE_UNAVAILABLE, problem)
    })?;
    Ok(upgrade
        .max_message_size(MAX_MESSAGE)
        .max_frame_size(MAX_MESSAGE)
        .on_upgrade(move |socket| serve(socket, robot, site.ended.subscribe(), permit)))
}

async fn serve(
    socket: WebSocket,
    robot: Arc<Robot>,
    ended: watch::Receiver<()>,
    _permit: OwnedSemaphorePermit,
) {
    let Watching { snapshot, news } = robot.watch(transport::monotonic_ns());
    let mut reader = Reader {
        socket,
        robot,
        field: None,
        ended,
    };
    // On failure the reader is gone.
    if reader.send(Frame::Text(snapshot)).await.is_some() {
        reader.follow(news).await;
    }
}

struct Reader {
    socket: WebSocket,
    robot: Arc<Robot>,
    field: Option<FieldView>,
    /// Changes when the server ends.
    ended: watch::Receiver<()>,
}

impl Reader {
    /// Passes on messages until the reader disconnects.
    async fn follow(
        &mut self,
        mut news: tokio::sync::broadcast::Receiver<Utf8Bytes>,
    ) -> Option<()> {
        loop {
            tokio::select! {
                message = news.recv() => match message {
                    Ok(text) => self.send(Frame::Text(text)).await?,
                    Err(RecvError::Lagged(messages)) => {
                        self.send(Frame::Text(text(&Message::Missed { messages }))).await?;
                        let Watching { snapshot, news: next } = self.robot.watch(transport::monotonic_ns());
                        news = next;
                        self.send(Frame::Text(snapshot)).await?;
                    }
                    Err(RecvError::Closed) => return None,
                },
                image = next_image(&mut self.field) => {
                    self.send(Frame::Binary(image?)).await?;
                }
                _ = self.ended.changed() => return self.close(GOING_AWAY, "the graph was stopped").await,
                said = self.socket.recv() => self.receive(said?.ok()?).await?,
            }
        }
    }

    async fn receive(&mut self, frame: Frame) -> Option<()> {
        let Frame::Text(said) = frame else {
            // The library answers pings; the end of the stream arrives as `None`.
            return matches!(frame, Frame::Ping(_) | Frame::Pong(_)).then_some(());
        };
        match serde_json::from_str(&said) {
            Ok(Said::Ping { t }) => self.send(Frame::Text(text(&Message::Pong { t }))).await,
            Ok(Said::Field { on }) => {
                self.field = on.then(|| self.robot.view_field());
                Some(())
            }
            Err(error) => {
                let mut reason = error.to_string();
                // The reason of a close frame holds 123 bytes at most.
                reason.truncate(reason.floor_char_boundary(120));
                self.close(POLICY_VIOLATION, &reason).await
            }
        }
    }

    /// Closes the stream, and returns `None`.
    async fn close(&mut self, code: u16, reason: &str) -> Option<()> {
        let reason = reason.into();
        self.send(Frame::Close(Some(CloseFrame { code, reason })))
            .await?;
        None
    }

    async fn send(&mut self, frame: Frame) -> Option<()> {
        let sent = tokio::time::timeout(TIMEOUT, self.socket.send(frame)).await;
        sent.ok()?.ok()
    }
}

/// Waits for an image; forever if the field is not open.
async fn next_image(field: &mut Option<FieldView>) -> Option<Bytes> {
    let Some(view) = field else {
        return std::future::pending().await;
    };
    loop {
        view.images.changed().await.ok()?;
        let image = view.images.borrow_and_update().clone();
        if image.is_some() {
            return image;
        }
    }
}
