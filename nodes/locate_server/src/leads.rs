//! What other shards have found for the questions that are searched here.
//!
//! A shard without the right map would search its maps far deeper than one server with all of
//! them, which knows of a good pose soon. So whoever asks tells each shard, at
//! `backcast/locate/<shard>/lead`, what the best pose has that another one found, and the search
//! goes on with that.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};

use engine::search::Lead;
use engine::votes::VoteShare;
use serde::{Deserialize, Serialize};

use crate::LocateError;
use crate::request::QuestionId;
use crate::shard::are_votes;

/// Questions that are kept at least, and at most.
const KEPT: (usize, usize) = (256, 65_536);

/// What is said of a question: what a pose has that another shard found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct SentLead {
    pub(crate) question: QuestionId,
    /// Its votes, and how many are possible on its map.
    pub(crate) votes: (u16, u16),
}

impl SentLead {
    /// Where it is sent to the shard of this name.
    pub(crate) fn key(shard: &str) -> String {
        format!("{}/lead", network_payload::locate(shard))
    }

    pub(crate) fn read(payload: &[u8]) -> Result<Self, LocateError> {
        let unsound = |reason: String| LocateError::Part { reason };
        let sent: SentLead =
            postcard::from_bytes(payload).map_err(|error| unsound(error.to_string()))?;
        let (votes, possible) = sent.votes;
        match are_votes(sent.votes) {
            true => Ok(sent),
            false => Err(unsound(format!(
                "a pose has {votes} of {possible} votes: allowed are at most all, of 1 at least"
            ))),
        }
    }
}

/// By question.
#[derive(Debug)]
pub(crate) struct Leads {
    kept: usize,
    known: Mutex<Known>,
}

#[derive(Debug, Default)]
struct Known {
    leads: HashMap<QuestionId, Arc<Lead>>,
    /// The newest last.
    order: VecDeque<QuestionId>,
}

impl Leads {
    /// Where so many questions may be under way. More are kept: what is said of one may come
    /// before the question and after its answer, and it may be another server of the shard that
    /// is asked.
    pub(crate) fn new(under_way: usize) -> Self {
        Leads {
            kept: (2 * under_way).clamp(KEPT.0, KEPT.1),
            known: Mutex::default(),
        }
    }

    /// What the best pose has that is known for a question, which may rise at any time.
    pub(crate) fn of(&self, question: QuestionId) -> Arc<Lead> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let Known { leads, order } = &mut *known;
        if let Some(lead) = leads.get(&question) {
            return Arc::clone(lead);
        }
        if order.len() == self.kept
            && let Some(oldest) = order.pop_front()
        {
            leads.remove(&oldest);
        }
        let lead = Arc::new(Lead::default());
        leads.insert(question, Arc::clone(&lead));
        order.push_back(question);
        lead
    }

    /// Takes what another shard found.
    pub(crate) fn take(&self, sent: SentLead) {
        let (votes, possible) = sent.votes;
        self.of(sent.question)
            .raise(VoteShare::new(votes, possible));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sent(question: u64, votes: (u16, u16)) -> SentLead {
        SentLead {
            question: (1, question),
            votes,
        }
    }

    #[test]
    fn what_is_said_of_a_question_counts_whenever_it_comes() {
        let leads = Leads::new(1);
        leads.take(sent(5, (30, 100)));
        let lead = leads.of((1, 5));
        assert_eq!(lead.share(), VoteShare::new(30, 100));
        leads.take(sent(5, (50, 100)));
        leads.take(sent(5, (40, 100)));
        leads.take(sent(6, (90, 100)));
        assert_eq!(lead.share(), VoteShare::new(50, 100));
        // Old ones make room, and are not lost for who has them.
        (7..7 + KEPT.0 as u64).for_each(|question| leads.take(sent(question, (1, 2))));
        assert_eq!(leads.of((1, 5)).share(), VoteShare::default());
        assert_eq!(lead.share(), VoteShare::new(50, 100));
    }

    #[test]
    fn what_is_said_of_questions_that_wait_is_kept() {
        let waiting = 1_000;
        let leads = Leads::new(waiting as usize);
        (0..waiting).for_each(|question| leads.take(sent(question, (1, 2))));
        let lead = |question| leads.of((1, question)).share();
        assert!((0..waiting).all(|question| lead(question) == VoteShare::new(1, 2)));
        assert_eq!(Leads::new(usize::MAX / 2).kept, KEPT.1);
    }

    #[test]
    fn what_no_pose_has_is_refused() {
        let read = |votes| SentLead::read(&postcard::to_allocvec(&sent(1, votes)).unwrap());
        assert_eq!(read((7, 9)).unwrap(), sent(1, (7, 9)));
        for wrong in [(1, 0), (8, 7)] {
            let error = read(wrong).unwrap_err().to_string();
            assert!(error.contains("allowed are at most all"), "{error}");
        }
        assert!(SentLead::read(&[0xff]).is_err());
    }
}
