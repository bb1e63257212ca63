//! What is made of the graph, and what was lost of it.

use transport::{Graph, Health, TransportError, with_causes};

use crate::{Entries, Options, TranscriptError};

/// Makes entries of received messages, and reports its health to the graph.
#[derive(Debug)]
pub struct Transcript {
    /// What was made.
    pub entries: Entries,
    /// Its health reports.
    pub health: Health,
    dropped: u64,
    refused: u64,
    last_refusal: String,
}

impl Transcript {
    /// Of nothing yet.
    ///
    /// # Errors
    /// If the graph fails.
    pub fn new(graph: &Graph, options: &Options) -> Result<Self, TransportError> {
        Ok(Transcript {
            entries: Entries::new(options),
            health: graph.health()?,
            dropped: 0,
            refused: 0,
            last_refusal: String::new(),
        })
    }

    /// Samples that were lost until now.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Samples that could not be used until now.
    #[must_use]
    pub fn refused(&self) -> u64 {
        self.refused
    }

    /// Counts samples that were lost.
    pub fn count_dropped(&mut self, samples: u64) {
        self.dropped += samples;
        self.health.count_dropped(samples);
    }

    /// A sample came, after others that were lost; it could be used, or not, which is
    /// said once for each reason.
    ///
    /// # Errors
    /// If the graph fails.
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
