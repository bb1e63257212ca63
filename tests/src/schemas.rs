//! Compares JSON with the schemas in `docs/schemas`, whose keywords are few: another one fails.

use serde_json::Value;

/// Asserts that a line, or a file, follows a schema and has no field that the schema lacks.
#[track_caller]
pub fn assert_follows(name: &str, text: &str) {
    let file = crate::root().join(format!("docs/schemas/{name}.json"));
    let schema: Value = serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
    let value = serde_json::from_str(text).unwrap();
    let errors = Check { root: &schema }.errors(&schema, &value, name);
    assert!(errors.is_empty(), "{errors:#?}: {text}");
}

struct Check<'a> {
    root: &'a Value,
}

impl Check<'_> {
    /// Returns what is wrong with the value at a path.
    fn errors(&self, schema: &Value, value: &Value, at: &str) -> Vec<String> {
        let keywords = schema.as_object().unwrap().iter();
        keywords
            .flat_map(|(keyword, wanted)| match keyword.as_str() {
                "properties" => self.fields(schema, value, at),
                "additionalProperties" if schema.get("properties").is_none() => {
                    let fields = value.as_object().into_iter().flatten();
                    let errors = fields.map(|(key, v)| self.errors(wanted, v, &below(at, key)));
                    errors.flatten().collect()
                }
                "items" => {
                    let items = value.as_array().into_iter().flatten();
                    let errors = items.map(|item| self.errors(wanted, item, &below(at, "[]")));
                    errors.flatten().collect()
                }
                "$ref" => {
                    let pointer = wanted.as_str().unwrap().trim_start_matches('#');
                    self.errors(self.root.pointer(pointer).unwrap(), value, at)
                }
                "anyOf" | "oneOf" => {
                    let each = wanted.as_array().unwrap().iter();
                    let each: Vec<_> = each.map(|one| self.errors(one, value, at)).collect();
                    let fits = each.iter().any(Vec::is_empty);
                    if fits { Vec::new() } else { each.concat() }
                }
                _ if is_met(keyword, wanted, value) => Vec::new(),
                _ => vec![format!("{at}: {keyword} {wanted}, found {value}")],
            })
            .collect()
    }

    fn fields(&self, schema: &Value, value: &Value, at: &str) -> Vec<String> {
        let fields = value.as_object().into_iter().flatten();
        let errors = fields.map(|(key, value)| match schema["properties"].get(key) {
            Some(schema) => self.errors(schema, value, &below(at, key)),
            None => vec![format!("{}: not in the schema", below(at, key))],
        });
        errors.flatten().collect()
    }
}

fn below(at: &str, key: &str) -> String {
    format!("{at}.{key}")
}

/// True if the value is as a keyword without schemas below it wants it.
fn is_met(keyword: &str, wanted: &Value, value: &Value) -> bool {
    let number = || (value.as_f64(), wanted.as_f64());
    let count = || (value.as_array().map(Vec::len), wanted.as_u64());
    match keyword {
        "$schema" | "$defs" | "title" | "description" | "format" | "default" => true,
        "const" => value == wanted,
        "enum" => wanted.as_array().unwrap().contains(value),
        "required" => {
            let mut keys = wanted.as_array().unwrap().iter();
            keys.all(|key| value.get(key.as_str().unwrap()).is_some())
        }
        "type" => match wanted {
            Value::Array(types) => types.iter().any(|one| is_a(one, value)),
            one => is_a(one, value),
        },
        // Other types than theirs meet them.
        "minimum" => !matches!(number(), (Some(found), Some(least)) if found < least),
        "maximum" => !matches!(number(), (Some(found), Some(most)) if found > most),
        "minItems" => !matches!(count(), (Some(found), Some(least)) if (found as u64) < least),
        "maxItems" => !matches!(count(), (Some(found), Some(most)) if found as u64 > most),
        _ => false,
    }
}

fn is_a(name: &Value, value: &Value) -> bool {
    match name.as_str().unwrap() {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn each_fault_is_named_with_its_place() {
        let schema = json!({
            "type": "object",
            "required": ["a", "b"],
            "properties": {
                "a": {"$ref": "#/$defs/A"},
                "b": {"anyOf": [{"$ref": "#/$defs/A"}, {"type": "null"}]},
                "c": {"type": "object", "additionalProperties": {"type": ["number", "null"]}}
            },
            "$defs": {"A": {"type": "array", "maxItems": 2, "items": {"type": "integer", "minimum": 0}}}
        });
        let errors = |value| Check { root: &schema }.errors(&schema, &value, "");
        let sound = json!({"a": [1, 2], "b": null, "c": {"x": 0.5, "y": null}});
        assert_eq!(errors(sound), [""; 0]);
        for (wrong, place) in [
            (json!({"a": []}), ": required"),
            (json!({"a": [0.5], "b": null}), ".a.[]: type"),
            (json!({"a": [-1], "b": null}), ".a.[]: minimum"),
            (json!({"a": [1, 2, 3], "b": null}), ".a: maxItems"),
            (json!({"a": [], "b": 1}), ".b: type"),
            (json!({"a": [], "b": [], "c": {"x": "1"}}), ".c.x: type"),
            (json!({"a": [], "b": [], "d": 1}), ".d: not in the schema"),
        ] {
            let errors = errors(wrong);
            assert!(errors[0].starts_with(place), "{place}: {errors:?}");
        }
    }
}
