//! Command-line options.

use std::path::PathBuf;

use axum::http::Uri;

/// Access to the page and its write actions.
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

    /// Server to which each change of a robot's state is posted, as a small object of JSON,
    /// over plain HTTP
    #[arg(long, value_name = "URL", value_parser = webhook)]
    pub webhook: Option<Uri>,
}

fn host(text: &str) -> Result<String, String> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-.".contains(c);
    if (1..=253).contains(&text.len()) && text.chars().all(is_plain) {
        return Ok(text.to_ascii_lowercase());
    }
    Err("needed is the name of a host, without scheme and port".to_owned())
}

fn webhook(text: &str) -> Result<Uri, String> {
    let needed = "needed is http://HOST[:PORT][/PATH]; TLS is left to a proxy on this machine";
    let server: Uri = text.parse().map_err(|error| format!("{error}: {needed}"))?;
    let has_host = server.host().is_some_and(|host| !host.is_empty());
    if server.scheme_str() == Some("http") && has_host {
        return Ok(server);
    }
    Err(needed.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_webhook_is_a_server_without_tls() {
        let server = webhook("http://10.0.0.2:8080/hooks/r7?key=1").unwrap();
        assert_eq!(server.host(), Some("10.0.0.2"));
        for refused in [
            "https://a/b",
            "a:8080",
            "/hook",
            "http:///a",
            "",
            "http://a b",
        ] {
            let error = webhook(refused).unwrap_err();
            assert!(error.contains("http://HOST"), "{refused}: {error}");
        }
    }

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
