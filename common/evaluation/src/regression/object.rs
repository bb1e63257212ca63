//! Outcome of a recording, as JSON. Pure.

use schemars::JsonSchema;
use serde::Serialize;

use super::compare::Difference;
use super::junit::Outcome;

#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct Object<'a> {
    /// Name of the recording among the others.
    case: &'a str,
    /// Number of scans with results.
    scans: usize,
    seconds: f64,
    /// True if the results were written as the new expectation.
    accepted: bool,
    /// Why the recording could not be played or compared to its end.
    error: Option<&'a str>,
    differences: &'a [Difference],
}

impl<'a> Object<'a> {
    /// `accepts` is true with `--accept`.
    pub(super) fn of(outcome: &'a Outcome, accepts: bool) -> Self {
        let result = outcome.result.as_ref();
        Object {
            case: &outcome.name,
            scans: outcome.scans.len(),
            seconds: outcome.took.as_secs_f64(),
            accepted: accepts && result.is_ok(),
            error: result.err().map(String::as_str),
            differences: result.map_or(&[], Vec::as_slice),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn an_outcome_has_its_differences_or_its_error() {
        let printed = |result| {
            let outcome = Outcome {
                name: "hall".to_owned(),
                scans: vec![7],
                took: Duration::from_millis(1500),
                result,
            };
            json::object(&Object::of(&outcome, true))
        };
        let difference = Difference {
            stamp_ns: 7,
            what: "verdict",
            expected: "Unique".to_owned(),
            found: "PoorFit".to_owned(),
        };
        let head = r#"{"schema":3,"case":"hall","scans":1,"seconds":1.5,"#;
        let differs = r#"{"stamp_ns":7,"what":"verdict","expected":"Unique","found":"PoorFit"}"#;
        assert_eq!(
            printed(Ok(vec![difference])),
            format!(r#"{head}"accepted":true,"error":null,"differences":[{differs}]}}"#)
        );
        assert_eq!(
            printed(Err("no map".to_owned())),
            format!(r#"{head}"accepted":false,"error":"no map","differences":[]}}"#)
        );
    }
}
