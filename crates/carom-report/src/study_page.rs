//! `study.html`: recommendation, arms, ranking, figures and metrics of a study as a single
//! self-contained page.

use carom_record::metrics::Metric;
use carom_record::study::{Arm, Row, Study};
use carom_record::{Status, metrics};
use maud::{Markup, PreEscaped, Render, html};

use crate::collected::{Origin, time_unit};
use crate::digits::five;
use crate::document::{document, figure, file, joined, minus, or_dash};
use crate::figure::pictures;
use crate::laboratory::style_of;
use crate::plot::{APART, Plot, style};
use crate::systems::Systems;
use crate::text::{Label, Prose, typeset};
use crate::{
    by_arm, claims, convergence, design, ensemble, integrity, settings, study_warnings, trend, verdict,
};

/// Largest number of values of a key that are listed one by one.
const FEW: usize = 4;

/// Longer lists of arms are folded.
const MANY: usize = 12;

/// The page.
pub(crate) fn page(
    study: &Study,
    picture: Option<&[String; 2]>,
    plots: &[Plot],
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
        (setup(study, picture))
        (arms(study))
        (verdict::rankings(study))
        (ensemble::section(study))
        (self::expectations(study, systems))
        (study_warnings::section(study, origins))
        h2 { "Figures" }
        @if let Some(words) = systems.words() { p { (Prose(&words)) } }
        (figures(plots))
        (metrics(study, systems))
        (trend::section(study))
        (convergence::section(study))
        (verdict::phases(study))
        (integrity::section(study, origins))
        (reproduce(study))
    };
    document(&study.manifest.title, "", &body)
}

/// The figures; those of many arms are folded away.
fn figures(plots: &[Plot]) -> Markup {
    let numbered: Vec<(usize, &Plot)> = plots.iter().enumerate().collect();
    let one = |(i, plot): &(usize, &Plot)| {
        let drawn = pictures(&plot.svg(), &plot.narrow());
        figure(i + 1, &plot.name, &["svg", "csv", "py"], &plot.caption, &drawn)
    };
    html! {
        @for together in numbered.chunk_by(|a, b| !a.1.group.is_empty() && a.1.group == b.1.group) {
            @if together.len() > 1 {
                details {
                    summary { (Label(&together[0].1.group)) " of all arms (" (together.len()) " figures)" }
                    @for plot in together { (one(plot)) }
                }
            } @else {
                @for plot in together { (one(plot)) }
            }
        }
    }
}

/// The drawing of the case, the values that differ between arms, and the design.
fn setup(study: &Study, picture: Option<&[String; 2]>) -> Markup {
    let (varied, shared) = (settings::varied(study), settings::shared(study));
    let title = study.manifest.arms.first().and_then(|arm| arm.case.get("title")?.as_str());
    let title = title.filter(|title| !title.is_empty());
    html! {
        h2 { "Setup" }
        @if let Some([svg, narrow]) = picture {
            figure {
                div.drawing { (PreEscaped(pictures(svg, narrow))) }
                figcaption {
                    "Initial configuration of the first arm"
                    @if let Some(title) = title { ": " (Label(title)) }
                    " (case " code { (study.manifest.source.case_path) } "). "
                    span.small { "(" (file("figures/setup.svg")) ")" }
                }
            }
        }
        @if picture.is_none() {
            p { "Case: " code { (study.manifest.source.case_path) } ". No sketch: the arms recorded no fields." }
        }
        @if !shared.is_empty() { p { "Set in all arms: " (codes(&shared, ", ")) "." } }
        @if !varied.is_empty() {
            p { "Parameters that differ between arms (otherwise the value of the case file applies):" }
            @if has_matrix(study) { (matrix(study, &varied)) } @else { (parameters(study, &varied)) }
        }
        (design::paragraphs(study))
    }
}

