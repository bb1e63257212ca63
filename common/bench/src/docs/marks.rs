//! Marks in the text of a page, and the figures between them. Pure.

use std::ops::Range;

use anyhow::{Context, bail};

/// Marks around a table, or around one figure in a sentence.
const OPEN: &str = "<!-- figures: ";
const NAMED: &str = " -->";
const CLOSE: &str = "<!-- /figures -->";

/// Marked place: a page by its path in the checkout, and the name of its mark.
pub(super) type Place = (&'static str, &'static str);

/// Figures of one place.
#[derive(Debug, Clone)]
pub(super) struct Written {
    pub(super) place: Place,
    pub(super) figures: Figures,
}

#[derive(Debug, Clone)]
pub(super) enum Figures {
    /// Rows of a table, by the text with which their first cells start. The page may have more.
    Rows(Vec<(String, Cells)>),
    /// The figure between the marks, wherever the page has them.
    Value(String),
}

/// Columns with figures, the first cell being column 1.
pub(super) type Cells = Vec<(usize, String)>;

/// Cells of the rows of a table, as they are on the page; the first one is empty, as is what stands
/// before the first `|`.
/// Fails if a mark of the page is not closed.
pub(super) fn rows(text: &str, mark: &str) -> anyhow::Result<Vec<Vec<String>>> {
    let mut rows = Vec::new();
    for (_, range) in places(text)?.into_iter().filter(|(name, _)| name == mark) {
        let lines = text[range].lines().filter(|line| line.starts_with('|'));
        let trimmed = |line: &str| line.split('|').map(|cell| cell.trim().to_owned()).collect();
        rows.extend(lines.skip(2).map(trimmed));
    }
    Ok(rows)
}

/// Writes figures into the text of their page. Returns a sentence on each that was another one there.
/// Fails if the page has no such row or column.
pub(super) fn write(text: &mut String, written: &Written) -> anyhow::Result<Vec<String>> {
    let (_, mark) = written.place;
    let mut differences = Vec::new();
    for (_, range) in places(text)?
        .into_iter()
        .rev()
        .filter(|(name, _)| name == mark)
    {
        let found = &text[range.clone()];
        let made = match &written.figures {
            Figures::Value(value) => {
                differences.extend(differs(written.place, "", found, value));
                value.clone()
            }
            Figures::Rows(rows) => {
                let (made, others) = table(written.place, found, rows)?;
                differences.extend(others);
                made
            }
        };
        text.replace_range(range, &made);
    }
    Ok(differences)
}

/// Names and contents of all marked places, in the order of the text.
fn places(text: &str) -> anyhow::Result<Vec<(String, Range<usize>)>> {
    let mut places = Vec::new();
    let mut at = 0;
    while let Some(open) = text[at..].find(OPEN) {
        let rest = &text[at + open + OPEN.len()..];
        let Some((name, rest)) = rest.split_once(NAMED) else {
            bail!("a mark `{OPEN}` is not closed by `{NAMED}`");
        };
        let from = text.len() - rest.len();
        let content = rest.split_once(CLOSE).map(|(content, _)| content);
        let Some(content) = content.filter(|content| !content.contains(OPEN)) else {
            bail!("the mark `{OPEN}{name}{NAMED}` is not closed by `{CLOSE}`");
        };
        at = from + content.len();
        places.push((name.to_owned(), from..at));
    }
    Ok(places)
}

/// Checks that a page has the marks of its places, and no others.
/// The error names the mark that is missing, unknown or not closed.
pub(super) fn check(page: &str, text: &str, known: &[Place]) -> anyhow::Result<()> {
    let found = places(text).with_context(|| page.to_owned())?;
    let of_page = known.iter().filter(|(of, _)| *of == page);
    let names: Vec<&str> = of_page.map(|(_, mark)| *mark).collect();
    for (name, _) in &found {
        if !names.contains(&&name[..]) {
            let allowed = match &names[..] {
                [] => "this page has none".to_owned(),
                names => format!("allowed are {}", names.join(", ")),
            };
            bail!("{page}: nothing is measured for the mark `{OPEN}{name}{NAMED}`; {allowed}");
        }
    }
    match names
        .iter()
        .find(|name| !found.iter().any(|(found, _)| found == *name))
    {
        Some(name) => bail!("{page}: the mark `{OPEN}{name}{NAMED}` is missing"),
        None => Ok(()),
    }
}

