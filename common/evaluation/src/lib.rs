//! Evaluation of recordings without a graph: `locate` finds the pose of each scan, `evaluate`
//! compares the poses with the ground truth, `sequence` runs the tracker over a drive, and
//! `regression` replays recordings through a graph and compares them with expected results.

pub mod evaluate;
pub mod locate;
mod outcomes;
pub mod regression;
mod sequence;
mod text;
mod trust;
mod truths;

pub fn schemas() -> Vec<command_line::json::schema::Named> {
    use command_line::json::schema::of_object;
    use outcomes::TotalLine;

    vec![
        of_object::<locate::Object>("locate"),
        of_object::<evaluate::Evaluation>("evaluate"),
        of_object::<TotalLine<'_, evaluate::Evaluation>>("evaluate_total"),
        of_object::<evaluate::AnswerFigures>("evaluate_answers"),
        of_object::<sequence::Figures>("evaluate_sequence"),
        of_object::<TotalLine<'_, sequence::Figures>>("evaluate_sequence_total"),
        of_object::<sequence::StressFigures>("evaluate_stress"),
        of_object::<regression::Object<'_>>("regress"),
        command_line::json::schema::of_file::<regression::Expectation>("expected"),
    ]
}
