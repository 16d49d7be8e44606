//! Arms of a study: first those of [[arm]], then all combinations of the grid. Problems of an arm
//! are reported at its place in the study file.

use carom_record::available_memory;
use carom_record::study::design::{Kind, MemberOf, Role};
use carom_record::study::ensemble::{Ensemble, Member};
use carom_record::study::sets_step;
use carom_run::case::{Case, Diagnostic, Document, Problem, gibibytes};
use toml_edit::Value;

use crate::file::{FINE_NAME, StudyFile, assignment, one_line};

/// The changes of an arm, with their places in the study file.
#[derive(Clone, Default)]
pub(crate) struct Draft {
    pub(crate) name: String,
    /// Path of the arm in the study file.
    pub(crate) path: String,
    /// Overrides `key=value`, each with its path in the study file.
    pub(crate) sets: Vec<(String, String)>,
    /// Case file that the arm names; none if it uses that of the study.
    pub(crate) case: Option<String>,
    /// Expectations, as TOML, that replace those of the case; none if it has none of its own.
    pub(crate) expect: Option<String>,
    /// Role of the arm in the study.
    pub(crate) role: Role,
}

impl Draft {
    /// The override that replaces the expectations of the case.
    pub(crate) fn expectations(&self) -> String {
        format!("expect={}", self.expect.as_deref().unwrap_or("[]"))
    }
}

/// Bytes of an arm while the study is planned, without the texts of its files: its case, resolved
/// and as it is stored.
const PER_ARM: f64 = 1e5;

/// Why the combinations of the grid do not fit into the memory; `text`: bytes of the study file.
pub(crate) fn too_many(file: &StudyFile, text: usize) -> Option<Problem> {
    let combinations: f64 = file.grid.iter().map(|(_, values)| values.len() as f64).product();
    let arms = combinations * file.steps.len().max(1) as f64;
    let need = arms * (PER_ARM + text as f64);
    let available = available_memory().filter(|available| need > *available)?;
    let why = format!("they need about {}, and {} are available", gibibytes(need), gibibytes(available));
    let help = "leave out keys or values, or give the combinations that matter as [[arm]]";
    let what = format!("the grid has too many combinations for the memory: {arms:.3e} arms");
    Some(Problem::new("grid", what, why, help).of_system())
}

/// All arms in their order.
pub(crate) fn all(file: &StudyFile) -> Vec<Draft> {
    let methods = methods(file);
    if file.design.is_some() { levels(&methods, file) } else { methods }
}

/// The method whose cost others are matched to: the one that the study names, or the first by name
/// of those without a step of their own, so that the order of the arms does not matter.
pub(crate) fn cost_of(file: &StudyFile) -> Option<String> {
    let has_own_step = |draft: &Draft| draft.sets.iter().any(|(set, _)| sets_step(set));
    let by_step = methods(file).into_iter().filter(|draft| !draft.role.by_cost);
    let first = by_step.min_by_key(|draft| (has_own_step(draft), draft.name.clone()));
    file.cost_of.clone().or_else(|| Some(first?.name))
}

/// The arms of the file and the combinations of its grid, the last key of which varies fastest.
fn methods(file: &StudyFile) -> Vec<Draft> {
    let mut drafts: Vec<Draft> = Vec::new();
    for (i, arm) in file.arms.iter().enumerate() {
        let path = format!("arm[{i}]");
        let table = format!("{path}.");
        let own = arm.set.iter().map(|entry| entry_at(entry, &table));
        drafts.push(Draft {
            name: arm.name.clone(),
            sets: with_common(file, own.collect()),
            case: arm.case.clone(),
            expect: arm.expect.clone(),
            path,
            role: Role { by_cost: arm.by_cost, ..Role::default() },
        });
    }
    let values = file.grid.iter().map(|(_, values)| values.len());
    let combinations: usize = if file.grid.is_empty() { 0 } else { values.product() };
    for combination in 0..combinations {
        // The number of combinations of the keys that follow.
        let mut following = combinations;
        let mut sets = Vec::new();
        let mut names = Vec::new();
        for (key, values) in &file.grid {
            following /= values.len();
            let i = combination / following % values.len();
            sets.push((assignment(key, &values[i]), format!("grid.\"{key}\"[{i}]")));
            names.push(format!("{key}={}", brief(&values[i])));
        }
        drafts.push(Draft {
            name: names.join(", "),
            path: "grid".into(),
            sets: with_common(file, sets),
            ..Draft::default()
        });
    }
    drafts
}

