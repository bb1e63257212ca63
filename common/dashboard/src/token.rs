//! The token that write actions need.

use std::path::Path;

use subtle::ConstantTimeEq;

use crate::DashboardError;

/// Something that only those who may change the graph know.
pub(crate) struct Token(String);

impl Token {
    /// Reads it from a file, spaces around it left out.
    ///
    /// # Errors
    /// The file cannot be read, or holds none.
    pub(crate) fn read(path: &Path) -> Result<Self, DashboardError> {
        let text = std::fs::read_to_string(path).map_err(|source| DashboardError::TokenFile {
            path: path.to_owned(),
            source,
        })?;
        let token = text.trim();
        if !(16..=256).contains(&token.len()) || !token.bytes().all(|b| b.is_ascii_graphic()) {
            return Err(DashboardError::Token {
                path: path.to_owned(),
                found: token.chars().count(),
            });
        }
        Ok(Token(token.to_owned()))
    }

    /// A new one of 128 random bits.
    ///
    /// # Errors
    /// The system has no random numbers.
    pub(crate) fn random() -> Result<Self, DashboardError> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(DashboardError::Random)?;
        let hex = bytes.iter().map(|byte| format!("{byte:02x}"));
        Ok(Token(hex.collect()))
    }

    /// The text, for the log and the configuration alone.
    pub(crate) fn reveal(&self) -> &str {
        &self.0
    }

    /// Compares in a time that tells nothing but the length.
    pub(crate) fn is(&self, given: &str) -> bool {
        self.0.as_bytes().ct_eq(given.as_bytes()).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_tokens_differ_and_know_themselves() {
        let (one, other) = (Token::random().unwrap(), Token::random().unwrap());
        assert_eq!(one.reveal().len(), 32);
        assert!(one.is(one.reveal()));
        assert!(!one.is(other.reveal()) && !one.is(""));
    }

    #[test]
    fn files_hold_tokens_that_cannot_be_guessed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("token");
        let read = |text: &str| {
            std::fs::write(&path, text).unwrap();
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
