//! The topics of a transcript.

use std::cell::RefCell;
use std::collections::BTreeMap;

use messages::{HealthHeader, LogHeader, ScanHeader, Topic, topic};
use transport::{GapCounter, Graph, Input, Subscriber, TransportError, monotonic_ns};

use crate::Transcript;

/// Who makes a transcript.
pub trait Listener {
    /// What keeps it from going on.
    type Error: From<TransportError>;

    /// Where it is made.
    fn transcript(&mut self) -> &mut Transcript;

    /// A node's report came.
    ///
    /// # Errors
    /// What keeps it from going on.
    fn reported(&mut self, _report: &HealthHeader) -> Result<(), Self::Error> {
        Ok(())
    }

    /// The verdict on a scan came, by its number.
    ///
    /// # Errors
    /// What keeps it from going on.
    fn judged(&mut self, _verdict: u32) -> Result<(), Self::Error> {
        Ok(())
    }

    /// The tracker's state at a scan came, by its number.
    ///
    /// # Errors
    /// What keeps it from going on.
    fn tracked(&mut self, _state: u32) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// The ends of all topics that have a place in it.
pub struct Inputs {
    map: Counted<topic::Map>,
    odometry: Counted<topic::OdometryTopic>,
    truths: Counted<topic::GroundTruthTopic>,
    scans: Subscriber<topic::Scan>,
    /// By laser, for each counts its own scans.
    scan_gaps: RefCell<BTreeMap<String, GapCounter>>,
    votes: Counted<topic::Votes>,
    field: Option<Counted<topic::Field>>,
    hypotheses: Counted<topic::Hypotheses>,
    particles: Counted<topic::Particles>,
    poses: Counted<topic::Tracked>,
    beams: Counted<topic::Beams>,
    health: Counted<topic::Health>,
    log: Subscriber<topic::Log>,
    /// By process, for each counts its own lines.
    log_gaps: RefCell<BTreeMap<u32, GapCounter>>,
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
    /// Subscribes. To the intensity image only where it is wanted, for it is computed
    /// only then.
    ///
    /// # Errors
    /// If the graph fails.
    pub fn open(graph: &Graph, field: bool) -> Result<Self, TransportError> {
        Ok(Inputs {
            map: Counted::open(graph)?,
            odometry: Counted::open(graph)?,
            truths: Counted::open(graph)?,
            scans: graph.subscriber()?,
            scan_gaps: RefCell::default(),
            votes: Counted::open(graph)?,
            field: field.then(|| Counted::open(graph)).transpose()?,
            hypotheses: Counted::open(graph)?,
            particles: Counted::open(graph)?,
            poses: Counted::open(graph)?,
            beams: Counted::open(graph)?,
            health: Counted::open(graph)?,
            log: graph.subscriber()?,
            log_gaps: RefCell::default(),
        })
    }

    /// What the event loop waits for.
    #[must_use]
    pub fn all(&self) -> Vec<&dyn Input> {
        let field = self
            .field
            .as_ref()
            .map(|field| -> &dyn Input { &field.subscriber });
        let others: [&dyn Input; 11] = [
            &self.map.subscriber,
            &self.odometry.subscriber,
            &self.truths.subscriber,
            &self.scans,
            &self.votes.subscriber,
            &self.hypotheses.subscriber,
            &self.particles.subscriber,
            &self.poses.subscriber,
            &self.beams.subscriber,
            &self.health.subscriber,
            &self.log,
        ];
        others.into_iter().chain(field).collect()
    }

