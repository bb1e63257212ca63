//! Asking all shards of a set of maps, for programs in Rust.

use std::collections::BTreeSet;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use engine::peaks::{Found, Merged, PeakConfig, Places, merge};
use engine::search::Lead;
use engine::votes::VoteShare;
use messages::{ScanHeader, Verdict};
use transport::wall_ns;
use zenoh::{Session, Wait};
use zenoh_session::KeyError;

use crate::LocateError;
use crate::client::{PAUSE, Question, ask_bytes, scan_bytes, sender};
use crate::leads::SentLead;
use crate::request::{PART, PART_ANSWER, PartQuestion, QuestionId};
use crate::shard::{Part, Shard};

/// Most bytes of a part, many times those of all candidates of a thousand maps' names.
const MAX_PART_BYTES: usize = 16 << 20;

/// What all shards say of a scan.
#[derive(Debug, Clone, PartialEq)]
pub struct OverMaps {
    /// The places and the verdict; each place has the number of its map. Where maps were not
    /// searched, nothing is `Unique`: the robot may be on one of them.
    pub places: Places,
    /// The names of all maps of the set, by their numbers.
    pub maps: Vec<String>,
    /// Those of which no server answered.
    pub not_searched: Vec<String>,
    /// Computing of the slowest shard.
    pub slowest: Duration,
}

impl OverMaps {
    /// The name of the best place's map.
    #[must_use]
    pub fn map(&self) -> Option<&str> {
        let best = self.places.places.first()?;
        self.maps.get(best.map as usize).map(String::as_str)
    }
}

