//! Requests of users with the token, sent to a robot. Its bridge accepts them if `region`,
//! `save` and `initial_pose` are among its outputs.

use messages::{Corner, Pose2, RegionHeader, SaveHeader, Stamp, topic};
use network_payload::{Preamble, Wire};
use transport::monotonic_ns;
use zenoh::bytes::Encoding;
use zenoh::qos::CongestionControl;
use zenoh::{Session, Wait};
use zenoh_ext::{AdvancedPublisher, AdvancedPublisherBuilderExt, CacheConfig, MissDetectionConfig};
use zenoh_session::KeyError;

use crate::FleetError;

pub(crate) struct Requests {
    regions: AdvancedPublisher<'static>,
    saves: AdvancedPublisher<'static>,
    hints: AdvancedPublisher<'static>,
    next: Preamble,
}

impl Requests {
    /// Opens the publishers to a robot, for the process with the session id `sender`.
    pub(crate) fn open(session: &Session, robot: &str, sender: u64) -> Result<Self, FleetError> {
        Ok(Requests {
            regions: declare::<topic::Region>(session, robot)?,
            saves: declare::<topic::Save>(session, robot)?,
            hints: declare::<topic::InitialPoseTopic>(session, robot)?,
            next: Preamble {
                sender,
                sequence: 0,
                clock_ns: 0,
            },
        })
    }

    /// Returns, for regions, for saving and for hints, true if there is a subscriber.
    pub(crate) fn subscribed(&self) -> [bool; 3] {
        let has_subscribers = |publisher: &AdvancedPublisher<'_>| {
            let status = publisher.matching_status().wait();
            status.is_ok_and(|status| status.matching())
        };
        [&self.regions, &self.saves, &self.hints].map(has_subscribers)
    }

    /// Requests a search region with these corners, metres in the map; none for everywhere.
    pub(crate) fn region(&mut self, corners: &[[f64; 2]]) -> Result<(), FleetError> {
        let corners: Vec<_> = corners.iter().map(|&[x, y]| Corner { x, y }).collect();
        let (preamble, stamp) = self.stamp();
        put::<topic::Region>(&self.regions, preamble, &RegionHeader { stamp }, &corners)
    }

    pub(crate) fn save(&mut self) -> Result<(), FleetError> {
        let (preamble, stamp) = self.stamp();
        put::<topic::Save>(&self.saves, preamble, &SaveHeader { stamp }, &[])
    }

    /// Tells the tracker where the robot's base probably is.
    pub(crate) fn hint(&mut self, map_from_base: Pose2) -> Result<(), FleetError> {
        let (preamble, stamp) = self.stamp();
        let header = dashboard::hint(map_from_base, stamp);
        put::<topic::InitialPoseTopic>(&self.hints, preamble, &header, &[])
    }

    /// Returns a stamp of the current time, without a time of measurement.
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
        // The page must not wait for a robot that is disconnected.
        .congestion_control(CongestionControl::Drop)
        .advanced();
    let publisher = if T::KEPT {
        let cache = CacheConfig::default().max_samples(1);
        publisher
            .cache(cache)
            // Otherwise each message would need a time of Zenoh's clock, which clients lack.
            .sample_miss_detection(MissDetectionConfig::default())
            .publisher_detection()
    } else {
        publisher
    };
    Ok(publisher.wait().map_err(KeyError::when("publish", &key))?)
}

fn put<T: Wire>(
    publisher: &AdvancedPublisher<'_>,
    preamble: Preamble,
    header: &T::Header,
    items: &[T::Item],
) -> Result<(), FleetError> {
    let payload = network_payload::encode::<T>(&preamble, header, items)?;
    let sent = publisher.put(payload).wait();
    Ok(sent.map_err(KeyError::when("send on", publisher.key_expr()))?)
}
