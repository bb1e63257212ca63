//! Checks on a message from the network before it enters a graph.
//!
//! Nodes check again what they rely on. These checks reject what no correct sender sends: invalid
//! numbers, contradicting sizes, invalid text. Ranges of a scan may have any value, since lasers
//! encode a missing echo in many ways, all of which the engine handles.

use messages::{
    Beam, BeamsHeader, BoundaryCell, BoundaryHeader, Corner, FieldHeader, FieldKind, GroundTruth,
    HealthHeader, HypothesesHeader, Hypothesis, InitialPose, InitialPoseKind, LogHeader, LogLevel,
    MapHeader, MapSet, MapsHeader, NodeState, Odometry, Particle, ParticlesHeader, Pose2,
    PoseHeader, Reading, ReadingsHeader, RegionHeader, ScanHeader, Topic, TrackReason, TrackState,
    Verdict, Vote, VotesByMapHeader, VotesHeader,
};

use crate::WireError;

type Checked = Result<(), WireError>;

/// Refuses fields with a number that is not finite.
macro_rules! finite {
    ($refuse:ident, $of:ident: $($field:ident),+) => {
        Ok(())$(.and_then(|()| $refuse.unless_finite(stringify!($field), &$of.$field)))+
    };
}

pub(crate) fn scan(refuse: Refuse, header: &ScanHeader, _: &[f32]) -> Checked {
    finite!(refuse, header: angle_min, angle_increment, base_from_laser)
}

pub(crate) fn odometry(refuse: Refuse, header: &Odometry, items: &[u8]) -> Checked {
    finite!(refuse, header: odom_from_child, twist)?;
    refuse.unless_count("items", items.len(), 0)
}

pub(crate) fn map(refuse: Refuse, header: &MapHeader, cells: &[u8]) -> Checked {
    finite!(refuse, header: resolution_m, map_from_grid)?;
    refuse.unless_count("cells", cells.len(), area(header.width, header.height))?;
    header.check_id(cells).or_else(|error| {
        let expected = format!("{:016x}, that of the cells", error.expected);
        refuse.refuse("map_id", &format_args!("{:016x}", error.found), expected)
    })
}

pub(crate) fn boundary(refuse: Refuse, header: &BoundaryHeader, cells: &[BoundaryCell]) -> Checked {
    refuse.unless_count("cells", cells.len(), header.boundary_cells)
}

pub(crate) fn maps(refuse: Refuse, header: &MapsHeader, items: &[u8]) -> Checked {
    match MapSet::read(header, items) {
        Ok(_) => Ok(()),
        Err(error) => refuse.refuse("items", &error, "a set of maps".into()),
    }
}

pub(crate) fn votes_by_map(refuse: Refuse, _: &VotesByMapHeader, maps: &[VotesHeader]) -> Checked {
    maps.iter()
        .try_for_each(|header| votes_header(refuse, header))
}

fn votes_header(refuse: Refuse, header: &VotesHeader) -> Checked {
    finite!(refuse, header: known_heading, bearing_rounding, beam_arc_m, base_from_laser)
}

pub(crate) fn votes(refuse: Refuse, header: &VotesHeader, votes: &[Vote]) -> Checked {
    votes_header(refuse, header)?;
    refuse.unless_count("votes", votes.len(), header.total)
}

pub(crate) fn readings(refuse: Refuse, _: &ReadingsHeader, readings: &[Reading]) -> Checked {
    for reading in readings {
        finite!(refuse, reading: from_x, from_y, bearing, weight)?;
    }
    Ok(())
}

pub(crate) fn field(refuse: Refuse, header: &FieldHeader, pixels: &[u16]) -> Checked {
    finite!(refuse, header: heading)?;
    refuse.unless_known("kind", header.kind, FieldKind::from_code)?;
    refuse.unless_count("pixels", pixels.len(), area(header.width, header.height))
}

pub(crate) fn hypotheses(
    refuse: Refuse,
    header: &HypothesesHeader,
    hypotheses: &[Hypothesis],
) -> Checked {
    refuse.unless_known("verdict", header.verdict, Verdict::from_code)?;
    finite!(refuse, header: confidence, inlier_share)?;
    for hypothesis in hypotheses {
        finite!(refuse, hypothesis: map_from_laser, map_from_base, score, probability, covariance)?;
    }
    Ok(())
}

pub(crate) fn particles(refuse: Refuse, _: &ParticlesHeader, particles: &[Particle]) -> Checked {
    for particle in particles {
        finite!(refuse, particle: map_from_base)?;
    }
    Ok(())
}

pub(crate) fn tracked(refuse: Refuse, header: &PoseHeader, words: &[u8]) -> Checked {
    refuse.unless_known("state", header.state, TrackState::from_code)?;
    refuse.unless_known("reason", header.reason, TrackReason::from_code)?;
    finite!(refuse, header: map_from_laser, map_from_base, map_from_odom)?;
    finite!(refuse, header: laser_covariance, base_covariance, since_m, probability, lead, score)?;
    refuse.unless_text("words", words, PoseHeader::WORDS_CAPACITY)
}

pub(crate) fn no_items<H>(refuse: Refuse, _: &H, items: &[u8]) -> Checked {
    refuse.unless_count("items", items.len(), 0)
}

