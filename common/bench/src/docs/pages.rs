//! README.md and the pages of docs, read and written.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;
use command_line::wrong_use;

use super::marks::{self, Place, Written};

/// All pages, by their paths in the checkout.
pub(super) struct Pages {
    root: PathBuf,
    texts: BTreeMap<String, String>,
    written: BTreeMap<String, String>,
}

impl Pages {
    /// Reads the pages of a checkout, and checks that they have the marks of these places and no
    /// others.
    pub(super) fn read(root: &Path, places: &[Place]) -> anyhow::Result<Self> {
        for needed in ["README.md", "docs", "recordings"] {
            if !root.join(needed).exists() {
                let root = root.display();
                return Err(wrong_use(format!(
                    "{root} has no {needed}: needed is a checkout of Backcast, here or by --root"
                )));
            }
        }
        let docs = fs::read_dir(root.join("docs")).context("cannot read the folder docs")?;
        let mut texts = BTreeMap::new();
        for file in docs {
            let name = file?.file_name().to_string_lossy().into_owned();
            if name.ends_with(".md") {
                texts.insert(format!("docs/{name}"), String::new());
            }
        }
        texts.insert("README.md".to_owned(), String::new());
        for (page, text) in &mut texts {
            *text = fs::read_to_string(root.join(page))
                .with_context(|| format!("cannot read {page}"))?;
            marks::check(page, text, places)?;
        }
        Ok(Pages {
            root: root.to_owned(),
            written: texts.clone(),
            texts,
        })
    }

    /// Text of a page as it was read.
    pub(super) fn text(&self, page: &str) -> anyhow::Result<&str> {
        let text = self.texts.get(page);
        Ok(text.with_context(|| format!("there is no page {page}"))?)
    }

    /// Takes figures into the text of their page. Returns a sentence on each that is another one there.
    pub(super) fn take(&mut self, written: &Written) -> anyhow::Result<Vec<String>> {
        let (page, _) = written.place;
        let text = self.written.get_mut(page);
        let text = text.with_context(|| format!("there is no page {page}"))?;
        marks::write(text, written)
    }

    /// Writes the pages that have changed; returns their names.
    pub(super) fn save(&self) -> anyhow::Result<Vec<&str>> {
        let changed = self
            .written
            .iter()
            .filter(|(page, text)| self.texts.get(*page) != Some(text));
        let save = |(page, text): (&'_ String, &String)| {
            let path = self.root.join(page);
            fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))
        };
        changed
            .map(|page| save(page).map(|()| page.0.as_str()))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::docs::marks::Figures;

    #[test]
    fn pages_that_have_changed_are_written() {
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        let read = || Pages::read(root.path(), &[("docs/a.md", "all")]);
        let error = read().err().unwrap().to_string();
        assert!(
            error.contains("has no README.md: needed is a checkout"),
            "{error}"
        );
        fs::create_dir(path("docs")).unwrap();
        fs::create_dir(path("recordings")).unwrap();
        fs::write(path("README.md"), "no figures\n").unwrap();
        let page = "<!-- figures: all -->4<!-- /figures -->\n";
        fs::write(path("docs/a.md"), page).unwrap();
        let mut pages = read().unwrap();
        let written = Written {
            place: ("docs/a.md", "all"),
            figures: Figures::Value("5".to_owned()),
        };
        assert_eq!(pages.take(&written).unwrap().len(), 1);
        assert_eq!(pages.text("docs/a.md").unwrap(), page);
        assert_eq!(pages.save().unwrap(), ["docs/a.md"]);
        let saved = fs::read_to_string(path("docs/a.md")).unwrap();
        assert_eq!(saved, page.replace('4', "5"));
    }
}
