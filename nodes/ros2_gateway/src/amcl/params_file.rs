//! Parser of parameter files in the format of ROS. Pure.
//!
//! ```yaml
//! amcl:
//!   ros__parameters:
//!     initial_pose: { x: 1.0 }
//! ```
//!
//! Nodes are given by name, in a namespace (`r2: amcl:` or `/r2/amcl:`), or by wildcards: `*`
//! matches one level, `/**` any number. The parameters of other nodes are ignored.

use serde_json::Value as Json;

use super::parameters::{Parameters, Value};
use crate::GatewayError;

const PARAMETERS: &str = "ros__parameters";

/// Loads the parameters of the node with this full name from a file's text; returns remarks on
/// those without effect.
pub(super) fn load(
    parameters: &mut Parameters,
    text: &str,
    file: &str,
    node: &str,
) -> Result<Vec<String>, GatewayError> {
    let refuse = |reason: String| GatewayError::Refused(format!("{file}: {reason}"));
    let root: Json = serde_saphyr::from_str(text).map_err(|error| refuse(error.to_string()))?;
    let mut found = Found::new();
    find(&root, "", &mut found).map_err(&refuse)?;
    let mut remarks = Vec::new();
    // Wildcards sort before names, so that names override them.
    found.sort_by(|a, b| a.0.cmp(&b.0));
    let mut is_there = false;
    for (name, values) in found.iter().filter(|(name, _)| is_meant(name, node)) {
        is_there = true;
        let mut flat = Vec::new();
        flatten(values, String::new(), &mut flat);
        for (parameter, json) in flat {
            // AMCL has no lists, but its file may contain some.
            let remark = match (value(json), json) {
                (Some(value), _) => parameters.load(&parameter, value),
                (None, Json::Array(_)) if !parameters.has(&parameter) => Ok(Some(format!(
                    "parameter {parameter} is none of AMCL's, and ignored"
                ))),
                (None, _) => Err(format!(
                    "{parameter} of {name} is {}: allowed are true, false, numbers and texts",
                    kind(json)
                )),
            };
            remarks.extend(remark.map_err(&refuse)?);
        }
    }
    if !is_there {
        let names: Vec<&str> = found.iter().map(|(name, _)| &**name).take(20).collect();
        let names = names.join(", ");
        remarks.push(format!(
            "{file} has no parameters for {node}, but for: {names}"
        ));
    }
    Ok(remarks)
}

/// Sets one parameter by a rule such as `use_sim_time:=true`, with a value in YAML.
pub(super) fn set(
    parameters: &mut Parameters,
    rule: &str,
    node: &str,
) -> Result<Vec<String>, GatewayError> {
    let is_letter = |c: char| c.is_ascii_alphanumeric() || "_./".contains(c);
    let parts = rule.split_once(":=");
    let parts = parts.filter(|(name, value)| name.chars().all(is_letter) && !value.contains('\n'));
    let Some((name, value)) = parts else {
        return Err(GatewayError::Option {
            option: "parameter",
            reason: format!("{rule:?}: allowed is NAME:=VALUE, as use_sim_time:=true"),
        });
    };
    let text = format!("/**:\n  {PARAMETERS}:\n    {name}: {value}\n");
    load(parameters, &text, rule, node)
}

/// Values of nodes by name.
type Found<'a> = Vec<(String, &'a Json)>;

/// Collects all nodes below, with their names so far.
fn find<'a>(json: &'a Json, name: &str, found: &mut Found<'a>) -> Result<(), String> {
    let Json::Object(keys) = json else {
        return match (json, name) {
            (Json::Null, _) => Ok(()),
            _ => Err(format!(
                "{name:?} is {}: allowed is {PARAMETERS} below it",
                kind(json)
            )),
        };
    };
    for (key, below) in keys {
        if key == PARAMETERS {
            found.push((name.to_owned(), below));
        } else {
            let key = key.trim_matches('/');
            find(below, &format!("{name}/{key}"), found)?;
        }
    }
    Ok(())
}

/// True if the pattern, which may have wildcards, matches the name of the node.
fn is_meant(pattern: &str, node: &str) -> bool {
    let [pattern, node] = [pattern, node].map(|name| {
        let parts = name.split('/').filter(|part| !part.is_empty());
        parts.collect::<Vec<_>>()
    });
    fits(&pattern, &node)
}

fn fits(pattern: &[&str], node: &[&str]) -> bool {
    match (pattern, node) {
        ([], []) => true,
        (["**", rest @ ..], _) => {
            (0..=node.len()).any(|n| node.get(n..).is_some_and(|node| fits(rest, node)))
        }
        ([one, rest @ ..], [name, others @ ..]) if *one == "*" || one == name => fits(rest, others),
        _ => false,
    }
}

fn flatten<'a>(json: &'a Json, name: String, flat: &mut Vec<(String, &'a Json)>) {
    match json {
        Json::Object(keys) => {
            for (key, below) in keys {
                let name = match &*name {
                    "" => key.clone(),
                    name => format!("{name}.{key}"),
                };
                flatten(below, name, flat);
            }
        }
        Json::Null => {}
        json => flat.push((name, json)),
    }
}

fn value(json: &Json) -> Option<Value> {
    Some(match json {
        Json::Bool(value) => Value::Bool(*value),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => Value::Integer(whole),
            None => Value::Double(number.as_f64()?),
        },
        Json::String(text) => Value::Text(text.clone().into()),
        Json::Null | Json::Array(_) | Json::Object(_) => return None,
    })
}

fn kind(json: &Json) -> &'static str {
    match json {
        Json::Null => "nothing",
        Json::Bool(_) => "true or false",
        Json::Number(_) => "a number",
        Json::String(_) => "a text",
        Json::Array(_) => "a list",
        Json::Object(_) => "a group",
    }
}

#[cfg(test)]
mod tests;
