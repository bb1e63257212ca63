//! Command-line options.

use std::path::PathBuf;

/// Who may reach the page, and change something there.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct Options {
    /// Another host name under which browsers may reach the page; addresses and
    /// localhost are always allowed. May be repeated
    #[arg(long, value_name = "NAME", value_parser = host)]
    pub host: Vec<String>,

    /// File with the token that write actions need, at least 16 characters [default: a
    /// new token, shown in the log]
    #[arg(long, value_name = "FILE")]
    pub token_file: Option<PathBuf>,
}

fn host(text: &str) -> Result<String, String> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-.".contains(c);
    if (1..=253).contains(&text.len()) && text.chars().all(is_plain) {
        return Ok(text.to_ascii_lowercase());
    }
    Err("needed is the name of a host, without scheme and port".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_host_is_a_name_alone() {
        assert_eq!(host("Robot7.local").unwrap(), "robot7.local");
        for refused in ["http://a", "a:7440", "a/b", ""] {
            assert!(
                host(refused).unwrap_err().contains("name of a host"),
                "{refused}"
            );
        }
    }
}
