//! Searches what is taken on, one request after the other.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use serde::Serialize;
use transport::monotonic_ns;
use zenoh::Wait;

use crate::counts::Counts;
use crate::dispatcher::{Job, WorkQueue};
use crate::locator::{Locator, Workspace};
use crate::request::{GLANCE_ANSWER, Glance, PART_ANSWER, Wanted};
use crate::{LocateError, request};

/// Answers until nobody takes requests any more.
pub(crate) fn work(work_queue: &WorkQueue, locator: &Locator, counts: &Arc<Counts>) {
    let mut workspace = Workspace::default();
    while let Some(job) = work_queue.next() {
        match answer(&job, locator, &mut workspace) {
            Ok((encoding, payload)) => {
                let reply = job.query.reply(&*job.key, payload).encoding(encoding);
                counts.sent(&reply.wait());
            }
            Err(error) => counts.refuse(&job.query, &error),
        }
        work_queue.busy.fetch_sub(1, Ordering::Relaxed);
    }
}

fn answer(
    job: &Job,
    locator: &Locator,
    workspace: &mut Workspace,
) -> Result<(String, Vec<u8>), LocateError> {
    let deadline = job.deadline;
    if deadline.has_passed() {
        return Err(deadline.late());
    }
    let start = Instant::now();
    let encoding = job.query.encoding().map(ToString::to_string);
    let payload = job.query.payload().map(|payload| payload.to_bytes());
    let asked = request::read(
        &encoding.unwrap_or_default(),
        &payload.unwrap_or_default(),
        monotonic_ns(),
    )?;
    let stop = || deadline.has_passed();
    let scan = (&asked.header, asked.ranges.as_slice());
    let form = match asked.wanted {
        Wanted::Hypotheses(form) => form,
        Wanted::Part { lead } => {
            let Some(mut part) = locator.locate_part(workspace, scan, lead, &stop)? else {
                return Err(deadline.late());
            };
            part.search_ns = start.elapsed().as_nanos() as u64;
            return Ok((PART_ANSWER.to_owned(), bytes_of(&part)?));
        }
        Wanted::Glance => {
            let Some(lead) = locator.glance(workspace, scan, &stop)? else {
                return Err(deadline.late());
            };
            let glance = Glance {
                lead: (lead.votes, lead.possible),
                search_ns: start.elapsed().as_nanos() as u64,
            };
            return Ok((GLANCE_ANSWER.to_owned(), bytes_of(&glance)?));
        }
    };
    let Some((mut header, hypotheses)) = locator.locate(workspace, scan, &stop)? else {
        return Err(deadline.late());
    };
    header.search_ns = start.elapsed().as_nanos() as u64;
    header.sent_ns = monotonic_ns();
    let name_of = |map_id| locator.name_of(map_id).map(str::to_owned);
    request::write(form, &header, &hypotheses, &name_of, header.sent_ns)
}

fn bytes_of(answer: &impl Serialize) -> Result<Vec<u8>, LocateError> {
    postcard::to_allocvec(answer).map_err(|error| LocateError::Part {
        reason: error.to_string(),
    })
}
