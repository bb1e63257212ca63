//! `backcast bench paper`: every claim of the paper's sections II to V measured again, and
//! its figures drawn again, into a folder of CSV and PNG files.
//!
//! Each experiment is one file that makes its rows and its pictures. `docs/paper.md` judges
//! the results.
//!
//! ```text
//!            ┌─ method    figures 1 to 3
//!            ├─ counts    operations against the formulas of section II B
//! command ───┼─ sonar     section IV: eight sonars ──────────── folder
//!            ├─ tables    tables 1 and 2 (through `line_up`)
//!            ├─ corridor  section V
//!            └─ aid       what the votes save Markov localization and particles
//! ```

mod aid;
mod command;
mod corridor;
mod counts;
mod folder;
mod interval;
mod method;
mod printed;
mod ring;
mod sonar;
mod tables;

pub(super) use command::{Config, run};
