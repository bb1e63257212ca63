//! Publishes scans and reports errors.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use messages::{NodeState, ScanHeader, topic};
use sick::cola::{Field, LmdScanData};
use sick::lms2xx::Status;
use sick::{Frame, SickError};
use transport::{ErrorLimit, Graph, Health, Publisher, TransportError, with_causes};

use crate::angles::Angles;
use crate::clock::DeviceClock;
use crate::lms2xx_scan::WholeScan;
use crate::scan::{self, Received, ScanSettings};
use crate::{Config, LmsError};

/// Longest time before the stop flag is noticed.
pub(super) const SLICE: Duration = Duration::from_millis(20);

/// Longest wait at the end for subscribers to process the last scans: a search takes seconds at
/// most, and a few scans may be queued.
const TIMEOUT: Duration = Duration::from_secs(30);

/// Last reported state of the source.
#[derive(PartialEq)]
enum Link {
    Untried,
    Up,
    Lost(String),
}

pub(super) struct Outlet {
    publisher: Publisher<topic::Scan>,
    health: Health,
    stop: Arc<AtomicBool>,
    settings: ScanSettings,
    pub(super) angles: Angles,
    error_limit: ErrorLimit,
    clock: DeviceClock,
    link: Link,
    /// Status code of the device; 0 is ok.
    device_status: u16,
    /// Number of valid telegrams of any kind.
    pub(super) telegrams: u64,
    pub(super) sent: u64,
    pub(super) refused: u64,
    /// Reason for rejecting the last scan telegram that was rejected.
    pub(super) scan_refusal: Option<String>,
}

impl Outlet {
    pub(super) fn open(graph: &Graph, config: &Config) -> Result<Self, TransportError> {
        Ok(Outlet {
            publisher: graph.publisher()?,
            health: graph.health()?,
            stop: graph.stop_flag(),
            settings: config.scan_settings(),
            angles: Angles::new(config.stated_angles()),
            error_limit: ErrorLimit::default(),
            clock: DeviceClock::default(),
            link: Link::Untried,
            device_status: 0,
            telegrams: 0,
            sent: 0,
            refused: 0,
            scan_refusal: None,
        })
    }

    pub(super) fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Waits until `deadline` or until the stop flag is set.
    pub(super) fn wait_until(&mut self, deadline: Instant) -> Result<(), TransportError> {
        while !self.stopped() {
            self.health.tick()?;
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            std::thread::sleep(left.min(SLICE));
        }
        Ok(())
    }

    /// Waits at the end until subscribers have taken the last scans, because unread messages are
    /// lost when the publisher is dropped.
    pub(super) fn finish(&mut self) -> Result<(), LmsError> {
        let deadline = Instant::now() + TIMEOUT;
        while !self.publisher.is_settled()? && !self.stopped() {
            let now = Instant::now();
            if now >= deadline {
                let seconds = TIMEOUT.as_secs();
                tracing::warn!("not all subscribers read the last scans within {seconds} s");
                break;
            }
            self.wait_until(deadline.min(now + SLICE))?;
        }
        Ok(())
    }

    pub(super) fn tick(&mut self) -> Result<(), TransportError> {
        self.health.tick()
    }

    /// Returns the telegram in a frame; reports errors.
    pub(super) fn take<T>(
        &mut self,
        next: Result<Frame<'_, T>, SickError>,
    ) -> Result<Option<T>, LmsError> {
        let frame = match next {
            Ok(frame) => frame,
            Err(error) => return self.refuse(&error.into()).map(|()| None),
        };
        self.telegrams += 1;
        self.health.count_received(1);
        if frame.skipped > 0 {
            tracing::debug!(bytes = frame.skipped, "skipped to the next telegram");
        }
        Ok(Some(frame.telegram))
    }