/// Whether parameters are listed by arm, and not by value.
fn has_matrix(study: &Study) -> bool {
    study.rows.len() <= FEW
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
                @let unset = arms().find(|(i, _)| values[*i].is_none());
                @let base = unset.and_then(|(_, arm)| settings::of_case(arm, key));
                @let distinct = distinct(values);
                li {
                    code { (key) } ": "
                    @if distinct.len() > FEW { (distinct.len()) " values" } @else { (codes(&distinct, ", ")) }
                    @if let Some(base) = base { "; in the case file " code { (base) } }
                }
            }
        }
    }
}

/// The values that are set, each once.
fn distinct(values: &[Option<&str>]) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for value in values.iter().flatten().map(|value| settings::brief(value)) {
        if !found.contains(&value) {
            found.push(value);
        }
    }
    found
}

/// Items set as code, with a separator between them.
fn codes(items: &[impl Render], separator: impl Render) -> Markup {
    joined(items.iter().map(|item| html! { code { (item) } }), separator)
}

fn arms(study: &Study) -> Markup {
    let m = &study.manifest;
    let own = |arm: &Arm| {
        let own = arm.sets.iter().filter(|set| !settings::is_shared(study, set));
        own.map(|set| settings::brief(set)).collect::<Vec<_>>()
    };
    // What the table of parameters lists is not said twice.
    let listed = m.arms.iter().any(|arm| arm.case_path.is_some())
        || !has_matrix(study) && m.arms.iter().any(|arm| !own(arm).is_empty());
    html! {
        h2 { "Arms" }
        // A long list would push the results down the page.
        details open[study.rows.len() <= MANY] {
            summary { (study.rows.len()) " arms (variants of the case)" }
            table {
                thead {
                    tr {
                        th.n { "No." } th { "Line" } th { "Arm" }
                        @if listed { th { "Settings" } }
                        th.n { "Steps" } th { "Status" }
                    }
                }
                @for (i, (row, arm)) in study.rows.iter().zip(&m.arms).enumerate() {
                    tr {
                        td.n { (i + 1) }
                        td { (line(style_of(study, i), row.is_unsound())) }
                        td {
                            a href={ (arm.directory) "/report.html" } { (row.name) }
                            @if m.reference.as_ref() == Some(&row.name) { " (reference)" }
                        }
                        @if listed {
                            @let sets = own(arm);
                            td {
                                @if let Some(path) = &arm.case_path { "case " code { (path) } }
                                @if arm.case_path.is_some() && !sets.is_empty() { br; }
                                (codes(&sets, html! { br; }))
                            }
                        }
                        td.n { (arm.steps) }
                        (ended(study, i, row))
                    }
                }
            }
        }
    }
}

/// How an arm ended, and why.
fn ended(study: &Study, arm: usize, row: &Row) -> Markup {
    let (class, word) = match row.status {
        Some(Status::Finished) if row.is_unsound() => ("undecided", "finished, created energy"),
        Some(Status::Finished) => ("pass", "finished"),
        Some(Status::Failed) => ("miss", "failed"),
        Some(Status::Running | Status::Stopped) => ("undecided", "not finished"),
        None if row.is_damaged() => ("miss", "damaged"),
        None => ("undecided", "not started"),
    };
    html! {
        td.(class) {
            (word)
            @if let Some(reason) = &row.reason { br; span.small.plain { (typeset(reason)) } }
            @if let Some(others) = study.finished_alike(arm) { br; span.small.plain { (typeset(&others)) } }
        }
    }
}

/// The line of an arm in the figures.
fn line(number: usize, apart: bool) -> Markup {
    let (color, width) = if apart { (APART, "1") } else { (style(number).0, "2") };
    html! {
        svg.line width="44" height="10" { path d="M1 5h42" stroke=(color) stroke-width=(width) {} }
    }
}

