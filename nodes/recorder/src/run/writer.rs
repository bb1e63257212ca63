//! Thread that compresses and writes.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use ros_graph::export::Entry;
use transport::with_causes;

use crate::writing::{BlackBox, Limits, Parts, Preamble, Room, Store, Tally};
use crate::{Config, Event, RecorderError};

/// Longest time before data is written to the file, well below the guaranteed second.
const FLUSH_PERIOD: Duration = Duration::from_millis(500);

const MEGABYTE: u64 = 1_000_000;

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Status {
    pub(super) tally: Tally,
    /// Reason why it cannot write now.
    pub(super) problem: Option<String>,
}

enum Command {
    Put(Entry),
    Save(String),
    Happened(Event),
}

/// Handle of the writer thread. The queue is bounded: when it is full, messages are dropped without
/// blocking.
pub(super) struct Writer {
    commands: Sender<Command>,
    thread: JoinHandle<Status>,
    status: Arc<Mutex<Status>>,
    queued_bytes: Arc<AtomicUsize>,
    capacity_bytes: usize,
    /// Number of messages that did not fit into the queue.
    dropped: u64,
}

impl Writer {
    pub(super) fn start(graph: &str, config: &Config) -> Result<Self, RecorderError> {
        let preamble = Preamble::new(config, graph)?;
        let output = config.output.clone();
        let store: Box<dyn Store> = match config.keep {
            None => Box::new(Parts::new(output, limits(config), preamble)?),
            Some(keep) => {
                let capacity = bytes(config.keep_size);
                let room = Room {
                    files: config.keep_files,
                    bytes: config.keep_disk.saturating_mul(MEGABYTE),
                };
                Box::new(BlackBox::new(output, keep, capacity, room, preamble))
            }
        };
        let (commands, waiting) = channel();
        let status = Arc::new(Mutex::default());
        let queued_bytes = Arc::new(AtomicUsize::new(0));
        let mut thread = WriterThread {
            store,
            waiting,
            queued_bytes: Arc::clone(&queued_bytes),
            status: Arc::clone(&status),
            problem: None,
            sync: config.sync.0,
        };
        let thread = std::thread::Builder::new()
            .name("writer".into())
            .spawn(move || thread.work())
            .map_err(RecorderError::Thread)?;
        Ok(Writer {
            commands,
            thread,
            status,
            queued_bytes,
            capacity_bytes: bytes(config.queue_size),
            dropped: 0,
        })
    }

    /// Queues an entry, or drops it if the queue is full.
    pub(super) fn put(&mut self, entry: Entry) -> Result<(), RecorderError> {
        let size = size(&entry);
        let queued = self.queued_bytes.fetch_add(size, Ordering::Relaxed);
        if queued + size > self.capacity_bytes && queued > 0 {
            self.queued_bytes.fetch_sub(size, Ordering::Relaxed);
            self.dropped += 1;
            return Ok(());
        }
        self.send(Command::Put(entry))
    }

    pub(super) fn save(&self, why: &str) -> Result<(), RecorderError> {
        self.send(Command::Save(why.to_owned()))
    }

    pub(super) fn happened(&self, event: Event) -> Result<(), RecorderError> {
        self.send(Command::Happened(event))
    }

    pub(super) fn status(&self) -> Status {
        let mut status = self
            .status
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        status.tally.dropped += self.dropped;
        status
    }

    /// Waits until everything is written.
    pub(super) fn finish(self) -> Result<Status, RecorderError> {
        drop(self.commands);
        let mut status = self.thread.join().map_err(|_| RecorderError::ThreadEnded)?;
        status.tally.dropped += self.dropped;
        Ok(status)
    }

    fn send(&self, command: Command) -> Result<(), RecorderError> {
        self.commands
            .send(command)
            .map_err(|_| RecorderError::ThreadEnded)
    }
}

struct WriterThread {
    store: Box<dyn Store>,
    waiting: Receiver<Command>,
    queued_bytes: Arc<AtomicUsize>,
    status: Arc<Mutex<Status>>,
    problem: Option<String>,
    /// Interval at which the file is synced to the disk; `None` for never.
    sync: Option<Duration>,
}

impl WriterThread {
    fn work(&mut self) -> Status {
        let mut flush_at = Instant::now() + FLUSH_PERIOD;
        let mut synced = Instant::now();
        loop {
            let patience = flush_at.saturating_duration_since(Instant::now());
            match self.waiting.recv_timeout(patience) {
                Ok(command) => self.obey(command),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break,
            }
            if Instant::now() >= flush_at {
                let mut flushed = self.store.flush();
                if flushed.is_ok() && self.sync.is_some_and(|every| synced.elapsed() >= every) {
                    flushed = self.store.sync();
                    synced = Instant::now();
                }
                self.note(flushed);
                flush_at = Instant::now() + FLUSH_PERIOD;
            }
        }
        let mut finished = self.store.finish();
        if finished.is_ok() && self.sync.is_some() {
            finished = self.store.sync();
        }
        self.note(finished);
        self.current()
    }

    fn obey(&mut self, command: Command) {
        match command {
            Command::Put(entry) => {
                let size = size(&entry);
                if let Err(error) = self.store.put(entry) {
                    self.problem = Some(with_causes(&error));
                }
                self.queued_bytes.fetch_sub(size, Ordering::Relaxed);
            }
            Command::Save(why) => {
                let saved = self.store.save(&why);
                self.note(saved);
            }
            Command::Happened(event) => {
                let saved = self.store.happened(&event.to_string());
                self.note(saved);
            }
        }
    }

    /// Publishes the status after an attempt to write.
    fn note(&mut self, outcome: Result<(), RecorderError>) {
        self.problem = outcome.err().map(|error| with_causes(&error));
        let current = self.current();
        *self.status.lock().unwrap_or_else(PoisonError::into_inner) = current;
    }

    fn current(&self) -> Status {
        Status {
            tally: self.store.tally(),
            problem: self.problem.clone(),
        }
    }
}

fn limits(config: &Config) -> Limits {
    Limits {
        split_bytes: config.split_size.map(|size| size.saturating_mul(MEGABYTE)),
        split_time: config.split_time,
        waiting_bytes: bytes(config.queue_size),
    }
}

fn bytes(megabytes: u64) -> usize {
    usize::try_from(megabytes.saturating_mul(MEGABYTE)).unwrap_or(usize::MAX)
}

fn size(entry: &Entry) -> usize {
    match entry {
        Entry::Message(message) => message.body.len(),
        Entry::Metadata(..) => 0,
    }
}
