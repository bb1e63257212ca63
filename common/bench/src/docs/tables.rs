//! Tables of the pages: where they stand, and the figures that `backcast evaluate --json` gives for
//! their rows. Pure.

use serde_json::Value;

use super::figures::{centimetres, metres, milliseconds, number, percent, share, share_of, turn};
use super::marks::{Cells, Figures, Place, Written};

/// Rows of a table, each with the JSON of its recording.
pub(super) type Rows = Vec<(String, Value)>;

/// Table with a row for each recording.
pub(super) struct Table {
    pub(super) place: Place,
    /// Columns with figures, and the figures of a row.
    cells: fn(&Value) -> Cells,
}

impl Table {
    pub(super) fn of(&self, rows: &[(String, Value)]) -> Written {
        let rows = rows
            .iter()
            .map(|(name, of)| (name.clone(), (self.cells)(of)));
        Written {
            place: self.place,
            figures: Figures::Rows(rows.collect()),
        }
    }
}

/// Single scans of the shipped recordings.
pub(super) const SHIPPED_SCANS: [Table; 3] = [
    Table {
        place: ("README.md", "scans"),
        cells: |of| {
            vec![
                (3, number(&of["truths"])),
                (4, share(&of["success_50cm_10deg"])),
                (5, share(&of["success_20cm_3deg"])),
                (7, errors(of)),
            ]
        },
    },
    Table {
        place: ("docs/accuracy.md", "shipped"),
        cells: |of| {
            vec![
                (2, number(&of["truths"])),
                (3, share(&of["success_50cm_10deg"])),
                (4, number(&of["unique"])),
                (5, number(&of["unique_wrong"])),
                (6, errors(of)),
                (7, in_ellipse(of)),
            ]
        },
    },
    Table {
        place: ("docs/benchmark.md", "scans"),
        cells: |of| {
            let error = metres(&of["error_m"]["median"]);
            vec![
                (2, number(&of["truths"])),
                (3, share(&of["success_50cm_10deg"])),
                (4, share(&of["success_20cm_3deg"])),
                (5, number(&of["unique"])),
                (6, number(&of["unique_wrong"])),
                (
                    7,
                    format!("{error} m, {}", turn(&of["error_deg"]["median"])),
                ),
            ]
        },
    },
];

/// Single scans of the evaluation data.
pub(super) const SCANS: Table = Table {
    place: ("docs/accuracy.md", "data"),
    cells: |of| {
        vec![
            (2, number(&of["truths"])),
            (3, share(&of["success_50cm_10deg"])),
            (4, share(&of["top16_recall"])),
            (5, share_of(&of["unique"], &of["truths"])),
            (6, number(&of["unique_wrong"])),
            (7, errors(of)),
            (8, in_ellipse(of)),
        ]
    },
};

/// Times of single scans: of the shipped recordings, and of the evaluation data.
pub(super) const SHIPPED_TIMES: Table = Table {
    place: ("README.md", "scans"),
    cells: |of| vec![(6, milliseconds(&of["cpu_ms"]))],
};
pub(super) const TIMES: Table = Table {
    place: ("docs/accuracy.md", "data"),
    cells: |of| vec![(9, milliseconds(&of["cpu_ms"]))],
};

/// Scans whose place was made unknown on the map.
pub(super) const ERASED: Table = Table {
    place: ("docs/accuracy.md", "erased"),
    cells: |of| counts(2, of, &["truths", "unique", "unique_wrong"]),
};

/// Scans on the maps of other buildings.
pub(super) const ELSEWHERE: Table = Table {
    place: ("docs/accuracy.md", "elsewhere"),
    cells: |of| counts(3, of, &["scans", "Unique", "Ambiguous", "PoorFit"]),
};

/// How the probabilities turned out.
pub(super) const PROBABILITIES: Table = Table {
    place: ("docs/accuracy.md", "probabilities"),
    cells: |of| {
        vec![
            (2, number(&of["answers"])),
            (3, share(&of["mean"])),
            (4, share_of(&of["right"], &of["answers"])),
        ]
    },
};

