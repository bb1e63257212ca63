//! Classification of the beams.

use engine::fit::{BeamClass, Ends};
use engine::peaks::Places;
use messages::{Beam, BeamFate};

/// Returns all beams of a scan with their classes at the best place.
pub(super) fn judged(ends: &Ends, places: &Places) -> impl Iterator<Item = Beam> {
    let voted = ends.judged(&places.classes).map(|beam| Beam {
        bearing: beam.bearing as f32,
        range_m: beam.reading_m as f32,
        weight: beam.weight as f32,
        fate: fate(beam.class) as u32,
    });
    let silent = ends.silent().iter().map(|&bearing| Beam {
        bearing: bearing as f32,
        range_m: f32::INFINITY,
        weight: 0.0,
        fate: BeamFate::NoReturn as u32,
    });
    voted.chain(silent)
}

fn fate(class: BeamClass) -> BeamFate {
    match class {
        BeamClass::Hit => BeamFate::Hit,
        BeamClass::Short => BeamFate::Short,
        BeamClass::Through => BeamFate::Through,
        BeamClass::Unknown => BeamFate::Unknown,
    }
}
