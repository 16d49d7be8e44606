//! Choice between direct and iterative solution of the linear systems of a case, and checks of
//! `newton.linear = "iterative"`.

use super::super::keys::word;
use super::super::{ContactSpec, LinearRule, TimeSpec};
use super::Check;

/// Unknowns in space from which conjugate gradients take less time than factors (ADR 52).
const MANY: f64 = 5_000.0;
const HELP: &str = "leave `linear` out";

impl LinearRule {
    /// Whether a case with this many unknowns is solved by iteration.
    pub fn iterates<'a>(
        self,
        dimension: usize,
        unknowns: f64,
        time: &TimeSpec,
        mut contacts: impl Iterator<Item = &'a ContactSpec>,
    ) -> bool {
        let moves = !time.scheme.is_static() && time.scheme.nonsmooth().is_none();
        match self {
            Self::Direct => false,
            Self::Iterative => true,
            Self::Auto => {
                let many = dimension == 3 && unknowns >= MANY;
                many && moves && !contacts.any(|contact| contact.friction.exists())
            }
        }
    }
}

impl<'a> Check<'a> {
    fn newton(&self, key: &str) -> Option<&'a str> {
        self.document.root().get("newton")?.table()?.get(key)?.text()
    }

    /// Value of `newton.linear`, or its default.
    pub(super) fn linear_rule(&self) -> LinearRule {
        self.newton("linear").and_then(word).unwrap_or_default()
    }

    pub(super) fn linear(&mut self) {
        if self.linear_rule() != LinearRule::Iterative {
            return;
        }
        let what = |of: String| format!("linear = \"iterative\" does not solve {of}");
        let draft = self.draft;
        if let Some(contact) = draft.contact.iter().flatten().find(|contact| contact.friction.exists()) {
            let why =
                "friction makes the rows of contact unsymmetric, and conjugate gradients need them symmetric";
            self.add(
                "newton.linear",
                what(format!("contact \"{}\", which has friction", contact.name)),
                why,
                HELP,
            );
        }
        if let Some(time) = draft.time.as_ref().filter(|time| time.scheme.nonsmooth().is_some()) {
            let why = "its steps need solutions for single contact forces, accurate to round-off, not the stages of an implicit scheme";
            self.add("newton.linear", what(format!("the steps of {}", time.scheme.kind)), why, HELP);
        }
        if self.newton("tangent") == Some("frozen-double") {
            let why = "\"frozen-double\" asks for a factorisation in double precision, and there is none";
            self.add("newton.tangent", what("with that tangent".into()), why, "use tangent = \"frozen\"");
        }
    }
}
