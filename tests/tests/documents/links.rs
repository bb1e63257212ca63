//! Table of contents of the book, and links.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

use tests::{markdown, root};

use crate::read;

/// Documents in addition to those in `docs`.
const OTHERS: [&str; 5] = [
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "README.md",
    "SECURITY.md",
    "packaging/python/README.md",
];

/// Returns all documents below `docs`, relative to the root.
fn documents() -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    let mut folders = vec![PathBuf::from("docs")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(root().join(&folder)).unwrap() {
            let name = entry.unwrap().file_name();
            let path = folder.join(name);
            if root().join(&path).is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "md") {
                found.insert(path);
            }
        }
    }
    found
}

fn all() -> BTreeSet<PathBuf> {
    let others = OTHERS.map(PathBuf::from);
    documents().into_iter().chain(others).collect()
}

/// Returns the links of a document to files of the repository, relative to the root, each with its
/// anchor, which may be empty.
fn links_of(document: &Path) -> Vec<(PathBuf, String)> {
    let text = read(&root().join(document));
    let outside = |link: &String| link.contains("://") || link.starts_with("mailto:");
    let links = markdown::links(&text).into_iter();
    links
        .filter(|link| !outside(link))
        .map(|link| {
            let (file, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let folder = document.parent().unwrap();
            let file = match file {
                "" => document.to_owned(),
                file => plain(&folder.join(file)),
            };
            (file, anchor.to_owned())
        })
        .collect()
}

/// Removes `..` from a path; one that leads out of the repository stays.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir if plain.parent().is_some() => _ = plain.pop(),
            part => plain.push(part),
        }
    }
    plain
}

#[test]
fn every_document_stands_in_the_book_once() {
    let summary = Path::new("docs/SUMMARY.md");
    let listed: Vec<PathBuf> = links_of(summary)
        .into_iter()
        .map(|(file, _)| file)
        .collect();
    let once: BTreeSet<PathBuf> = listed.iter().cloned().collect();
    assert_eq!(listed.len(), once.len(), "one is listed twice");
    let mut expected = documents();
    expected.remove(summary);
    assert_eq!(once, expected);
}

#[test]
fn every_link_leads_somewhere() {
    let mut anchors: BTreeMap<PathBuf, Vec<String>> = BTreeMap::new();
    let mut broken = Vec::new();
    let mut count = 0;
    for document in all() {
        for (file, anchor) in links_of(&document) {
            count += 1;
            let path = root().join(&file);
            let known = match path.exists() {
                true if anchor.is_empty() => true,
                true => anchors
                    .entry(file.clone())
                    .or_insert_with(|| markdown::anchors(&read(&path)))
                    .contains(&anchor),
                false => false,
            };
            if !known {
                broken.push(format!(
                    "{}: {}#{anchor}",
                    document.display(),
                    file.display()
                ));
            }
        }
    }
    assert!(count > 100, "{count}");
    assert!(broken.is_empty(), "{broken:#?}");
}