/// Drives from their first scans, judged as the answers of another program.
pub(super) const FROM_FIRST_SCAN: Table = Table {
    place: ("docs/benchmark.md", "drives"),
    cells: |of| {
        let errors = &of["trajectory"];
        let ape = ["rmse", "max"].map(|of| metres(&errors["ape_m"][of]));
        let step = metres(&errors["rpe_m"]["rmse"]);
        vec![
            (2, number(&of["truths"])),
            (3, number(&of["answered"])),
            (4, share(&of["success_50cm_10deg"])),
            (5, number(&of["wrong_scans"])),
            (6, format!("{} m", ape.join(" / "))),
            (7, format!("{step} m, {}", turn(&errors["rpe_deg"]["rmse"]))),
        ]
    },
};

pub(super) const TRACKED: Table = Table {
    place: ("docs/tracking.md", "drives"),
    cells: |of| {
        let right = ["1", "2", "5", "10", "20"].map(|metres| percent(&of["right"][metres]));
        let rms = centimetres(&of["rms_m"]);
        let mut cells: Cells = (2..).zip(right).collect();
        cells.extend([
            (7, number(&of["wrong_starts"])),
            (8, number(&of["losses"])),
            (9, format!("{rms} {}", turn(&of["rms_deg"]))),
            (10, format!("{} %", percent(&of["in_ellipse"]))),
        ]);
        cells
    },
};

pub(super) const INTERRUPTED: Table = Table {
    place: ("docs/tracking.md", "interruptions"),
    cells: |of| {
        let wrong = |what: &str| {
            let wrong = number(&of[format!("{what}_wrong")]);
            format!("{wrong} of {}", number(&of[what]))
        };
        vec![
            (2, percent(&of["kidnaps_noticed_within_2"])),
            (3, percent(&of["kidnaps_right_after_5_m"])),
            (4, wrong("kidnaps")),
            (5, percent(&of["outages_right_after_5_m"])),
            (6, wrong("outages")),
        ]
    },
};

/// Figures in sentences: the total of the shipped scans, and of all.
pub(super) const SHIPPED_UNIQUE: Place = ("README.md", "unique");
pub(super) const SHIPPED_WRONG: Place = ("README.md", "wrong");
pub(super) const ALL_TRUTHS: Place = ("docs/accuracy.md", "truths");
pub(super) const ALL_UNIQUE: Place = ("docs/accuracy.md", "unique");
pub(super) const ALL_WRONG: Place = ("docs/accuracy.md", "wrong");

/// Places of all figures of this file.
pub(super) fn places() -> Vec<Place> {
    let single = [
        SCANS,
        ERASED,
        ELSEWHERE,
        PROBABILITIES,
        FROM_FIRST_SCAN,
        TRACKED,
        INTERRUPTED,
    ];
    let tables = SHIPPED_SCANS.into_iter().chain(single);
    let mut places: Vec<Place> = tables.map(|table| table.place).collect();
    places.extend([
        SHIPPED_UNIQUE,
        SHIPPED_WRONG,
        ALL_TRUTHS,
        ALL_UNIQUE,
        ALL_WRONG,
    ]);
    places
}

/// Figure in a sentence.
pub(super) fn value(place: Place, of: &Value) -> Written {
    Written {
        place,
        figures: Figures::Value(number(of)),
    }
}

fn counts(first: usize, of: &Value, keys: &[&str]) -> Cells {
    let counts = keys.iter().map(|key| number(&of[key]));
    (first..).zip(counts).collect()
}

/// Median errors of the scans that were found.
fn errors(of: &Value) -> String {
    let distance = centimetres(&of["error_m"]["median"]);
    format!("{distance}, {}", turn(&of["error_deg"]["median"]))
}

/// Share of the `Unique` whose true position is in the ellipse of 95 %.
fn in_ellipse(of: &Value) -> String {
    share_of(&of["unique_in_ellipse"], &of["unique"])
}
