//! Texts that dora converts. Values that dora would rewrite are errors.

use std::time::Duration;

use crate::raw::{Text, rest_of_line};

/// Longest time of a key, in seconds.
const MAX_SECONDS: f64 = 3600.0;

/// True if the text is plain in the file: not quoted, folded or tagged.
fn is_plain(text: &Text, source: &str) -> bool {
    rest_of_line(source, text.defined).starts_with(&text.value) && !text.value.is_empty()
}

pub(crate) fn read_count(text: &Text, source: &str) -> Result<u32, String> {
    let digits = text.value.bytes().all(|b| b.is_ascii_digit());
    let number = text.value.parse().ok().filter(|_| digits);
    number
        .filter(|n: &u32| is_plain(text, source) && n.to_string() == text.value)
        .ok_or_else(|| {
            let allowed = "a whole number from 0 to 4294967295";
            bad_number("max_restarts", &text.value, allowed)
        })
}

pub(crate) fn read_seconds(
    key: &'static str,
    text: &Text,
    source: &str,
) -> Result<Duration, String> {
    let looks_decimal = text.value.starts_with(|c: char| c.is_ascii_digit())
        && text.value.bytes().all(|b| b.is_ascii_digit() || b == b'.');
    // Some YAML parsers read `007` and `1.` as text.
    let ambiguous = text.value.ends_with('.')
        || (text.value.starts_with('0') && text.value.len() > 1 && !text.value.starts_with("0."));
    let (least, allowed) = match key {
        // Nodes report every second.
        "health_check_timeout" => (2.0, "seconds from 2 to 3600, like 15"),
        _ => (0.0, "seconds from 0 to 3600, like 0.5"),
    };
    let is_allowed = |s: &f64| (least..=MAX_SECONDS).contains(s);
    text.value
        .parse()
        .ok()
        .filter(|s| looks_decimal && !ambiguous && is_allowed(s) && is_plain(text, source))
        .map(Duration::from_secs_f64)
        .ok_or_else(|| bad_number(key, &text.value, allowed))
}

fn bad_number(key: &str, found: &str, allowed: &str) -> String {
    format!("`{key}` is `{found}`; allowed is {allowed}, without quotes")
}

/// Reads the value of an environment variable, exactly as written.
pub(crate) fn read_env_value(text: &Text, source: &str) -> Result<String, String> {
    let value = &text.value;
    let refuse = |why: String| {
        Err(format!(
            "the value `{value}` would not reach the process as written: {why}"
        ))
    };
    if value.contains('$') {
        return refuse("dora puts a variable in place of `$`; leave it out".to_owned());
    }
    if value.contains('\0') {
        return refuse("it holds a zero byte".to_owned());
    }
    let respelled = respelled_number(value);
    if respelled != *value {
        return refuse(format!("dora reads it as a number, `{respelled}`"));
    }
    if is_plain(text, source) && yaml_reads_otherwise(value) {
        return refuse("YAML reads it as a number or boolean; put it in quotes".to_owned());
    }
    Ok(value.clone())
}

/// Returns the spelling that dora gives a text that Rust can parse as a number, quoted or not.
fn respelled_number(value: &str) -> String {
    if let Ok(integer) = value.parse::<i64>() {
        return integer.to_string();
    }
    value
        .parse::<f64>()
        .map_or_else(|_| value.to_owned(), |number| number.to_string())
}

/// True for plain spellings that YAML converts to something else.
fn yaml_reads_otherwise(value: &str) -> bool {
    let lower = value.to_ascii_lowercase();
    let unsigned = lower.trim_start_matches(['+', '-']);
    let respelled_boolean = matches!(&*lower, "true" | "false") && lower != value;
    respelled_boolean
        || matches!(unsigned, ".inf" | ".nan")
        || ["0x", "0o", "0b"].iter().any(|p| unsigned.starts_with(p))
}

#[cfg(test)]
mod tests {
    use crate::parse;

    /// Returns the errors for `key: value`.
    fn fault(key: &str, value: &str) -> Option<String> {
        let text = format!("nodes:\n  - id: a\n    path: x\n    {key}: {value}\n");
        let problems = parse(&text).err()?;
        Some(problems.iter().map(ToString::to_string).collect())
    }

    fn env(value: &str) -> Option<String> {
        fault("env", &format!("{{A: {value}}}"))
    }

    #[test]
    fn counts_are_plain_whole_numbers() {
        let count = |value| fault("restart_policy: always\n    max_restarts", value);
        for good in ["0", "3", "4294967295"] {
            assert_eq!(count(good), None);
        }
        for bad in "-1 1.0 \"5\" 5x 1_0 0x3 007 +5 4294967296 ''".split(' ') {
            let said = count(bad).expect(bad);
            assert!(said.starts_with("5:19: `max_restarts` is `"), "{said}");
        }
    }

    #[test]
    fn delays_are_plain_seconds() {
        let delay = |value| fault("restart_policy: always\n    restart_delay", value);
        for good in ["0", "1", "0.5", "12.25", "3600"] {
            assert_eq!(delay(good), None);
        }
        for bad in "-1 .inf .nan 1s '1.5' 1_0.5 3601 007 1. 1.2.3 99999999999999999999".split(' ') {
            let said = delay(bad).expect(bad);
            assert!(said.starts_with("5:20: `restart_delay` is `"), "{said}");
        }
    }

    #[test]
    fn environment_values_arrive_as_written_or_not_at_all() {
        for good in [
            "x", "1", "-3", "true", "1.5", "yes", "a b", "''", "\"0x10\"", "'True'", "~/x", "1_000",
        ] {
            assert_eq!(env(good), None, "{good}");
        }
        for (bad, why) in [
            ("$HOME/y", "in place of `$`"),
            ("'a${HOME}b'", "in place of `$`"),
            ("007", "a number, `7`"),
            ("'007'", "a number, `7`"),
            ("1.50", "a number, `1.5`"),
            ("1e3", "a number, `1000`"),
            ("infinity", "a number, `inf`"),
            ("+5", "a number, `5`"),
            ("-0", "a number, `0`"),
            ("9223372036854775808", "a number, `9223372036854776000`"),
            (".5", "a number, `0.5`"),
            ("True", "put it in quotes"),
            ("0x10", "put it in quotes"),
            ("-.inf", "put it in quotes"),
            ("~", "a text or number belongs"),
            ("[1]", "a text or number belongs"),
        ] {
            let said = env(bad).expect(bad);
            assert!(said.contains(why), "{bad}: {said}");
        }
    }
}
