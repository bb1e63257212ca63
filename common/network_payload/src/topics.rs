//! Network properties of each topic: schema, limits, times.
//!
//! The version of a schema changes whenever the topic's header or items do.

use messages::{Topic, topic};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::WireError;
use crate::checks::{self, Refuse};

/// A topic that may be sent over a network.
pub trait Wire:
    Topic<Header: Serialize + DeserializeOwned, Item: Serialize + DeserializeOwned>
{
    /// Name and version of the payload's schema.
    const SCHEMA: &'static str;
    /// Largest payload in bytes, both uncompressed and as received.
    const MAX_BYTES: usize;
    /// True if payloads are compressed.
    const COMPRESSED: bool = false;
    /// True if late joiners on another machine get the newest sample: for messages that hold until
    /// the next one.
    const KEPT: bool = false;
    /// True if the publisher computes it only while it has subscribers, so that relays subscribe
    /// only on request.
    const ON_DEMAND: bool = false;

    /// Checks for contradictions and invalid numbers.
    fn check(header: &Self::Header, items: &[Self::Item]) -> Result<(), WireError>;

    /// Calls `change` for each time of the sender's monotonic clock in the header.
    fn each_time(header: &mut Self::Header, change: impl FnMut(&mut i64));
}

/// A generic operation on a topic that is given by name.
pub trait Visit {
    type Output;
    fn visit<T: Wire>(self) -> Self::Output;
}

const KIB: usize = 1 << 10;
const MIB: usize = 1 << 20;

macro_rules! wire {
    ($($topic:ident = $schema:literal, $bytes:expr, $check:ident, [$($time:ident $(. $part:ident)?),*] $(, $trait:ident)*;)+) => {
        $(
            impl Wire for topic::$topic {
                const SCHEMA: &'static str = $schema;
                const MAX_BYTES: usize = $bytes;
                $(const $trait: bool = true;)*
                fn check(
                    header: &Self::Header,
                    items: &[Self::Item],
                ) -> Result<(), WireError> {
                    checks::$check(Refuse::on::<Self>(), header, items)
                }
                fn each_time(header: &mut Self::Header, mut change: impl FnMut(&mut i64)) {
                    $(change(&mut header.$time$(.$part)?);)*
                }
            }
        )+

        /// Calls `visitor` with the topic called `name`; `None` if there is none.
        pub fn by_name<V: Visit>(name: &str, visitor: V) -> Option<V::Output> {
            $(
                if name == <topic::$topic as Topic>::NAME {
                    return Some(visitor.visit::<topic::$topic>());
                }
            )+
            None
        }
    };
}

wire! {
    Scan = "Scan/v2", MIB, scan, [stamp.entered_ns];
    OdometryTopic = "Odometry/v2", 4 * KIB, odometry, [stamp.entered_ns];
    Map = "Map/v2", 64 * MIB, map, [stamp.entered_ns], COMPRESSED, KEPT;
    Boundary = "Boundary/v2", 32 * MIB, boundary, [stamp.entered_ns], COMPRESSED, KEPT;
    Maps = "Maps/v1", 64 * MIB, maps, [stamp.entered_ns], COMPRESSED, KEPT;
    VotesByMap = "VotesByMap/v1", MIB, votes_by_map, [stamp.entered_ns];
    Votes = "Votes/v7", 16 * MIB, votes, [stamp.entered_ns];
    Readings = "Readings/v1", 4 * MIB, readings, [stamp.entered_ns];
    Field = "Field/v1", 64 * MIB, field, [stamp.entered_ns], COMPRESSED, ON_DEMAND;
    Hypotheses = "Hypotheses/v5", MIB, hypotheses, [stamp.entered_ns, sent_ns];
    Particles = "Particles/v1", 32 * MIB, particles, [stamp.entered_ns];
    Tracked = "Pose/v1", 4 * KIB, tracked, [stamp.entered_ns, sent_ns];
    Attention = "Attention/v1", 4 * KIB, no_items, [stamp.entered_ns];
    InitialPoseTopic = "InitialPose/v2", 4 * KIB, initial_pose, [stamp.entered_ns];
    Beams = "Beams/v1", MIB, beams, [stamp.entered_ns];
    GroundTruthTopic = "GroundTruth/v2", 4 * KIB, ground_truth, [stamp.entered_ns];
    Region = "Region/v1", 64 * KIB, region, [stamp.entered_ns], KEPT;
    Save = "Save/v1", 4 * KIB, no_items, [stamp.entered_ns];
    Health = "Health/v1", 4 * KIB, health, [sent_ns];
    Log = "Log/v1", 4 * KIB, log, [written_ns];
}

#[cfg(test)]
mod tests {
    use iceoryx2_bb_elementary_traits::zero_copy_send::ZeroCopySend;

    use super::*;

    struct Versions;
    impl Visit for Versions {
        type Output = [&'static str; 3];
        fn visit<T: Wire>(self) -> Self::Output {
            // SAFETY: the name is only shown.
            [T::NAME, T::SCHEMA, unsafe { T::Header::type_name() }]
        }
    }

    /// A changed layout must change its schema.
    #[test]
    fn every_topic_has_a_schema_of_its_own_with_the_version_of_its_messages() {
        let mut schemas = std::collections::BTreeSet::new();
        for name in topic::NAMES {
            let [found, schema, header] = by_name(name, Versions).unwrap();
            assert_eq!(found, *name);
            let (schema_name, schema_version) = schema.split_once('/').unwrap();
            let (header_name, header_version) = header.split_once('/').unwrap();
            assert!(header_name.starts_with(schema_name), "{header}, {schema}");
            assert_eq!(header_version, schema_version, "{header}, {schema}");
            assert!(schemas.insert(schema), "{schema}");
        }
        assert!(by_name("scam", Versions).is_none());
    }
}
