//! What `newton.linear = "iterative"` cannot solve.

use super::super::tree::Node;
use super::Check;

impl Check<'_> {
    pub(super) fn linear(&mut self) {
        let newton = self.document.root().get("newton").and_then(Node::table);
        let given = |key: &str| newton.and_then(|table| table.get(key)).and_then(Node::text);
        if given("linear") != Some("iterative") {
            return;
        }
        const HELP: &str = "leave `linear` out";
        let what = |of: String| format!("linear = \"iterative\" does not solve {of}");
        let draft = self.draft;
        if let Some(contact) = draft.contacts.iter().flatten().find(|contact| contact.friction.exists()) {
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
        if given("tangent") == Some("frozen-double") {
            let why = "\"frozen-double\" asks for a factorisation in double precision, and there is none";
            self.add("newton.tangent", what("with that tangent".into()), why, "use tangent = \"frozen\"");
        }
    }
}
