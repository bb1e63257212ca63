//! The token that write actions need.

use std::fs::File;
use std::io::Read;
use std::os::unix::fs::MetadataExt;
use std::path::Path;

use subtle::ConstantTimeEq;

use crate::DashboardError;

/// Permission bits for users outside the owner and group.
const OTHERS: u32 = 0o007;

pub(crate) struct Token(String);

impl Token {
    /// Reads the token from a file and trims white space.
    /// Fails if the file cannot be read, is accessible to all users, or holds no valid token.
    pub(crate) fn read(path: &Path) -> Result<Self, DashboardError> {
        let unreadable = |source| DashboardError::TokenFile {
            path: path.to_owned(),
            source,
        };
        let mut file = File::open(path).map_err(unreadable)?;
        let mode = file.metadata().map_err(unreadable)?.mode() & 0o777;
        if mode & OTHERS != 0 {
            let path = path.to_owned();
            return Err(DashboardError::OpenTokenFile { path, mode });
        }
        let mut text = String::new();
        file.read_to_string(&mut text).map_err(unreadable)?;
        let token = text.trim();
        if !(16..=256).contains(&token.len()) || !token.bytes().all(|b| b.is_ascii_graphic()) {
            return Err(DashboardError::Token {
                path: path.to_owned(),
                found: token.chars().count(),
            });
        }
        Ok(Token(token.to_owned()))
    }

    /// Returns a new token of 128 random bits, in hexadecimal.
    pub(crate) fn random() -> Result<Self, DashboardError> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(DashboardError::Random)?;
        let hex = bytes.iter().map(|byte| format!("{byte:02x}"));
        Ok(Token(hex.collect()))
    }

    /// The token as text; only for the log and the configuration.
    pub(crate) fn reveal(&self) -> &str {
        &self.0
    }

    /// Compares in a time that depends only on the length.
    pub(crate) fn is(&self, given: &str) -> bool {
        self.0.as_bytes().ct_eq(given.as_bytes()).into()
    }
}

#[cfg(test)]
mod tests {
    use std::fs::Permissions;
    use std::os::unix::fs::PermissionsExt;

    use super::*;

    #[test]
    fn random_tokens_differ_and_know_themselves() {
        let (one, other) = (Token::random().unwrap(), Token::random().unwrap());
        assert_eq!(one.reveal().len(), 32);
        assert!(one.is(one.reveal()));
        assert!(!one.is(other.reveal()) && !one.is(""));
    }

    fn set_mode(path: &Path, mode: u32) {
        let permissions = Permissions::from_mode(mode);
        std::fs::set_permissions(path, permissions).unwrap();
    }

    #[test]
    fn a_file_that_everybody_can_use_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("token");
        std::fs::write(&path, "0123456789abcdef").unwrap();
        for mode in [0o600, 0o640, 0o400] {
            set_mode(&path, mode);
            assert!(Token::read(&path).is_ok(), "{mode:o}");
        }
        for mode in [0o644, 0o602, 0o777] {
            set_mode(&path, mode);
            let error = Token::read(&path).err().unwrap().to_string();
            let expected = [format!("{mode:o}"), "chmod".to_owned()];
            assert!(expected.iter().all(|word| error.contains(word)), "{error}");
        }
    }

    #[test]
    fn files_hold_tokens_that_cannot_be_guessed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("token");
        let read = |text: &str| {
            std::fs::write(&path, text).unwrap();
            set_mode(&path, 0o600);
            Token::read(&path).map(|token| token.reveal().to_owned())
        };
        assert_eq!(read("0123456789abcdef\n").unwrap(), "0123456789abcdef");
        for text in ["", "short", "0123456789 abcdef", &"ä".repeat(20)] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains("16 to 256"), "{error}");
        }
        assert!(Token::read(&folder.path().join("none")).is_err());
    }
}
