//! Changes of a case that may get a run past the place where it stopped, as the options of the
//! command that make them. A changed case is read again with them, so that a run with these options
//! is a run of this case.

use carom_case::{
    Case, ContactLaw, ContactPoint, ContactSpec, Detection, Document, Enforcement, Fallback, Persistency,
    TangentRule, read,
};
use carom_record::Source;

use crate::initial::continues;
use crate::setup::Setup;

/// A kind of change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Δt/4.
    Shorter,
    /// 2Δt.
    Longer,
    /// Another ρ∞ of the same scheme.
    Damped,
    /// A dissipative scheme of two stages.
    Bathe,
    /// Backward Euler in place of load steps.
    Inertia,
    /// Springs of the default stiffness at the place.
    Penalty,
    /// An augmented Lagrangian in place of multipliers.
    Augmented,
    /// Springs ten times as stiff, or as soft.
    Stiffer,
    Softer,
    /// Multipliers in place of springs.
    Multiplier,
    /// A new tangent in every iteration.
    Full,
    /// Velocities that are compatible with contact where it begins.
    Project,
    /// Contact implicit in velocity in the steps that are not accepted.
    Fallback,
}

/// A case with the text from which it was read.
pub(super) struct Original<'a> {
    case: &'a Case,
    /// None if the text, or a file that it names, is not there any more, or gives another case.
    source: Option<&'a Source>,
    /// Names of the tables of its contacts.
    tables: Vec<String>,
}

impl<'a> Original<'a> {
    pub(super) fn new(case: &'a Case, source: &'a Source) -> Self {
        let document = document(source, &[]);
        let same = document.as_ref().and_then(|document| titled(document, case)).as_ref() == Some(case);
        let tables = document.map_or_else(Vec::new, |document| document.names("contact"));
        Self { case, source: same.then_some(source), tables }
    }

    /// These options if the case can be read and built with them, and none otherwise: a key that is
    /// given may contradict them.
    pub(super) fn accepted(&self, sets: Vec<String>) -> Vec<String> {
        let changed = self.source.and_then(|source| titled(&document(source, &sets)?, self.case));
        let accepted = changed.filter(|case| case != self.case && Setup::new(case).build().is_ok());
        accepted.map_or_else(Vec::new, |_| sets)
    }

    /// Whether the text of the case is known, so that options can be tried.
    pub(super) fn is_known(&self) -> bool {
        self.source.is_some()
    }

    /// Whether the case can be read and built with this option, as far as that is known.
    pub(super) fn permits(&self, set: &str) -> bool {
        !self.is_known() || !self.accepted(vec![set.to_owned()]).is_empty()
    }

