//! The rows of a case as a table that people read. Pure.

use std::fmt::Write as _;

use super::row::Row;
use super::scope::Table;

/// The columns behind the method's name, and how wide each is.
const COLUMNS: [(&str, usize); 7] = [
    ("CPU ms", 12),
    ("ratio", 12),
    ("found", 7),
    ("operations", 12),
    ("additions", 12),
    ("prepare ms", 12),
    ("map MB", 9),
];

const NAME: usize = 32;

pub(super) fn title(table: Table, instruction_set: &str) -> String {
    let about = match table {
        Table::Table1 => "The paper's Table 1: where was this scan taken, if its heading is known?",
        Table::Table2 => "The paper's Table 2: where was this scan taken, at what heading?",
        Table::Search => "The exact search over x, y and all headings.",
    };
    format!("{about}\nOne thread, {instruction_set}; every method has the same worlds and scans.\n")
}

pub(super) const LEGEND: &str = "
CPU ms      processor time for one scan, median; ~ where it is scaled up from some of the headings
ratio       that time against the fastest reverse projection above
found       scans located to 0.5 m and 10 degrees, of those measured
operations  and additions: as the paper counts them, 2mp and kmp against n(2m+1) and 2mn
            (n free cells, p boundary cells, m beams, k cells that a reading's votes reach)
prepare ms  processor time to prepare the map, once; map MB what is kept of that
";

/// The rows of one case, under what they have in common.
pub(super) fn block(rows: &[Row]) -> String {
    let Some(first) = rows.first() else {
        return String::new();
    };
    let mut text = format!("\n{}\n", case(first));
    let names = COLUMNS.map(|(name, _)| name.to_owned());
    let _ = writeln!(text, "{}", line("method", &names));
    for row in rows {
        let _ = match &row.skipped {
            Some(reason) => writeln!(text, "  {:<NAME$}  left out: {reason}", row.label),
            None => writeln!(text, "{}", line(row.label, &cells(row))),
        };
    }
    text
}

fn case(row: &Row) -> String {
    let headings = match row.headings {
        1 => "heading known".to_owned(),
        n => format!("{n} headings"),
    };
    format!(
        "{}, {size} x {size} cells, p/n {:.0} %, noise {} %, {} beams, {headings}, {} taper, k {:.0}",
        row.kind,
        100.0 * row.p_over_n,
        row.noise_percent,
        row.beams,
        row.taper,
        row.k,
        size = row.size,
    )
}

fn cells(row: &Row) -> [String; COLUMNS.len()] {
    let scaled = if row.scaled_from_headings.is_some() {
        "~"
    } else {
        ""
    };
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
    let found = row.found.map(|share| {
        let found = (share * row.scans as f64).round();
        format!("{found}/{}", row.scans)
    });
    [
        or_dash(row.cpu_ms.map(|ms| format!("{scaled}{}", milliseconds(ms)))),
        or_dash(row.ratio_to_reverse_projection.map(ratio)),
        or_dash(found),
        or_dash(row.operations.map(count)),
        or_dash(row.additions.map(count)),
        format!("{:.0}", row.prepare_cpu_ms),
        format!("{:.1}", row.map_bytes as f64 / 1e6),
    ]
}

fn line(name: &str, cells: &[String; COLUMNS.len()]) -> String {
    let mut line = format!("  {name:<NAME$}");
    for (cell, (_, width)) in cells.iter().zip(COLUMNS) {
        let _ = write!(line, "{cell:>width$}");
    }
    line
}

fn milliseconds(ms: f64) -> String {
    if ms < 1000.0 {
        format!("{ms:.2}")
    } else {
        format!("{ms:.0}")
    }
}

fn ratio(ratio: f64) -> String {
    if ratio < 100.0 {
        format!("{ratio:.2} x")
    } else {
        format!("{ratio:.0} x")
    }
}

/// A count with a unit of thousands.
fn count(value: f64) -> String {
    let units = [(1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k")];
    match units.iter().find(|(size, _)| value >= *size) {
        Some((size, unit)) => format!("{:.1} {unit}", value / size),
        None => format!("{value:.0}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row() -> Row {
        Row {
            label: "Reverse projection, search",
            kind: "rooms".into(),
            size: 1200,
            beams: 180,
            headings: 360,
            p_over_n: 0.0501,
            noise_percent: 10.0,
            taper: "trapezoid".into(),
            k: 22.6,
            cpu_ms: Some(12.345),
            ratio_to_reverse_projection: Some(1.0),
            scans: 5,
            found: Some(0.8),
            additions: Some(4.2e9),
            prepare_cpu_ms: 512.3,
            map_bytes: 83_700_000,
            ..Row::default()
        }
    }

    #[test]
    fn columns_stand_below_one_another() {
        let scaled = Row {
            cpu_ms: Some(25_000.4),
            ratio_to_reverse_projection: Some(2025.0),
            scaled_from_headings: Some(20),
            found: None,
            ..row()
        };
        let skipped = Row {
            skipped: Some("its table would take 18.0 GB".to_owned()),
            ..row()
        };
        assert_eq!(
            block(&[row(), scaled, skipped]),
            "
rooms, 1200 x 1200 cells, p/n 5 %, noise 10 %, 180 beams, 360 headings, trapezoid taper, k 23
  method                                CPU ms       ratio  found  operations   additions  prepare ms   map MB
  Reverse projection, search             12.35      1.00 x    4/5           -       4.2 G         512     83.7
  Reverse projection, search            ~25000      2025 x      -           -       4.2 G         512     83.7
  Reverse projection, search        left out: its table would take 18.0 GB
"
        );
    }
}
