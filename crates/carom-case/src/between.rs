//! Contacts among bodies, `between = "all"` or a list: one contact for each pair and one for each
//! side with itself.

use super::keys::View;
use super::spec::SKIN;
use super::tree::Value;
use super::{BodySpec, ContactSpec, MaterialSpec, PrimarySpec};

/// The bodies and materials of the case, as far as they could be read.
pub(super) struct Bodies<'a> {
    pub(super) bodies: &'a [Option<BodySpec>],
    pub(super) materials: &'a [Option<MaterialSpec>],
}

impl Bodies<'_> {
    /// λ + 2μ of a body, that of the softest of its materials.
    fn modulus(&self, body: &str) -> f64 {
        let body = self.bodies.iter().flatten().find(|spec| spec.name == body);
        let names = body.map_or_else(Vec::new, BodySpec::material_names);
        let of_body = self.materials.iter().flatten().filter(|m| names.contains(&m.name.as_str()));
        of_body.map(|material| material.lambda + 2.0 * material.mu).reduce(f64::min).unwrap_or(0.0)
    }

    /// The contacts of the table `v` with the key `between`; `one`: its other keys, `declared`: the
    /// bodies of contacts and ties that have tables of their own.
    pub(super) fn contacts(
        &self,
        v: &View,
        one: &ContactSpec,
        declared: &[Vec<String>],
    ) -> Option<Vec<ContactSpec>> {
        let of_itself: bool = v.get("self")?;
        let sides = self.sides(v)?;
        let body = |side: &str| side.split_once('.').map_or("", |side| side.0).to_owned();
        let known = |a: &str, b: &str| declared.iter().any(|bodies| *bodies == [a, b] || *bodies == [b, a]);
        let mut contacts = Vec::new();
        let mut add = |name: String, secondary: &str, primary: &str| {
            let primary = PrimarySpec::Side(primary.to_owned());
            contacts.push(ContactSpec { name, secondary: secondary.to_owned(), primary, ..one.clone() });
        };
        for (i, first) in sides.iter().enumerate() {
            let a = body(first);
            if of_itself && !known(&a, &a) {
                add(format!("{}-{a}", one.name), first, first);
            }
            for second in &sides[i + 1..] {
                let b = body(second);
                if known(&a, &b) {
                    continue;
                }
                let name = format!("{}-{a}-{b}", one.name);
                // The softer one is the secondary, of equals the first.
                if self.modulus(&b) < self.modulus(&a) {
                    add(name, second, first);
                } else {
                    add(name, first, second);
                }
            }
        }
        match &mut contacts[..] {
            // A case without bodies and an empty list are errors of their own.
            [] if self.bodies.is_empty() => return None,
            [] if v.has_problem(|p| p.path == format!("{}.between", v.path)) => return None,
            [] => {
                let what = format!("contact `{}` has no pair of sides", one.name);
                let why = "there is no other body, or the contacts and ties of these bodies are all \
                    declared in tables of their own";
                let help = if of_itself { "leave it out" } else { "leave out `self = false`" };
                return v.wrong("between", what, why, help);
            }
            [only] => only.name.clone_from(&one.name),
            _ => {}
        }
        Some(contacts)
    }

    /// The sides that `between` names; `None` if a body could not be read or is named wrongly.
    fn sides(&self, v: &View) -> Option<Vec<String>> {
        let between = v.table.get("between")?;
        if between.text() == Some("all") {
            return self.bodies.iter().map(|body| Some(format!("{}.{SKIN}", body.as_ref()?.name))).collect();
        }
        let Value::List(list) = &between.value else { return None };
        let whole = |name: &str| if name.contains('.') { name.to_owned() } else { format!("{name}.{SKIN}") };
        let sides: Vec<String> = list.iter().map(|node| node.text().map(whole)).collect::<Option<_>>()?;
        let body = |side: &str| side.split('.').next().unwrap_or_default().to_owned();
        for (j, side) in sides.iter().enumerate() {
            if sides[..j].iter().any(|other| body(other) == body(side)) {
                let what = format!("`between` has two sides of the body `{}`", body(side));
                let why = "a body meets each other body, and itself, in one contact";
                let help = format!("write \"{}\", which is its whole boundary", body(side));
                return v.wrong(&format!("between[{j}]"), what, why, help);
            }
        }
        Some(sides)
    }
}
