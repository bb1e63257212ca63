//! Receives votes and publishes hypotheses.

use std::time::{Duration, Instant};

use engine::beams::BeamConfig;
use engine::settings::fit_id;
use messages::{MapSet, NodeState, SearchOutcome, VotesHeader, topic};
use transport::{
    Flow, GapCounter, Graph, Health, Publisher, Sample, Subscriber, TransportError, monotonic_ns,
    with_causes,
};

use crate::answer::{Answer, Workspace, answer, nothing};
use crate::maps::Maps;
use crate::scans::Scans;
use crate::{Config, PeakError, particles};

/// Longest delay of a health report.
const TICK: Duration = Duration::from_millis(100);

pub fn run(graph: &Graph, config: &Config) -> Result<(), PeakError> {
    let votes = graph.subscriber::<topic::Votes>()?;
    let scans = graph.subscriber::<topic::Scan>()?;
    let readings = graph.subscriber::<topic::Readings>()?;
    let by_map = graph.subscriber::<topic::VotesByMap>()?;
    let maps = graph.subscriber::<topic::Map>()?;
    let sets = graph.subscriber::<topic::Maps>()?;
    let mut node = Node {
        config: config.clone(),
        maps: Maps::default(),
        scans: Scans::default(),
        workspace: Workspace::default(),
        gaps: GapCounter::default(),
        newest_kept: None,
        last_refusal: String::new(),
        hypotheses: graph.publisher_for(config.peaks.max_hypotheses as usize)?,
        // Enough for the default number of beams; the publisher grows for more.
        beams: graph.publisher_for(BeamConfig::default().max_beams as usize)?,
        particles: match config.particles.particles {
            Some(count) => Some((graph.publisher_for(count as usize)?, count)),
            None => None,
        },
        health: graph.health()?,
    };
    graph.run(
        &[&votes, &scans, &readings, &by_map, &maps, &sets],
        TICK,
        |_| {
            node.step(&votes, (&scans, &readings, &by_map), (&maps, &sets))?;
            Ok(Flow::Continue)
        },
    )
}

struct Node {
    config: Config,
    maps: Maps,
    scans: Scans,
    workspace: Workspace,
    gaps: GapCounter,
    /// Counter of the newest scan that is searched only on request.
    newest_kept: Option<u64>,
    last_refusal: String,
    hypotheses: Publisher<topic::Hypotheses>,
    beams: Publisher<topic::Beams>,
    /// Publisher and number of particles, if requested.
    particles: Option<(Publisher<topic::Particles>, u32)>,
    health: Health,
}

impl Node {
    fn step(
        &mut self,
        votes: &Subscriber<topic::Votes>,
        (scans, readings, by_map): (
            &Subscriber<topic::Scan>,
            &Subscriber<topic::Readings>,
            &Subscriber<topic::VotesByMap>,
        ),
        (maps, sets): (&Subscriber<topic::Map>, &Subscriber<topic::Maps>),
    ) -> Result<(), TransportError> {
        loop {
            let sample = votes.receive()?;
            // The scan, the data derived from it and the map were sent before the votes.
            while let Some(scan) = scans.receive()? {
                self.health.count_received(1);
                self.scans.receive(scan.header(), scan.items());
            }
            while let Some(sample) = readings.receive()? {
                let stamp = sample.header().stamp;
                self.scans.take_readings(stamp, sample.items());
            }
            while let Some(sample) = by_map.receive()? {
                let stamp = sample.header().stamp;
                self.scans.take_by_map(stamp, sample.items());
            }
            if let Some(set) = sets.newest()? {
                self.on_set(&set)?;
            }
            // While sets are published, this is the map of the set that is displayed.
            if let Some(map) = maps.newest()?
                && !sets.has_publishers()
            {
                self.on_map(&map)?;
            }
            self.health.tick()?;
            match sample {
                Some(sample) => self.answer(&sample)?,
                None => return Ok(()),
            }
        }
    }

    fn on_map(&mut self, map: &Sample<topic::Map>) -> Result<(), TransportError> {
        self.health.count_received(1);
        self.health.state(NodeState::Busy)?;
        let (header, cells) = (map.header(), map.items());
        let checked = header.check_id(cells).map_err(PeakError::from);
        let taken = checked.and_then(|()| Ok(self.maps.receive(header, cells)?));
        self.taken(header.map_id, taken)
    }

