//! Asking all shards of a set of maps, for programs in Rust.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use engine::peaks::{Found, Merged, PeakConfig, Places, merge};
use engine::votes::VoteShare;
use messages::{ScanHeader, Verdict};
use serde::de::DeserializeOwned;
use zenoh::{Session, Wait};
use zenoh_session::KeyError;

use crate::LocateError;
use crate::client::{PAUSE, Question, ask_bytes, scan_bytes};
use crate::request::{GLANCE_ANSWER, Glance, PART, PART_ANSWER, PartQuestion};
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

/// Asks all shards of the set of this name, each again and again until the deadline, and merges
/// what they find. They are asked twice, all at once: for the votes of a pose that a short search
/// finds, and then for all that counts beside the best of these, for a shard without the right
/// map would search its maps far deeper than that needs. A server that dies meanwhile costs no answer where another one
/// has the same shard, and is named by its maps where none has.
///
/// # Errors
/// [`LocateError::Late`] if no shard answered in time, [`LocateError::Refused`] if the scan is
/// none, and an error where servers disagree how many shards there are, or send what is not
/// sound.
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
    let (of, there) = loop {
        if let Some(found) = shards(session, set)? {
            break found;
        }
        if Instant::now() + PAUSE >= due {
            return Err(late());
        }
        std::thread::sleep(PAUSE);
    };
    let scan = scan_bytes(session, (header, ranges))?;
    // One shard alone knows all poses.
    let (lead, glanced) = match of {
        1 => (VoteShare::default(), Duration::ZERO),
        // Who is there answers at once; who dies now is not waited for until the deadline.
        _ => glance(
            session,
            (set, of),
            &there,
            &scan,
            Instant::now() + deadline / 4,
        )?,
    };
    let question = part_question(false, lead, &scan)?;
    let ask = |number| part(session, &Shard { number, of }.name(set), &question, due);
    let parts = of_each(1..=of, ask)?;
    let Some(first) = parts.first() else {
        return Err(late());
    };
    if parts.iter().any(|part| part.maps != first.maps) {
        let reason = "servers have other maps than each other under one name".to_owned();
        return Err(LocateError::Part { reason });
    }
    let mut all = merged(&parts, config)?;
    all.slowest += glanced;
    Ok(all)
}

/// The best share that short searches of the shards that are there find, and how long the
/// slowest took.
fn glance(
    session: &Session,
    (set, of): (&str, u16),
    there: &BTreeSet<u16>,
    scan: &[u8],
    due: Instant,
) -> Result<(VoteShare, Duration), LocateError> {
    let question = part_question(true, VoteShare::default(), scan)?;
    let ask = |number| -> Result<Glance, LocateError> {
        let name = Shard { number, of }.name(set);
        answer(session, &name, (&question, GLANCE_ANSWER), due)
    };
    let glances = of_each(there.iter().copied(), ask)?;
    let mut best = VoteShare::default();
    for Glance { lead, .. } in &glances {
        let (votes, possible) = *lead;
        if possible == 0 || votes > possible {
            let reason = format!("a pose has {votes} of {possible} votes");
            return Err(LocateError::Part { reason });
        }
        let share = VoteShare::new(votes, possible);
        if share.compare(best).is_gt() {
            best = share;
        }
    }
    let slowest = glances.iter().map(|glance| glance.search_ns).max();
    Ok((best, Duration::from_nanos(slowest.unwrap_or_default())))
}

fn part_question(glance: bool, lead: VoteShare, scan: &[u8]) -> Result<Question, LocateError> {
    let asked = PartQuestion {
        glance,
        lead: (lead.votes, lead.possible),
        scan,
    };
    let payload = postcard::to_allocvec(&asked).map_err(|error| LocateError::Part {
        reason: error.to_string(),
    })?;
    Ok(Question::of(PART, payload))
}

/// What shards say that are asked at once; those that are late are left out.
fn of_each<T: Send>(
    shards: impl Iterator<Item = u16>,
    ask: impl Fn(u16) -> Result<T, LocateError> + Sync,
) -> Result<Vec<T>, LocateError> {
    let answers: Vec<_> = std::thread::scope(|scope| {
        let ask = &ask;
        let asked: Vec<_> = shards
            .map(|number| scope.spawn(move || ask(number)))
            .collect();
        let joined = asked.into_iter().map(std::thread::ScopedJoinHandle::join);
        let answer =
            |end: Result<_, _>| end.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        joined.map(answer).collect()
    });
    let is_answer = |answer: &Result<T, _>| !matches!(answer, Err(LocateError::Late { .. }));
    // The others have answers.
    answers.into_iter().filter(is_answer).collect()
}

fn merged(parts: &[Part], config: &PeakConfig) -> Result<OverMaps, LocateError> {
    let mut found: Vec<Found> = Vec::new();
    for part in parts {
        found.push(part.found()?);
    }
    let Merged { mut places, .. } = merge(&found, config);
    let maps = parts[0].maps.clone();
    let is_searched = |map: usize| parts.iter().any(|part| part.shard.holds(map));
    let missing = maps.iter().enumerate();
    let missing = missing.filter(|(map, _)| !is_searched(*map));
    let not_searched: Vec<String> = missing.map(|(_, name)| name.clone()).collect();
    if !not_searched.is_empty() && places.verdict == Verdict::Unique {
        places.verdict = Verdict::Ambiguous;
    }
    let slowest = parts.iter().map(|part| part.search_ns).max();
    Ok(OverMaps {
        places,
        maps,
        not_searched,
        slowest: Duration::from_nanos(slowest.unwrap_or_default()),
    })
}

/// How many shards a set has, and which of them are there; `None` where none is.
fn shards(session: &Session, set: &str) -> Result<Option<(u16, BTreeSet<u16>)>, LocateError> {
    let key = format!("{}/*/*/*/*", network_payload::locate(&format!("{set}.$*")));
    let failed = KeyError::when("look who is at", &key);
    let tokens = session.liveliness().get(&key).wait().map_err(failed)?;
    let (mut found, mut there) = (BTreeSet::new(), BTreeSet::new());
    for reply in tokens {
        let Ok(sample) = reply.into_result() else {
            continue;
        };
        let name = sample.key_expr().as_str().split('/').nth(2);
        let shard = name.and_then(|name| Shard::of_name(name, set));
        found.extend(shard.map(|shard| shard.of));
        there.extend(shard.map(|shard| shard.number));
    }
    match (found.len(), found.pop_first()) {
        (0 | 1, of) => Ok(of.map(|of| (of, there))),
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
) -> Result<Part, LocateError> {
    answer(session, name, (question, PART_ANSWER), due)
}

fn answer<T: DeserializeOwned>(
    session: &Session,
    name: &str,
    (question, allowed): (&Question, &str),
    due: Instant,
) -> Result<T, LocateError> {
    let remaining = due.saturating_duration_since(Instant::now());
    let (encoding, payload) = ask_bytes(session, name, question, remaining)?;
    let unsound = |reason: String| LocateError::Part { reason };
    if encoding != allowed {
        return Err(unsound(format!(
            "it is {encoding:?}: allowed is {allowed:?}"
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
