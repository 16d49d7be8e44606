//! Errors in the specification of a scheme. Every variant names its key, for readers of files to
//! point at.

/// A scheme that does not exist or cannot take a step.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SchemeError {
    /// No scheme of this name.
    #[error("unknown scheme kind `{kind}`; known: {}", .known.join(", "))]
    UnknownKind {
        /// As requested.
        kind: String,
        /// All names.
        known: Vec<&'static str>,
    },
    /// A parameter the kind needs was not given.
    #[error("scheme `{kind}` requires {expected}; `{key}` is missing")]
    Missing {
        /// Name of the scheme.
        kind: &'static str,
        /// The missing key.
        key: &'static str,
        /// Key sets of the kind, in words.
        expected: String,
        /// An example for each of them.
        examples: Vec<String>,
        /// Keys of the kind.
        known: Vec<&'static str>,
    },
    /// A parameter that the kind does not have, alone or together with the others.
    #[error("`{key}` cannot be given here: scheme `{kind}` requires {expected}")]
    Superfluous {
        /// Name of the scheme.
        kind: &'static str,
        /// The superfluous key.
        key: String,
        /// Key sets of the kind, in words.
        expected: String,
        /// An example for each of them.
        examples: Vec<String>,
        /// Keys of the kind.
        known: Vec<&'static str>,
    },
    /// A value with which no step is possible.
    #[error("{key} = {value} is outside {range}: {hint}")]
    OutOfRange {
        /// Key of the parameter.
        key: &'static str,
        /// As given.
        value: f64,
        /// The valid range.
        range: &'static str,
        /// Advice to the user.
        hint: String,
    },
}

impl SchemeError {
    /// The key of the scheme's table concerned; `kind` if the name itself is wrong.
    pub fn key(&self) -> &str {
        match self {
            Self::UnknownKind { .. } => "kind",
            Self::Missing { key, .. } | Self::OutOfRange { key, .. } => key,
            Self::Superfluous { key, .. } => key,
        }
    }

    /// Valid replacements of the key, for a suggestion: kinds, or keys of the kind.
    pub fn known(&self) -> &[&'static str] {
        match self {
            Self::UnknownKind { known, .. }
            | Self::Missing { known, .. }
            | Self::Superfluous { known, .. } => known,
            Self::OutOfRange { .. } => &[],
        }
    }
}
