//! `study.html`: the page of a study, with its verdict and numbers first and its settings folded.

use carom_record::Status;
use carom_record::study::{Row, Study};
use maud::{Markup, html};

use super::collected::Origin;
use super::{claims, convergence, ensemble, numbers, ranked, reproduce, settings, trend, verdict, warnings};
use crate::document::{figure, framed};
use crate::figure::Figure;
use crate::text::Prose;

/// The page; `picture`: the drawing of the first arm; `figures`: each with whether it is folded
/// away.
pub(super) fn page(
    study: &Study,
    picture: Option<&Figure>,
    figures: &[(bool, Figure)],
    origins: &[Origin],
) -> String {
    let sections = [
        ("verdict", "Recommendation", verdict::section(study)),
        ("claims", "Claims", claims::section(study)),
        ("results", "Results", numbers::results(study)),
        ("ranking", "Ranking", ranked::section(study)),
        ("expectations", "Expectations", numbers::expectations(study)),
        ("warnings", "Warnings", warnings::section(study, origins)),
        ("figures", "Figures", drawn(study, figures)),
        ("metrics", "Metrics", numbers::metrics(study)),
        ("trends", "Trends", trend::section(study)),
        ("convergence", "Convergence", convergence::section(study)),
        ("ensemble", "Ensemble", ensemble::section(study)),
        ("settings", "Set-up and settings", settings::section(study, picture)),
        ("reproduce", "How to reproduce and cite", reproduce::section(study, origins)),
    ];
    let shown: Vec<_> = sections.iter().filter(|(.., body)| !body.0.is_empty()).collect();
    let title = &study.manifest.title;
    let body = html! {
        nav.contents {
            details {
                summary { "Contents" }
                ul { @for (id, heading, _) in &shown { li { a href={ "#" (id) } { (heading) } } } }
            }
        }
        main {
            h1 { (title) " " (status(study)) }
            @for (id, heading, body) in &shown { section id=(id) { h2 { (heading) } (body) } }
        }
    };
    framed(title, "", "run", &body)
}

/// How the study ended, in one line.
fn status(study: &Study) -> Markup {
    let count = |is: fn(&Row) -> bool| study.rows.iter().filter(|row| is(row)).count();
    let all = study.rows.len();
    let finished = count(|row| row.status == Some(Status::Finished));
    let failed = count(|row| row.status == Some(Status::Failed));
    let unsound = count(Row::is_unsound) - failed;
    let expectations = || study.rows.iter().flat_map(|row| &row.expectations).chain(&study.expectations);
    let missed = expectations().filter(|expectation| !expectation.pass).count();
    let (class, word) = match study.manifest.status {
        Status::Finished if finished < all => {
            let rest = if failed == all - finished { "failed" } else { "did not finish" };
            ("failed", format!("{finished} of {all} arms finished; {} {rest}", all - finished))
        }
        Status::Finished if unsound > 0 => {
            ("failed", format!("finished; in {unsound} of {all} arms the energy rose by more than 2 %"))
        }
        Status::Finished if missed > 0 => {
            ("failed", format!("finished; {missed} of {} expectations missed", expectations().count()))
        }
        Status::Finished => ("finished", "finished".to_owned()),
        Status::Running => ("running", "running or interrupted; can be resumed".to_owned()),
        Status::Stopped | Status::Failed => ("stopped", "stopped; can be resumed".to_owned()),
    };
    html! { span.status.(class) { (word) } }
}

/// The figures; those that are folded away are together.
fn drawn(study: &Study, figures: &[(bool, Figure)]) -> Markup {
    let (open, folded): (Vec<_>, Vec<_>) = figures.iter().enumerate().partition(|(_, (folded, _))| !folded);
    html! {
        @if let Some(words) = study.systems.words() { p { (Prose(&words)) } }
        @for (i, (_, one)) in open { (figure((i, one))) }
        @if !folded.is_empty() {
            details {
                summary { (folded.len()) " more figures" }
                @for (i, (_, one)) in folded { (figure((i, one))) }
            }
        }
    }
}
