//! AMCL's parameters, as set by a file or by other nodes. Pure.
//!
//! Rejects a value of another type or out of range, and a change that needs a restart of the node.

mod declared;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use geometry::Pose;
use ros::rcl_interfaces::{
    FloatingPointRange, ListParametersResult, Parameter, ParameterDescriptor, ParameterValue,
    SetParametersResult,
};

pub(crate) use declared::FILE;
use declared::{ALL, Counts, Declared};

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Bool(bool),
    Integer(i64),
    Double(f64),
    Text(Cow<'static, str>),
}

#[derive(Debug, Clone)]
pub(crate) struct Parameters(BTreeMap<&'static str, Value>);

impl Default for Parameters {
    fn default() -> Self {
        Parameters(ALL.iter().map(|d| (d.name, d.default.clone())).collect())
    }
}

impl Parameters {
    /// Takes a value of a file. Returns a remark if the parameter is not one of AMCL's or has no
    /// meaning here.
    pub(super) fn load(&mut self, name: &str, value: Value) -> Result<Option<String>, String> {
        let Some(declared) = declared(name) else {
            return Ok(Some(format!(
                "parameter {name} is none of AMCL's, and ignored"
            )));
        };
        self.0.insert(declared.name, fitting(declared, value)?);
        let meaning = declared.meaning;
        Ok((declared.counts == Counts::Never)
            .then(|| format!("parameter {name} has no meaning here: {meaning}")))
    }

    pub(super) fn set(&mut self, name: &str, value: &ParameterValue) -> SetParametersResult {
        let (successful, reason) = match self.checked(name, value) {
            Ok((declared, value)) => {
                self.0.insert(declared.name, value);
                let remark = match declared.counts {
                    Counts::Never => format!("it has no meaning here: {}", declared.meaning),
                    Counts::Always | Counts::AtStart => String::new(),
                };
                (true, remark)
            }
            Err(reason) => (false, reason),
        };
        SetParametersResult { successful, reason }
    }

    pub(super) fn set_all<'a>(
        &mut self,
        values: impl Iterator<Item = (&'a str, &'a ParameterValue)>,
    ) -> SetParametersResult {
        let mut next = self.clone();
        for (name, value) in values {
            let result = next.set(name, value);
            if !result.successful {
                return result;
            }
        }
        *self = next;
        SetParametersResult {
            successful: true,
            reason: String::new(),
        }
    }

    fn checked(
        &self,
        name: &str,
        value: &ParameterValue,
    ) -> Result<(&'static Declared, Value), String> {
        let declared =
            declared(name).ok_or_else(|| format!("{name} is none of AMCL's parameters"))?;
        let value = Value::try_from(value).map_err(|found| refused(declared, &found))?;
        let value = fitting(declared, value)?;
        if declared.counts == Counts::AtStart && self.0.get(name) != Some(&value) {
            return Err(format!(
                "{name} cannot change while the node runs: set it in --params-file and start again"
            ));
        }
        Ok((declared, value))
    }

    /// Returns the value of a parameter; of type 0 if there is none of that name.
    pub(super) fn get(&self, name: &str) -> ParameterValue {
        self.0
            .get(name)
            .map(ParameterValue::from)
            .unwrap_or_default()
    }

    pub(super) fn named(&self, name: String) -> Parameter {
        let value = self.get(&name);
        Parameter { name, value }
    }

    /// Returns the type, range and meaning of a parameter; of type 0 if there is none.
    pub(super) fn describe(&self, name: &str) -> ParameterDescriptor {
        let unknown = ParameterDescriptor {
            name: name.to_owned(),
            ..ParameterDescriptor::default()
        };
        declared(name).map_or(unknown.clone(), |declared| {
            let range = declared
                .range
                .map(|(from_value, to_value)| FloatingPointRange {
                    from_value,
                    to_value,
                    step: 0.0,
                });
            ParameterDescriptor {
                r#type: self.get(name).r#type,
                description: match declared.counts {
                    Counts::Never => format!("no meaning here: {}", declared.meaning),
                    Counts::Always | Counts::AtStart => declared.meaning.to_owned(),
                },
                read_only: declared.counts == Counts::AtStart,
                floating_point_range: range.into_iter().collect(),
                ..unknown
            }
        })
    }

    /// Lists the names that begin with one of the prefixes and are at most `depth` levels below it;
    /// 0 is any number of levels.
    pub(super) fn list(&self, prefixes: &[String], depth: u64) -> ListParametersResult {
        let is_near = |rest: &str| depth == 0 || (rest.matches('.').count() as u64) < depth;
        let is_listed = |name: &str| {
            let below = |prefix: &String| match name.strip_prefix(prefix.as_str()) {
                Some("") => true,
                Some(rest) => rest.strip_prefix('.').is_some_and(is_near),
                None => false,
            };
            match prefixes {
                [] => is_near(name),
                prefixes => prefixes.iter().any(below),
            }
        };
        let names: Vec<String> = self
            .0
            .keys()
            .copied()
            .filter(|name| is_listed(name))
            .map(str::to_owned)
            .collect();
        let mut above: Vec<String> = names
            .iter()
            .filter_map(|name| Some(name.rsplit_once('.')?.0.to_owned()))
            .collect();
        above.dedup();
        ListParametersResult {
            names,
            prefixes: above,
        }
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// Returns the text of a parameter; empty if there is none of that name.
    pub(super) fn text(&self, name: &str) -> &str {
        match self.0.get(name) {
            Some(Value::Text(text)) => text,
            _ => "",
        }
    }

    /// Returns the file of the saved pose; `None` if the pose is not saved.
    pub(super) fn saved_pose_file(&self) -> Option<&Path> {
        let file = self.text(FILE);
        (!file.is_empty()).then(|| Path::new(file))
    }

    pub(super) fn has_default_file(&self) -> bool {
        self.0.get(FILE) == declared(FILE).map(|declared| &declared.default)
    }

    pub(super) fn clear_saved_pose_file(&mut self) {
        self.0.insert(FILE, Value::Text("".into()));
    }

    pub(super) fn is_on(&self, name: &str) -> bool {
        self.0.get(name) == Some(&Value::Bool(true))
    }

    /// Returns the number of a parameter; 0 if there is none of that name.
    pub(super) fn number(&self, name: &str) -> f64 {
        match self.0.get(name) {
            Some(Value::Double(number)) => *number,
            _ => 0.0,
        }
    }

    pub(super) fn initial_pose(&self) -> Pose {
        let of = |axis: &str| self.number(&format!("initial_pose.{axis}"));
        Pose::new(of("x"), of("y"), of("yaw"))
    }
}

fn declared(name: &str) -> Option<&'static Declared> {
    ALL.iter().find(|declared| declared.name == name)
}