/// Every method of a design at each level, or at its own step if no steps are given. For a method
/// whose cost is matched, its own step is the step of its first pilot at the first level, and is
/// scaled with the steps of the levels for the others.
fn levels(methods: &[Draft], file: &StudyFile) -> Vec<Draft> {
    let steps = &file.steps;
    let cost_of = cost_of(file);
    let at = |(method, level): (&Draft, usize)| {
        let role = Role { method: Some(method.name.clone()), level, ..method.role.clone() };
        let Some(step) = steps.get(level) else { return Draft { role, ..method.clone() } };
        let mut sets = method.sets.clone();
        let costed = (file.design == Some(Kind::MatchedCost) || method.role.by_cost)
            && cost_of.as_ref() != Some(&method.name);
        let own = sets.iter().find_map(|(set, _)| set.strip_prefix("time.step=")?.trim().parse::<f64>().ok());
        // The step of the level replaces the method's own step.
        sets.retain(|(set, _)| !sets_step(set));
        let first = own.filter(|_| costed).map_or(*step, |own| own * step / steps[0]);
        sets.push((format!("time.step={first:?}"), format!("steps[{level}]")));
        let of = if costed { "cost of " } else { "" };
        Draft { name: format!("{}, {of}Δt {step:e}", method.name), sets, role, ..method.clone() }
    };
    let count = steps.len().max(1);
    methods.iter().flat_map(|m| (0..count).map(move |level| (m, level))).map(at).collect()
}

/// Step and mesh factor of a level of the computed reference.
struct Level {
    /// Number of steps to the end.
    steps: f64,
    mesh: f64,
}

/// Levels of the computed reference, the coarsest first. The finest step is at most `step` over
/// `refine`. Steps and cells are in the ratios of the mesh factors; for a mesh that is not to be
/// refined, the steps are those of the factors 1, 2 and 4. None if no number of steps fits them.
fn levels_of_reference(file: &StudyFile, case: &Case, step: f64) -> Option<Vec<Level>> {
    let least = (case.time.end / step * file.fine.refine as f64 * (1.0 - 1e-9)).ceil();
    let is_one_mesh = file.fine.mesh == [1.0];
    let halves = case.bodies.iter().all(|body| body.mesh.is_divided_exactly(1.5));
    let factors: &[f64] = match &file.fine.mesh[..] {
        [] if case.dimension == 3 && halves => &[1.0, 1.5, 2.0],
        [] if case.dimension == 3 => &[1.0, 2.0],
        [] if case.dimension == 2 => &[1.0, 2.0, 3.0],
        [] | [1.0] => &[1.0, 2.0, 4.0],
        given => given,
    };
    let finest = factors[factors.len() - 1];
    // A check has half of the finest steps.
    let fits = |steps: &f64| {
        steps % 2.0 == 0.0
            && factors.iter().all(|factor| {
                let count = steps * factor / finest;
                (count - count.round()).abs() < 1e-9 * count && count >= 1.0
            })
    };
    let steps = (0..10_000).map(|more| least + f64::from(more)).find(fits)?;
    let level = |factor: &f64| Level {
        steps: (steps * factor / finest).round(),
        mesh: if is_one_mesh { 1.0 } else { *factor },
    };
    Some(factors.iter().map(level).collect())
}

