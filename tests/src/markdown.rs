//! Links and anchors of a document. Pure; it knows only the Markdown that the documents use.

use std::collections::BTreeMap;

/// Returns the lines outside fenced code.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut is_code = false;
    text.lines().filter(move |line| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence
    })
}

/// Returns the targets of all links and pictures, as they are written.
pub fn links(text: &str) -> Vec<String> {
    let prose: Vec<&str> = prose(text).collect();
    let mut found = Vec::new();
    // Every second piece is a code span, in which nothing is a link.
    let text: String = prose.join("\n").split('`').step_by(2).collect();
    for after in text.split("](").skip(1) {
        let target = after.split(')').next().unwrap_or_default();
        found.push(target.split_whitespace().collect());
    }
    found
}

/// Returns the anchors of all headings, in the form of GitHub and mdBook.
pub fn anchors(text: &str) -> Vec<String> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let headings = prose(text).filter_map(|line| {
        let title = line.trim_start_matches('#');
        let is_heading = title.len() < line.len() && title.starts_with(' ');
        is_heading.then(|| anchor(title.trim()))
    });
    let mut all = Vec::new();
    for heading in headings {
        let count = seen.entry(heading.clone()).or_default();
        all.push(match *count {
            0 => heading,
            count => format!("{heading}-{count}"),
        });
        *count += 1;
    }
    all
}

fn anchor(title: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || ['-', '_', ' '].contains(c);
    let kept = title.chars().filter(kept);
    kept.collect::<String>().to_lowercase().replace(' ', "-")
}

/// Returns the first cells of all rows of the tables below the first heading of this title, up to
/// the next heading of any level: the text of their first code span.
pub fn first_cells(text: &str, title: &str) -> Vec<String> {
    let mut lines = prose(text).skip_while(|line| line.trim_start_matches('#').trim() != title);
    lines.next();
    let section = lines.take_while(|line| !line.starts_with('#'));
    let rows = section.filter_map(|line| line.strip_prefix("| `"));
    rows.filter_map(|row| row.split_once('`'))
        .map(|(name, _)| name.to_owned())
        .collect()
}
