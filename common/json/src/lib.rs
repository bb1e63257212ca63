//! What is written for programs to read: objects of JSON, each with the schema that it
//! follows (docs/json.md).

use serde::Serialize;

/// Raised when a field changes its meaning or goes, of any object; a field that is
/// added raises nothing.
pub const SCHEMA: u32 = 1;

#[derive(Serialize)]
struct Versioned<'a, T> {
    schema: u32,
    #[serde(flatten)]
    object: &'a T,
}

/// The object on one line, without its end; its first field is [`SCHEMA`].
///
/// Plain values under fixed keys cannot fail to serialize; a fault there would show as
/// the line's content.
pub fn object(object: &impl Serialize) -> String {
    let schema = SCHEMA;
    serde_json::to_string(&Versioned { schema, object })
        .unwrap_or_else(|error| format!("{{\"error\":\"{error}\"}}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_object_says_its_schema_first() {
        #[derive(Serialize)]
        struct Scan {
            stamp_ns: i64,
            score: Option<f64>,
        }
        let scan = Scan {
            stamp_ns: i64::MIN,
            score: None,
        };
        assert_eq!(
            object(&scan),
            r#"{"schema":1,"stamp_ns":-9223372036854775808,"score":null}"#
        );
    }
}
