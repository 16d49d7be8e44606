//! `study.html`: arms, claims, metrics and overlays, in one page that needs nothing but itself.

use carom_record::Status;
use carom_record::study::{Row, Study, Verdict};
use maud::{Markup, PreEscaped, Render, html};

use crate::collected::Origins;
use crate::digits::five;
use crate::document::{document, figure, file, joined, or_dash};
use crate::plot::{Plot, style};
use crate::text::Label;
use crate::{convergence, design, integrity, verdict};

/// Arms in one table of metrics; more make more tables.
const ACROSS: usize = 8;

/// Values of a key that are told one by one.
const FEW: usize = 4;

/// More arms than these are folded away.
const MANY: usize = 12;

/// The page.
pub(crate) fn page(study: &Study, picture: Option<&str>, plots: &[Plot], origins: &Origins) -> String {
    let (class, word) = match study.manifest.status {
        Status::Finished => ("finished", "finished"),
        Status::Running => ("running", "running, or killed: resumable"),
        Status::Stopped | Status::Failed => ("stopped", "stopped: resumable"),
    };
    let body = html! {
        p { span.status.(class) { (word) } }
        (verdict::summary(study))
        (setup(study, picture))
        (arms(study))
        (verdict::rankings(study))
        (claims(&study.verdicts))
        (expectations(study))
        h2 { "Figures" }
        @for (i, plot) in plots.iter().enumerate() {
            (figure(i + 1, &plot.name, &["svg", "csv", "py"], &plot.caption, &plot.svg()))
        }
        (metrics(study))
        (convergence::section(study))
        (verdict::phases(study))
        (integrity::section(study, origins))
        (reproduce(study))
    };
    document(&study.manifest.title, "", &body)
}

/// The case drawn, what is made of what, and what the arms vary.
fn setup(study: &Study, picture: Option<&str>) -> Markup {
    let mut varied: Vec<(&str, Vec<&str>)> = Vec::new();
    let sets = study.manifest.arms.iter().filter(|a| !a.role.fine).flat_map(|a| &a.sets);
    for (key, value) in sets.filter_map(|set| set.split_once('=')) {
        let (key, value) = (key.trim(), value.trim());
        match varied.iter_mut().find(|(k, _)| *k == key) {
            Some((_, values)) if values.contains(&value) => {}
            Some((_, values)) => values.push(value),
            None => varied.push((key, vec![value])),
        }
    }
    html! {
        h2 { "Setup" }
        @if let Some(svg) = picture {
            figure {
                (PreEscaped(svg))
                figcaption {
                    "The case " code { (study.manifest.source.case_path) } " as its first arm has it "
                    span.small { "(" (file("figures/setup.svg")) ")" }
                }
            }
        }
        @if !varied.is_empty() {
            p { "Varied, where an arm does not leave it as the case has it:" }
            ul {
                @for (key, values) in varied {
                    li {
                        code { (key) } ": "
                        @if values.len() > FEW { (values.len()) " values" } @else { (codes(&values, ", ")) }
                    }
                }
            }
        }
        (design::paragraphs(study))
    }
}

/// Pieces of input with something between them.
fn codes(pieces: &[impl Render], between: impl Render) -> Markup {
    joined(pieces.iter().map(|piece| html! { code { (piece) } }), between)
}

fn arms(study: &Study) -> Markup {
    let m = &study.manifest;
    html! {
        h2 { "Arms" }
        // A long list stands in the way of what was found.
        details open[study.rows.len() <= MANY] {
            summary { (study.rows.len()) " arms, and what each sets" }
            table {
                thead { tr { th {} th {} th { "Arm" } th { "Sets" } th.n { "Steps" } th {} } }
                @for (i, (row, arm)) in study.rows.iter().zip(&m.arms).enumerate() {
                    tr {
                        td.n { (i + 1) }
                        td { (line(i)) }
                        td {
                            a href={ (arm.directory) "/report.html" } { (row.name) }
                            @if m.reference.as_ref() == Some(&row.name) { " (reference)" }
                        }
                        td {
                            @if let Some(path) = &arm.case_path { "case " code { (path) } }
                            @if arm.case_path.is_some() && !arm.sets.is_empty() { br; }
                            (codes(&arm.sets, html! { br; }))
                        }
                        td.n { (arm.steps) }
                        (ended(row))
                    }
                }
            }
        }
    }
}

/// How an arm ended, and why.
fn ended(row: &Row) -> Markup {
    let (class, word) = match row.status {
        Some(Status::Finished) => ("pass", "finished"),
        Some(Status::Failed) => ("miss", "failed"),
        Some(Status::Running | Status::Stopped) => ("undecided", "not finished"),
        None => ("undecided", "not begun"),
    };
    html! {
        td.(class) {
            (word)
            @if let Some(reason) = &row.reason { br; span.small { (reason) } }
        }
    }
}

/// The line of an arm in the figures.
fn line(arm: usize) -> Markup {
    let (color, dashes, _) = style(arm);
    html! {
        svg.line width="44" height="10" {
            path d="M1 5h42" stroke=(color) stroke-width="2" stroke-dasharray=(dashes) {}
        }
    }
}

fn claims(verdicts: &[Verdict]) -> Markup {
    let class = |v: &Verdict| match v.holds {
        Some(true) => "pass",
        Some(false) => "miss",
        None => "undecided",
    };
    html! {
        @if !verdicts.is_empty() {
            h2 { "Claims" }
            table {
                thead { tr { th { "Claim" } th.n { "Left" } th.n { "Right" } th {} } }
                @for v in verdicts {
                    tr {
                        td { (v.claim.text) br; code { (v.claim.compare) } }
                        td.n { (or_dash(v.left, five)) }
                        td.n { (or_dash(v.right, five)) }
                        td.(class(v)) { (v.word()) }
                    }
                }
            }
        }
    }
}

