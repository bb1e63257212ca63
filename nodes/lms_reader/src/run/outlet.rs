//! Where scans leave the node and troubles are reported.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use messages::{NodeState, topic};
use transport::{Graph, Health, Publisher, TransportError, with_causes};

use crate::LmsError;
use crate::cola_b::{Frame, LmdScanData, Telegram};
use crate::complaints::Complaints;
use crate::scan::{self, Received, ScanSettings};

/// How long the stop flag may go unseen.
pub(super) const SLICE: Duration = Duration::from_millis(20);

/// What was last said about the source.
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
    complaints: Complaints,
    link: Link,
    device_status: [u8; 2],
    /// Sound telegrams of any kind.
    pub(super) telegrams: u64,
    pub(super) sent: u64,
    pub(super) refused: u64,
}

impl Outlet {
    pub(super) fn open(graph: &Graph, settings: ScanSettings) -> Result<Self, TransportError> {
        Ok(Outlet {
            publisher: graph.publisher()?,
            health: graph.health()?,
            stop: graph.stop_flag(),
            settings,
            complaints: Complaints::default(),
            link: Link::Untried,
            device_status: [0, 0],
            telegrams: 0,
            sent: 0,
            refused: 0,
        })
    }

    pub(super) fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Waits until `deadline` or the stop flag.
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

    /// Waits until every subscriber is done with what was sent, until `deadline`
    /// or the stop flag; says whether they are.
    pub(super) fn wait_until_taken(&mut self, deadline: Instant) -> Result<bool, TransportError> {
        loop {
            if self.publisher.is_settled()? {
                return Ok(true);
            }
            let now = Instant::now();
            if self.stopped() || now >= deadline {
                return Ok(false);
            }
            self.wait_until(deadline.min(now + SLICE))?;
        }
    }

    pub(super) fn tick(&mut self) -> Result<(), TransportError> {
        self.health.tick()
    }

    /// The scan in a telegram, if there is one; anything wrong is reported.
    pub(super) fn hear<'a>(
        &mut self,
        next: Result<Frame<'a>, LmsError>,
    ) -> Result<Option<LmdScanData<'a>>, LmsError> {
        let frame = match next {
            Ok(frame) => frame,
            Err(error) => return self.refuse(&error).map(|()| None),
        };
        self.telegrams += 1;
        self.health.count_received(1);
        if frame.skipped > 0 {
            tracing::debug!(bytes = frame.skipped, "skipped to the next telegram");
        }
        match frame.telegram {
            Telegram::ScanData(data) => return Ok(Some(data)),
            Telegram::ScanDataStarted(true) => tracing::info!("the device sends scans"),
            Telegram::ScanDataStarted(false) => self.refuse(&LmsError::NotStarted)?,
            Telegram::Fault(code) => self.refuse(&LmsError::Fault { code })?,
            Telegram::Other(command) => {
                tracing::debug!(command = %command.escape_ascii(), "skipped a telegram");
            }
        }
        Ok(None)
    }

    /// Sends a scan; one that cannot be laid out is reported as refused.
    pub(super) fn publish(
        &mut self,
        data: &LmdScanData<'_>,
        received: Received,
    ) -> Result<(), LmsError> {
        let made = scan::distances(data).and_then(|distances| {
            let header = scan::header(data, &distances, &self.settings, received)?;
            Ok((distances, header))
        });
        let (distances, mut header) = match made {
            Ok(made) => made,
            Err(error) => return self.refuse(&error),
        };
        header.stamp.counter = self.sent;
        let mut loan = self.publisher.loan(distances.len())?;
        *loan.header_mut() = header;
        scan::fill_ranges(&distances, loan.items_mut());
        loan.send()?;
        self.sent += 1;
        self.health.count_sent(1);
        if self.link != Link::Up {
            let (serial, beams) = (data.serial_number, distances.len());
            tracing::info!(serial, beams, "scans arrive");
            self.link = Link::Up;
        }
        self.judge(data.status)?;
        Ok(())
    }

    /// The source is gone; said once for each reason.
    pub(super) fn lost(&mut self, error: &LmsError) -> Result<(), LmsError> {
        let lost = Link::Lost(with_causes(error));
        if let Link::Lost(reason) = &lost
            && self.link != lost
        {
            tracing::warn!("{reason}; trying again");
            self.health.error(reason)?;
        }
        self.link = lost;
        self.health.state(NodeState::Degraded)?;
        Ok(())
    }

    fn refuse(&mut self, error: &LmsError) -> Result<(), LmsError> {
        self.refused += 1;
        self.health.count_refused(1);
        if let Some(held_back) = self.complaints.note(transport::monotonic_ns()) {
            let problem = with_causes(error);
            tracing::warn!(held_back, "{problem}");
            self.health.error(&problem)?;
        }
        self.health.state(NodeState::Degraded)?;
        Ok(())
    }

    /// A device in order makes the node ready.
    fn judge(&mut self, status: [u8; 2]) -> Result<(), TransportError> {
        if status != self.device_status {
            self.device_status = status;
            let problem = LmsError::DeviceStatus { found: status }.to_string();
            tracing::warn!("{problem}");
            self.health.error(&problem)?;
        }
        self.health.state(match status {
            [0, 0] => NodeState::Ready,
            _ => NodeState::Degraded,
        })
    }
}
