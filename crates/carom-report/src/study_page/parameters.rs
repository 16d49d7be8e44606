//! The set-up on the page of a study: the drawing of the case, the values that differ between arms,
//! and the design.

use carom_record::study::Study;
use maud::{Markup, html};

use crate::document::{codes, file};
use crate::figure::Figure;
use crate::ordered::distinct;
use crate::text::Label;
use crate::{design, settings, setup};

/// Largest number of values of a key that are listed one by one.
const FEW: usize = 4;

/// The section of the page.
pub(super) fn section(study: &Study, picture: Option<&Figure>) -> Markup {
    let (varied, shared) = (settings::varied(study), settings::shared(study));
    let title = study.manifest.arms.first().and_then(|arm| arm.case.get("title")?.as_str());
    let title = title.filter(|title| !title.is_empty());
    html! {
        h2 { "Setup" }
        @if let Some(picture) = picture {
            figure {
                div.drawing { (picture.pictures()) }
                figcaption {
                    "Initial configuration of the first arm"
                    @if let Some(title) = title { ": " (Label(title)) }
                    " (case " code { (study.manifest.source.case_path) } "). "
                    span.small { "(" (file("figures/setup.svg")) ")" }
                }
            }
        }
        @if picture.is_none() {
            p {
                @if let Some(title) = title { (Label(title)) " (case " } @else { "Case: " }
                code { (study.manifest.source.case_path) }
                @if title.is_some() { ")" }
                ". No sketch: the arms recorded no fields."
            }
            (in_words(study))
        }
        @if !shared.is_empty() { p { "Set in all arms: " (codes(&shared, ", ")) "." } }
        @if !varied.is_empty() {
            p { "Parameters that differ between arms" @if is_rounded(study, &varied) { ", rounded to five digits" } ":" }
            @if has_matrix(study) { (matrix(study, &varied)) } @else { (parameters(study, &varied)) }
        }
        (design::paragraphs(study))
    }
}

/// Whether parameters are listed by arm, and not by value.
pub(super) fn has_matrix(study: &Study) -> bool {
    study.rows.len() <= FEW
}

/// Whether a number that is shown has fewer digits than in its file.
fn is_rounded(study: &Study, varied: &[(&str, Vec<Option<&str>>)]) -> bool {
    // Longer lists of values are only counted.
    let shown = |values: &&Vec<Option<&str>>| has_matrix(study) || values_of(values).len() <= FEW;
    let values = varied.iter().map(|(_, values)| values).filter(shown).flatten().flatten();
    values.into_iter().any(|value| settings::brief(value) != **value)
}

/// A table with a row for every parameter and a column for every arm.
fn matrix(study: &Study, varied: &[(&str, Vec<Option<&str>>)]) -> Markup {
    let of_case = |arm: usize, key: &str| settings::of_case(&study.manifest.arms[arm], key);
    html! {
        div.scroll {
            table.metrics {
                thead { tr { th { "Parameter" } @for row in &study.rows { th { (row.name) } } } }
                @for (key, values) in varied {
                    tr {
                        td { code { (key) } }
                        @for (arm, value) in values.iter().enumerate() {
                            td {
                                @match (value, of_case(arm, key)) {
                                    (Some(value), _) => code { (settings::brief(value)) },
                                    (None, Some(value)) => code { (settings::brief(&value)) },
                                    (None, None) => span.small { "case file" },
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// A list of parameters, each with its distinct values and that of the case.
fn parameters(study: &Study, varied: &[(&str, Vec<Option<&str>>)]) -> Markup {
    let arms = || study.manifest.arms.iter().enumerate().filter(|(_, arm)| !arm.role.fine);
    html! {
        ul {
            @for (key, values) in varied {
                @let unset = arms().filter(|(i, _)| values[*i].is_none());
                @let others: Vec<_> = unset.map(|(_, arm)| settings::of_case(arm, key)).collect();
                @let distinct = values_of(values);
                li {
                    code { (key) } ": "
                    @if distinct.len() > FEW { (distinct.len()) " values" } @else { (codes(&distinct, ", ")) }
                    (elsewhere(&others))
                }
            }
        }
    }
}

/// What a parameter is in arms that do not set it; a value that the page cannot show is unknown.
fn elsewhere(others: &[Option<String>]) -> Markup {
    let distinct = distinct(others.iter().map(|other| other.as_deref().unwrap_or("none")));
    html! {
        @match &distinct[..] {
            [] => "; set in every arm",
            ["none"] => "; without a value in the other arms",
            [one] => { "; in the other arms " code { (settings::brief(one)) } }
            several => {
                "; in the other arms, where the default depends on other settings, "
                (codes(several, " or "))
            }
        }
    }
}

/// The model of the first arm in words, where it is not drawn.
fn in_words(study: &Study) -> Markup {
    let rows = study.manifest.arms.first().map(|arm| setup::in_words(&arm.case)).unwrap_or_default();
    html! {
        ul {
            @for (name, lines) in &rows {
                li { (name) ": " (Label(&lines.join("; "))) }
            }
        }
    }
}

/// The values that are set, each once.
fn values_of(values: &[Option<&str>]) -> Vec<String> {
    distinct(values.iter().flatten().map(|value| settings::brief(value)))
}

#[cfg(test)]
mod tests {
    use super::elsewhere;

    /// A default that depends on the scheme is not one value of the case file.
    #[test]
    fn all_values_of_the_other_arms_are_named() {
        let words = |others: &[Option<&str>]| {
            let others: Vec<_> = others.iter().map(|other| other.map(str::to_owned)).collect();
            elsewhere(&others).into_string()
        };
        assert_eq!(words(&[]), "; set in every arm");
        assert_eq!(words(&[None, None]), "; without a value in the other arms");
        assert_eq!(words(&[Some("1"), Some("1")]), "; in the other arms <code>1</code>");
        assert!(words(&[Some("1"), Some("2")]).ends_with("<code>1</code> or <code>2</code>"));
    }
}
