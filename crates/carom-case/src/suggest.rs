//! "Did you mean": the candidate nearest to a misspelt word.

/// The nearest candidate, if at most a third of the letters differ.
pub(super) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let plain = |s: &str| s.to_lowercase().replace(['-', ' '], "_");
    let word = plain(word);
    let distance = |candidate: &str| {
        let candidate = plain(candidate);
        let letters = word.chars().count().max(candidate.chars().count());
        // One letter is no misspelling of another.
        let most = if letters < 2 { 0 } else { (letters / 3).max(1) };
        let found = strsim::damerau_levenshtein(&word, &candidate);
        (found <= most).then_some(found)
    };
    candidates.into_iter().filter_map(|c| Some((distance(c)?, c))).min_by_key(|(d, _)| *d).map(|(_, c)| c)
}

/// `did you mean …?`, or the list of all candidates.
pub(super) fn help<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str> + Clone) -> String {
    nearest(word, candidates.clone())
        .map_or_else(|| format!("use one of: {}", list(candidates)), |c| format!("did you mean `{c}`?"))
}

/// A list of names; `none` if it is empty.
pub(super) fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<_> = names.into_iter().collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}
