//! Checks of friction: what it is built for. Everything else is refused, never without friction.

use super::super::{ContactLaw, Detection};
use super::super::{ContactPoint, ContactSpec, Enforcement, MassKind, ObstacleMotion};
use super::Check;

impl Check<'_> {
    /// Combinations that have no friction yet.
    pub(super) fn friction(&mut self, contact: &ContactSpec) {
        if contact.mu == 0.0 {
            return;
        }
        let draft = self.draft;
        let scheme = draft.time.as_ref().map(|time| &time.scheme);
        let turns = matches!(&contact.motion, ObstacleMotion::Prescribed { rotate: Some(_), .. });
        let is_light = |side: &str| {
            let name = side.split_once('.').map_or(side, |(body, _)| body);
            draft.bodies.iter().flatten().any(|body| {
                body.name == name && body.mass != MassKind::Consistent && body.mass != MassKind::Lumped
            })
        };
        let light = is_light(&contact.secondary) || contact.primary.side().is_some_and(is_light);
        let mut refuse = |with: &str, why: &str, help: &str| {
            let what = format!("mu = {} cannot be used {with}", contact.mu);
            self.add_unique(contact.path("mu"), what, why, help);
        };
        if draft.dimension == Some(1) {
            refuse("in dimension 1", "the end of a bar has no tangent", "leave mu out");
        }
        if let Some(scheme) = scheme
            && (scheme.nonsmooth().is_some() || scheme.conserves())
        {
            let why = "friction is built for schemes whose stages balance forces: the α family, two-stage and two-step schemes, and \"static\"";
            let help = "use a scheme such as chung-hulbert, hht, newmark, bathe or tr-bdf2, or leave mu out";
            refuse(&format!("with scheme `{}`", scheme.kind), why, help);
        }
        if contact.enforcement == Enforcement::Penalty {
            let why = "friction of penalty springs needs springs of its own in the tangential direction, which are not built yet";
            refuse("with a penalty", why, "use enforcement = \"multiplier\", or leave mu out");
        }
        if contact.law == Some(ContactLaw::Predictor) {
            let why = "the projection of the predictor has no friction";
            refuse("with law = \"predictor\"", why, "use law = \"position\", or leave mu out");
        }
        if contact.xi == ContactPoint::Frozen || contact.detection == Detection::Trajectory {
            let why = "the slip is that of the closest point";
            refuse("with this contact point", why, "leave xi and detection out, or leave mu out");
        }
        if turns {
            let why = "the slip on an obstacle is exact only while it does not turn within a step";
            refuse(
                "with an obstacle that turns",
                why,
                "use a body instead of the obstacle, leave out `rotate`, or leave mu out",
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
}
