//! Searches accepted requests one after the other.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use transport::monotonic_ns;
use zenoh::Wait;

use crate::counts::Counts;
use crate::dispatcher::{Job, WorkQueue};
use crate::error::BUSY;
use crate::locator::{Locator, Workspace};
use crate::{LocateError, request};

pub(crate) fn work(work_queue: &WorkQueue, locator: &Locator, counts: &Arc<Counts>) {
    let mut workspace = Workspace::default();
    while let Some(job) = work_queue.next() {
        match answer(&job, locator, &mut workspace) {
            Ok((encoding, payload)) => {
                let reply = job.query.reply(&*job.key, payload).encoding(encoding);
                counts.sent(&reply.wait());
            }
            // The forwarding server may be newer and know the encoding: it takes back requests that
            // are answered with "busy".
            Err(error @ LocateError::Encoding { .. }) if job.is_handed_on => {
                counts.refuse_as(&job.query, &error, BUSY);
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
    let Some((mut header, hypotheses)) = locator.locate(workspace, scan, &stop)? else {
        return Err(deadline.late());
    };
    header.search_ns = start.elapsed().as_nanos() as u64;
    header.sent_ns = monotonic_ns();
    let name_of = |map_id| locator.name_of(map_id).map(str::to_owned);
    request::write(asked.form, &header, &hypotheses, &name_of, header.sent_ns)
}
