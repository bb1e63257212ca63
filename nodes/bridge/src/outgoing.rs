//! A topic sent to the network.
//!
//! Samples of a live topic are dropped if the network is slower than the graph: the next one is
//! newer. Messages kept for late joiners are sent reliably, without blocking other topics.

use std::rc::Rc;
use std::time::Duration;

use network_payload::{Preamble, Wire};
use transport::{Graph, Input, Sample, Subscriber, TransportError, monotonic_ns};
use zenoh::bytes::Encoding;
use zenoh::qos::{CongestionControl, Priority};
use zenoh::{Session, Wait};
use zenoh_ext::{AdvancedPublisher, AdvancedPublisherBuilderExt, CacheConfig, MissDetectionConfig};
use zenoh_session::{KeyError, Report};

use crate::BridgeError;
use crate::exit::{Aside, Exit};
use crate::rates::Limit;
use crate::route::{Ends, Route};

/// Interval at which readers learn whether they missed the newest kept message.
const HEARTBEAT: Duration = Duration::from_millis(500);

pub(crate) struct Outgoing<T: Wire> {
    /// `None` while a topic that is computed on demand has no remote subscriber.
    subscriber: Option<Rc<Subscriber<T>>>,
    key: String,
    exit: Exit,
    limit: Limit,
    next: Preamble,
}

impl<T: Wire> Outgoing<T> {
    pub(crate) fn open(ends: Ends<'_>) -> Result<Self, BridgeError> {
        let subscriber = if T::ON_DEMAND {
            None
        } else {
            Some(Rc::new(ends.graph.subscriber()?))
        };
        let key = network_payload::key::<T>(ends.robot);
        let publisher = declare::<T>(ends.session, &key)?;
        let exit = if T::KEPT {
            Exit::Aside(Aside::new(publisher))
        } else {
            Exit::Here(publisher)
        };
        Ok(Outgoing {
            subscriber,
            key,
            exit,
            limit: Limit::of::<T>(&ends.config.rate),
            next: Preamble {
                sender: ends.sender,
                sequence: 0,
                clock_ns: 0,
            },
        })
    }

    fn follow(&mut self, graph: &Graph) -> Result<(), TransportError> {
        match (self.exit.has_subscribers(), &self.subscriber) {
            (true, None) => self.subscriber = Some(Rc::new(graph.subscriber()?)),
            (false, Some(_)) => self.subscriber = None,
            _ => {}
        }
        Ok(())
    }

    fn send(&mut self, sample: &Sample<T>, report: &mut Report) -> Result<(), BridgeError> {
        let now_ns = monotonic_ns();
        if !T::KEPT && (!self.exit.has_subscribers() || !self.limit.admits(now_ns)) {
            return Ok(());
        }
        self.next.clock_ns = now_ns;
        let payload =
            match network_payload::encode::<T>(&self.next, sample.header(), sample.items()) {
                Ok(payload) => payload,
                Err(error) => return Ok(report.refused(&BridgeError::from(error))?),
            };
        self.next.sequence += 1;
        match self.exit.put(payload) {
            Some(outcome) => self.report(outcome, report),
            None => Ok(()),
        }
    }

    fn report(&self, outcome: zenoh::Result<()>, report: &mut Report) -> Result<(), BridgeError> {
        match outcome {
            Ok(()) => report.sent(),
            Err(source) => {
                report.dropped(1);
                report.refused(&KeyError::when("send on", &self.key)(source))?;
            }
        }
        Ok(())
    }
}

impl<T: Wire> Route for Outgoing<T> {
    fn input(&self) -> Option<Rc<dyn Input>> {
        let subscriber = self.subscriber.clone()?;
        Some(subscriber)
    }

    fn step(&mut self, graph: &Graph, tick: bool, report: &mut Report) -> Result<(), BridgeError> {
        if tick && T::ON_DEMAND {
            self.follow(graph)?;
        }
        while let Some(outcome) = self.exit.outcome() {
            self.report(outcome, report)?;
        }
        let Some(subscriber) = self.subscriber.clone() else {
            return Ok(());
        };
        while let Some(sample) = subscriber.receive()? {
            report.received();
            self.send(&sample, report)?;
        }
        Ok(())
    }
}

fn declare<T: Wire>(
    session: &Session,
    key: &str,
) -> Result<AdvancedPublisher<'static>, BridgeError> {
    let failed = KeyError::when("publish", key);
    let publisher = session
        .declare_publisher(key.to_owned())
        .encoding(Encoding::from(network_payload::encoding::<T>()));
    let publisher = if T::KEPT {
        publisher
            .congestion_control(CongestionControl::Block)
            // Lower priority than live messages.
            .priority(Priority::DataLow)
            .cache(CacheConfig::default().max_samples(1))
            .sample_miss_detection(MissDetectionConfig::default().heartbeat(HEARTBEAT))
            .publisher_detection()
    } else {
        // Not express: each message would take one of the two batches of its priority, so that a
        // third one at the same time is dropped, and Zenoh might keep dropping.
        publisher
            .congestion_control(CongestionControl::Drop)
            .advanced()
    };
    Ok(publisher.wait().map_err(failed)?)
}
