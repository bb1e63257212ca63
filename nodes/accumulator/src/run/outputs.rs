//! Publishers of the node.

use engine::beams::BeamConfig;
use engine::settings::reading_id;
use messages::{
    FieldHeader, Reading, ReadingsHeader, Stamp, Vote, VotesByMapHeader, VotesHeader, topic,
};
use transport::{Graph, Publisher, TransportError, monotonic_ns};

use crate::Config;

pub(super) struct Outputs {
    votes: Publisher<topic::Votes>,
    by_map: Publisher<topic::VotesByMap>,
    readings: Publisher<topic::Readings>,
    field: Publisher<topic::Field>,
    field_period_ns: i64,
    /// Time at which the next image is due; `None` before the first one.
    field_due_ns: Option<i64>,
    /// Id of the settings by which scans are read.
    settings: u64,
}

impl Outputs {
    pub(super) fn open(graph: &Graph, config: &Config) -> Result<Self, TransportError> {
        Ok(Outputs {
            votes: graph.publisher_for(config.vote_search.collect.max_votes as usize)?,
            by_map: graph.publisher()?,
            // Enough for the default number of beams; the publisher grows for more.
            readings: graph.publisher_for(BeamConfig::default().max_beams as usize)?,
            field: graph.publisher()?,
            field_period_ns: (1e9 / config.field_rate) as i64,
            field_due_ns: None,
            settings: reading_id(&config.join, &config.vote_search.votes.beams),
        })
    }

    /// Publishes the votes on several maps that were searched together, one of which leads.
    pub(super) fn votes_of_maps(
        &self,
        leading: &VotesHeader,
        by_map: &[(VotesHeader, &[Vote])],
    ) -> Result<(), TransportError> {
        let mut loan = self.by_map.loan(by_map.len())?;
        *loan.header_mut() = VotesByMapHeader {
            stamp: leading.stamp,
        };
        for (item, (header, _)) in loan.items_mut().iter_mut().zip(by_map) {
            *item = *header;
        }
        loan.send()?;
        let total = by_map.iter().map(|(_, votes)| votes.len()).sum();
        let mut loan = self.votes.loan(total)?;
        *loan.header_mut() = VotesHeader {
            total: total as u64,
            maps: by_map.len() as u64,
            settings: self.settings,
            ..*leading
        };
        let mut rest = loan.items_mut();
        for (_, votes) in by_map {
            let (here, after) = rest.split_at_mut(votes.len());
            here.copy_from_slice(votes);
            rest = after;
        }
        loan.send()
    }

    pub(super) fn votes(&self, header: &VotesHeader, votes: &[Vote]) -> Result<(), TransportError> {
        let settings = self.settings;
        self.votes.send(
            VotesHeader {
                settings,
                ..*header
            },
            votes,
        )
    }

    pub(super) fn readings(
        &self,
        stamp: Stamp,
        readings: &[Reading],
    ) -> Result<(), TransportError> {
        self.readings.send(ReadingsHeader { stamp }, readings)
    }

    /// Returns true if `field` has a subscriber and an image is due, and counts it as sent.
    pub(super) fn is_field_due(&mut self) -> bool {
        let now_ns = monotonic_ns();
        let is_due = self.field_due_ns.is_none_or(|due| now_ns >= due);
        if is_due && self.field.has_subscribers() {
            self.field_due_ns = Some(now_ns.saturating_add(self.field_period_ns));
            return true;
        }
        false
    }

    pub(super) fn field(
        &self,
        header: &FieldHeader,
        intensities: &[u16],
    ) -> Result<(), TransportError> {
        self.field.send(*header, intensities)
    }
}