/// Schemes of the computed reference: its own, if none is given, and the second one; if that is
/// given, the other way round. Load steps have one scheme.
const CHUNG_HULBERT: &str = "time.scheme={ kind = \"chung-hulbert\", rho_inf = 0.1 }";
const STATIC: &str = "time.scheme={ kind = \"static\" }";
const BATHE: &str = "time.scheme={ kind = \"bathe\", rho_inf = 0.5 }";

/// The runs of the computed reference, the coarsest first, and two checks on its finest mesh: its
/// scheme and the second one, with twice the finest step. None if no steps fit its factors. The
/// reference of arms that are all static is static, and has no second scheme.
pub(crate) fn fine(file: &StudyFile, case: &Case, step: f64, is_static: bool) -> Option<Vec<Draft>> {
    let given = file.fine.set.iter().map(|entry| entry_at(entry, "fine."));
    let (own, others): (Vec<_>, Vec<_>) = given.partition(|(set, _)| set.starts_with("time.scheme"));
    let placed = |scheme: &str| (scheme.to_owned(), "fine".to_owned());
    let of_arms = if is_static { STATIC } else { CHUNG_HULBERT };
    let own = if own.is_empty() { vec![placed(of_arms)] } else { own };
    let is_static = own.iter().any(|(set, _)| set.contains("\"static\""));
    let is_bathe = own.iter().any(|(set, _)| set.contains("bathe"));
    let second = vec![placed(if is_bathe { CHUNG_HULBERT } else { BATHE })];
    let levels = levels_of_reference(file, case, step)?;
    let finest = levels.last()?;
    let draft = |name: String, level: &Level, scheme: &[(String, String)], check: bool| {
        let mut sets = with_common(file, others.clone());
        let is_whole = scheme.iter().any(|(set, _)| set.starts_with("time.scheme="));
        sets.retain(|(set, _)| !(is_whole && set.starts_with("time.scheme")));
        sets.extend_from_slice(scheme);
        sets.push((format!("time.step={:?}", case.time.end / level.steps), "fine".to_owned()));
        if level.mesh != 1.0 {
            sets.push((format!("refine={:?}", case.refine * level.mesh), "fine.mesh".to_owned()));
        }
        let role = Role { fine: true, check, ..Role::default() };
        Draft { name, path: "reference".into(), sets, role, ..Draft::default() }
    };
    let run = |level: &Level| {
        let times = (finest.steps / level.steps * 1e4).round() / 1e4;
        let on = if finest.mesh == 1.0 { String::new() } else { format!(", mesh {}", level.mesh) };
        let name = if times == 1.0 { FINE_NAME.to_owned() } else { format!("{FINE_NAME}, {times} Δt{on}") };
        draft(name, level, &own, false)
    };
    let longer = Level { steps: finest.steps / 2.0, ..*finest };
    let of_step = draft(format!("{FINE_NAME}, check of the step"), &longer, &own, true);
    let of_scheme = draft(format!("{FINE_NAME}, check of the scheme"), &longer, &second, true);
    let checks = std::iter::once(of_step).chain((!is_static).then_some(of_scheme));
    Some(levels.iter().map(run).chain(checks).collect())
}

