//! The thread on which viewers are served.
//!
//! The library announces a channel to viewers before it records that they know it
//! (foxglove 0.30.3, `ConnectedClient::advertise_channels`), so that a viewer who asks for
//! the channel in between is refused: "Unknown channel ID". Viewers are therefore served
//! by one thread, and channels are opened on that thread, too: what a viewer says is read
//! before or after, and never meanwhile.

use std::sync::mpsc;

use tokio::runtime::{Builder, Handle, Runtime};

/// The thread, which ends when this is dropped.
#[derive(Debug)]
pub(crate) struct Serving(Runtime);

impl Serving {
    /// # Errors
    /// There can be no thread.
    pub(crate) fn start() -> std::io::Result<Self> {
        let mut one_thread = Builder::new_multi_thread();
        one_thread.worker_threads(1).thread_name("viewers");
        one_thread.enable_all().build().map(Serving)
    }

    /// For the server.
    pub(crate) fn handle(&self) -> &Handle {
        self.0.handle()
    }

    /// Does this on the thread, while it does nothing else; none if it panics.
    pub(crate) fn between<R: Send + 'static>(
        &self,
        work: impl FnOnce() -> R + Send + 'static,
    ) -> Option<R> {
        let (done, outcome) = mpsc::sync_channel(1);
        self.0.spawn(async move { done.send(work()) });
        outcome.recv().ok()
    }
}

#[cfg(test)]
mod tests {
    use std::thread::current;

    use super::*;

    #[test]
    fn work_is_done_where_viewers_are_served_and_nowhere_else() {
        let serving = Serving::start().unwrap();
        let here = current().id();
        let viewers: Vec<_> = (0..50)
            .map(|_| serving.handle().spawn(async { current().id() }))
            .collect();
        let there = serving.between(|| current().id()).unwrap();
        assert_ne!(there, here);
        for viewer in viewers {
            assert_eq!(serving.handle().block_on(viewer).unwrap(), there);
        }
    }
}
