//! The table of constants: what is found with each of them lowered and raised.

use serde_json::Value;

use super::figures::share;
use super::marks::{self, Figures, Place, Written};
use super::pages::Pages;
use super::recordings::{Folders, QUERIES};
use super::runs::{Lines, Runs};

/// The table has the values that are tried, and a row for the defaults.
pub(super) const PLACE: Place = ("docs/accuracy.md", "constants");
const DEFAULTS: &str = "(all as they are)";

/// Columns of a lower value, of a higher one, and of the best value for the sets but one.
const LOWER: usize = 3;
const HIGHER: usize = 4;
const LEFT_OUT: usize = 5;

/// Shares of the scans that are found, a set at a time, and how many of all are `Unique`, and wrong.
struct Outcome {
    found: Vec<f64>,
    unique: u64,
    wrong: u64,
}

impl Outcome {
    /// Of the lines of the sets, and of the total.
    fn of(lines: &Lines) -> Self {
        let found = lines
            .iter()
            .filter_map(|of| of["success_50cm_10deg"].as_f64());
        let total = &lines.last().unwrap_or(&Value::Null)["total"];
        let count = |key: &str| total[key].as_u64().unwrap_or_default();
        Outcome {
            found: found.collect(),
            unique: count("unique"),
            wrong: count("unique_wrong"),
        }
    }

    /// Mean over the sets, without one if it is given.
    fn mean(&self, without: Option<usize>) -> f64 {
        let sets = self.found.iter().enumerate();
        let kept = sets.filter(|&(set, _)| Some(set) != without);
        let (count, sum) = kept.fold((0.0, 0.0), |(n, sum), (_, found)| (n + 1.0, sum + found));
        sum / count
    }

    fn text(&self) -> String {
        let wrong = match self.wrong {
            0 => String::new(),
            wrong => format!(", {wrong} wrong"),
        };
        format!("{}, {}{wrong}", share(&self.mean(None).into()), self.unique)
    }
}

/// Evaluates each constant of the table with the values that are there.
pub(super) fn measure(folders: &Folders, pages: &Pages) -> anyhow::Result<Written> {
    let data = folders.data.clone().unwrap_or_default();
    let queries = QUERIES.iter().map(|(_, file)| data.join(file));
    let files: Vec<_> = queries
        .chain(folders.shipped().into_iter().take(2))
        .collect();
    let mut runs = Runs::default();
    let mut evaluate =
        |options: &[&str]| runs.evaluate(&[&["--every", "5"], options].concat(), &files);
    let default = evaluate(&[]);
    let mut planned = Vec::new();
    for row in marks::rows(pages.text(PLACE.0)?, PLACE.1)? {
        let option = row[1].trim_matches('`');
        if option.starts_with("--") {
            let values = [&row[LOWER], &row[HIGHER]].map(|cell| value_of(cell));
            let tried = values.clone().map(|value| evaluate(&[option, &value]));
            planned.push((option.to_owned(), values, tried));
        }
    }
    let found: Vec<_> = runs.run(2)?.iter().map(Outcome::of).collect();
    let default = &found[default];
    let mut rows = vec![(DEFAULTS.to_owned(), vec![(2, default.text())])];
    for (option, [lower, higher], tried) in planned {
        let [low, high] = tried.map(|run| &found[run]);
        let best = share(&left_out(&[default, low, high]).into());
        let cells = vec![
            (LOWER, format!("{lower}: {}", low.text())),
            (HIGHER, format!("{higher}: {}", high.text())),
            (LEFT_OUT, best),
        ];
        rows.push((option, cells));
    }
    Ok(Written {
        place: PLACE,
        figures: Figures::Rows(rows),
    })
}

/// The value of a cell such as `0.07: 93.8 %, 210`.
fn value_of(cell: &str) -> String {
    cell.split(':').next().unwrap_or_default().trim().to_owned()
}

/// Mean share that is found on each set with the value that is best on the others.
fn left_out(values: &[&Outcome]) -> f64 {
    let sets = values[0].found.len();
    let of_set = (0..sets).map(|set| {
        let better =
            |best: &Outcome, next: &Outcome| next.mean(Some(set)) > best.mean(Some(set)) + 1e-9;
        let best = values
            .iter()
            .fold(values[0], |best, next| match better(best, next) {
                true => next,
                false => best,
            });
        best.found[set]
    });
    of_set.sum::<f64>() / sets as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_value_for_a_set_is_chosen_on_the_others() {
        let outcome = |found: &[f64]| Outcome {
            found: found.to_vec(),
            unique: 7,
            wrong: 0,
        };
        let (default, other) = (outcome(&[0.5, 0.5, 0.5]), outcome(&[1.0, 0.5, 0.0]));
        // The other value is better on the first two, so that the last has it.
        assert_eq!(left_out(&[&default, &other]), (0.5 + 0.5 + 0.0) / 3.0);
        assert_eq!(other.text(), "50.0 %, 7");
        assert_eq!(value_of("0.07: 93.8 %, 210"), "0.07");
    }
}
