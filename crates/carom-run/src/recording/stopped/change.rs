//! Changes of a case that may get a run past the place where it stopped, as the options of the
//! command that make them.

use carom_case::{
    Case, ContactLaw, ContactPoint, Detection, Enforcement, Persistency, SchemeSpec, TangentRule,
};
use carom_time::ForceRule;

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
    /// Springs of the default stiffness at the place.
    Penalty,
    /// Springs ten times as stiff, or as soft.
    Stiffer,
    Softer,
    /// Multipliers in place of springs.
    Multiplier,
    /// A new tangent in every iteration.
    Full,
    /// Velocities that are compatible with contact where it begins.
    Project,
}

impl Kind {
    const ALL: [Self; 10] = [
        Self::Shorter,
        Self::Longer,
        Self::Damped,
        Self::Bathe,
        Self::Penalty,
        Self::Stiffer,
        Self::Softer,
        Self::Multiplier,
        Self::Full,
        Self::Project,
    ];
}

/// A changed case.
#[derive(Clone, Debug)]
pub(super) struct Change {
    pub kind: Kind,
    pub case: Case,
    /// `key=value` of every changed key.
    pub sets: Vec<String>,
}

/// Default of `stiffness`.
const STIFFNESS: f64 = 10.0;

impl Change {
    /// The change that these options make.
    pub(super) fn of(sets: &[String], case: &Case, contact: Option<&str>) -> Option<Self> {
        if sets.is_empty() {
            return None;
        }
        Kind::ALL.into_iter().filter_map(|kind| Self::new(kind, case, contact)).find(|c| c.sets == sets)
    }

    /// A change of a case, at one contact or at all; none if it changes nothing or cannot be used.
    pub(super) fn new(kind: Kind, case: &Case, contact: Option<&str>) -> Option<Self> {
        let mut change = Self { kind, case: case.clone(), sets: Vec::new() };
        let scheme = &case.time.scheme;
        let implicit = !scheme.is_static() && scheme.nonsmooth().is_none();
        match kind {
            Kind::Shorter => change.step(0.25),
            Kind::Longer if implicit && case.time.phase == 0.0 && case.time.steps().is_multiple_of(2) => {
                change.step(2.0);
            }
            Kind::Damped if implicit => {
                let rho = *scheme.parameters.get("rho_inf")?;
                let lower = if rho > 0.5 { 0.5 } else { 0.0 };
                if rho <= lower {
                    return None;
                }
                change.case.time.scheme.parameters.insert("rho_inf".into(), lower);
                change.sets.push(format!("time.scheme.rho_inf={lower:?}"));
            }
            Kind::Bathe if !scheme.is_static() && scheme.kind != "bathe" => change.bathe()?,
            Kind::Penalty if implicit => change.enforcement(contact, Enforcement::Penalty),
            Kind::Multiplier if implicit => change.enforcement(contact, Enforcement::Multiplier),
            Kind::Stiffer => change.stiffness(contact, 10.0),
            Kind::Softer => change.stiffness(contact, 0.1),
            Kind::Full if implicit && case.newton.tangent != TangentRule::Full => {
                change.case.newton.tangent = TangentRule::Full;
                change.sets.push("newton.tangent=full".into());
            }
            Kind::Project if implicit => change.project(contact),
            _ => {}
        }
        (!change.sets.is_empty()).then_some(change)
    }

    fn step(&mut self, factor: f64) {
        self.case.time.step *= factor;
        self.sets.push(format!("time.step={:?}", self.case.time.step));
    }

    /// The scheme of Bathe with contact on positions.
    fn bathe(&mut self) -> Option<()> {
        if self.case.contacts.iter().any(|c| c.restitution != 0.0 || c.xi == ContactPoint::Frozen) {
            return None;
        }
        self.case.time.scheme = SchemeSpec {
            kind: "bathe".into(),
            parameters: [("rho_inf".to_owned(), 0.0)].into(),
            forces: ForceRule::default(),
        };
        self.sets.push("time.scheme={ kind = \"bathe\", rho_inf = 0.0 }".into());
        for contact in &mut self.case.contacts {
            if contact.law == Some(ContactLaw::Predictor) {
                self.sets.push(format!("contact.{}.law=position", contact.name));
            }
            contact.law = Some(ContactLaw::Position);
        }
        Some(())
    }

    fn enforcement(&mut self, at: Option<&str>, to: Enforcement) {
        for contact in &mut self.case.contacts {
            let usable = contact.law == Some(ContactLaw::Position)
                && contact.xi == ContactPoint::Closest
                && contact.detection == Detection::ClosestPoint
                && contact.restitution == 0.0;
            if contact.enforcement == to || !usable || at.is_some_and(|at| at != contact.name) {
                continue;
            }
            contact.enforcement = to;
            let word = if to == Enforcement::Penalty {
                contact.stiffness = STIFFNESS;
                contact.persistency = Persistency::None;
                "penalty"
            } else {
                contact.persistency = Persistency::Project;
                "multiplier"
            };
            self.sets.push(format!("contact.{}.enforcement={word}", contact.name));
        }
    }

    fn project(&mut self, at: Option<&str>) {
        for contact in &mut self.case.contacts {
            let usable = contact.enforcement == Enforcement::Multiplier
                && contact.law == Some(ContactLaw::Position)
                && contact.persistency == Persistency::None;
            if usable && at.is_none_or(|at| at == contact.name) {
                contact.persistency = Persistency::Project;
                self.sets.push(format!("contact.{}.persistency=project", contact.name));
            }
        }
    }

    fn stiffness(&mut self, at: Option<&str>, factor: f64) {
        for contact in &mut self.case.contacts {
            if contact.enforcement == Enforcement::Penalty && at.is_none_or(|at| at == contact.name) {
                contact.stiffness *= factor;
                self.sets.push(format!("contact.{}.stiffness={:?}", contact.name, contact.stiffness));
            }
        }
    }
}