    /// Publishes the scan of a CoLa telegram, or reports it as refused if it cannot be converted.
    pub(super) fn publish_cola(
        &mut self,
        data: &LmdScanData<'_>,
        received: Received,
    ) -> Result<(), LmsError> {
        let made = scan::distances(data).and_then(|distances| {
            scan::check(data, &distances)?;
            let angles = self.angles.of(Field::of(&distances))?;
            let (settings, clock) = (&self.settings, &mut self.clock);
            let measured_ns = scan::measured_ns(data, settings, received, clock)?;
            let header = scan::header(data, &distances, angles, settings, measured_ns, received);
            Ok((distances, angles.0.clockwise, header))
        });
        let (distances, clockwise, header) = match made {
            Ok(made) => made,
            Err(error) => {
                self.refuse(&error)?;
                self.scan_refusal = Some(with_causes(&error));
                return Ok(());
            }
        };
        self.publish(header, distances.values.len(), |ranges| {
            scan::fill_ranges(&distances, clockwise, ranges);
        })?;
        let found = data.status;
        self.judge(u16::from_be_bytes(found), || {
            format!(
                "the device reports status {} {} (0 0 is in order, 0 1 an error, 0 2 a dirty \
                 window, 0 4 and 0 5 one that is too dirty)",
                found[0], found[1]
            )
        })?;
        Ok(())
    }

    /// Publishes the scan of an LMS2xx, or reports it as refused if it cannot be converted.
    pub(super) fn publish_lms2xx(
        &mut self,
        scan: &WholeScan<'_>,
        status: Status,
        received: Received,
    ) -> Result<(), LmsError> {
        let header = match scan.header(&self.settings, received) {
            Ok(header) => header,
            Err(error) => return self.refuse(&error),
        };
        self.publish(header, scan.len(), |ranges| scan.fill_ranges(ranges))?;
        let code = if status.is_in_order() { 0 } else { status.0 };
        self.judge(code.into(), || {
            let implausible = match status.is_implausible() {
                true => ", implausible values",
                false => "",
            };
            let dirty = if status.is_polluted() {
                ", a dirty window"
            } else {
                ""
            };
            format!(
                "the device reports status {:#04x}: level {} (3 is an error, 4 a fatal \
                 one){implausible}{dirty}",
                status.0,
                status.level()
            )
        })?;
        Ok(())
    }

    fn publish(
        &mut self,
        mut header: ScanHeader,
        beams: usize,
        fill: impl FnOnce(&mut [f32]),
    ) -> Result<(), LmsError> {
        header.stamp.counter = self.sent;
        let mut loan = self.publisher.loan(beams)?;
        *loan.header_mut() = header;
        fill(loan.items_mut());
        loan.send()?;
        if self.sent == 0 {
            // It is not an error if the device starts after the node.
            self.health.forget_error();
        }
        self.sent += 1;
        self.health.count_sent(1);
        if self.link != Link::Up {
            tracing::info!(beams, "receiving scans");
            self.link = Link::Up;
        }
        Ok(())
    }

    /// Reports that the source is lost, once for each reason.
    pub(super) fn lost(&mut self, error: &LmsError) -> Result<(), LmsError> {
        let lost = Link::Lost(with_causes(error));
        if let Link::Lost(reason) = &lost
            && self.link != lost
        {
            match self.link {
                // The device may start after the node.
                Link::Untried => tracing::info!("waiting for the device: {reason}"),
                _ => tracing::warn!("{reason}; reconnecting"),
            }
            self.health.error(reason)?;
        }
        self.link = lost;
        self.clock = DeviceClock::default();
        self.angles.forget_name();
        self.health.state(NodeState::Degraded)?;
        Ok(())
    }

    pub(super) fn refuse(&mut self, error: &LmsError) -> Result<(), LmsError> {
        self.refused += 1;
        self.health.count_refused(1);
        if let Some(held_back) = self.error_limit.note(transport::monotonic_ns()) {
            let problem = with_causes(error);
            tracing::warn!(held_back, "{problem}");
            self.health.error(&problem)?;
        }
        self.health.state(NodeState::Degraded)?;
        Ok(())
    }

    /// Updates the node's state from the device status: 0 is ready, others are degraded.
    fn judge(
        &mut self,
        status: u16,
        problem: impl FnOnce() -> String,
    ) -> Result<(), TransportError> {
        if status != self.device_status {
            self.device_status = status;
            if status == 0 {
                tracing::info!("the device works again");
            } else {
                let problem = problem();
                tracing::warn!("{problem}");
                self.health.error(&problem)?;
            }
        }
        self.health.state(match status {
            0 => NodeState::Ready,
            _ => NodeState::Degraded,
        })
    }
}
