//! What those with the token want, on its way to a robot. Its bridge takes it where
//! `region` and `save` are among its outputs.

use messages::{Corner, RegionHeader, SaveHeader, Stamp, topic};
use network_payload::{Preamble, Wire};
use transport::monotonic_ns;
use zenoh::bytes::Encoding;
use zenoh::qos::CongestionControl;
use zenoh::{Session, Wait};
use zenoh_ext::{AdvancedPublisher, AdvancedPublisherBuilderExt, CacheConfig, MissDetectionConfig};
use zenoh_session::KeyError;

use crate::FleetError;

/// What a robot may be asked.
pub(crate) struct Requests {
    regions: AdvancedPublisher<'static>,
    saves: AdvancedPublisher<'static>,
    next: Preamble,
}

impl Requests {
    /// To a robot, from the process with the session id `sender`.
    pub(crate) fn open(session: &Session, robot: &str, sender: u64) -> Result<Self, FleetError> {
        Ok(Requests {
            regions: declare::<topic::Region>(session, robot)?,
            saves: declare::<topic::Save>(session, robot)?,
            next: Preamble {
                sender,
                sequence: 0,
                clock_ns: 0,
            },
        })
    }

    /// Whether somebody subscribes to regions, and to saving.
    pub(crate) fn subscribed(&self) -> (bool, bool) {
        let has_subscribers = |publisher: &AdvancedPublisher<'_>| {
            let status = publisher.matching_status().wait();
            status.is_ok_and(|status| status.matching())
        };
        (has_subscribers(&self.regions), has_subscribers(&self.saves))
    }

    /// Corners, metres in the map; none for everywhere.
    pub(crate) fn region(&mut self, corners: &[[f64; 2]]) -> Result<(), FleetError> {
        let corners: Vec<_> = corners.iter().map(|&[x, y]| Corner { x, y }).collect();
        let (preamble, stamp) = self.stamp();
        let header = RegionHeader { stamp };
        let payload = network_payload::encode::<topic::Region>(&preamble, &header, &corners)?;
        put(&self.regions, payload)
    }

    pub(crate) fn save(&mut self) -> Result<(), FleetError> {
        let (preamble, stamp) = self.stamp();
        let payload =
            network_payload::encode::<topic::Save>(&preamble, &SaveHeader { stamp }, &[])?;
        put(&self.saves, payload)
    }

    /// Nothing was measured: it is a request of this moment.
    fn stamp(&mut self) -> (Preamble, Stamp) {
        self.next.clock_ns = monotonic_ns();
        let stamp = Stamp {
            measured_ns: 0,
            entered_ns: self.next.clock_ns,
            counter: self.next.sequence,
        };
        let preamble = self.next;
        self.next.sequence += 1;
        (preamble, stamp)
    }
}

fn declare<T: Wire>(
    session: &Session,
    robot: &str,
) -> Result<AdvancedPublisher<'static>, FleetError> {
    let key = network_payload::key::<T>(robot);
    let publisher = session
        .declare_publisher(key.clone())
        .encoding(Encoding::from(network_payload::encoding::<T>()))
        // The page is not to wait for a robot that is cut off.
        .congestion_control(CongestionControl::Drop)
        .advanced();
    let publisher = if T::KEPT {
        let cache = CacheConfig::default().max_samples(1);
        publisher
            .cache(cache)
            // Else each message would need a time by Zenoh's clock, which clients lack.
            .sample_miss_detection(MissDetectionConfig::default())
            .publisher_detection()
    } else {
        publisher
    };
    let publisher = publisher.wait().map_err(KeyError::when("publish", &key))?;
    Ok(publisher)
}

fn put(publisher: &AdvancedPublisher<'_>, payload: Vec<u8>) -> Result<(), FleetError> {
    let sent = publisher.put(payload).wait();
    sent.map_err(KeyError::when("send on", publisher.key_expr()))?;
    Ok(())
}
