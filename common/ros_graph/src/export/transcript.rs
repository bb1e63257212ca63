//! Entries made from the graph, with counts of lost samples.

use transport::{Graph, Health, TransportError, with_causes};

use crate::export::{Entries, Options, TranscriptError};

/// Converts received samples to entries, and reports its health to the graph.
#[derive(Debug)]
pub struct Transcript {
    pub entries: Entries,
    pub health: Health,
    dropped: u64,
    refused: u64,
    last_refusal: String,
}

impl Transcript {
    pub fn new(graph: &Graph, options: &Options) -> Result<Self, TransportError> {
        Ok(Transcript {
            entries: Entries::new(options),
            health: graph.health()?,
            dropped: 0,
            refused: 0,
            last_refusal: String::new(),
        })
    }

    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    pub fn refused(&self) -> u64 {
        self.refused
    }

    pub fn count_dropped(&mut self, samples: u64) {
        self.dropped += samples;
        self.health.count_dropped(samples);
    }

    /// Counts a received sample, and `lost` samples before it; logs an error that differs from the
    /// last one.
    pub fn taken(
        &mut self,
        lost: u64,
        outcome: Result<(), TranscriptError>,
    ) -> Result<(), TransportError> {
        self.health.count_received(1);
        if lost > 0 {
            tracing::warn!("{lost} samples were lost: they arrived faster than they were read");
            self.count_dropped(lost);
        }
        let Err(error) = outcome else {
            return Ok(());
        };
        self.refused += 1;
        self.health.count_refused(1);
        let problem = with_causes(&error);
        if problem != self.last_refusal {
            tracing::warn!("{problem}");
            self.health.error(&problem)?;
            self.last_refusal = problem;
        }
        Ok(())
    }
}
