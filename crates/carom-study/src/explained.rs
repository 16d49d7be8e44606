//! Keys of case and study files, for `carom explain KEY`.

use carom_case::ExplainedKey;
use carom_case::keys::Keys;

use crate::file::StudyFile;

/// Keys of case and study files by a path such as `contact.enforcement` or `arm.set`, or by its
/// last names alone. Empty if there is no such key.
pub fn explained(path: &str) -> Vec<ExplainedKey> {
    carom_case::explained(path, &[&StudyFile::TABLE])
}

/// Meaning of a misspelt path of [`explained`], or of one of these words: `did you mean …?`, or
/// where all keys are listed.
pub fn similar_key(path: &str, words: &[&str]) -> String {
    carom_case::similar_key(path, &[&StudyFile::TABLE], words)
}
