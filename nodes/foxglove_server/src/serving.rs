//! Thread that serves the viewers.
//!
//! The library advertises a channel to viewers before it records that they know it (foxglove
//! 0.30.3, `ConnectedClient::advertise_channels`), so that a viewer who subscribes in between gets
//! the error "Unknown channel ID". Therefore a single thread serves the viewers, and channels are
//! opened on the same thread: requests of viewers are read before or after that, never meanwhile.

use std::sync::mpsc;

use tokio::runtime::{Builder, Handle, Runtime};

/// Runtime with the thread, which ends when this is dropped.
#[derive(Debug)]
pub(crate) struct Serving(Runtime);

impl Serving {
    pub(crate) fn start() -> std::io::Result<Self> {
        let mut one_thread = Builder::new_multi_thread();
        one_thread.worker_threads(1).thread_name("viewers");
        one_thread.enable_all().build().map(Serving)
    }

    pub(crate) fn handle(&self) -> &Handle {
        self.0.handle()
    }

    /// Runs `work` on the thread, between other tasks; returns `None` if it panics.
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
