//! Facts of a case that its record states for metrics and studies.

use carom_record::metrics::Overlay;
use carom_record::{ContactFacts, Facts, Held, Stepping, Turns, body_of};

use super::spec::{
    Case, ContactSpec, Enforcement, FormulaSpec, Method, ObstacleMotion, OverlaySpec, Persistency,
    SupportSpec,
};

impl Case {
    /// Facts of the case that metrics, expectations and studies use.
    pub fn facts(&self) -> Facts {
        Facts {
            title: self.title.clone(),
            dimension: self.dimension,
            is_static: self.time.scheme.is_static(),
            stepping: self.stepping(),
            end: self.time.end,
            refine: self.refine,
            contacts: self.contacts.iter().map(contact).collect(),
            tied: self.tied(),
            held: self.supports.iter().flat_map(held).collect(),
            probes: self.probes.iter().map(|probe| probe.name.clone()).collect(),
            exact: self.exact.clone(),
            overlays: self.overlays.iter().map(overlay).collect(),
            expects: self.expects.clone(),
        }
    }

    /// Computations of a step of the scheme.
    fn stepping(&self) -> Stepping {
        let scheme = &self.time.scheme;
        if scheme.is_explicit() {
            Stepping::Explicit
        } else if scheme.conserves() {
            Stepping::EnergyMomentum
        } else {
            Stepping::Implicit
        }
    }

    /// Names of the bodies that ties join to another one, each once.
    fn tied(&self) -> Vec<String> {
        let mut names = Vec::new();
        for tie in &self.ties {
            let [a, b] = tie.bodies();
            if a != b {
                names.extend([a, b].map(str::to_owned));
            }
        }
        names.sort_unstable();
        names.dedup();
        names
    }
}

fn contact(spec: &ContactSpec) -> ContactFacts {
    ContactFacts {
        name: spec.name.clone(),
        secondary: spec.secondary.clone(),
        primary: spec.primary.side().map(str::to_owned),
        moves: !ObstacleMotion::is_fixed(&spec.motion),
        turns: turns(&spec.motion),
        is_penalty: spec.enforcement == Enforcement::Penalty,
        is_mortar: spec.method == Method::Mortar,
        projects: spec.persistency == Persistency::Project,
    }
}

fn turns(motion: &ObstacleMotion) -> Option<Turns> {
    let ObstacleMotion::Prescribed { rotate: Some((angle, _)), axis, .. } = motion else { return None };
    let axis = match axis.as_deref() {
        Some([x, y, z]) => [*x, *y, *z],
        _ => [0.0, 0.0, 1.0],
    };
    Some(Turns { angle: angle.to_string(), axis })
}

/// Constrained axes of all bodies of a support, each with its displacement if that is a formula;
/// the axis is none where it is the normal of the side.
fn held(support: &SupportSpec) -> Vec<Held> {
    let mut axes = Vec::new();
    if support.normal {
        axes.push((None, None));
    }
    axes.extend(support.fix.iter().map(|axis| (Some(*axis), None)));
    for (axis, displacement) in &support.moves {
        let formula = match displacement {
            FormulaSpec::Number(_) => None,
            FormulaSpec::Text(text) => Some(text.clone()),
        };
        axes.push((Some(*axis), formula));
    }
    let on = |side: &String| {
        let body = body_of(side).to_owned();
        let held = axes.iter().map(move |(axis, displacement)| Held {
            body: body.clone(),
            axis: *axis,
            displacement: displacement.clone(),
        });
        held.collect::<Vec<_>>()
    };
    support.on.iter().flat_map(on).collect()
}

fn overlay(spec: &OverlaySpec) -> Overlay {
    Overlay {
        name: spec.name.clone(),
        column: spec.column.clone(),
        times: spec.times.clone(),
        values: spec.values.clone(),
        source: spec.source.clone(),
    }
}
