//! `backcast bench docs`: the figures in README.md and docs, measured again and written between
//! marks in the pages, or compared with what stands there.
//!
//! `<!-- figures: NAME -->` and `<!-- /figures -->` enclose a table or a figure in a sentence. Only
//! cells with figures are written; names of rows and titles of columns belong to the page.
//!
//! ```text
//!             ┌─ runs       `backcast evaluate` and `locate`, two at a time
//! command ────┼─ measured ─┬─ tables     the columns of each table
//!             │            ├─ constants  each constant lowered and raised
//!             │            └─ stress     drives with something broken
//!             └─ pages ──── marks       where figures stand
//! ```

mod command;
mod constants;
mod figures;
mod marks;
mod measured;
mod pages;
mod recordings;
mod runs;
mod stress;
mod tables;
mod times;

pub(super) use command::{Config, run};
