//! Splits command lines into words like dora, without expansion.

use crate::Command;

/// Splits `args` into words; as in a shell, `#` at the start of a word begins a comment.
pub(crate) fn split_args(text: &str) -> Result<Vec<String>, String> {
    shlex::split(text)
        .filter(|_| !text.contains('\0'))
        .ok_or_else(|| {
            let found = text.trim_end();
            format!(
                "`args` cannot be split in words: a quote is not closed or a backslash ends the \
                 text in `{found}`"
            )
        })
}

/// Splits `build` into a command per line, without quotes, which dora reads unlike a shell.
pub(crate) fn split_build(text: &str) -> Result<Vec<Command>, String> {
    if text.is_empty() {
        return Err(bad_build("", "is empty"));
    }
    text.lines().map(split_line).collect()
}

fn split_line(line: &str) -> Result<Command, String> {
    if line.contains(['"', '\'', '\\', '$', '#', '\0']) {
        return Err(bad_build(line, "holds one of \" ' \\ $ #"));
    }
    let mut words = line.split_whitespace().map(ToOwned::to_owned);
    let program = words.next().ok_or_else(|| bad_build(line, "is empty"))?;
    Ok(Command {
        program,
        args: words.collect(),
    })
}

fn bad_build(line: &str, why: &str) -> String {
    format!("the build line `{line}` {why}; allowed are plain words with spaces between")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_follow_the_quoting_of_a_shell() {
        let words = split_args("--x 'a b' \"c d\" e\\ f --y=1\n--z # said twice").unwrap();
        assert_eq!(words, ["--x", "a b", "c d", "e f", "--y=1", "--z"]);
        assert_eq!(split_args("$HOME ~").unwrap(), ["$HOME", "~"]);
        assert_eq!(split_args(" ").unwrap(), [""; 0]);
        for open in ["'a", "a \"b", "a\\"] {
            let fault = split_args(open).unwrap_err();
            assert!(fault.contains("a quote is not closed"), "{fault}");
        }
    }

    #[test]
    fn a_build_has_a_command_a_line() {
        let commands = split_build("cargo build  -p x\ntrue\n").unwrap();
        assert_eq!(commands[0].to_string(), "cargo build -p x");
        assert_eq!(commands[1].program, "true");
        assert_eq!(commands.len(), 2);
        for bad in ["", "\n", "a\n\nb", "echo 'x'", "echo $HOME", "a # b"] {
            let fault = split_build(bad).expect_err(bad);
            assert!(fault.starts_with("the build line `"), "{fault}");
        }
    }
}
