//! Colours, shapes and text and what they stand for, the same in every picture. Colours of
//! kinds are those of Okabe and Ito ("Color Universal Design", 2008), which the colour-blind
//! can distinguish; marks have a shape of their own besides.

use crate::drawing::{Color, TextStyle};
use engine::fit::BeamClass;
use messages::{TrackState, Verdict};

use super::shapes::Shape;

pub(super) const INK: Color = Color::rgb(0x1F_2933);
pub(super) const QUIET: Color = Color::rgb(0x66_7380);
pub(super) const FRAME: Color = Color::rgb(0xC3_CAD3);
pub(super) const GRATING: Color = Color::rgb(0xE7_EAEE);

/// The size of all text but titles, pixels of a picture of the common width: 7.6 points
/// where that is printed over two columns of a journal (180 mm). At half the width, for
/// one column, it is 6 points.
pub(super) const TEXT: f64 = 18.0;

pub(super) fn text(unit: f64) -> TextStyle {
    TextStyle::new(TEXT * unit, INK)
}

pub(super) fn title(unit: f64) -> TextStyle {
    TextStyle::new(23.0 * unit, INK).bold()
}

/// The style, smaller where the text would be wider than `width`.
pub(super) fn fitted(style: TextStyle, text: &str, width: f64) -> TextStyle {
    let natural = style.width_of(text);
    TextStyle {
        size: style.size * (width / natural.max(1.0)).clamp(0.0, 1.0),
        ..style
    }
}

/// Cells of the map, and what lies beyond it.
pub(super) const FREE: Color = Color::rgb(0xFF_FFFF);
pub(super) const OCCUPIED: Color = Color::rgb(0x25_2B33);
pub(super) const UNKNOWN: Color = Color::rgb(0xDF_E3E8);
pub(super) const OUTSIDE: Color = Color::rgb(0xD3_D8DF);
/// Cells that rays end in.
pub(super) const BOUNDARY: Color = Color::rgb(0xD5_5E00);

/// The best place, the others, and the true one.
pub(super) const BEST: Color = Color::rgb(0x1B_5FD0);
pub(super) const OTHER: Color = Color::rgb(0x5E_86BF);
pub(super) const TRUTH: Color = Color::rgb(0xC2_187A);

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

/// The colour and the shape of the end of a beam, and what it did in a few words.
pub(super) fn of_class(class: BeamClass) -> (Color, Shape, &'static str) {
    match class {
        BeamClass::Hit => (Color::rgb(0x00_9E73), Shape::Circle, "hit"),
        BeamClass::Short => (Color::rgb(0xE6_9F00), Shape::Triangle, "short"),
        BeamClass::Through => (Color::rgb(0xD5_5E00), Shape::Cross, "through a wall"),
        BeamClass::Unknown => {
            let name = "behind the unknown";
            (Color::rgb(0x56_5BB8), Shape::Diamond, name)
        }
    }
}

/// All verdicts, in the order in which legends name them.
pub(super) const VERDICTS: [Verdict; 4] = [
    Verdict::Unique,
    Verdict::Ambiguous,
    Verdict::PoorFit,
    Verdict::NoScan,
];

pub(super) fn of_verdict(verdict: Verdict) -> (Color, Shape) {
    match verdict {
        Verdict::Unique => (CURVES[0], Shape::Circle),
        Verdict::Ambiguous => (CURVES[5], Shape::Square),
        Verdict::PoorFit => (CURVES[1], Shape::Triangle),
        Verdict::NoScan => (QUIET, Shape::Diamond),
    }
}

/// The colour and the shape of a state of the tracker, and its name.
pub(super) fn of_state(state: TrackState) -> (Color, Shape, &'static str) {
    match state {
        TrackState::Unique => (CURVES[0], Shape::Circle, "unique"),
        TrackState::Doubtful => (CURVES[5], Shape::Square, "doubtful"),
        TrackState::Lost => (CURVES[1], Shape::Triangle, "lost"),
        TrackState::Searching => (QUIET, Shape::Diamond, "searching, at the true place"),
    }
}

/// Dark text on what is light, and white on what is dark.
pub(super) fn ink_on(color: Color) -> Color {
    let [red, green, blue] = [color.red, color.green, color.blue].map(f64::from);
    // Luma of ITU-R BT.601.
    let luma = 0.299 * red + 0.587 * green + 0.114 * blue;
    if luma > 140.0 { INK } else { Color::WHITE }
}

/// Colour of a share of the most votes, 0..=1 (magma from its light end, even to the colour-blind).
pub(super) fn heat(share: f64) -> Color {
    let share = share.clamp(0.0, 1.0);
    let colorous::Color { r, g, b } = colorous::MAGMA.eval_continuous(1.0 - 0.92 * share);
    let color = Color {
        red: r,
        green: g,
        blue: b,
        opacity: 1.0,
    };
    // The lightest colour is not yet that of paper.
    Color::WHITE.towards(color, 5.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_votes_are_darker() {
        let luma = |share| {
            let color = heat(share);
            299 * u32::from(color.red) + 587 * u32::from(color.green) + 114 * u32::from(color.blue)
        };
        assert_eq!(heat(0.0), Color::WHITE);
        let steps: Vec<u32> = (0..=20).map(|i| luma(f64::from(i) / 20.0)).collect();
        assert!(steps.windows(2).all(|pair| pair[1] < pair[0]), "{steps:?}");
    }

    #[test]
    fn kinds_differ_in_colour_and_in_shape() {
        let classes = CLASSES.map(|class| (of_class(class).0, of_class(class).1));
        for kinds in [classes, VERDICTS.map(of_verdict)] {
            for (i, (color, shape)) in kinds.iter().enumerate() {
                let mut others = kinds[i + 1..].iter();
                assert!(others.all(|other| other.0 != *color && other.1 != *shape));
            }
        }
        assert_eq!(ink_on(CURVES[5]), INK, "on orange");
        assert_eq!(ink_on(CURVES[0]), Color::WHITE, "on blue");
    }
}
