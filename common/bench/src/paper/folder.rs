//! The folder that tables and pictures are written into.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;
use command_line::output;
use plots::drawing::Scene;

#[derive(Debug)]
pub(super) struct Folder {
    path: PathBuf,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Csv {
    columns: usize,
    text: String,
}

impl Folder {
    /// Makes the folder where it is missing, and the ones above it.
    pub(super) fn open(path: &Path) -> anyhow::Result<Self> {
        // An hour of measuring must not end with a file that cannot be written.
        output::make_folder(path)
            .with_context(|| format!("cannot write into the folder {}", path.display()))?;
        Ok(Folder {
            path: path.to_owned(),
        })
    }

    pub(super) fn table(&self, name: &str, csv: &Csv) -> anyhow::Result<()> {
        let file = self.path.join(name);
        fs::write(&file, &csv.text)
            .with_context(|| format!("cannot write the table {}", file.display()))
    }

    pub(super) fn picture(&self, name: &str, scene: &Scene) -> anyhow::Result<()> {
        plots::save_png(scene, &self.path.join(name))
    }
}

impl Csv {
    /// A table of columns whose names commas separate.
    pub(super) fn new(columns: &str) -> Self {
        Csv {
            columns: columns.split(',').count(),
            text: format!("{columns}\n"),
        }
    }

    /// Adds a row. Fields are names and numbers, which need no quotes.
    pub(super) fn push(&mut self, fields: impl IntoIterator<Item = String>) {
        let fields: Vec<String> = fields.into_iter().collect();
        debug_assert_eq!(fields.len(), self.columns);
        self.text.push_str(&fields.join(","));
        self.text.push('\n');
    }
}

/// A number with four digits; empty where there is none.
pub(super) fn digits(value: f64) -> String {
    if !value.is_finite() {
        return String::new();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let before = value.abs().log10().floor() as i32 + 1;
    let decimals = usize::try_from(4 - before).unwrap_or(0);
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits() {
        let texts = [0.012_345_6, 1.0, 29.096, 12_345.6, 0.0, f64::NAN].map(digits);
        assert_eq!(texts, ["0.01235", "1.000", "29.10", "12346", "0", ""]);
    }
}