    /// The options of a change, `key=value`, at one contact or at all; none if the case has nothing
    /// that it changes.
    pub(super) fn sets(&self, kind: Kind, contact: Option<&str>) -> Option<Vec<String>> {
        let case = self.case;
        let scheme = &case.time.scheme;
        let step = case.time.step;
        let implicit = !scheme.is_static() && scheme.nonsmooth().is_none();
        // A saved state keeps its clock.
        let free = !continues(case);
        let sets = match kind {
            Kind::Shorter if free => vec![format!("time.step={:?}", 0.25 * step)],
            Kind::Longer
                if free && implicit && case.time.phase == 0.0 && case.time.steps().is_multiple_of(2) =>
            {
                vec![format!("time.step={:?}", 2.0 * step)]
            }
            Kind::Damped if implicit => {
                let rho = *scheme.parameters.get("rho_inf")?;
                let lower = if rho > 0.5 { 0.5 } else { 0.0 };
                if rho <= lower {
                    return None;
                }
                vec![format!("time.scheme.rho_inf={lower:?}")]
            }
            Kind::Bathe if !scheme.is_static() && scheme.kind != "bathe" => {
                let predictor = |c: &ContactSpec| c.law == Some(ContactLaw::Predictor);
                let bathe = "time.scheme={ kind = \"bathe\", rho_inf = 0.0 }".to_owned();
                let laws = self.each(None, predictor, |_| vec!["law=position".to_owned()]);
                std::iter::once(bathe).chain(laws).collect()
            }
            Kind::Inertia if scheme.is_static() => {
                vec!["time.scheme={ kind = \"backward-euler\" }".to_owned()]
            }
            Kind::Penalty if implicit => self.each(
                contact,
                |c| plain(c) && c.enforcement == Enforcement::Multiplier,
                |c| {
                    let given = c.persistency != Persistency::None;
                    let none = given.then(|| "persistency=none".to_owned());
                    std::iter::once("enforcement=penalty".to_owned()).chain(none).collect()
                },
            ),
            Kind::Augmented if implicit || scheme.is_static() => self.each(
                contact,
                |c| plain(c) && c.enforcement == Enforcement::Multiplier,
                |_| vec!["enforcement=augmented".to_owned()],
            ),
            Kind::Multiplier if implicit => self.each(
                contact,
                |c| plain(c) && c.enforcement != Enforcement::Multiplier,
                |_| ["enforcement=multiplier", "persistency=project"].map(ToOwned::to_owned).into(),
            ),
            Kind::Stiffer => self.stiffness(contact, 10.0),
            Kind::Softer => self.stiffness(contact, 0.1),
            Kind::Full if implicit && case.newton.tangent != TangentRule::Full => {
                vec!["newton.tangent=full".to_owned()]
            }
            Kind::Project if implicit => {
                let unprojected = |c: &ContactSpec| {
                    c.enforcement.is_exact()
                        && c.law == Some(ContactLaw::Position)
                        && c.persistency == Persistency::None
                };
                self.each(contact, unprojected, |_| vec!["persistency=project".to_owned()])
            }
            Kind::Fallback if implicit && case.time.fallback == Fallback::None => {
                vec!["time.fallback=velocity".to_owned()]
            }
            _ => Vec::new(),
        };
        (!sets.is_empty()).then_some(sets)
    }

    /// The keys of the tables of some contacts; several contacts have one table in the case if it
    /// says `between`.
    fn each(
        &self,
        at: Option<&str>,
        of: impl Fn(&ContactSpec) -> bool,
        keys: impl Fn(&ContactSpec) -> Vec<String>,
    ) -> Vec<String> {
        let chosen = self.case.contacts.iter().filter(|c| of(c) && at.is_none_or(|at| at == c.name));
        let mut sets = Vec::new();
        for contact in chosen {
            let Some(table) = self.tables.get(contact.entry) else { continue };
            for key in keys(contact) {
                let set = format!("contact.{}.{key}", quoted(table));
                if !sets.contains(&set) {
                    sets.push(set);
                }
            }
        }
        sets
    }

    fn stiffness(&self, at: Option<&str>, factor: f64) -> Vec<String> {
        let springs = |c: &ContactSpec| c.enforcement == Enforcement::Penalty;
        self.each(at, springs, |c| vec![format!("stiffness={:?}", factor * c.stiffness)])
    }
}

/// Whether a contact may be enforced by springs and by multipliers.
fn plain(contact: &ContactSpec) -> bool {
    contact.law == Some(ContactLaw::Position)
        && contact.xi == ContactPoint::Closest
        && contact.detection == Detection::ClosestPoint
        && contact.restitution == 0.0
}

/// A name as a part of a key.
pub(super) fn quoted(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if name.chars().all(bare) { name.to_owned() } else { format!("{name:?}") }
}

/// The case of a document with the title of another one: without one in the text, a case has the
/// name of its file.
fn titled(document: &Document, like: &Case) -> Option<Case> {
    Some(Case { title: like.title.clone(), ..read(document).ok()? })
}

/// The text of a case with further options, as read from a file of its folder.
fn document(source: &Source, more: &[String]) -> Option<Document> {
    let sets = [&source.sets, more].concat();
    let name = source.folder.as_deref().unwrap_or("".as_ref()).join("case.toml");
    Document::parse(&name.display().to_string(), &source.text, &sets).ok()
}
