//! Contact that nobody has declared: bodies that overlap without a contact, and bodies that cross
//! themselves. Nothing prevents it, and no force comes of it: it is warned of.

use std::collections::HashMap;

use carom_contact::Skin;

use crate::model::{BodyInstance, Model};
use crate::penetration::Penetration;
use crate::skins::{part_of, plane_skin, skin, skin_facets};
use crate::valid_cells::Checked;
use crate::watched::{Watched, Way, lengths};

/// Allowed depth of bodies without a contact, over the length of a facet.
const UNDECLARED: f64 = 0.01;

/// Finds it. A cache: its content affects no result.
#[derive(Debug)]
pub(crate) struct Undeclared {
    between: Penetration,
    /// The bodies that may cross themselves, once they have been asked for.
    own: Option<Vec<Own>>,
}

/// A body that may cross itself.
#[derive(Debug)]
struct Own {
    body: usize,
    skin: Skin,
    /// The contact of each facet with its own body.
    declared: Vec<Option<usize>>,
    checked: Checked,
}

impl Undeclared {
    /// For all bodies in the plane or in space; in space none is asked whether it crosses itself.
    pub(crate) fn new(model: &Model) -> Self {
        let declared = |a: usize, b: usize| {
            model.contacts.iter().any(|contact| {
                let other = contact.facets.first().and_then(|(_, facets)| part_of(model, facets.first()?[0]));
                let pair = (contact.primary_part, other);
                pair == (Some(a), Some(b)) || pair == (Some(b), Some(a))
            })
        };
        let mut ways = Vec::new();
        let solid = |(_, part): &(usize, &BodyInstance)| skin(part).is_some();
        for (a, part) in model.parts.iter().enumerate().filter(solid) {
            let facets = skin_facets(part);
            for body in (0..model.parts.len()).filter(|&b| b != a && !declared(a, b)) {
                let nodes = lengths(model, &facets)
                    .map(|(node, length)| Watched::new(node, length, false, UNDECLARED));
                ways.push(Way::new(model, None, body, nodes.collect()));
            }
        }
        Self { between: Penetration::new(model, ways, Vec::new()), own: None }
    }

    /// Pairs of bodies of which one is inside the other, and each body that crosses itself as a
    /// pair with itself.
    pub(crate) fn found(&mut self, model: &Model, y: &[f64]) -> Vec<(usize, usize)> {
        let mut pairs = self.overlapping(model, y);
        pairs.extend(self.crossing_themselves(model, y));
        pairs
    }

    fn overlapping(&mut self, model: &Model, y: &[f64]) -> Vec<(usize, usize)> {
        self.between.begin(model, y);
        let mut pairs = Vec::new();
        for k in 0..self.between.ways.len() {
            if let (_, Some(found)) = self.between.deepest(model, k, None)
                && let Some(part) = part_of(model, found.node)
            {
                let body = self.between.ways[k].body;
                pairs.push((part.min(body), part.max(body)));
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    fn crossing_themselves(&mut self, model: &Model, y: &[f64]) -> Vec<(usize, usize)> {
        let skins = self.own.get_or_insert_with(|| own(model));
        let crosses = |Own { body, skin, declared, checked }: &mut Own| {
            let now = model.parts[*body].of(y);
            if checked.holds(now, model.dimension) {
                return None;
            }
            skin.update(y);
            let known = |a: usize, b: usize| declared[a].is_some() && declared[a] == declared[b];
            let crosses = skin.crosses_itself(y, known);
            checked.set(now, if crosses { 0.0 } else { skin.clearance_to_itself(y) });
            crosses.then_some((*body, *body))
        };
        skins.iter_mut().filter_map(crosses).collect()
    }
}

/// The bodies of which not the whole boundary is in one contact with itself.
fn own(model: &Model) -> Vec<Own> {
    let mut contact_of: HashMap<&[usize], usize> = HashMap::new();
    for (k, contact) in model.contacts.iter().enumerate().filter(|(_, contact)| contact.itself) {
        for facet in contact.facets.iter().flat_map(|(_, facets)| facets) {
            contact_of.entry(facet).or_insert(k);
        }
    }
    let skins = model.parts.iter().enumerate().filter_map(|(body, part)| {
        let of = |facet: &Vec<usize>| contact_of.get(facet.as_slice()).copied();
        let declared: Vec<Option<usize>> = skin_facets(part).iter().map(of).collect();
        let in_one = declared.iter().all(|contact| contact.is_some() && *contact == declared[0]);
        if in_one {
            None
        } else {
            Some(Own { body, skin: plane_skin(part)?, declared, checked: Checked::default() })
        }
    });
    skins.collect()
}
