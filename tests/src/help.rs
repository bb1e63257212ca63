//! Parser for `--help` of a node or a command, and Markdown tables of it, so that the documents
//! list the options of the executables. Pure.

use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Indentation of clap's options, and of the text below one.
const OPTION_INDENT: [&str; 2] = ["      --", "  -"];
const TEXT_INDENT: &str = "          ";

/// An option, or an argument without a name.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Parameter {
    /// Option as it is typed, with its value: `--threads <COUNT>`.
    pub usage: String,
    /// Default value; empty if there is none.
    pub default: String,
    /// Meaning, with unit and range, in one paragraph.
    pub meaning: String,
}

#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Help {
    /// First paragraph.
    pub about: String,
    /// Parameters in the order of the help, without `--help` and `--version`.
    pub parameters: Vec<Parameter>,
    /// Text after "Exit codes:"; empty if there is none.
    pub exit_codes: String,
}

impl Help {
    /// Parses the text that clap prints.
    pub fn parse(text: &str) -> Self {
        let about = text.lines().take_while(|line| !line.trim().is_empty());
        let exit_codes = text
            .split_once("Exit codes:")
            .map_or("", |(_, after)| after);
        Help {
            about: about.map(str::trim).collect::<Vec<_>>().join(" "),
            parameters: parameters(text),
            exit_codes: words(exit_codes),
        }
    }
}

fn parameters(text: &str) -> Vec<Parameter> {
    let mut all: Vec<Parameter> = Vec::new();
    let mut in_arguments = false;
    let mut is_open = false;
    for line in text.lines() {
        let is_option = OPTION_INDENT.iter().any(|indent| line.starts_with(indent));
        let is_argument = in_arguments && line.starts_with("  ") && !line.starts_with("   ");
        if is_open
            && !is_option
            && let Some(text) = line.strip_prefix(TEXT_INDENT)
            && let Some(parameter) = all.last_mut()
        {
            parameter.read(text.trim());
        } else if is_option || is_argument {
            let line = line.trim();
            let (usage, text) = line.split_once("  ").unwrap_or((line, ""));
            let mut parameter = Parameter {
                usage: usage.trim().to_owned(),
                ..Parameter::default()
            };
            parameter.read(text.trim());
            all.push(parameter);
            is_open = true;
        } else if !line.trim().is_empty() {
            in_arguments = line == "Arguments:";
            is_open = false;
        }
    }
    let of_clap = ["-h, --help", "-V, --version"];
    all.retain(|parameter| !of_clap.contains(&parameter.usage.as_str()));
    all
}

impl Parameter {
    /// Adds a line below the option.
    fn read(&mut self, line: &str) {
        if line.is_empty() || line == "Possible values:" {
            return;
        }
        let mut line = line.to_owned();
        if let Some((before, rest)) = line.split_once("[default: ")
            && let Some((default, after)) = rest.split_once(']')
        {
            default.clone_into(&mut self.default);
            line = format!("{}{after}", before.trim_end());
        }
        if let Some(values) = line.strip_prefix("[possible values: ") {
            let values = values.trim_end_matches(']').split(", ");
            let values: Vec<_> = values.map(|value| format!("`{value}`")).collect();
            line = values.join(" or ");
        }
        if let Some(value) = line.strip_prefix("- ") {
            let (name, meaning) = value.split_once(':').unwrap_or((value, ""));
            line = format!("`{}`: {}", name.trim(), meaning.trim());
        }
        let separator = match self.meaning.as_str() {
            "" => "",
            text if text.ends_with(['.', ':', ';']) => " ",
            _ => "; ",
        };
        if !line.is_empty() {
            self.meaning += separator;
            self.meaning += &line;
        }
    }
}

/// Tables of several executables, a section each. An option that was listed before, with the same
/// meaning and default, is only named, with a link to the section that explains it.
#[derive(Debug, Default)]
pub struct Tables {
    known: BTreeMap<String, Vec<(Parameter, String)>>,
}

impl Tables {
    /// Returns the section of one executable, under a heading of this level.
    pub fn section(&mut self, level: usize, name: &str, help: &Help) -> String {
        let mut new = Vec::new();
        let mut again: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        for parameter in &help.parameters {
            let known = self.known.get(&parameter.usage).into_iter().flatten();
            let same = known.into_iter().find(|(other, _)| other == parameter);
            match same {
                Some((_, section)) => again.entry(section).or_default().push(&parameter.usage),
                None => new.push(parameter),
            }
        }
        let mut text = format!("{} {name}\n\n{}\n", "#".repeat(level), cell(&help.about));
        if !new.is_empty() {
            text += "\n| option | default | meaning |\n|---|---|---|\n";
        }
        for Parameter {
            usage,
            default,
            meaning,
        } in new.iter().copied()
        {
            let default = match default.as_str() {
                "" => String::new(),
                words if words.contains(' ') => words.to_owned(),
                value => format!("`{value}`"),
            };
            let (usage, meaning) = (escaped(usage), cell(meaning));
            // Writing to a text does not fail.
            let _ = writeln!(text, "| `{usage}` | {} | {meaning} |", escaped(&default));
        }
        for (section, options) in &again {
            let link = section.replace(' ', "-");
            let names = options.iter().map(|usage| format!("`{}`", flag(usage)));
            let names: Vec<_> = names.collect();
            let _ = writeln!(text, "\nAs of [{section}](#{link}): {}.", names.join(", "));
        }
        for parameter in new {
            let known = self.known.entry(parameter.usage.clone()).or_default();
            known.push((parameter.clone(), name.to_owned()));
        }
        text
    }
}

/// Returns a table of exit codes, a row for each executable.
pub fn exit_codes<'a>(all: impl IntoIterator<Item = (&'a str, &'a Help)>) -> String {
    let mut text = "| command | exit codes |\n|---|---|\n".to_owned();
    for (name, help) in all {
        if !help.exit_codes.is_empty() {
            let _ = writeln!(text, "| `{name}` | {} |", cell(&help.exit_codes));
        }
    }
    text
}

/// Returns the option without its value.
fn flag(usage: &str) -> &str {
    usage.split(" <").next().unwrap_or(usage)
}

fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn escaped(text: &str) -> String {
    text.replace('|', "\\|")
}

/// Escapes text for a cell: text in angle brackets would be taken for HTML.
fn cell(text: &str) -> String {
    escaped(text).replace('<', "&lt;")
}