/// The unit of a metric, or of a reduction of one column, of the first arm named; empty for other
/// expressions.
fn unit_of_question(study: &Study, what: &str) -> String {
    let plain = what.split(" of \"").next().unwrap_or(what);
    let (form, column) = plain.rsplit_once(' ').unwrap_or(("", plain));
    if plain.contains(['[', '/', '*', '+']) || what.matches(" of \"").count() > 1 {
        return String::new();
    }
    let metrics = study.metrics();
    let unit = |name: &str| metrics.iter().find(|m| m.name == name).map(|m| m.unit.clone());
    let of_column = || unit(&format!("{column}:min"));
    match form.split(' ').next() {
        Some("") | None => unit(plain),
        Some("time") => Some(time_unit(study).to_owned()),
        Some("min" | "max" | "first" | "last" | "at" | "range" | "drift" | "peak" | "rms") => of_column(),
        _ => None,
    }
    .unwrap_or_default()
}

fn expectations(study: &Study, systems: &Systems) -> Markup {
    let arms = study.rows.iter().flat_map(|row| row.expectations.iter().map(move |e| (row.name.as_str(), e)));
    let all: Vec<_> = arms.chain(study.expectations.iter().map(|e| ("", e))).collect();
    let met = all.iter().filter(|(_, e)| e.pass).count();
    let table = by_arm(study);
    // Those of arms are in the units of their cases.
    let unit = |what: &str| {
        if systems.is_one() { unit_of_question(study, what) } else { String::new() }
    };
    let (of_arms, units) =
        (all.iter().any(|(arm, _)| !arm.is_empty()), all.iter().any(|(_, e)| !unit(&e.what).is_empty()));
    html! {
        @if !all.is_empty() {
            h2 { "Expectations" }
            p { (met) " of " (all.len()) " met." }
            @if let Some(table) = &table { (table) }
            details open[table.is_none()] {
                summary { "All expectations with their sources" }
                table {
                    thead {
                        tr {
                            th { "Quantity" }
                            @if of_arms { th { "Arm" } }
                            th { "Expected" } th.n { "Result" }
                            @if units { th { "Unit" } }
                            th { "Met" } th { "Source" }
                        }
                    }
                    @for (arm, e) in all {
                        tr {
                            td {
                                code { (e.what) }
                                @if let Some(why) = &e.why { br; span.small { (why) } }
                            }
                            @if of_arms { td { (arm) } }
                            td { (minus(&e.expected)) }
                            td.n { (or_dash(e.got, five)) }
                            @if units { td.unit { (Label(&unit(&e.what))) } }
                            @if e.pass { td.pass { "yes" } } @else { td.miss { "missed" } }
                            td { @if let Some(source) = &e.source { (source) } }
                        }
                    }
                }
            }
        }
    }
}

/// Largest number of columns of tables by arm.
const COLUMNS: usize = 8;

/// Expectations by arm, one row per arm and one column per quantity, result above expected value;
/// nothing for fewer than three arms.
fn by_arm(study: &Study) -> Option<Markup> {
    let mut quantities: Vec<&str> = Vec::new();
    for e in study.rows.iter().flat_map(|row| &row.expectations) {
        if !quantities.contains(&e.what.as_str()) {
            quantities.push(&e.what);
        }
    }
    let arms: Vec<_> = study.rows.iter().filter(|row| !row.expectations.is_empty()).collect();
    if arms.len() < 3 || quantities.is_empty() || quantities.len() > COLUMNS {
        return None;
    }
    let cell = |row: &Row, quantity: &str| {
        let mine: Vec<_> = row.expectations.iter().filter(|e| e.what == quantity).collect();
        let class = if mine.iter().all(|e| e.pass) { "pass" } else { "miss" };
        let Some(first) = mine.first() else { return html! { td {} } };
        html! {
            td.n {
                span.(class) { (or_dash(first.got, five)) }
                br;
                span.small { (joined(mine.iter().map(|e| minus(&e.expected)), ", ")) }
            }
        }
    };
    Some(html! {
        table.metrics {
            thead { tr { th { "Arm" } @for quantity in &quantities { th.n { code { (quantity) } } } } }
            @for row in arms {
                tr { td { (row.name) } @for quantity in &quantities { (cell(row, quantity)) } }
            }
        }
    })
}