    /// Takes everything that has come, measurements before their answers.
    ///
    /// # Errors
    /// If the graph fails, or the listener does.
    pub fn take<L: Listener>(&self, to: &mut L) -> Result<(), L::Error> {
        while let Some(map) = self.map.subscriber.receive()? {
            let outcome = to
                .transcript()
                .entries
                .map(map.header(), map.items(), monotonic_ns());
            to.transcript().taken(0, outcome)?;
        }
        self.take_measurements(to)?;
        self.take_answers(to)?;
        while let Some(report) = self.health.subscriber.receive()? {
            let (header, error) = (report.header(), report.items());
            let outcome = to
                .transcript()
                .entries
                .health(header, error, monotonic_ns());
            to.transcript().taken(0, outcome)?;
            to.reported(header)?;
        }
        while let Some(line) = self.log.receive()? {
            let header = line.header();
            let lost = self.lines_lost_before(header);
            let outcome = to.transcript().entries.log(header, line.items());
            to.transcript().taken(lost, outcome)?;
        }
        Ok(())
    }

    fn scans_lost_before(&self, scan: &ScanHeader) -> u64 {
        let mut gaps = self.scan_gaps.borrow_mut();
        let gaps = gaps.entry(scan.laser.to_string()).or_default();
        gaps.lost_before(scan.stamp.counter)
    }

    fn lines_lost_before(&self, line: &LogHeader) -> u64 {
        let mut gaps = self.log_gaps.borrow_mut();
        gaps.entry(line.pid).or_default().lost_before(line.counter)
    }

    fn take_measurements<L: Listener>(&self, to: &mut L) -> Result<(), L::Error> {
        while let Some(sample) = self.odometry.subscriber.receive()? {
            let lost = self.odometry.lost_before(sample.header().stamp.counter);
            let outcome = to.transcript().entries.odometry(sample.header());
            to.transcript().taken(lost, outcome)?;
        }
        while let Some(sample) = self.truths.subscriber.receive()? {
            let lost = self.truths.lost_before(sample.header().stamp.counter);
            let outcome = to.transcript().entries.ground_truth(sample.header());
            to.transcript().taken(lost, outcome)?;
        }
        while let Some(sample) = self.scans.receive()? {
            let header = sample.header();
            let lost = self.scans_lost_before(header);
            let outcome = to.transcript().entries.scan(header, sample.items());
            to.transcript().taken(lost, outcome)?;
        }
        Ok(())
    }

    /// Answers carry the stamps of their scans, so a gap among them may be a scan
    /// that was never answered, and is no loss here. A listener that
    /// is too slow for them is too slow for the scans as well, which are counted.
    fn take_answers<L: Listener>(&self, to: &mut L) -> Result<(), L::Error> {
        while let Some(sample) = self.votes.subscriber.receive()? {
            let outcome = to
                .transcript()
                .entries
                .votes(sample.header(), sample.items());
            to.transcript().taken(0, outcome)?;
        }
        // Images are left out by choice where they come too fast.
        while let Some(sample) = self
            .field
            .as_ref()
            .map_or(Ok(None), |f| f.subscriber.receive())?
        {
            let outcome = to
                .transcript()
                .entries
                .field(sample.header(), sample.items());
            to.transcript().taken(0, outcome)?;
        }
        if self.poses.subscriber.has_publishers() {
            to.transcript().entries.expect_tracker();
        }
        while let Some(sample) = self.hypotheses.subscriber.receive()? {
            let header = sample.header();
            let outcome = to.transcript().entries.hypotheses(header, sample.items());
            to.transcript().taken(0, outcome)?;
            to.judged(header.verdict)?;
        }
        while let Some(sample) = self.particles.subscriber.receive()? {
            let outcome = to
                .transcript()
                .entries
                .particles(sample.header(), sample.items());
            to.transcript().taken(0, outcome)?;
        }
        while let Some(sample) = self.poses.subscriber.receive()? {
            let header = sample.header();
            let entries = &mut to.transcript().entries;
            let outcome = entries.tracked(header, sample.items());
            to.transcript().taken(0, outcome)?;
            to.tracked(header.state)?;
        }
        while let Some(sample) = self.beams.subscriber.receive()? {
            let outcome = to
                .transcript()
                .entries
                .beams(sample.header(), sample.items());
            to.transcript().taken(0, outcome)?;
        }
        Ok(())
    }
}
