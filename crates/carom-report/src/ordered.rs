//! Items without repetitions, and in groups, in the order in which they first occur.

/// Each item once.
pub(crate) fn distinct<T: PartialEq>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut found = Vec::new();
    for item in items {
        if !found.contains(&item) {
            found.push(item);
        }
    }
    found
}

/// Each key once, with all items that have it.
pub(crate) fn grouped<K: PartialEq, T>(items: impl IntoIterator<Item = (K, T)>) -> Vec<(K, Vec<T>)> {
    let mut found: Vec<(K, Vec<T>)> = Vec::new();
    for (key, item) in items {
        match found.iter_mut().find(|(known, _)| *known == key) {
            Some((_, members)) => members.push(item),
            None => found.push((key, vec![item])),
        }
    }
    found
}
