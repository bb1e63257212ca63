//! Subscribers for a transcript.

use std::cell::RefCell;
use std::collections::BTreeMap;

use messages::{HealthHeader, LogHeader, ScanHeader, Topic, topic};
use transport::{GapCounter, Graph, Input, Subscriber, TransportError, monotonic_ns};

use crate::Transcript;

/// Receiver of a transcript.
pub trait Listener {
    type Error: From<TransportError>;

    /// Transcript that the samples are added to.
    fn transcript(&mut self) -> &mut Transcript;

    /// Called for each health report of a node.
    ///
    /// # Errors
    /// Any error ends [`Inputs::take`].
    fn reported(&mut self, _report: &HealthHeader) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Called for each verdict on a scan, by its number.
    ///
    /// # Errors
    /// Any error ends [`Inputs::take`].
    fn judged(&mut self, _verdict: u32) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Called for each state of the tracker at a scan, by its number.
    ///
    /// # Errors
    /// Any error ends [`Inputs::take`].
    fn tracked(&mut self, _state: u32) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// Subscribers of all topics of a transcript.
pub struct Inputs {
    map: Counted<topic::Map>,
    odometry: Counted<topic::OdometryTopic>,
    truths: Counted<topic::GroundTruthTopic>,
    scans: Subscriber<topic::Scan>,
    /// By laser, because each laser counts its own scans.
    scan_gaps: RefCell<BTreeMap<String, GapCounter>>,
    votes: Counted<topic::Votes>,
    field: Option<Counted<topic::Field>>,
    hypotheses: Counted<topic::Hypotheses>,
    particles: Counted<topic::Particles>,
    poses: Counted<topic::Tracked>,
    beams: Counted<topic::Beams>,
    health: Counted<topic::Health>,
    log: Subscriber<topic::Log>,
    /// By process, because each process counts its own lines.
    log_gaps: RefCell<BTreeMap<u32, GapCounter>>,
}

/// A subscriber that counts missed samples.
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
    /// Subscribes to all topics; to the intensity image only if `field` is set, because it is only
    /// computed for subscribers.
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

    /// Inputs for the event loop.
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

    /// Receives all pending samples, measurements before the answers to them.
    ///
    /// # Errors
    /// If the graph or the listener fails.
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

    /// Answers carry the stamps of their scans, so a gap in their counters may be an unanswered
    /// scan; it is not counted as a loss. A listener that is too slow for answers is also too slow
    /// for scans, which are counted.
    fn take_answers<L: Listener>(&self, to: &mut L) -> Result<(), L::Error> {
        while let Some(sample) = self.votes.subscriber.receive()? {
            let outcome = to
                .transcript()
                .entries
                .votes(sample.header(), sample.items());
            to.transcript().taken(0, outcome)?;
        }
        // Images that come too fast are skipped on purpose.
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
