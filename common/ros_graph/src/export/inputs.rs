//! Subscribers for a transcript.

use std::cell::RefCell;
use std::collections::BTreeMap;

use messages::{GroundTruth, HealthHeader, LogHeader, Odometry, ScanHeader, Topic, topic};
use transport::{GapCounter, Graph, Input, Subscriber, TransportError, monotonic_ns};

use crate::export::{Entries, Transcript, TranscriptError};

pub trait Listener {
    type Error: From<TransportError>;

    /// Transcript that the samples are added to.
    fn transcript(&mut self) -> &mut Transcript;

    /// Called for each health report of a node.
    fn reported(&mut self, _report: &HealthHeader) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Called for each verdict on a scan, by its number.
    fn judged(&mut self, _verdict: u32) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Called for each state of the tracker at a scan, by its number.
    fn tracked(&mut self, _state: u32) -> Result<(), Self::Error> {
        Ok(())
    }
}

pub struct Inputs {
    map: Subscriber<topic::Map>,
    odometry: Subscriber<topic::OdometryTopic>,
    truths: Subscriber<topic::GroundTruthTopic>,
    scans: Subscriber<topic::Scan>,
    votes: Subscriber<topic::Votes>,
    field: Option<Subscriber<topic::Field>>,
    hypotheses: Subscriber<topic::Hypotheses>,
    particles: Subscriber<topic::Particles>,
    poses: Subscriber<topic::Tracked>,
    beams: Subscriber<topic::Beams>,
    health: Subscriber<topic::Health>,
    log: Subscriber<topic::Log>,
    /// By who counts: each laser counts its own scans, and each process its own lines.
    gaps: RefCell<BTreeMap<String, GapCounter>>,
}

impl Inputs {
    /// Subscribes to all topics; to the intensity image only if `field` is set, because it is only
    /// computed for subscribers.
    pub fn open(graph: &Graph, field: bool) -> Result<Self, TransportError> {
        Ok(Inputs {
            map: graph.subscriber()?,
            odometry: graph.subscriber()?,
            truths: graph.subscriber()?,
            scans: graph.subscriber()?,
            votes: graph.subscriber()?,
            field: field.then(|| graph.subscriber()).transpose()?,
            hypotheses: graph.subscriber()?,
            particles: graph.subscriber()?,
            poses: graph.subscriber()?,
            beams: graph.subscriber()?,
            health: graph.subscriber()?,
            log: graph.subscriber()?,
            gaps: RefCell::default(),
        })
    }

    pub fn all(&self) -> Vec<&dyn Input> {
        let field = self.field.as_ref().map(|field| -> &dyn Input { field });
        let others: [&dyn Input; 11] = [
            &self.map,
            &self.odometry,
            &self.truths,
            &self.scans,
            &self.votes,
            &self.hypotheses,
            &self.particles,
            &self.poses,
            &self.beams,
            &self.health,
            &self.log,
        ];
        others.into_iter().chain(field).collect()
    }

    /// Receives all pending samples, measurements before the answers to them.
    pub fn take<L: Listener>(&self, to: &mut L) -> Result<(), L::Error> {
        take_each(&self.map, to, no_loss, |entries, map, cells| {
            entries.map(map, cells, monotonic_ns())
        })?;
        self.take_measurements(to)?;
        self.take_answers(to)?;
        while let Some(report) = self.health.receive()? {
            let (header, error) = (report.header(), report.items());
            let entries = &mut to.transcript().entries;
            let outcome = entries.health(header, error, monotonic_ns());
            to.transcript().taken(0, outcome)?;
            to.reported(header)?;
        }
        let lost = |line: &LogHeader| self.lost(format!("log {}", line.pid), line.counter);
        take_each(&self.log, to, lost, Entries::log)
    }

    fn lost(&self, by: String, counter: u64) -> u64 {
        let mut gaps = self.gaps.borrow_mut();
        gaps.entry(by).or_default().lost_before(counter)
    }

    fn take_measurements<L: Listener>(&self, to: &mut L) -> Result<(), L::Error> {
        let lost = |odometry: &Odometry| self.lost("odometry".into(), odometry.stamp.counter);
        take_each(&self.odometry, to, lost, |entries, odometry, _| {
            entries.odometry(odometry)
        })?;
        let lost = |truth: &GroundTruth| self.lost("truth".into(), truth.stamp.counter);
        take_each(&self.truths, to, lost, |entries, truth, _| {
            entries.ground_truth(truth)
        })?;
        let lost =
            |scan: &ScanHeader| self.lost(format!("scan {}", scan.laser), scan.stamp.counter);
        take_each(&self.scans, to, lost, Entries::scan)
    }

    /// Answers carry the stamps of their scans, so a gap in their counters may be an unanswered
    /// scan; it is not counted as a loss. A listener that is too slow for answers is also too slow
    /// for scans, which are counted.
    fn take_answers<L: Listener>(&self, to: &mut L) -> Result<(), L::Error> {
        take_each(&self.votes, to, no_loss, Entries::votes)?;
        // Images that come too fast are skipped on purpose.
        if let Some(field) = &self.field {
            take_each(field, to, no_loss, Entries::field)?;
        }
        if self.poses.has_publishers() {
            to.transcript().entries.expect_tracker();
        }
        while let Some(sample) = self.hypotheses.receive()? {
            let header = sample.header();
            let outcome = to.transcript().entries.hypotheses(header, sample.items());
            to.transcript().taken(0, outcome)?;
            to.judged(header.verdict)?;
        }
        take_each(&self.particles, to, no_loss, Entries::particles)?;
        while let Some(sample) = self.poses.receive()? {
            let header = sample.header();
            let outcome = to.transcript().entries.tracked(header, sample.items());
            to.transcript().taken(0, outcome)?;
            to.tracked(header.state)?;
        }
        take_each(&self.beams, to, no_loss, Entries::beams)
    }
}

/// Adds all pending samples of a topic to the transcript, and the number that was lost before each.
fn take_each<T: Topic, L: Listener>(
    from: &Subscriber<T>,
    to: &mut L,
    lost_before: impl Fn(&T::Header) -> u64,
    add: impl Fn(&mut Entries, &T::Header, &[T::Item]) -> Result<(), TranscriptError>,
) -> Result<(), L::Error> {
    while let Some(sample) = from.receive()? {
        let header = sample.header();
        let outcome = add(&mut to.transcript().entries, header, sample.items());
        to.transcript().taken(lost_before(header), outcome)?;
    }
    Ok(())
}

/// Number of lost samples of a topic whose gaps are not losses.
fn no_loss<H>(_: &H) -> u64 {
    0
}
