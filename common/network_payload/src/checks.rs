//! Checks on a message from the network before it enters a graph.
//!
//! Nodes check again what they rely on. These checks reject what no correct sender sends: invalid
//! numbers, contradicting sizes, invalid text. Ranges of a scan may have any value, since lasers
//! encode a missing echo in many ways, all of which the engine handles.

use messages::{
    AttentionHeader, Beam, BeamsHeader, BoundaryCell, BoundaryHeader, Corner, FieldHeader,
    FieldKind, GroundTruth, HealthHeader, HypothesesHeader, Hypothesis, InitialPose,
    InitialPoseKind, LogHeader, LogLevel, MapHeader, MapSet, MapsHeader, NodeState, Odometry,
    Particle, ParticlesHeader, Pose2, PoseHeader, Reading, ReadingsHeader, RegionHeader,
    SaveHeader, ScanHeader, Topic, TrackReason, TrackState, Verdict, Vote, VotesByMapHeader,
    VotesHeader, topic,
};

use crate::WireError;

type Checked = Result<(), WireError>;

/// Allowed values of a number.
const FINITE: &str = "a finite number";

pub(crate) fn scan(header: &ScanHeader, _: &[f32]) -> Checked {
    let refuse = Refuse::on::<topic::Scan>();
    refuse.unless_finite("angle_min", header.angle_min)?;
    refuse.unless_finite("angle_increment", header.angle_increment)?;
    refuse.unless_pose("base_from_laser", header.base_from_laser)
}

pub(crate) fn odometry(header: &Odometry, items: &[u8]) -> Checked {
    let refuse = Refuse::on::<topic::OdometryTopic>();
    refuse.unless_pose("odom_from_child", header.odom_from_child)?;
    refuse.unless_pose("twist", header.twist)?;
    refuse.unless_count("items", items.len(), 0)
}

pub(crate) fn map(header: &MapHeader, cells: &[u8]) -> Checked {
    let refuse = Refuse::on::<topic::Map>();
    refuse.unless_finite("resolution_m", header.resolution_m)?;
    refuse.unless_pose("map_from_grid", header.map_from_grid)?;
    refuse.unless_count("cells", cells.len(), area(header.width, header.height))?;
    header.check_id(cells).or_else(|error| {
        let expected = format!("{:016x}, that of the cells", error.expected);
        refuse.refuse("map_id", &format_args!("{:016x}", error.found), expected)
    })
}

pub(crate) fn boundary(header: &BoundaryHeader, cells: &[BoundaryCell]) -> Checked {
    let refuse = Refuse::on::<topic::Boundary>();
    refuse.unless_count("cells", cells.len(), header.boundary_cells)
}

pub(crate) fn maps(header: &MapsHeader, items: &[u8]) -> Checked {
    let refuse = Refuse::on::<topic::Maps>();
    match MapSet::read(header, items) {
        Ok(_) => Ok(()),
        Err(error) => refuse.refuse("items", &error, "a set of maps".into()),
    }
}

pub(crate) fn votes_by_map(_: &VotesByMapHeader, maps: &[VotesHeader]) -> Checked {
    let refuse = Refuse::on::<topic::VotesByMap>();
    maps.iter()
        .try_for_each(|header| votes_header(refuse, header))
}

fn votes_header(refuse: Refuse, header: &VotesHeader) -> Checked {
    refuse.unless_finite("known_heading", header.known_heading)?;
    refuse.unless_finite("bearing_rounding", header.bearing_rounding)?;
    refuse.unless_finite("beam_arc_m", header.beam_arc_m)?;
    refuse.unless_pose("base_from_laser", header.base_from_laser)
}

pub(crate) fn votes(header: &VotesHeader, votes: &[Vote]) -> Checked {
    let refuse = Refuse::on::<topic::Votes>();
    votes_header(refuse, header)?;
    refuse.unless_count("votes", votes.len(), header.total)
}

pub(crate) fn readings(_: &ReadingsHeader, readings: &[Reading]) -> Checked {
    let refuse = Refuse::on::<topic::Readings>();
    for reading in readings {
        refuse.unless_finite("from_x", reading.from_x)?;
        refuse.unless_finite("from_y", reading.from_y)?;
        refuse.unless_finite("bearing", reading.bearing)?;
        refuse.unless_finite("weight", reading.weight)?;
    }
    Ok(())
}

pub(crate) fn field(header: &FieldHeader, pixels: &[u16]) -> Checked {
    let refuse = Refuse::on::<topic::Field>();
    refuse.unless_finite("heading", header.heading)?;
    refuse.unless_known("kind", header.kind, FieldKind::from_code)?;
    refuse.unless_count("pixels", pixels.len(), area(header.width, header.height))
}

