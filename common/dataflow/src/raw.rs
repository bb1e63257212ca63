//! The descriptor as written in the file: texts with their places.

use std::fmt;

use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_saphyr::{Error, Location, MergeKeyPolicy, Spanned};

use crate::{Place, Problem};

pub(crate) type Text = Spanned<String>;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawDataflow {
    pub(crate) nodes: Spanned<Vec<Spanned<RawNode>>>,
}

/// An entry of `nodes`, with numbers as text, as this parser accepts more spellings than dora's.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawNode {
    #[serde(default, deserialize_with = "present")]
    pub(crate) id: Option<Text>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) path: Option<Text>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) args: Option<Text>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) env: Option<Spanned<Entries>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) build: Option<Text>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) inputs: Option<Spanned<Entries>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) outputs: Option<Spanned<Vec<Text>>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) restart_policy: Option<Text>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) max_restarts: Option<Text>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) restart_delay: Option<Text>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) max_restart_delay: Option<Text>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) restart_window: Option<Text>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) health_check_timeout: Option<Text>,
}

impl RawNode {
    pub(crate) fn id(&self) -> &str {
        self.id.as_ref().map_or("", |id| &id.value)
    }

    pub(crate) fn inputs(&self) -> &[(Text, Text)] {
        self.inputs.as_ref().map_or(&[], |inputs| &inputs.value.0)
    }

    pub(crate) fn outputs(&self) -> &[Text] {
        self.outputs.as_ref().map_or(&[], |outputs| &outputs.value)
    }
}

/// Prevents a key with the value `null` from being read as missing.
fn present<'de, D, T>(deserializer: D) -> Result<Option<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    T::deserialize(deserializer).map(Some)
}

#[derive(Debug)]
pub(crate) struct Entries(pub(crate) Vec<(Text, Text)>);

impl<'de> Deserialize<'de> for Entries {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct EntriesVisitor;
        impl<'de> Visitor<'de> for EntriesVisitor {
            type Value = Entries;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a map")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Entries(entries))
            }
        }
        deserializer.deserialize_map(EntriesVisitor)
    }
}

pub(crate) fn parse(text: &str) -> Result<RawDataflow, Problem> {
    let options = serde_saphyr::options! {
        with_snippet: false,
        strict_booleans: true,
        merge_keys: MergeKeyPolicy::Error,
        reject_unsupported_tags: true,
        // A descriptor of the allowed size has few aliases; an alias bomb has many.
        alias_limits: serde_saphyr::alias_limits! { max_total_replayed_events: 10_000 },
    };
    let raw: RawDataflow =
        serde_saphyr::from_str_with_options(text, options).map_err(|e| problem(&e, text))?;
    for node in &raw.nodes.value {
        for map in [&node.value.env, &node.value.inputs].into_iter().flatten() {
            refuse_null(map.value.0.is_empty(), map.referenced, '{', text)?;
        }
        if let Some(list) = &node.value.outputs {
            refuse_null(list.value.is_empty(), list.referenced, '[', text)?;
        }
    }
    refuse_null(raw.nodes.value.is_empty(), raw.nodes.referenced, '[', text)?;
    Ok(raw)
}

/// Refuses `null` where the parser reads an empty list, because a value may be forgotten.
fn refuse_null(empty: bool, at: Location, opening: char, text: &str) -> Result<(), Problem> {
    if !empty || rest_of_line(text, at).starts_with(opening) {
        return Ok(());
    }
    let allowed = if opening == '[' { "a list" } else { "a map" };
    Err(Problem {
        place: at.into(),
        fault: format!("found `nothing` where {allowed} belongs"),
    })
}

/// Returns the text from a location to the end of its line; empty if the parser has no byte offset.
pub(crate) fn rest_of_line(text: &str, at: Location) -> &str {
    at.span()
        .byte_offset()
        .and_then(|offset| text.get(usize::try_from(offset).ok()?..))
        .and_then(|rest| rest.lines().next())
        .unwrap_or("")
}