/// The members of the ensemble of arm number `arm`, except for itself, with the changes that make
/// them from the arm's case. Sides cannot be swapped against a rigid primary: a case that has no
/// others has no swapped members. The meshes of the reference are its own, and so is what an arm
/// itself sets.
pub(crate) fn members(ensemble: &Ensemble, arm: usize, draft: &Draft, case: &Case) -> Vec<Draft> {
    let swaps: Vec<String> = case
        .contacts
        .iter()
        // Contacts of `between` have no keys of their own, and a side is not swapped with itself.
        .filter(|contact| !contact.between && !contact.is_of_itself())
        .filter_map(|contact| {
            let side = contact.primary.side()?;
            Some([
                format!("contact.{}.secondary=\"{side}\"", contact.name),
                format!("contact.{}.primary=\"{}\"", contact.name, contact.secondary),
            ])
        })
        .flatten()
        .collect();
    let is_own = |change: &String| {
        let mut own = draft.sets.iter().filter(|(_, path)| !path.starts_with("set."));
        own.any(|(set, _)| replaces(key_of(set), key_of(change)) || replaces(key_of(change), key_of(set)))
    };
    let possible = |member: &Member| {
        !(member.swapped && swaps.is_empty()
            || draft.role.fine && member.mesh != 1.0
            || ensemble.changes(member).iter().any(is_own))
    };
    let member = |member: Member| {
        let mut sets = ensemble.changes(&member).to_vec();
        if member.phase != 0.0 {
            sets.push(format!("time.phase={:?}", (case.time.phase + member.phase).fract()));
        }
        if member.swapped {
            sets.extend(swaps.iter().cloned());
        }
        if member.mesh != 1.0 {
            sets.push(format!("refine={:?}", case.refine * member.mesh));
        }
        let sets = sets.into_iter().map(|set| (set, "ensemble".to_owned()));
        let sets = draft.sets.iter().cloned().chain(sets).collect();
        let name = format!("{} ({})", draft.name, ensemble.name(&member));
        let role = Role { member: Some(MemberOf { arm, member }), ..draft.role.clone() };
        Draft { name, sets, expect: None, role, ..draft.clone() }
    };
    let members = if draft.role.check { Vec::new() } else { ensemble.members() };
    members.into_iter().skip(1).filter(possible).map(member).collect()
}

/// Overrides of an arm: those of all arms, except for keys that `own` replaces, followed by `own`.
fn with_common(file: &StudyFile, own: Vec<(String, String)>) -> Vec<(String, String)> {
    let overridden = |set: &str| own.iter().any(|(own, _)| replaces(key_of(own), key_of(set)));
    let common = file.set.iter().map(|entry| entry_at(entry, ""));
    let mut sets: Vec<_> = common.filter(|(set, _)| !overridden(set)).collect();
    sets.extend(own);
    sets
}

/// The key of an assignment.
fn key_of(set: &str) -> &str {
    set.split('=').next().unwrap_or_default().trim()
}

