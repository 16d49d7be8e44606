//! Checks of friction. What it is not built for is refused, so that no case runs without the
//! friction that it asks for.

use super::super::{ContactLaw, Detection};
use super::super::{ContactPoint, ContactSpec, Enforcement, FormulaSpec, FrictionSpec, ObstacleMotion};
use super::Check;

impl Check<'_> {
    /// Reports combinations with which friction is not implemented.
    pub(super) fn friction(&mut self, contact: &ContactSpec) {
        self.friction_keys(contact);
        if !contact.friction.exists() {
            return;
        }
        let draft = self.draft;
        let scheme = self.scheme();
        let is_light = |side: &str| {
            let name = side.split_once('.').map_or(side, |(body, _)| body);
            draft.body.iter().flatten().any(|body| body.name == name && body.mass.is_redistributed())
        };
        let light = is_light(&contact.secondary) || contact.primary.side().is_some_and(is_light);
        let mut refuse = |with: &str, why: &str, help: &str| {
            let key = if contact.friction.mu.is_some() { "mu" } else { "shear" };
            let value = match &contact.friction.mu {
                Some(FormulaSpec::Number(mu)) => format!(" = {mu}"),
                Some(FormulaSpec::Text(mu)) => format!(" = \"{mu}\""),
                None => String::new(),
            };
            self.add_unique(contact.path(key), format!("{key}{value} cannot be used {with}"), why, help);
        };
        if draft.dimension == Some(1) {
            refuse("in dimension 1", "the end of a bar has no tangent", "leave mu out");
        }
        if let Some(scheme) = scheme
            && contact.enforcement == Enforcement::Penalty
            && scheme.conserves()
        {
            let why = "the gap of an energy-conserving spring is updated from step to step, and a tangential \
                spring is not implemented for it";
            refuse("with a conserving penalty", why, "use enforcement = \"multiplier\", or leave mu out");
        }
        if contact.law == Some(ContactLaw::Predictor) {
            let why = "the projection of the predictor has no friction";
            refuse("with law = \"predictor\"", why, "use law = \"position\", or leave mu out");
        }
        if contact.xi == ContactPoint::Frozen || contact.detection == Detection::Trajectory {
            let why = "the slip is that of the closest point";
            refuse("with this contact point", why, "leave xi and detection out, or leave mu out");
        }
        if draft.dimension != Some(1) && matches!(contact.motion, ObstacleMotion::Free { .. }) {
            let why = "friction turns an obstacle that moves freely, and rigid obstacles do not rotate yet: its \
                spin, and the slip that depends on it, would be wrong";
            refuse(
                "against an obstacle with a mass",
                why,
                "use a stiff deformable body in place of the obstacle, or leave mu out",
            );
        }
        if light {
            let why = "a node without mass would stick and slip without inertia";
            refuse(
                "with redistributed mass",
                why,
                "use mass = \"consistent\" or \"lumped\", or leave mu out",
            );
        }
    }

    /// Reports keys of friction that have no effect without another key.
    fn friction_keys(&mut self, contact: &ContactSpec) {
        let FrictionSpec { mu, mu_dynamic, decay, stick_stiffness, .. } = &contact.friction;
        let mut needs = |key: &str, given: bool, other: &str, has: bool, why: &str| {
            if given && !has {
                let what = format!("`{key}` is given without {other}");
                self.add(contact.path(key), what, why, format!("give {other}, or leave out `{key}`"));
            }
        };
        let why = "it is the coefficient of a node that slips, which is at most that of one that sticks";
        needs("mu_dynamic", mu_dynamic.is_some(), "`mu`", mu.is_some(), why);
        let why = "it is the rate of the transition from `mu` to `mu_dynamic`";
        needs("decay", decay.is_some(), "`mu_dynamic`", mu_dynamic.is_some(), why);
        let springs = contact.enforcement != Enforcement::Multiplier;
        let why = "a multiplier enforces stick exactly";
        needs("stick_stiffness", stick_stiffness.is_some(), "a penalty", springs, why);
        let constant = mu.as_ref().and_then(FormulaSpec::constant);
        if let (Some(stick), Some(slip)) = (constant, *mu_dynamic)
            && slip > stick
        {
            let what = format!("mu_dynamic = {slip} is larger than mu = {stick}");
            let why = "a node that began to slip would stick again at once";
            let help = "give a smaller one, or leave out `mu_dynamic`";
            self.add(contact.path("mu_dynamic"), what, why, help);
        }
        if let Some(mu) = constant.filter(|mu| *mu < 0.0) {
            let what = format!("`mu` must be a number ≥ 0, not {mu}");
            self.add(contact.path("mu"), what, "friction takes energy", "give 0 or a positive number");
        }
    }
}