pub(crate) fn hypotheses(header: &HypothesesHeader, hypotheses: &[Hypothesis]) -> Checked {
    let refuse = Refuse::on::<topic::Hypotheses>();
    refuse.unless_known("verdict", header.verdict, Verdict::from_code)?;
    refuse.unless_finite("confidence", header.confidence.into())?;
    refuse.unless_finite("inlier_share", header.inlier_share.into())?;
    for hypothesis in hypotheses {
        refuse.unless_pose("map_from_laser", hypothesis.map_from_laser)?;
        refuse.unless_pose("map_from_base", hypothesis.map_from_base)?;
        refuse.unless_finite("score", hypothesis.score.into())?;
        refuse.unless_finite("probability", hypothesis.probability.into())?;
        refuse.unless_all_finite("covariance", &hypothesis.covariance)?;
    }
    Ok(())
}

pub(crate) fn particles(_: &ParticlesHeader, particles: &[Particle]) -> Checked {
    let refuse = Refuse::on::<topic::Particles>();
    for particle in particles {
        refuse.unless_pose("map_from_base", particle.map_from_base)?;
    }
    Ok(())
}

pub(crate) fn tracked(header: &PoseHeader, words: &[u8]) -> Checked {
    let refuse = Refuse::on::<topic::Tracked>();
    refuse.unless_known("state", header.state, TrackState::from_code)?;
    refuse.unless_known("reason", header.reason, TrackReason::from_code)?;
    refuse.unless_pose("map_from_laser", header.map_from_laser)?;
    refuse.unless_pose("map_from_base", header.map_from_base)?;
    refuse.unless_pose("map_from_odom", header.map_from_odom)?;
    refuse.unless_all_finite("laser_covariance", &header.laser_covariance)?;
    refuse.unless_all_finite("base_covariance", &header.base_covariance)?;
    refuse.unless_finite("since_m", header.since_m)?;
    refuse.unless_finite("probability", header.probability)?;
    refuse.unless_finite("lead", header.lead)?;
    refuse.unless_finite("score", header.score)?;
    refuse.unless_text("words", words, PoseHeader::WORDS_CAPACITY)
}

pub(crate) fn attention(_: &AttentionHeader, items: &[u8]) -> Checked {
    Refuse::on::<topic::Attention>().unless_count("items", items.len(), 0)
}

pub(crate) fn initial_pose(header: &InitialPose, items: &[u8]) -> Checked {
    let refuse = Refuse::on::<topic::InitialPoseTopic>();
    refuse.unless_known("kind", header.kind, InitialPoseKind::from_code)?;
    refuse.unless_pose("map_from_base", header.map_from_base)?;
    refuse.unless_all_finite("covariance", &header.covariance)?;
    refuse.unless_count("items", items.len(), 0)
}

pub(crate) fn beams(header: &BeamsHeader, beams: &[Beam]) -> Checked {
    let refuse = Refuse::on::<topic::Beams>();
    refuse.unless_pose("map_from_laser", header.map_from_laser)?;
    for beam in beams {
        refuse.unless_finite("bearing", beam.bearing.into())?;
        refuse.unless_finite("weight", beam.weight.into())?;
    }
    Ok(())
}

pub(crate) fn ground_truth(header: &GroundTruth, items: &[u8]) -> Checked {
    let refuse = Refuse::on::<topic::GroundTruthTopic>();
    refuse.unless_pose("map_from_laser", header.map_from_laser)?;
    refuse.unless_count("items", items.len(), 0)
}

pub(crate) fn region(_: &RegionHeader, corners: &[Corner]) -> Checked {
    let refuse = Refuse::on::<topic::Region>();
    for corner in corners {
        refuse.unless_finite("x", corner.x)?;
        refuse.unless_finite("y", corner.y)?;
    }
    Ok(())
}

pub(crate) fn save(_: &SaveHeader, items: &[u8]) -> Checked {
    Refuse::on::<topic::Save>().unless_count("items", items.len(), 0)
}

pub(crate) fn health(header: &HealthHeader, error: &[u8]) -> Checked {
    let refuse = Refuse::on::<topic::Health>();
    refuse.unless_known("state", header.state, NodeState::from_code)?;
    refuse.unless_text("last error", error, HealthHeader::ERROR_CAPACITY)
}

pub(crate) fn log(header: &LogHeader, line: &[u8]) -> Checked {
    let refuse = Refuse::on::<topic::Log>();
    refuse.unless_known("level", header.level, LogLevel::from_code)?;
    refuse.unless_text("line", line, LogHeader::TEXT_CAPACITY)
}