    fn on_set(&mut self, set: &Sample<topic::Maps>) -> Result<(), TransportError> {
        self.health.count_received(1);
        self.health.state(NodeState::Busy)?;
        let read = MapSet::read(set.header(), set.items()).map_err(PeakError::from);
        let taken = read.and_then(|read| Ok(self.maps.receive_set(&read)?));
        self.taken(set.header().set_id, taken)
    }

    fn taken(&mut self, map_id: u64, taken: Result<(), PeakError>) -> Result<(), TransportError> {
        match taken {
            Ok(()) => self.health.state(NodeState::Ready),
            Err(error) => {
                let problem = format!("map {map_id:016x} rejected: {}", with_causes(&error));
                tracing::warn!("{problem}");
                self.health.count_refused(1);
                self.health.error(&problem)?;
                self.health.state(NodeState::Degraded)
            }
        }
    }

    fn answer(&mut self, votes: &Sample<topic::Votes>) -> Result<(), TransportError> {
        let start = Instant::now();
        let header = votes.header();
        let counter = header.stamp.counter;
        self.health.count_received(1);
        if header.outcome == SearchOutcome::NotAsked as u32 {
            self.newest_kept = Some(counter);
            self.health.count_dropped(self.gaps.lost_before(counter));
            return Ok(());
        }
        let known = (&self.maps, &self.scans);
        // The messages borrow from the workspace.
        let mut workspace = std::mem::take(&mut self.workspace);
        let answered = answer(
            header,
            votes.items(),
            known,
            &self.config.peaks,
            &mut workspace,
        );
        let extract_ns = start.elapsed().as_nanos() as u64;
        // Votes have the counter of their scan: a missing one was lost either as scan or as votes.
        // A scan that was kept has already been counted.
        if self.newest_kept.is_none_or(|newest| newest < counter) {
            self.health.count_dropped(self.gaps.lost_before(counter));
        }
        let done = match answered {
            Ok(answer) => {
                self.last_refusal.clear();
                self.send(header, &answer, extract_ns)
            }
            Err(error) => self
                .send(header, &nothing(header), extract_ns)
                .and_then(|()| self.refuse(header.stamp.counter, &error)),
        };
        self.workspace = workspace;
        done
    }

    fn send(
        &mut self,
        votes: &VotesHeader,
        answer: &Answer<'_>,
        extract_ns: u64,
    ) -> Result<(), TransportError> {
        let hypotheses = answer.hypotheses();
        let mut loan = self.hypotheses.loan(hypotheses.len())?;
        for (item, hypothesis) in loan.items_mut().iter_mut().zip(hypotheses) {
            *item = hypothesis;
        }
        let header = loan.header_mut();
        *header = answer.header;
        header.settings = fit_id(votes.settings, &self.config.peaks.fit);
        header.extract_ns = extract_ns;
        header.sent_ns = monotonic_ns();
        loan.send()?;
        self.health.count_sent(1);
        self.send_particles(answer)?;
        // The beams are only for display.
        if self.beams.has_subscribers() {
            self.beams.send(answer.beams_header, answer.beams)?;
        }
        Ok(())
    }

    fn send_particles(&mut self, answer: &Answer<'_>) -> Result<(), TransportError> {
        let Some((publisher, count)) = &self.particles else {
            return Ok(());
        };
        let seed = self.config.particles.particles_seed;
        match particles::draw(answer, *count, seed) {
            Ok((header, particles)) => publisher.send(header, &particles),
            Err(error) => self.refuse(answer.header.stamp.counter, &error.into()),
        }
    }

    fn refuse(&mut self, counter: u64, error: &PeakError) -> Result<(), TransportError> {
        self.health.count_refused(1);
        let reason = with_causes(error);
        let problem = format!("votes of scan {counter} rejected: {reason}");
        self.health.error(&problem)?;
        // A persistent fault would otherwise fill the log.
        if reason != self.last_refusal {
            tracing::warn!("{problem}");
            self.last_refusal = reason;
        }
        Ok(())
    }
}