/// Whether a value of `key` replaces that of `other`: the same key, or its table.
fn replaces(key: &str, other: &str) -> bool {
    other.strip_prefix(key).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// An override of a table of the study file, whose path is given with a dot at its end.
fn entry_at((key, value): &(String, Value), table: &str) -> (String, String) {
    (assignment(key, value), format!("{table}set.\"{key}\""))
}

/// Text of a value for names; a table is its kind and numbers, `chung-hulbert 0.6`.
fn brief(value: &Value) -> String {
    match value {
        Value::String(text) => text.value().clone(),
        Value::InlineTable(table) => {
            let parts: Vec<String> = table.iter().map(|(_, v)| brief(v)).collect();
            parts.join(" ")
        }
        other => one_line(other),
    }
}

/// Directory name: letters, digits and dots of the name, everything else as single hyphens, at most
/// 40 characters.
pub(crate) fn slug(name: &str) -> String {
    let mut slug = String::new();
    for c in name.chars() {
        match c {
            'Δ' => slug.push('d'),
            'ρ' => slug.push_str("rho"),
            '∞' => slug.push_str("inf"),
            '.' => slug.push('.'),
            c if c.is_ascii_alphanumeric() => slug.push(c.to_ascii_lowercase()),
            _ if !slug.ends_with('-') => slug.push('-'),
            _ => {}
        }
    }
    let slug: String = slug.chars().take(40).collect();
    slug.trim_matches(['-', '.']).to_owned()
}

/// A diagnostic of an arm's case, at its place in the study file; `base` are those of the case
/// without any change.
pub(crate) fn placed(study: &Document, draft: &Draft, found: &Diagnostic, base: &[Diagnostic]) -> Diagnostic {
    if base.contains(found) {
        return found.clone();
    }
    let expect = (draft.expectations(), format!("{}.expect", draft.path));
    let mut sets = draft.sets.iter().chain([&expect]);
    let set = sets.find(|(set, _)| found.file == "--set" && found.quoted == *set);
    let path = set.map_or(&draft.path, |(_, path)| path);
    let place = match found.line {
        line if line > 0 && found.file != "--set" => format!(" ({}:{line}:{})", found.file, found.column),
        _ => String::new(),
    };
    // A mistake in what all arms have in common is one mistake.
    let why = if path.starts_with("set.") {
        format!("{}{place}", found.why)
    } else {
        format!("arm \"{}\": {}{place}", draft.name, found.why)
    };
    let at_key = set.is_some_and(|(set, _)| set.find('=').is_some_and(|end| found.column <= end));
    if at_key {
        // A key of [grid] has a list of values.
        let key = path.trim_end_matches(']').trim_end_matches(|c: char| c.is_ascii_digit());
        let key = key.strip_suffix('[').unwrap_or(path);
        return study.diagnose(&Problem::new(key, &found.what, why, &found.help).at_key());
    }
    study.diagnose(&Problem::new(path, &found.what, why, &found.help))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grid_is_a_product() {
        let mut file = StudyFile::default();
        let list = |text: &str| -> Vec<Value> {
            let parsed: Value = text.parse().unwrap();
            parsed.as_array().unwrap().iter().cloned().collect()
        };
        file.grid.push((
            "time.scheme".into(),
            list("[{ kind = \"hu\" }, { kind = \"chung-hulbert\", rho_inf = 0.6 }]"),
        ));
        file.grid.push(("time.step".into(), list("[1e-3, 0.0005]")));
        let arms = all(&file);
        let names: Vec<&str> = arms.iter().map(|a| a.name.as_str()).collect();
        assert_eq!(names[0], "time.scheme=hu, time.step=1e-3");
        assert_eq!(names[3], "time.scheme=chung-hulbert 0.6, time.step=0.0005");
        assert_eq!(arms[2].sets[0].0, "time.scheme={ kind = \"chung-hulbert\", rho_inf = 0.6 }");
        assert_eq!(arms[2].sets[1].1, "grid.\"time.step\"[0]");
        assert_eq!(slug("Hu, Δt 1.875e-4"), "hu-dt-1.875e-4");
    }

    /// At matched cost, methods are named after the step whose cost they have, and start at their
    /// own step.
    #[test]
    fn matched_cost_names_what_is_matched() {
        let arm = |name: &str, step: Option<&str>| crate::file::ArmEntry {
            name: name.into(),
            set: step.map(|s| ("time.step".to_owned(), s.parse().unwrap())).into_iter().collect(),
            case: None,
            expect: None,
            by_cost: step.is_some(),
        };
        let of = |design: Kind| StudyFile {
            design: Some(design),
            steps: vec![0.01, 0.005],
            arms: vec![arm("Hu", None), arm("explicit", Some("0.002"))],
            ..StudyFile::default()
        };
        let file = of(Kind::MatchedCost);
        let arms = all(&file);
        assert_eq!(arms[1].name, "Hu, Δt 5e-3");
        assert_eq!(
            (arms[3].name.as_str(), arms[3].sets[0].0.as_str()),
            ("explicit, cost of Δt 5e-3", "time.step=0.001")
        );
        assert_eq!(arms[0].sets[0].0, "time.step=0.01");
        // With matched steps, an arm with `match = "cost"` is the same.
        let same = all(&of(Kind::MatchedStep));
        let sets = |arms: &[Draft]| arms.iter().map(|a| (a.name.clone(), a.sets.clone())).collect::<Vec<_>>();
        assert_eq!(sets(&same), sets(&arms));
        assert!(same[3].role.by_cost && !same[0].role.by_cost);
    }
}