fn expectations(study: &Study) -> Markup {
    let arms = study.rows.iter().flat_map(|row| row.expectations.iter().map(move |e| (row.name.as_str(), e)));
    let all: Vec<_> = arms.chain(study.expectations.iter().map(|e| ("", e))).collect();
    let met = all.iter().filter(|(_, e)| e.pass).count();
    let across = side_by_side(study);
    html! {
        @if !all.is_empty() {
            h2 { "Expectations" }
            p { (met) " of " (all.len()) " met." }
            @if let Some(table) = &across { (table) }
            details open[across.is_none()] {
                summary { "One by one, with their sources" }
                table {
                    thead {
                        tr {
                            th { "What" } th { "Arm" } th { "Expected" } th.n { "Got" } th {} th { "Source" }
                        }
                    }
                    @for (arm, e) in all {
                        tr {
                            td {
                                code { (e.what) }
                                @if let Some(why) = &e.why { br; span.small { (why) } }
                            }
                            td { (arm) }
                            td { (e.expected) }
                            td.n { (or_dash(e.got, five)) }
                            @if e.pass { td.pass { "met" } } @else { td.miss { "missed" } }
                            td { @if let Some(source) = &e.source { (source) } }
                        }
                    }
                }
            }
        }
    }
}

/// Most columns that stand side by side.
const COLUMNS: usize = 8;

/// What is expected of several arms, a row per arm and a column per question: what it got over what
/// was expected.
fn side_by_side(study: &Study) -> Option<Markup> {
    let mut questions: Vec<&str> = Vec::new();
    for e in study.rows.iter().flat_map(|row| &row.expectations) {
        if !questions.contains(&e.what.as_str()) {
            questions.push(&e.what);
        }
    }
    let arms: Vec<_> = study.rows.iter().filter(|row| !row.expectations.is_empty()).collect();
    if arms.len() < 3 || questions.is_empty() || questions.len() > COLUMNS {
        return None;
    }
    let cell = |row: &Row, question: &str| {
        let mine: Vec<_> = row.expectations.iter().filter(|e| e.what == question).collect();
        let class = if mine.iter().all(|e| e.pass) { "pass" } else { "miss" };
        let Some(first) = mine.first() else { return html! { td {} } };
        html! {
            td.n {
                span.(class) { (or_dash(first.got, five)) }
                br;
                span.small { (joined(mine.iter().map(|e| &e.expected), ", ")) }
            }
        }
    };
    Some(html! {
        table.metrics {
            thead { tr { th { "Arm" } @for question in &questions { th.n { code { (question) } } } } }
            @for row in arms {
                tr { td { (row.name) } @for question in &questions { (cell(row, question)) } }
            }
        }
    })
}

fn metrics(study: &Study) -> Markup {
    let mut shown = study.metrics();
    shown.retain(|m| study.rows.iter().any(|r| r.value(&m.name).is_some()));
    html! {
        h2 { "Metrics" }
        @for (part, rows) in study.rows.chunks(ACROSS).enumerate() {
            table.metrics {
                thead {
                    tr {
                        th { "Metric" } th { "Unit" }
                        @for i in 1..=rows.len() { th.n { (part * ACROSS + i) } }
                    }
                }
                @for metric in &shown {
                    tr {
                        td { code { (metric.name) } }
                        td { (Label(&metric.unit)) }
                        @for row in rows { td.n { (or_dash(row.value(&metric.name), five)) } }
                    }
                }
            }
        }
        p.small {
            "Columns are the numbers of the arms. Every value is computed from the arm's own directory alone; the same \
             numbers with all digits are in " (file("study.csv")) " and " (file("study_tidy.csv")) "."
        }
        details {
            summary { "Definitions" }
            table {
                @for metric in &shown { tr { td { code { (metric.name) } } td { (metric.definition) } } }
            }
        }
    }
}

/// An entry for a bibliography that names the program and the input.
fn bibtex(study: &Study) -> String {
    let m = &study.manifest;
    let (year, hash) = (m.created.get(..4).unwrap_or_default(), m.input_hash.get(..16).unwrap_or_default());
    format!(
        "@software{{carom,\n  title   = {{Carom: impact and contact by the positional finite element method}},\n  version = {{{}}},\n  year    = {{{year}}},\n  \
         note    = {{study \"{}\", input {hash}}}\n}}",
        m.version, m.title
    )
}

/// Files of a study directory, where it has them.
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
    let there = FILES.iter().filter(|name| study.directory.join(name).is_file());
    html! {
        h2 { "To reproduce" }
        p {
            "Save the study as " code { "study.toml" } " and the case as " code { (m.source.case_path) }
            " beside it, then with Carom " (m.version) ":"
        }
        pre { "carom study study.toml" }
        p.small {
            "Input hash " code.hash { (m.input_hash) } "; made " (m.created) " on " (m.machine.cpus) " cores, "
            (m.machine.os) " " (m.machine.arch) ". Results do not depend on the number of jobs; wall times do."
        }
        details { summary { "The study file" } pre { (m.source.study) } }
        details { summary { "The case file" } pre { (m.source.case) } }
        p {
            "The folder of this page is the record of the study, and enough to make the page again with "
            code { "carom report" } ": put it into an archive whole. In it: " code { "arms/" }
            @for name in there { " · " (file(name)) }
        }
        h2 { "To cite" }
        pre { (bibtex(study)) }
        @for (path, text) in &m.source.others {
            details { summary { "The case file " (path) } pre { (text) } }
        }
    }
}