/// Writes figures into the rows of a table.
fn table(
    place: Place,
    text: &str,
    rows: &[(String, Cells)],
) -> anyhow::Result<(String, Vec<String>)> {
    let (page, mark) = place;
    let mut lines: Vec<String> = text.split('\n').map(str::to_owned).collect();
    let titles = lines.iter().find(|line| line.starts_with('|'));
    let titles: Vec<String> = titles.map_or(Vec::new(), |line| cells(line));
    let mut differences = Vec::new();
    for (name, figures) in rows {
        let Some(line) = lines.iter_mut().find(|line| is_row(line, name)) else {
            bail!("{page}: the table {mark} has no row {name:?}");
        };
        let mut cells = cells(line);
        for (column, figure) in figures {
            let title = titles.get(*column).map(|title| title.trim());
            let (Some(cell), Some(title)) = (cells.get_mut(*column), title) else {
                bail!("{page}: the row {name:?} of the table {mark} has no column {column}");
            };
            let at = format!(", {name}, column {title:?}");
            differences.extend(differs(place, &at, cell.trim(), figure));
            *cell = format!(" {figure} ");
        }
        *line = cells.join("|");
    }
    Ok((lines.join("\n"), differences))
}

fn cells(line: &str) -> Vec<String> {
    line.split('|').map(str::to_owned).collect()
}

/// True if the first cell of a line is this name, or goes on behind it with another word.
fn is_row(line: &str, name: &str) -> bool {
    let cell = line.strip_prefix("| ").unwrap_or_default();
    let rest = cell.trim_start_matches('`').strip_prefix(name);
    rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || "-_.".contains(c)))
}

/// Sentence on a figure that differs. `cell` names row and column, and is empty in a sentence.
fn differs((page, mark): Place, cell: &str, found: &str, measured: &str) -> Option<String> {
    (found != measured)
        .then(|| format!("{page}: {mark}{cell}: {found:?} on the page, {measured:?} measured"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACES: [Place; 2] = [("README.md", "scans"), ("README.md", "all")];
    const PAGE: &str = "\
Of <!-- figures: all -->4<!-- /figures --> scans:

<!-- figures: scans -->

| recording | truths | found |
|---|---|---|
| `glass-through` | 1 | a |
| `glass`, a wall | 3 | b |

<!-- /figures -->

Again <!-- figures: all -->5<!-- /figures -->.
";

    fn row(name: &str, column: usize, figure: &str) -> Written {
        Written {
            place: PLACES[0],
            figures: Figures::Rows(vec![(name.to_owned(), vec![(column, figure.to_owned())])]),
        }
    }

    #[test]
    fn figures_that_differ_are_named_and_written() {
        let mut page = PAGE.to_owned();
        let mut take = |written: &Written| write(&mut page, written).unwrap();
        assert_eq!(take(&row("glass-through", 2, "1")), [""; 0]);
        assert_eq!(take(&row("glass", 2, "3")), [""; 0]);
        let expected =
            "README.md: scans, glass, column \"truths\": \"3\" on the page, \"7\" measured";
        assert_eq!(take(&row("glass", 2, "7")), [expected]);
        let value = Written {
            place: PLACES[1],
            figures: Figures::Value("8".to_owned()),
        };
        assert_eq!(take(&value).len(), 2, "both places of the mark");
        let expected = PAGE.replace("| 3 |", "| 7 |");
        let expected = expected.replace("-->4<", "-->8<").replace("-->5<", "-->8<");
        assert_eq!(page, expected);
        assert_eq!(
            rows(PAGE, "scans").unwrap()[1][1..3],
            ["`glass`, a wall", "3"]
        );
    }

    #[test]
    fn rows_columns_and_marks_that_are_not_there_are_named() {
        let wrong = |written| {
            write(&mut PAGE.to_owned(), &written)
                .unwrap_err()
                .to_string()
        };
        let expected = "README.md: the table scans has no row \"wood\"";
        assert_eq!(wrong(row("wood", 2, "7")), expected);
        let expected = "README.md: the row \"glass\" of the table scans has no column 9";
        assert_eq!(wrong(row("glass", 9, "7")), expected);
        let check = |text: &str| match check("README.md", text, &PLACES) {
            Ok(()) => String::new(),
            Err(error) => format!("{error:#}"),
        };
        assert_eq!(check(PAGE), "");
        let expected = "README.md: nothing is measured for the mark `<!-- figures: sum -->`; \
                        allowed are scans, all";
        assert_eq!(
            check(&PAGE.replace("figures: all", "figures: sum")),
            expected
        );
        assert_eq!(
            check(""),
            "README.md: the mark `<!-- figures: scans -->` is missing"
        );
        let expected = "README.md: the mark `<!-- figures: all -->` is not closed by \
                        `<!-- /figures -->`";
        assert_eq!(check(&PAGE.replacen(CLOSE, "", 1)), expected);
    }
}
