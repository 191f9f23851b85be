//! The solver of a case: a method of this program, or an attached solver with its name and digest.

use oedometer_problem::method::Method;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What solves a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(untagged)]
pub enum SolverName {
    /// A method of this program.
    Own(Method),
    /// An external solver, attached by the study.
    Attached(#[schemars(with = "AttachedText")] Attached),
}

impl SolverName {
    /// The method, where it is one of this program.
    pub fn built_in(&self) -> Option<Method> {
        if let Self::Own(method) = self { Some(*method) } else { None }
    }
}

impl From<Method> for SolverName {
    fn from(method: Method) -> Self {
        Self::Own(method)
    }
}

impl fmt::Display for SolverName {
    /// The name of the method or of the attached solver.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Own(method) => method.fmt(out),
            Self::Attached(attached) => out.write_str(attached.name()),
        }
    }
}

/// Letters that a name may have.
pub const LONGEST_NAME: usize = 31;
/// Hexadecimal digits of a digest.
pub const DIGEST_DIGITS: usize = 16;

/// The identity of an attached solver: the name that the study gives it, and a digest of its command and of the
/// adapter's files. A small copyable value, as a method is.
#[derive(Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "AttachedText", into = "AttachedText")]
pub struct Attached {
    name: [u8; LONGEST_NAME],
    digest: [u8; DIGEST_DIGITS],
}

/// An identity as text, as records have it.
#[derive(Clone, Serialize, Deserialize, schemars::JsonSchema)]
pub struct AttachedText {
    /// Name of the solver in its study.
    pub name: String,
    /// Digest of the command and of the files of the adapter.
    pub digest: String,
}

/// Why a text cannot identify a solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NameError {
    /// The name is empty or has other letters.
    #[error("a name has letters, digits, `-`, `_` and `.`, and begins with a letter")]
    NotPlain,
    /// The name is too long.
    #[error("a name has at most {LONGEST_NAME} letters")]
    TooLong,
    /// The digest has another length or other letters.
    #[error("a digest has {DIGEST_DIGITS} hexadecimal digits")]
    Digest,
}

impl Attached {
    /// A solver by its name and the digest of its files.
    ///
    /// # Errors
    /// When the name is not plain or too long, or the digest is invalid.
    pub fn new(name: &str, digest: &str) -> Result<Self, NameError> {
        let is_inner = |letter: char| letter.is_ascii_alphanumeric() || "-_.".contains(letter);
        if !name.starts_with(|first: char| first.is_ascii_alphabetic()) || !name.chars().all(is_inner) {
            return Err(NameError::NotPlain);
        }
        if name.len() > LONGEST_NAME {
            return Err(NameError::TooLong);
        }
        let digits: [u8; DIGEST_DIGITS] = digest.as_bytes().try_into().map_err(|_| NameError::Digest)?;
        if !digits.iter().all(u8::is_ascii_hexdigit) {
            return Err(NameError::Digest);
        }
        let mut bytes = [0; LONGEST_NAME];
        bytes[..name.len()].copy_from_slice(name.as_bytes());
        Ok(Self { name: bytes, digest: digits })
    }

    /// The name that the study gives it.
    pub fn name(&self) -> &str {
        let end = self.name.iter().position(|byte| *byte == 0).unwrap_or(LONGEST_NAME);
        std::str::from_utf8(&self.name[..end]).unwrap_or_default()
    }

    /// The digest of its command and of the adapter's files.
    pub fn digest(&self) -> &str {
        std::str::from_utf8(&self.digest).unwrap_or_default()
    }
}

impl fmt::Debug for Attached {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} ({})", self.name(), self.digest())
    }
}

impl TryFrom<AttachedText> for Attached {
    type Error = NameError;
    fn try_from(text: AttachedText) -> Result<Self, NameError> {
        Self::new(&text.name, &text.digest)
    }
}

impl From<Attached> for AttachedText {
    fn from(attached: Attached) -> Self {
        Self { name: attached.name().to_owned(), digest: attached.digest().to_owned() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DIGEST: &str = "0123456789abcdef";

    #[test]
    fn a_name_and_a_digest_come_back_as_they_were_given() {
        let longest = "a".repeat(LONGEST_NAME);
        for name in ["ogs", "scikit-fem_0.9", &longest] {
            let attached = Attached::new(name, DIGEST).expect("a plain name");
            assert_eq!((attached.name(), attached.digest()), (name, DIGEST));
            let text = serde_json::to_string(&attached).expect("plain");
            assert_eq!(serde_json::from_str::<Attached>(&text).expect("the same"), attached);
        }
    }

    #[test]
    fn other_names_and_digests_are_refused() {
        let long = "a".repeat(LONGEST_NAME + 1);
        for (name, why) in [
            ("", NameError::NotPlain),
            ("9a", NameError::NotPlain),
            ("a b", NameError::NotPlain),
            ("a/b", NameError::NotPlain),
            (&long, NameError::TooLong),
        ] {
            assert_eq!(Attached::new(name, DIGEST), Err(why), "{name}");
        }
        assert_eq!(Attached::new("a", "0123"), Err(NameError::Digest));
        assert_eq!(Attached::new("a", "0123456789abcdeg"), Err(NameError::Digest));
        assert_eq!(
            [NameError::NotPlain, NameError::TooLong, NameError::Digest].map(|error| error.to_string()),
            [
                "a name has letters, digits, `-`, `_` and `.`, and begins with a letter",
                "a name has at most 31 letters",
                "a digest has 16 hexadecimal digits"
            ]
        );
    }
}