fn problem(error: &Error, text: &str) -> Problem {
    let at = error.location();
    let found = || match at.map_or("", |at| rest_of_line(text, at)).trim_end() {
        "" => "nothing".to_owned(),
        line => line.chars().take(40).collect(),
    };
    let fault = match error.without_snippet() {
        Error::SerdeUnknownField {
            field, expected, ..
        } => {
            let allowed = expected.join(", ");
            format!("unknown key `{field}`; allowed are {allowed}")
        }
        Error::DuplicateMappingKey { key, .. } => {
            let key = key.clone().unwrap_or_else(found);
            format!("the key `{key}` appears a second time here; each may appear once")
        }
        Error::SerdeMissingField { field, .. } => format!("`{field}` is missing"),
        Error::NullIntoString { .. } => wrong_type(&found(), "string"),
        Error::Unexpected { expected, .. } => wrong_type(&found(), expected),
        other => format!(
            "not a descriptor: {}",
            without_place(&other.to_string(), at)
        ),
    };
    Problem {
        place: at.map_or(Place::START, Place::from),
        fault,
    }
}

fn wrong_type(found: &str, expected: &str) -> String {
    let allowed = match expected {
        e if e.starts_with("mapping") => "a map",
        e if e.starts_with("sequence") => "a list",
        _ => "a text or number",
    };
    format!("found `{found}` where {allowed} belongs")
}

/// Removes the place from the end of the parser's message; we put it in front.
fn without_place(message: &str, at: Option<Location>) -> String {
    let place = at.map_or_else(String::new, |at| {
        format!(" at line {}, column {}", at.line(), at.column())
    });
    message.strip_suffix(&place).unwrap_or(message).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expected: &str) {
        let problem = parse(text).unwrap_err().to_string();
        assert!(problem.starts_with(expected), "{text:?}: {problem}");
    }

    #[test]
    fn keys_are_known_and_stand_once() {
        check("nodes:\n  - id: a\n    pth: x\n", "3:5: unknown key `pth`");
        check("nodes: []\ndeploy: x\n", "2:1: unknown key `deploy`");
        check("nodes:\n  - id: a\n    id: b\n", "3:5: the key `id`");
        check("nodes: [{env: {A: 1, A: 2}}]", "1:22: the key `A` appears");
        check("{}", "1:1: `nodes` is missing");
        check("nodes: [{id: a, <<: {path: x}}]", "1:17: not a descriptor:");
    }

    #[test]
    fn values_are_of_their_kind() {
        check("nodes:\n  - id: a\n    args: [x, y]\n", "3:11: found `[x");
        check("nodes:\n  - id: a\n    env: [A=b]\n", "3:10: found `[A=b]`");
        check("nodes:\n  - outputs: scan\n", "2:14: found `scan` where a");
        check("nodes: 5", "1:8: found `5` where a list");
        check("- a", "1:1: found `- a` where a map");
        check("nodes: [5]", "1:9: found `5]` where a map");
    }

    #[test]
    fn a_forgotten_value_is_not_taken_for_an_empty_one() {
        check("nodes:\n  - id: a\n    outputs: ~\n", "3:14: found");
        check("nodes: [{env: ~}]", "1:15: found `nothing` where a map");
        check("nodes:\n  - path: ~\n", "2:11: found `~` where a text");
        check("nodes:\n", "1:6: found `nothing` where a list");
        assert!(parse("nodes: [{env: {}, inputs: {}, outputs: []}]").is_ok());
    }

    #[test]
    fn what_is_not_yaml_is_reported_in_the_words_of_the_parser() {
        check("nodes: [{id: \"a", "1:14: not a descriptor: unclosed quote");
        check("nodes:\n\t- id: a\n", "2:2: not a descriptor: tabs");
        check("", "1:1: not a descriptor: unexpected end of input");
        check("nodes: [{id: *q}]", "1:14: not a descriptor: alias");
    }

    #[test]
    fn repeating_by_aliases_is_limited() {
        let env: String = (0..100).map(|i| format!("A{i}: x, ")).collect();
        let graph = |aliases: usize| {
            let nodes = "  - {env: *e}\n".repeat(aliases);
            format!("nodes:\n  - {{env: &e {{{env}}}}}\n{nodes}")
        };
        assert!(parse(&graph(10)).is_ok());
        let said = parse(&graph(100)).unwrap_err().to_string();
        assert!(said.contains("alias replay limit"), "{said}");
    }
}
