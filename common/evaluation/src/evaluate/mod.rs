//! `backcast evaluate`: success rate and accuracy of the search against the true poses of
//! recordings. Prints a row or a JSON object per file, and how well the probabilities of the
//! results are calibrated. With `--answers` it judges poses that another program found.
//!
//! One process and no graph. Scans without a true pose are not searched; a file that is damaged or
//! holds no truth is an error.

mod answers;
mod command;
mod given;
mod judge;
mod limits;
mod memory;
mod table;

pub(crate) use answers::Figures as AnswerFigures;
pub use command::{Config, NOTES, run};
pub(crate) use judge::Evaluation;
