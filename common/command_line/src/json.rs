//! Output of JSON objects for programs, each with the version of its schema (docs/json.md).

pub mod schema;

use schemars::JsonSchema;
use serde::Serialize;

/// Version of the schemas of all objects: increased when a field changes its meaning or is removed,
/// but not when one is added.
pub const SCHEMA: u32 = 3;

#[derive(Serialize, JsonSchema)]
struct Versioned<'a, T> {
    #[schemars(extend("const" = SCHEMA))]
    schema: u32,
    #[serde(flatten)]
    object: &'a T,
}

/// Formats the object on one line, without a newline; its first field is [`SCHEMA`].
///
/// Plain values under fixed keys cannot fail to serialize; otherwise the line would have the error.
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
            r#"{"schema":3,"stamp_ns":-9223372036854775808,"score":null}"#
        );
    }
}
