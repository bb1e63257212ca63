//! The topics that are recorded.

use std::cell::RefCell;
use std::collections::BTreeMap;

use messages::{LogHeader, Topic, topic};
use transport::{GapCounter, Graph, Input, Subscriber, TransportError};

use super::Recorder;
use crate::RecorderError;

pub(super) struct Inputs {
    map: Counted<topic::Map>,
    odometry: Counted<topic::OdometryTopic>,
    truths: Counted<topic::GroundTruthTopic>,
    scans: Counted<topic::Scan>,
    votes: Counted<topic::Votes>,
    field: Option<Counted<topic::Field>>,
    hypotheses: Counted<topic::Hypotheses>,
    beams: Counted<topic::Beams>,
    health: Counted<topic::Health>,
    log: Subscriber<topic::Log>,
    /// By process, for each counts its own lines.
    log_gaps: RefCell<BTreeMap<u32, GapCounter>>,
    /// Only where there is something to save.
    saves: Option<Subscriber<topic::Save>>,
}

/// A subscriber that knows what it has missed.
struct Counted<T: Topic> {
    subscriber: Subscriber<T>,
    gaps: RefCell<GapCounter>,
}

impl<T: Topic> Counted<T> {
    fn open(graph: &Graph) -> Result<Self, TransportError> {
        Ok(Counted {
            subscriber: graph.subscriber()?,
            gaps: RefCell::default(),
        })
    }

    fn lost_before(&self, counter: u64) -> u64 {
        self.gaps.borrow_mut().lost_before(counter)
    }
}

impl Inputs {
    /// The field is subscribed to only where it is wanted, for it is computed
    /// only then.
    ///
    /// Wishes to save are heard where the last minutes are kept.
    pub(super) fn open(graph: &Graph, field: bool, keeps: bool) -> Result<Self, TransportError> {
        Ok(Inputs {
            map: Counted::open(graph)?,
            odometry: Counted::open(graph)?,
            truths: Counted::open(graph)?,
            scans: Counted::open(graph)?,
            votes: Counted::open(graph)?,
            field: field.then(|| Counted::open(graph)).transpose()?,
            hypotheses: Counted::open(graph)?,
            beams: Counted::open(graph)?,
            health: Counted::open(graph)?,
            log: graph.subscriber()?,
            log_gaps: RefCell::default(),
            saves: keeps.then(|| graph.subscriber()).transpose()?,
        })
    }

    pub(super) fn all(&self) -> Vec<&dyn Input> {
        let field = self
            .field
            .as_ref()
            .map(|field| -> &dyn Input { &field.subscriber });
        let others: [&dyn Input; 9] = [
            &self.map.subscriber,
            &self.odometry.subscriber,
            &self.truths.subscriber,
            &self.scans.subscriber,
            &self.votes.subscriber,
            &self.hypotheses.subscriber,
            &self.beams.subscriber,
            &self.health.subscriber,
            &self.log,
        ];
        let saves = self.saves.as_ref().map(|saves| -> &dyn Input { saves });
        others.into_iter().chain(field).chain(saves).collect()
    }

    /// Takes everything that has come, measurements before their answers.
    pub(super) fn take(&self, to: &mut Recorder) -> Result<(), RecorderError> {
        while let Some(map) = self.map.subscriber.receive()? {
            let outcome = to
                .entries
                .map(map.header(), map.items(), Recorder::now_ns());
            to.taken(0, outcome)?;
        }
        self.take_measurements(to)?;
        self.take_answers(to)?;
        while let Some(report) = self.health.subscriber.receive()? {
            let (header, error) = (report.header(), report.items());
            let outcome = to.entries.health(header, error, Recorder::now_ns());
            to.taken(0, outcome)?;
            let event = to.lookout.health(header);
            to.happened(event)?;
        }
        while let Some(line) = self.log.receive()? {
            let header = line.header();
            let lost = self.lines_lost_before(header);
            let outcome = to.entries.log(header, line.items());
            to.taken(lost, outcome)?;
        }
        // What it is about has come before.
        if let Some(saves) = &self.saves
            && saves.newest()?.is_some()
        {
            to.save("asked by the graph")?;
        }
        Ok(())
    }

    fn lines_lost_before(&self, line: &LogHeader) -> u64 {
        let mut gaps = self.log_gaps.borrow_mut();
        gaps.entry(line.pid).or_default().lost_before(line.counter)
    }

    fn take_measurements(&self, to: &mut Recorder) -> Result<(), RecorderError> {
        while let Some(sample) = self.odometry.subscriber.receive()? {
            let lost = self.odometry.lost_before(sample.header().stamp.counter);
            let outcome = to.entries.odometry(sample.header());
            to.taken(lost, outcome)?;
        }
        while let Some(sample) = self.truths.subscriber.receive()? {
            let lost = self.truths.lost_before(sample.header().stamp.counter);
            let outcome = to.entries.ground_truth(sample.header());
            to.taken(lost, outcome)?;
        }
        while let Some(sample) = self.scans.subscriber.receive()? {
            let lost = self.scans.lost_before(sample.header().stamp.counter);
            let outcome = to.entries.scan(sample.header(), sample.items());
            to.taken(lost, outcome)?;
        }
        Ok(())
    }

    /// Answers carry the stamps of their scans, so a gap among them may be a scan
    /// that was never answered, and is no loss of the recorder's. A recorder that
    /// is too slow for them is too slow for the scans as well, which are counted.
    fn take_answers(&self, to: &mut Recorder) -> Result<(), RecorderError> {
        while let Some(sample) = self.votes.subscriber.receive()? {
            let outcome = to.entries.votes(sample.header(), sample.items());
            to.taken(0, outcome)?;
        }
        // Images are left out by choice where they come too fast.
        while let Some(sample) = self
            .field
            .as_ref()
            .map_or(Ok(None), |f| f.subscriber.receive())?
        {
            let outcome = to.entries.field(sample.header(), sample.items());
            to.taken(0, outcome)?;
        }
        while let Some(sample) = self.hypotheses.subscriber.receive()? {
            let header = sample.header();
            let outcome = to.entries.hypotheses(header, sample.items());
            to.taken(0, outcome)?;
            let event = to.lookout.verdict(header.verdict);
            to.happened(event)?;
        }
        while let Some(sample) = self.beams.subscriber.receive()? {
            let outcome = to.entries.beams(sample.header(), sample.items());
            to.taken(0, outcome)?;
        }
        Ok(())
    }
}
