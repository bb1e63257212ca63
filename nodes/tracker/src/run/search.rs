//! Requests searches and waits for their results.

use std::time::Instant;

use messages::{ScanHeader, Stamp};
use transport::{Peers, TransportError};

use super::inputs::Inputs;
use super::outputs::Outputs;
use super::turn::{SEARCH_WAIT, Since, Turn};
use super::{Node, TrackerError};

/// Processes that take part in a search, which ends with any of them.
#[derive(Debug, Default)]
pub(super) struct Searchers {
    asked: Peers,
    answering: Peers,
}

impl Searchers {
    fn now(inputs: &Inputs, outputs: &Outputs) -> Self {
        Searchers {
            asked: outputs.asked(),
            answering: inputs.hypotheses.publishers(),
        }
    }

    fn any_new_since(&self, before: &Searchers) -> bool {
        self.asked.any_new_since(&before.asked) || self.answering.any_new_since(&before.answering)
    }
}

impl Node {
    pub(super) fn ask(&mut self, inputs: &Inputs, stamp: Stamp) -> Result<(), TransportError> {
        // A process that starts later and misses the request is then detected as new.
        self.searchers = Searchers::now(inputs, &self.outputs);
        self.outputs.ask(stamp)
    }

    /// Continues with a scan once scan `of` is searched, or will not be; true if it did.
    pub(super) fn wait_for_search(
        &mut self,
        inputs: &Inputs,
        scan: &ScanHeader,
        (of, since): (Stamp, Since),
    ) -> Result<bool, TrackerError> {
        let has_come = self.answers.of(of).is_some();
        if !has_come && Searchers::now(inputs, &self.outputs).any_new_since(&self.searchers) {
            // The answer may be that the scan is no longer known: that counts as no search, and the
            // next key scan is searched.
            self.ask(inputs, of)?;
            self.is_silent = false;
            let since = Since::now(self.looks);
            let scan = *scan;
            self.turn = Turn::Search { scan, of, since };
            return Ok(false);
        }
        // Scans are searched in order, even by a searcher that searches all of them.
        let is_lost = self.answers.any_after(of);
        let is_over = is_lost || self.is_silent || since.is_over(SEARCH_WAIT, self.looks);
        if !has_come && !is_over {
            return Ok(false);
        }
        if !has_come {
            self.is_silent |= !is_lost;
            self.refuse(&format!("no hypotheses received for scan {}", of.counter))?;
        }
        self.finish(inputs, scan, has_come.then_some(of), Instant::now())?;
        Ok(true)
    }
}
