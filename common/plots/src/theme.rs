//! Colours and what they stand for, the same in every picture.

use drawing::Color;
use engine::fit::BeamClass;
use messages::{TrackState, Verdict};

/// Text and axes.
pub(super) const INK: Color = Color::rgb(0x1F_2933);
/// Text that stands back.
pub(super) const QUIET: Color = Color::rgb(0x66_7380);
/// Lines around panels.
pub(super) const FRAME: Color = Color::rgb(0xC3_CAD3);
/// Lines behind a chart.
pub(super) const GRATING: Color = Color::rgb(0xE7_EAEE);

/// Cells of the map, and what lies beyond it.
pub(super) const FREE: Color = Color::rgb(0xFF_FFFF);
pub(super) const OCCUPIED: Color = Color::rgb(0x25_2B33);
pub(super) const UNKNOWN: Color = Color::rgb(0xDF_E3E8);
pub(super) const OUTSIDE: Color = Color::rgb(0xD3_D8DF);
/// Cells that rays end in.
pub(super) const BOUNDARY: Color = Color::rgb(0xD6_3A2F);

/// The best place, the others, and the true one.
pub(super) const BEST: Color = Color::rgb(0x1B_5FD0);
pub(super) const OTHER: Color = Color::rgb(0x5E_86BF);
pub(super) const TRUTH: Color = Color::rgb(0xC2_187A);

/// Colours of the curves of a chart, which the colour-blind can distinguish (Okabe and Ito,
/// "Color Universal Design", 2008).
pub(super) const CURVES: [Color; 7] = [
    Color::rgb(0x00_72B2),
    Color::rgb(0xD5_5E00),
    Color::rgb(0x00_9E73),
    Color::rgb(0xCC_79A7),
    Color::rgb(0x56_B4E9),
    Color::rgb(0xE6_9F00),
    Color::rgb(0x1F_2933),
];

/// All classes of beams, in the order in which legends name them.
pub(super) const CLASSES: [BeamClass; 4] = [
    BeamClass::Hit,
    BeamClass::Short,
    BeamClass::Through,
    BeamClass::Unknown,
];

/// The colour of a beam, and what it did in a few words; the colours are those that the
/// colour-blind can distinguish, see [`CURVES`].
pub(super) fn of_class(class: BeamClass) -> (Color, &'static str) {
    match class {
        BeamClass::Hit => (Color::rgb(0x00_9E73), "hit"),
        BeamClass::Short => (Color::rgb(0xE6_9F00), "short"),
        BeamClass::Through => (Color::rgb(0xD5_5E00), "through a wall"),
        BeamClass::Unknown => (Color::rgb(0x56_5BB8), "behind the unknown"),
    }
}

/// The colour of a verdict.
pub(super) fn of_verdict(verdict: Verdict) -> Color {
    match verdict {
        Verdict::Unique => Color::rgb(0x0E_8A46),
        Verdict::Ambiguous => Color::rgb(0xD9_7A00),
        Verdict::PoorFit => Color::rgb(0xC6_2F2B),
        Verdict::NoScan => Color::rgb(0x6B_7785),
    }
}

/// The colour of a state of the tracker.
pub(super) fn of_state(state: TrackState) -> Color {
    match state {
        TrackState::Unique => Color::rgb(0x0E_8A46),
        TrackState::Doubtful => Color::rgb(0xD9_7A00),
        TrackState::Lost => Color::rgb(0xC6_2F2B),
        TrackState::Searching => Color::rgb(0x6B_7785),
    }
}