fn metrics(study: &Study, systems: &Systems) -> Markup {
    let mut shown = study.metrics();
    shown.retain(|m| study.rows.iter().any(|r| r.value(&m.name).is_some()));
    let groups = metrics::TITLES.map(|title| {
        (title, shown.iter().copied().filter(|m| metrics::group(&m.name) == title).collect::<Vec<_>>())
    });
    html! {
        h2 { "Metrics" }
        @for (title, members) in groups.iter().filter(|(_, members)| !members.is_empty()) {
            details {
                summary { (title) " " span.small { "(" (joined(members.iter().map(|m| &m.name), ", ")) ")" } }
                (by_arm::tables(study, members, COLUMNS, |arm, metric| {
                    html! { (or_dash(study.rows[arm].value(&metric.name), five)) }
                }))
                table {
                    @for (names, definition) in definitions(members) {
                        tr { td { (codes(&names, ", ")) } td { (definition) } }
                    }
                }
            }
        }
        p.small {
            "Column headings are the numbers of the arms. "
            @if !systems.is_one() { "Values are in the units of the first arm. " }
            "Every value is computed from the directory of its \
             arm alone. Data in full precision: " (file("study.csv")) ", and with measured times \
             " (file("study_tidy.csv")) "."
        }
    }
}

/// Definitions, each with all its metrics: those of columns have the same for every probe.
fn definitions<'a>(metrics: &[&'a Metric]) -> Vec<(Vec<&'a str>, &'static str)> {
    let mut found: Vec<(Vec<&str>, &str)> = Vec::new();
    for metric in metrics {
        match found.iter_mut().find(|(_, definition)| *definition == metric.definition) {
            Some((names, _)) => names.push(&metric.name),
            None => found.push((vec![&metric.name], metric.definition)),
        }
    }
    found
}

/// A bibliography entry with the version of the program and the hash of the input.
fn bibtex(study: &Study) -> String {
    let m = &study.manifest;
    let (year, hash) = (m.created.get(..4).unwrap_or_default(), m.input_hash.get(..16).unwrap_or_default());
    let title = "Carom: impact and contact by the positional finite element method";
    format!(
        "@software{{carom,\n  title   = {{{title}}},\n  version = {{{}}},\n  year    = {{{year}}},\n  \
         note    = {{study \"{}\", input {hash}}}\n}}",
        m.version, m.title
    )
}

/// Files that a study directory may contain.
const FILES: [&str; 9] = [
    "study.json",
    "study.csv",
    "study_tidy.csv",
    "ranking.csv",
    "reference.csv",
    "claims.csv",
    "theory.csv",
    "frequencies.csv",
    "checks.json",
];

fn reproduce(study: &Study) -> Markup {
    let m = &study.manifest;
    let beside = m.source.case_path.rsplit('/').next().unwrap_or_default();
    let there = FILES.iter().filter(|name| study.directory.join(name).is_file());
    html! {
        h2 { "How to reproduce" }
        p {
            (Prose("Save the study file below as `study.toml` and the case file as "))
            code { (m.source.case_path) } " relative to it"
            @if m.source.case_path.contains('/') {
                " (or beside it, with " code { "case = \"" (beside) "\"" } " in the study file)"
            }
            ", and run Carom " (m.version) ":"
        }
        pre { "carom study study.toml" }
        p.small {
            "Input hash " code.hash { (m.input_hash) } "; created " (m.created) " on " (m.machine.cpus)
            " cores, " (m.machine.os) " " (m.machine.arch) ". Results do not depend on the number of jobs; \
             wall times do."
        }
        details { summary { "Study file" } pre { (m.source.study) } }
        details { summary { "Case file" } pre { (m.source.case) } }
        @for (path, text) in &m.source.others {
            details { summary { "Case file " code { (path) } } pre { (text) } }
        }
        p {
            (Prose("The folder of this page is the complete record of the study: archive it as a whole, and \
                    `carom report` rebuilds the page from it. Files: `arms/`"))
            @for name in there { " · " (file(name)) }
        }
        h2 { "How to cite" }
        pre { (bibtex(study)) }
    }
}
