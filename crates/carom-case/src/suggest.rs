//! "Did you mean": the candidate that a word means or is nearest to.

/// Words that other programs use, or symbols, and what they mean here.
const OTHER_WORDS: [(&str, &str); 20] = [
    ("dt", "step"),
    ("e", "young"),
    ("explicit", "central-difference"),
    ("friction", "mu"),
    ("friction_coefficient", "mu"),
    ("leapfrog", "central-difference"),
    ("master", "primary"),
    ("nu", "poisson"),
    ("obstacle", "contact"),
    ("point", "at"),
    ("position", "at"),
    ("reactions", "SUPPORT.reaction_x"),
    ("rho", "density"),
    ("slave", "secondary"),
    ("t_end", "end"),
    ("time_step", "step"),
    ("v", "velocity"),
    ("v0", "velocity"),
    ("velocity_verlet", "central-difference"),
    ("verlet", "central-difference"),
];

/// The candidate that is another word for this one; or the nearest one, if at most a third of the
/// letters differ, or the only one that begins with the word, or is its first part:
/// `redistributed` of `redistributed-nearest`.
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
    let candidates: Vec<_> = candidates.into_iter().collect();
    let means = |candidate: &&str| OTHER_WORDS.contains(&(word.as_str(), *candidate));
    if let Some(meant) = candidates.iter().copied().find(means) {
        return Some(meant);
    }
    let near = candidates.iter().filter_map(|&c| Some((distance(c)?, c))).min_by_key(|(d, _)| *d);
    let is_part = |candidate: &&str| {
        let candidate = plain(candidate);
        word.len() > 2 && candidate.starts_with(&word) || word.starts_with(&format!("{candidate}_"))
    };
    let mut parts = candidates.iter().copied().filter(is_part);
    near.map(|(_, c)| c).or_else(|| parts.next().filter(|_| parts.next().is_none()))
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