fn area(width: u32, height: u32) -> u64 {
    u64::from(width) * u64::from(height)
}

/// Builds the errors of one topic.
#[derive(Clone, Copy)]
struct Refuse {
    topic: &'static str,
}

impl Refuse {
    fn on<T: Topic>() -> Self {
        Refuse { topic: T::NAME }
    }

    fn unless_finite(&self, field: &'static str, value: f64) -> Checked {
        if value.is_finite() {
            return Ok(());
        }
        self.refuse(field, &value, FINITE.into())
    }

    fn unless_pose(&self, field: &'static str, pose: Pose2) -> Checked {
        self.unless_all_finite(field, &[pose.x, pose.y, pose.yaw])
    }

    fn unless_all_finite(&self, field: &'static str, values: &[f64]) -> Checked {
        let mut values = values.iter();
        values.try_for_each(|&value| self.unless_finite(field, value))
    }

    fn unless_count(&self, field: &'static str, found: usize, header: u64) -> Checked {
        if u64::try_from(found) == Ok(header) {
            return Ok(());
        }
        self.refuse(field, &found, format!("{header}, as the header says"))
    }

    fn unless_known<C: Copy + Into<u64>, K>(
        &self,
        field: &'static str,
        code: C,
        from_code: impl Fn(C) -> Option<K>,
    ) -> Checked {
        if from_code(code).is_some() {
            return Ok(());
        }
        self.refuse(
            field,
            &code.into(),
            "one of the codes of this version".into(),
        )
    }

    fn unless_text(&self, field: &'static str, bytes: &[u8], most: usize) -> Checked {
        if bytes.len() > most {
            return self.refuse(field, &bytes.len(), format!("at most {most} bytes"));
        }
        match std::str::from_utf8(bytes) {
            Ok(_) => Ok(()),
            Err(error) => self.refuse(field, &error, "UTF-8".into()),
        }
    }

    fn refuse(
        &self,
        field: &'static str,
        found: &dyn std::fmt::Display,
        allowed: String,
    ) -> Checked {
        Err(WireError::Field {
            topic: self.topic,
            field,
            found: found.to_string(),
            allowed,
        })
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;

    fn check(outcome: Checked, expected: &str) {
        let said = outcome.err().map_or("accepted".into(), |e| e.to_string());
        assert_eq!(said, expected);
    }

    #[test]
    fn numbers_that_are_none_are_refused() {
        let mut header: ScanHeader = Zeroable::zeroed();
        check(scan(&header, &[f32::NAN, f32::INFINITY]), "accepted");
        header.angle_increment = f64::NAN;
        let expected = "topic scan: angle_increment is NaN, but must be a finite number";
        check(scan(&header, &[]), expected);

        let mut place: Hypothesis = Zeroable::zeroed();
        check(hypotheses(&Zeroable::zeroed(), &[place]), "accepted");
        place.map_from_laser.yaw = f64::NEG_INFINITY;
        let expected = "topic hypotheses: map_from_laser is -inf, but must be a finite number";
        check(hypotheses(&Zeroable::zeroed(), &[place]), expected);
    }

    #[test]
    fn sizes_that_contradict_each_other_are_refused() {
        let header = MapHeader {
            width: u32::MAX,
            height: u32::MAX,
            ..MapHeader::default()
        };
        let expected =
            "topic map: cells is 3, but must be 18446744065119617025, as the header says";
        check(map(&header, &[0; 3]), expected);
        let mut header = MapHeader {
            width: 3,
            height: 1,
            ..MapHeader::default()
        };
        let expected = format!(
            "topic map: map_id is 0000000000000000, but must be {:016x}, that of the cells",
            header.id_of(&[0; 3])
        );
        check(map(&header, &[0; 3]), &expected);
        header.map_id = header.id_of(&[0; 3]);
        check(map(&header, &[0; 3]), "accepted");
        check(boundary(&Zeroable::zeroed(), &[]), "accepted");
        check(
            votes(&Zeroable::zeroed(), &[Zeroable::zeroed()]),
            "topic votes: votes is 1, but must be 0, as the header says",
        );
    }

    #[test]
    fn text_and_codes_are_those_of_this_version() {
        let mut header: HealthHeader = Zeroable::zeroed();
        check(health(&header, b"all is well"), "accepted");
        check(
            health(&header, &[b'x'; 1025]),
            "topic health: last error is 1025, but must be at most 1024 bytes",
        );
        let outcome = health(&header, &[0xff]).unwrap_err().to_string();
        assert!(outcome.ends_with("but must be UTF-8"), "{outcome}");
        header.state = 5;
        check(
            health(&header, b""),
            "topic health: state is 5, but must be one of the codes of this version",
        );
    }
}
