//! `study.html`: recommendation, arms, ranking, figures and metrics of a study as a single
//! self-contained page.

mod arms;
mod parameters;
mod reproduce;
mod results;

use carom_record::Status;
use carom_record::study::Study;
use maud::{Markup, html};

use crate::collected::Origin;
use crate::document::{document, figure};
use crate::figure::Figure;
use crate::systems::Systems;
use crate::text::{Label, Prose};
use crate::{claims, convergence, ensemble, integrity, phases, study_warnings, trend, verdict};

/// The page.
pub(crate) fn page(
    study: &Study,
    picture: Option<&Figure>,
    drawn: &[(&str, Figure)],
    origins: &[Origin],
    systems: &Systems,
) -> String {
    let failed = study.rows.iter().filter(|row| row.status == Some(Status::Failed)).count();
    let unsound = study.rows.iter().filter(|row| row.is_unsound()).count() - failed;
    let expectations = || study.rows.iter().flat_map(|row| &row.expectations).chain(&study.expectations);
    let (expected, missed) = (expectations().count(), expectations().filter(|e| !e.pass).count());
    let all = study.rows.len();
    let finished = study.rows.iter().filter(|row| row.status == Some(Status::Finished)).count();
    let (class, word) = match study.manifest.status {
        Status::Finished if finished < all => {
            let rest = if failed == all - finished { "failed" } else { "did not finish" };
            ("failed", format!("{finished} of {all} arms finished; {} {rest}", all - finished))
        }
        Status::Finished if unsound > 0 => {
            ("failed", format!("finished; in {unsound} of {all} arms the energy rose by more than 2 %"))
        }
        Status::Finished if missed > 0 => {
            ("failed", format!("finished; {missed} of {expected} expectations missed"))
        }
        Status::Finished => ("finished", "finished".to_owned()),
        Status::Running => ("running", "running or interrupted; can be resumed".to_owned()),
        Status::Stopped | Status::Failed => ("stopped", "stopped; can be resumed".to_owned()),
    };
    let body = html! {
        p { span.status.(class) { (word) } }
        (verdict::summary(study))
        (claims::section(study))
        (parameters::section(study, picture))
        (arms::section(study, origins))
        (verdict::rankings(study, origins))
        (ensemble::section(study))
        (results::expectations(study, systems))
        (study_warnings::section(study, origins))
        h2 { "Figures" }
        @if let Some(words) = systems.words() { p { (Prose(&words)) } }
        (figures(drawn))
        (results::metrics(study, systems))
        (trend::section(study))
        (convergence::section(study))
        (phases::section(study))
        (integrity::section(study, origins))
        (reproduce::section(study))
    };
    document(&study.manifest.title, "", &body)
}

/// The figures, each with the title of those that it is folded away with.
fn figures(drawn: &[(&str, Figure)]) -> Markup {
    let mut numbers = 0..;
    html! {
        @for together in drawn.chunk_by(|(a, _), (b, _)| !a.is_empty() && a == b) {
            @let figures = html! {
                @for ((_, one), i) in together.iter().zip(numbers.by_ref()) { (figure((i, one))) }
            };
            @if together.len() > 1 {
                details {
                    summary { (Label(together[0].0)) " of all arms (" (together.len()) " figures)" }
                    (figures)
                }
            } @else { (figures) }
        }
    }
}
