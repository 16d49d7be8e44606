//! Warning about stick that begins in vibrations. Where a pair begins to stick, its traction falls
//! from that of slip to what carries the body, and whatever then moves on its own vibrates: nodes
//! behind the contact, the springs of a penalty, and, without the projection, the velocity of the
//! pair itself, which a scheme with ρ∞ = 1 turns round in every step. Of an amplitude that nothing
//! damps the first peak beyond μ ends the stick, and with a smaller μ in slip it does not return.

use carom_case::{Case, ContactSpec, Enforcement, FormulaSpec, Persistency, SchemeSpec};
use carom_mechanics::model::{Contact, Model};
use carom_time::Explained;

use super::found::Found;

/// Round-off of a spectral radius of 1 at infinite frequency.
const ROUND_OFF: f64 = 1e-9;

pub(super) fn undamped_stick(case: &Case, model: &Model) -> Vec<Found> {
    let weakens = |spec: &ContactSpec| {
        let stick = spec.friction.mu.as_ref().and_then(FormulaSpec::constant);
        spec.friction.mu_dynamic.is_some_and(|slip| stick.is_none_or(|stick| slip < stick))
    };
    let scheme = &case.time.scheme;
    let contacts = || case.contacts.iter().filter(|spec| weakens(spec));
    if contacts().next().is_none() || scheme.is_static() || damps(scheme) {
        return Vec::new();
    }
    let of = |spec: &ContactSpec| {
        let vibrates = cause(case, model, spec)?;
        let what = format!(
            "`mu_dynamic` is less than `mu`, and `{}` with these parameters damps no vibration (ρ∞ = 1): where \
             stick begins, {vibrates}",
            scheme.kind
        );
        Some(Found::of_contact(&spec.name, what))
    };
    contacts().filter_map(of).collect()
}

/// Whether a scheme damps vibrations of infinite frequency.
fn damps(scheme: &SchemeSpec) -> bool {
    let rho = scheme.integrator().ok().and_then(|made| match made.explain() {
        Explained::Stages(explained) => Some(explained.rho_inf),
        Explained::Nonsmooth(explained) => explained.rho_inf,
    });
    rho.is_some_and(|rho| rho < 1.0 - ROUND_OFF)
}

/// The vibrating part where stick begins; none if the contact holds everything that may move.
fn cause(case: &Case, model: &Model, spec: &ContactSpec) -> Option<&'static str> {
    if spec.enforcement == Enforcement::Penalty {
        return Some("the springs of sticking nodes begin to vibrate");
    }
    let position = case.time.scheme.nonsmooth().is_none();
    if position && spec.persistency == Persistency::None {
        return Some("the velocity of a sticking node is turned round in every step");
    }
    let d = model.dimension;
    let moves = |node: usize| {
        let holds = |contact: &Contact| contact.friction.is_some() && contact.surface.contains(&node);
        (0..d).any(|i| !model.fixed[d * node + i]) && !model.contacts.iter().any(holds)
    };
    let bodies = || model.parts.iter().filter(|part| spec.bodies().any(|body| body == part.name));
    bodies().any(|part| part.nodes().any(moves)).then_some("the bodies begin to vibrate")
}