pub(crate) fn initial_pose(refuse: Refuse, header: &InitialPose, items: &[u8]) -> Checked {
    refuse.unless_known("kind", header.kind, InitialPoseKind::from_code)?;
    finite!(refuse, header: map_from_base, covariance)?;
    refuse.unless_count("items", items.len(), 0)
}

pub(crate) fn beams(refuse: Refuse, header: &BeamsHeader, beams: &[Beam]) -> Checked {
    finite!(refuse, header: map_from_laser)?;
    for beam in beams {
        finite!(refuse, beam: bearing, weight)?;
    }
    Ok(())
}

pub(crate) fn ground_truth(refuse: Refuse, header: &GroundTruth, items: &[u8]) -> Checked {
    finite!(refuse, header: map_from_laser)?;
    refuse.unless_count("items", items.len(), 0)
}

pub(crate) fn region(refuse: Refuse, _: &RegionHeader, corners: &[Corner]) -> Checked {
    for corner in corners {
        finite!(refuse, corner: x, y)?;
    }
    Ok(())
}

pub(crate) fn health(refuse: Refuse, header: &HealthHeader, error: &[u8]) -> Checked {
    refuse.unless_known("state", header.state, NodeState::from_code)?;
    refuse.unless_text("last error", error, HealthHeader::ERROR_CAPACITY)
}

pub(crate) fn log(refuse: Refuse, header: &LogHeader, line: &[u8]) -> Checked {
    refuse.unless_known("level", header.level, LogLevel::from_code)?;
    refuse.unless_text("line", line, LogHeader::TEXT_CAPACITY)
}

fn area(width: u32, height: u32) -> u64 {
    u64::from(width) * u64::from(height)
}

/// A field of numbers.
trait Numbers {
    fn numbers(&self) -> impl IntoIterator<Item = f64>;
}

impl Numbers for f64 {
    fn numbers(&self) -> impl IntoIterator<Item = f64> {
        [*self]
    }
}

impl Numbers for f32 {
    fn numbers(&self) -> impl IntoIterator<Item = f64> {
        [f64::from(*self)]
    }
}

impl Numbers for Pose2 {
    fn numbers(&self) -> impl IntoIterator<Item = f64> {
        [self.x, self.y, self.yaw]
    }
}

impl Numbers for [f64; 9] {
    fn numbers(&self) -> impl IntoIterator<Item = f64> {
        *self
    }
}

/// Builds the errors of one topic.
#[derive(Clone, Copy)]
pub(crate) struct Refuse {
    topic: &'static str,
}

impl Refuse {
    pub(crate) fn on<T: Topic>() -> Self {
        Refuse { topic: T::NAME }
    }

    fn unless_finite(&self, field: &'static str, of: &impl Numbers) -> Checked {
        match of.numbers().into_iter().find(|number| !number.is_finite()) {
            Some(found) => self.refuse(field, &found, "a finite number".into()),
            None => Ok(()),
        }
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
    use messages::topic;

    use super::*;
    use crate::Wire;

    fn check<T: Wire>(header: &T::Header, items: &[T::Item], expected: &str) {
        let outcome = T::check(header, items);
        let said = outcome.err().map_or("accepted".into(), |e| e.to_string());
        assert_eq!(said, expected);
    }

    #[test]
    fn numbers_that_are_none_are_refused() {
        let mut header: ScanHeader = Zeroable::zeroed();
        check::<topic::Scan>(&header, &[f32::NAN, f32::INFINITY], "accepted");
        header.angle_increment = f64::NAN;
        let expected = "topic scan: angle_increment is NaN, but must be a finite number";
        check::<topic::Scan>(&header, &[], expected);

        let mut place: Hypothesis = Zeroable::zeroed();
        check::<topic::Hypotheses>(&Zeroable::zeroed(), &[place], "accepted");
        place.map_from_laser.yaw = f64::NEG_INFINITY;
        let expected = "topic hypotheses: map_from_laser is -inf, but must be a finite number";
        check::<topic::Hypotheses>(&Zeroable::zeroed(), &[place], expected);
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
        check::<topic::Map>(&header, &[0; 3], expected);
        let mut header = MapHeader {
            width: 3,
            height: 1,
            ..MapHeader::default()
        };
        let expected = format!(
            "topic map: map_id is 0000000000000000, but must be {:016x}, that of the cells",
            header.id_of(&[0; 3])
        );
        check::<topic::Map>(&header, &[0; 3], &expected);
        header.map_id = header.id_of(&[0; 3]);
        check::<topic::Map>(&header, &[0; 3], "accepted");
        check::<topic::Boundary>(&Zeroable::zeroed(), &[], "accepted");
        check::<topic::Votes>(
            &Zeroable::zeroed(),
            &[Zeroable::zeroed()],
            "topic votes: votes is 1, but must be 0, as the header says",
        );
    }

    #[test]
    fn text_and_codes_are_those_of_this_version() {
        let mut header: HealthHeader = Zeroable::zeroed();
        check::<topic::Health>(&header, b"all is well", "accepted");
        check::<topic::Health>(
            &header,
            &[b'x'; 1025],
            "topic health: last error is 1025, but must be at most 1024 bytes",
        );
        let error = topic::Health::check(&header, &[0xff]).unwrap_err();
        assert!(error.to_string().ends_with("but must be UTF-8"), "{error}");
        header.state = 5;
        check::<topic::Health>(
            &header,
            b"",
            "topic health: state is 5, but must be one of the codes of this version",
        );
    }
}