/// Asks all shards of the set of this name at once, each again and again until the deadline,
/// and merges what they find. As soon as one has an answer, the others are sent what its best
/// pose has: a shard without the right map would search its maps far deeper than that needs. A
/// server that dies meanwhile costs no answer where another one has the same shard, and is named
/// by its maps where none has.
///
/// Servers must judge by the same score as the caller.
///
/// # Errors
/// [`LocateError::Late`] if no shard answered in time, [`LocateError::Refused`] if the scan is
/// none, and an error where servers disagree how many shards there are, judge by another score,
/// or send what is not sound.
pub fn ask_shards(
    session: &Session,
    set: &str,
    (header, ranges): (&ScanHeader, &[f32]),
    deadline: Duration,
    config: &PeakConfig,
) -> Result<OverMaps, LocateError> {
    let due = Instant::now() + deadline;
    let late = || LocateError::Late {
        deadline_ms: deadline.as_millis(),
    };
    let of = loop {
        if let Some(of) = shards(session, set, due)? {
            break of;
        }
        if Instant::now() + PAUSE >= due {
            return Err(late());
        }
        std::thread::sleep(PAUSE);
    };
    let scan = scan_bytes(session, (header, ranges))?;
    let id = question_id(session);
    let payload = postcard::to_allocvec(&PartQuestion { id, scan: &scan });
    let payload = payload.map_err(|error| LocateError::Part {
        reason: error.to_string(),
    })?;
    let question = Question::of(PART, payload);
    let lead = Lead::default();
    let tell = |shard: Shard| tell(session, &shard.name(set), id, lead.share());
    let ask = |number| {
        let shard = Shard { number, of };
        // A server that takes over was not there when the others were told.
        let before = || {
            if lead.share() != VoteShare::default() {
                tell(shard);
            }
        };
        let part = part(session, &shard.name(set), &question, due, &before)?;
        let found = part.found(shard, config.score)?;
        if found.lead.compare(lead.share()).is_gt() {
            lead.raise(found.lead);
            let others = (1..=of).filter(|other| *other != number);
            others.for_each(|number| tell(Shard { number, of }));
        }
        Ok((part, found))
    };
    let ask = &ask;
    let answers: Vec<_> = std::thread::scope(|scope| {
        let asked: Vec<_> = (1..=of)
            .map(|number| scope.spawn(move || ask(number)))
            .collect();
        let joined = asked.into_iter().map(std::thread::ScopedJoinHandle::join);
        let answer =
            |end: Result<_, _>| end.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        joined.map(answer).collect()
    });
    let mut parts = Vec::new();
    for answer in answers {
        match answer {
            Ok(answer) => parts.push(answer),
            // The others have answers.
            Err(LocateError::Late { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    let Some((first, _)) = parts.first() else {
        return Err(late());
    };
    if parts.iter().any(|(part, _)| part.maps != first.maps) {
        let reason = "servers have other maps than each other under one name".to_owned();
        return Err(LocateError::Part { reason });
    }
    Ok(merged(parts, config))
}

/// A number that no other question has.
fn question_id(session: &Session) -> QuestionId {
    // Also not one of a session of this number before.
    static ASKED: LazyLock<AtomicU64> = LazyLock::new(|| AtomicU64::new(wall_ns().unsigned_abs()));
    let sender = sender(session);
    (sender, ASKED.fetch_add(1, Ordering::Relaxed))
}

/// Tells a shard what a pose has that another one found. Where that does not arrive, it takes
/// longer and finds the same.
fn tell(session: &Session, shard: &str, question: QuestionId, found: VoteShare) {
    let sent = SentLead {
        question,
        votes: (found.votes, found.possible),
    };
    if let Ok(bytes) = postcard::to_allocvec(&sent) {
        let _ = session.put(SentLead::key(shard), bytes).wait();
    }
}

/// At least one part, all of one set.
fn merged(parts: Vec<(Part, Found)>, config: &PeakConfig) -> OverMaps {
    let (parts, found): (Vec<Part>, Vec<Found>) = parts.into_iter().unzip();
    let Merged {
        mut places,
        found: merged,
        ..
    } = merge(&found, config);
    // A shard that searched beside a pose that is none of these left out what they may lack, as
    // where a question has the number of another one.
    let is_beside_another = |part: &Part| part.beside().compare(merged.lead).is_gt();
    let maps = parts[0].maps.clone();
    let is_searched = |map: usize| parts.iter().any(|part| part.shard.holds(map));
    let missing = maps.iter().enumerate();
    let missing = missing.filter(|(map, _)| !is_searched(*map));
    let not_searched: Vec<String> = missing.map(|(_, name)| name.clone()).collect();
    let may_lack = !not_searched.is_empty() || parts.iter().any(is_beside_another);
    if may_lack && places.verdict == Verdict::Unique {
        places.verdict = Verdict::Ambiguous;
    }
    let slowest = parts.iter().map(|part| part.search_ns).max();
    OverMaps {
        places,
        maps,
        not_searched,
        slowest: Duration::from_nanos(slowest.unwrap_or_default()),
    }
}

/// How many shards a set has, by the servers that are there; `None` where there is none.
fn shards(session: &Session, set: &str, due: Instant) -> Result<Option<u16>, LocateError> {
    let key = format!("{}/*/*/*/*", network_payload::locate(&format!("{set}.$*")));
    let failed = KeyError::when("look who is at", &key);
    let remaining = due.saturating_duration_since(Instant::now());
    let tokens = session.liveliness().get(&key).timeout(remaining).wait();
    let tokens = tokens.map_err(failed)?;
    let mut found = BTreeSet::new();
    for reply in tokens {
        let Ok(sample) = reply.into_result() else {
            continue;
        };
        let name = sample.key_expr().as_str().split('/').nth(2);
        let shard = name.and_then(|name| Shard::of_name(name, set));
        found.extend(shard.map(|shard| shard.of));
    }
    match (found.len(), found.pop_first()) {
        (0 | 1, of) => Ok(of),
        (_, of) => {
            let numbers: Vec<String> = of.iter().chain(&found).map(u16::to_string).collect();
            let reason = format!(
                "servers of {set} disagree how many shards there are: {}",
                numbers.join(", ")
            );
            Err(LocateError::Part { reason })
        }
    }
}

fn part(
    session: &Session,
    name: &str,
    question: &Question,
    due: Instant,
    before: &dyn Fn(),
) -> Result<Part, LocateError> {
    let remaining = due.saturating_duration_since(Instant::now());
    let (encoding, payload) = ask_bytes(session, name, question, remaining, before)?;
    let unsound = |reason: String| LocateError::Part { reason };
    if encoding != PART_ANSWER {
        return Err(unsound(format!(
            "it is {encoding:?}: allowed is {PART_ANSWER:?}"
        )));
    }
    let bytes = payload.len();
    if bytes > MAX_PART_BYTES {
        return Err(unsound(format!(
            "it has {bytes} bytes: allowed are {MAX_PART_BYTES}"
        )));
    }
    postcard::from_bytes(&payload).map_err(|error| unsound(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shard::tests::part_of;

    /// What both shards of a set say, with these votes of 100 and beside such ones.
    fn verdict(shards: [((u16, u16), (u16, u16)); 2]) -> Verdict {
        let config = PeakConfig::default();
        let part = |(number, (lead, beside)): (u16, _)| {
            let shard = Shard { number, of: 2 };
            let mut part = part_of(shard, lead);
            part.beside = beside;
            let found = part.found(shard, config.score).unwrap();
            (part, found)
        };
        let parts = (1..).zip(shards).map(part).collect();
        merged(parts, &config).places.verdict
    }

    #[test]
    fn beside_a_pose_that_no_shard_has_nothing_stands_alone() {
        let (low, high) = ((10, 100), (80, 100));
        assert_eq!(verdict([(low, low), (high, high)]), Verdict::Unique);
        // The other one's pose was told.
        assert_eq!(verdict([(low, high), (high, high)]), Verdict::Unique);
        assert_eq!(verdict([(low, (4, 5)), (high, high)]), Verdict::Unique);
        // None of both has that one.
        assert_eq!(
            verdict([(low, (81, 100)), (high, high)]),
            Verdict::Ambiguous
        );
        assert_eq!(verdict([(low, low), (high, (1, 1))]), Verdict::Ambiguous);
    }
}
