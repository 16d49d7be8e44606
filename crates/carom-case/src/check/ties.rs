//! Checks of ties: two different sides that no contact joins, bodies that both have mass or both
//! none, and a name of their own.

use super::super::{Overhang, PrimarySpec, TieMethod, TieSpec};
use super::Check;

impl Check<'_> {
    pub(super) fn ties(&mut self) {
        let ties = &self.draft.tie;
        for (k, tie) in ties.iter().enumerate() {
            let Some(tie) = tie else { continue };
            let path = |key: &str| format!("tie[{k}].{key}");
            let secondary = self.side(&tie.secondary, path("secondary"));
            let primary = self.side(&tie.primary, path("primary"));
            self.mortar_tie(k, tie);
            self.different_sides(k, tie);
            self.not_in_contact(k, tie);
            if let (Some(a), Some(b)) = (secondary, primary)
                && self.massless(a) != self.massless(b)
                && !self.is_static()
            {
                let [light, heavy] = if self.massless(a) { [a, b] } else { [b, a] };
                let what = format!("tie `{}` joins bodies with and without mass", tie.name);
                let why = format!(
                    "the balance of `{}`, which has no mass, holds at the end of a step, that of `{}` as a mean over it",
                    light.name, heavy.name
                );
                self.add(path("secondary"), what, why, "give both a density > 0, or both density = 0.0");
            }
            if self.draft.manufactured.is_some() {
                let why = "all boundary nodes follow the manufactured motion, and none is left to be tied";
                self.add(path("name"), "[manufactured] cannot have ties", why, "leave one of them out");
            }
            if self.draft.contact.iter().flatten().any(|contact| contact.name == tie.name) {
                let what = format!("a contact and a tie are both named `{}`", tie.name);
                let why = "the columns of their forces have their names";
                self.add(path("name"), what, why, "rename one of them");
            }
        }
    }

    /// Reports a mortar tie where it is not available.
    fn mortar_tie(&mut self, k: usize, tie: &TieSpec) {
        if tie.method != TieMethod::Mortar {
            return;
        }
        let path = format!("tie[{k}].method");
        if let Some(dimension @ (1 | 3)) = self.draft.dimension {
            let what = format!("method = \"mortar\" cannot be used in dimension {dimension}");
            let why = "its weights are integrals over curves in the plane";
            self.add(path, what, why, "leave `method` out");
        } else if tie.overhang == Overhang::Free {
            let what = "method = \"mortar\" cannot be used with overhang = \"free\"";
            let why = "a mean over a part of the surface that has no partner is not known";
            self.add(path, what, why, "exchange `secondary` and `primary`, or leave `method` out");
        }
    }

    /// Reports a contact of the sides of a tie.
    fn not_in_contact(&mut self, k: usize, tie: &TieSpec) {
        let contacts = self.draft.contact.iter().flatten();
        let same = contacts.filter(|contact| {
            let PrimarySpec::Side(primary) = &contact.primary else { return false };
            let sides = [&contact.secondary, primary];
            sides == [&tie.secondary, &tie.primary] || sides == [&tie.primary, &tie.secondary]
        });
        if let Some(contact) = same.into_iter().next() {
            let what = format!("tie `{}` and contact `{}` have the same sides", tie.name, contact.name);
            let why = "sides that move as one never part or slide: the contact would have no effect";
            self.add(format!("tie[{k}].name"), what, why, "leave one of them out");
        }
    }

    fn different_sides(&mut self, k: usize, tie: &TieSpec) {
        let path = format!("tie[{k}].primary");
        if tie.secondary == tie.primary {
            let why = "a side cannot move with itself";
            self.add(path, "both sides of the tie are the same", why, "give another side");
            return;
        }
        let others = &self.draft.tie[..k];
        let same = |other: &TieSpec| {
            let [a, b] = [(&other.secondary, &other.primary), (&tie.secondary, &tie.primary)];
            a == b || a == (b.1, b.0)
        };
        if let Some(other) = others.iter().flatten().find(|other| same(other)) {
            let why = format!("tie `{}` has the same sides", other.name);
            self.add(path, "this pair of sides is already tied", why, "leave one of them out");
        }
    }
}
