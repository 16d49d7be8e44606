//! What can be wrong with a scheme as asked for. Every variant names the key it is about, for a
//! reader of files to point at.

/// A scheme that does not exist or cannot be stepped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SchemeError {
    /// No scheme of this name.
    #[error("unknown scheme kind `{kind}`; known: {}", .known.join(", "))]
    UnknownKind {
        /// As asked for.
        kind: String,
        /// All names.
        known: Vec<&'static str>,
    },
    /// A parameter the kind needs was not given.
    #[error("scheme `{kind}` needs `{key}`; it takes {expected}")]
    Missing {
        /// Name of the scheme.
        kind: &'static str,
        /// The missing key.
        key: &'static str,
        /// Key sets the kind takes, in words.
        expected: String,
        /// Keys the kind knows.
        known: Vec<&'static str>,
    },
    /// A parameter the kind does not take, alone or next to the others.
    #[error("scheme `{kind}` does not take `{key}`; it takes {expected}")]
    Superfluous {
        /// Name of the scheme.
        kind: &'static str,
        /// The superfluous key.
        key: String,
        /// Key sets the kind takes, in words.
        expected: String,
        /// Keys the kind knows.
        known: Vec<&'static str>,
    },
    /// A value no step can be taken with.
    #[error("{key} = {value} is outside {range}: {hint}")]
    OutOfRange {
        /// Key of the parameter.
        key: &'static str,
        /// As given.
        value: f64,
        /// What is allowed.
        range: &'static str,
        /// What to try.
        hint: String,
    },
}

impl SchemeError {
    /// The key of the scheme's table this is about; `kind` where the name itself is wrong.
    pub fn key(&self) -> &str {
        match self {
            Self::UnknownKind { .. } => "kind",
            Self::Missing { key, .. } | Self::OutOfRange { key, .. } => key,
            Self::Superfluous { key, .. } => key,
        }
    }

    /// What could stand in the key's place, for a suggestion: kinds, or keys of the kind.
    pub fn known(&self) -> &[&'static str] {
        match self {
            Self::UnknownKind { known, .. }
            | Self::Missing { known, .. }
            | Self::Superfluous { known, .. } => known,
            Self::OutOfRange { .. } => &[],
        }
    }
}