/// Converts a value to the parameter's type and checks its range: an integer is a number, too.
fn fitting(declared: &Declared, value: Value) -> Result<Value, String> {
    let value = match (&declared.default, value) {
        (Value::Double(_), Value::Integer(whole)) => Value::Double(whole as f64),
        (_, value) => value,
    };
    let is_same = std::mem::discriminant(&value) == std::mem::discriminant(&declared.default);
    let is_within = match (&value, declared.range) {
        (Value::Double(number), Some((least, most))) => (least..=most).contains(number),
        (Value::Double(number), None) => number.is_finite(),
        // Names of frames and topics.
        (Value::Text(text), _) => text.len() <= messages::FrameName::CAPACITY,
        _ => true,
    };
    match is_same && is_within {
        true => Ok(value),
        false => Err(refused(declared, &value.to_string())),
    }
}

fn refused(declared: &Declared, found: &str) -> String {
    let allowed = match (&declared.default, declared.range) {
        (Value::Bool(_), _) => "true and false".to_owned(),
        (Value::Integer(_), _) => "whole numbers".to_owned(),
        (Value::Double(_), None) => "finite numbers".to_owned(),
        (Value::Double(_), Some((least, most))) => format!("numbers from {least} to {most}"),
        (Value::Text(_), _) => format!("texts of at most {} bytes", messages::FrameName::CAPACITY),
    };
    let name = declared.name;
    format!("parameter {name} is {found}: allowed are {allowed}")
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Value::Bool(value) => write!(f, "{value}"),
            Value::Integer(value) => write!(f, "{value}"),
            Value::Double(value) => write!(f, "{value:?}"),
            // The text comes from outside and may have any length.
            Value::Text(value) => {
                let end = value.floor_char_boundary(80);
                write!(f, "the text {:?}", value.get(..end).unwrap_or_default())
            }
        }
    }
}

impl From<&Value> for ParameterValue {
    fn from(value: &Value) -> Self {
        let mut of = ParameterValue::default();
        match value {
            Value::Bool(value) => (of.r#type, of.bool_value) = (1, *value),
            Value::Integer(value) => (of.r#type, of.integer_value) = (2, *value),
            Value::Double(value) => (of.r#type, of.double_value) = (3, *value),
            Value::Text(text) => (of.r#type, of.string_value) = (4, text.to_string()),
        }
        of
    }
}

impl TryFrom<&ParameterValue> for Value {
    type Error = String;

    fn try_from(value: &ParameterValue) -> Result<Self, String> {
        match value.r#type {
            1 => Ok(Value::Bool(value.bool_value)),
            2 => Ok(Value::Integer(value.integer_value)),
            3 => Ok(Value::Double(value.double_value)),
            4 => Ok(Value::Text(value.string_value.clone().into())),
            0 => Err("not set".to_owned()),
            5..=9 => Err("a list".to_owned()),
            other => Err(format!("of type {other}")),
        }
    }
}

#[cfg(test)]
mod tests;
