//! A state as fields for viewers: displacement, velocity, stress (nodal mean within each body) and contact pressure.

use std::collections::BTreeMap;

use carom_contact::Linearised;
use carom_record::{Block, Cell, FieldSet, PointArray};
use carom_solid::line_shape;

use super::units::Labels;
use crate::case::Case;
use crate::model::{Contact, Model};
use crate::state::State;

/// Fields of a state.
pub(super) fn field_set<const D: usize>(case: &Case, model: &Model<D>, state: &State) -> FieldSet {
    let label = Labels::of(case);
    let spatial = |x: &[f64; D]| -> [f64; 3] { std::array::from_fn(|i| if i < D { x[i] } else { 0.0 }) };
    let vectors = |values: &[f64]| values.as_chunks::<D>().0.iter().flat_map(spatial).collect::<Vec<f64>>();
    let moved: Vec<f64> = state.y.iter().zip(&model.reference).map(|(y, x)| y - x).collect();
    let blocks = model.parts.iter().map(|part| {
        let mesh = part.body.mesh();
        Block {
            body: part.name.clone(),
            cell: if D == 1 { Cell::Curve } else { Cell::Triangle },
            degree: mesh.element.degree(),
            connectivity: mesh.cells.iter().map(|n| n + part.first_node).collect(),
        }
    });
    let array = |name: &str, unit: &str, components: usize, values: Vec<f64>| PointArray {
        name: name.into(),
        unit: unit.into(),
        components,
        values,
    };
    FieldSet {
        points: model.reference.as_chunks::<D>().0.iter().map(spatial).collect(),
        blocks: blocks.collect(),
        arrays: vec![
            array("displacement", &label.length, 3, vectors(&moved)),
            array("velocity", &label.velocity, 3, vectors(&state.v)),
            array("stress", &label.stress, 6, nodal_stress(model, state)),
            array("contact_pressure", &label.stress, 1, pressures(case, model, state)),
        ],
    }
}

/// Cauchy stress XX YY ZZ XY YZ XZ at the nodes, mean over the cells of a node that have one there; NaN where none has (J ≤ 0).
fn nodal_stress<const D: usize>(model: &Model<D>, state: &State) -> Vec<f64> {
    let nodes = model.mass.nodes();
    let (mut sum, mut count) = (vec![[0.0; 6]; nodes], vec![0.0_f64; nodes]);
    for part in &model.parts {
        let mesh = part.body.mesh();
        let y = &state.y.as_chunks::<D>().0[part.nodes()];
        let places = part.body.reference_nodes();
        for cell in 0..mesh.cell_count() {
            for (&node, xi) in mesh.cell(cell).iter().zip(&places) {
                if let Ok(point) = part.body.point(cell, xi, y) {
                    let s = point.cauchy;
                    let components = [s[0][0], s[1][1], s[2][2], s[0][1], s[1][2], s[0][2]];
                    for (total, c) in sum[part.first_node + node].iter_mut().zip(components) {
                        *total += c;
                    }
                    count[part.first_node + node] += 1.0;
                }
            }
        }
    }
    sum.iter().zip(&count).flat_map(|(s, n)| s.map(|x| x / n)).collect()
}

fn pressures<const D: usize>(case: &Case, model: &Model<D>, state: &State) -> Vec<f64> {
    let mut pressure = vec![0.0; model.mass.nodes()];
    for (contact, pairs) in model.contacts.iter().zip(&state.pairs) {
        let weights = consistent_weights(contact, state, case.thickness);
        for pair in pairs.iter().filter(|p| p.active) {
            pressure[contact.method.secondary()[pair.node]] -= pair.lambda / weights[pair.node];
        }
    }
    pressure
}

/// ∫φᴺ ds over the current secondary side, times the thickness: the area a multiplier acts on. One entry per secondary node.
pub(super) fn consistent_weights<const D: usize>(contact: &Contact<D>, state: &State, thickness: f64) -> Vec<f64> {
    // Gauss–Legendre with three points: exact for |y'| constant and φ of degree 3.
    const RULE: [(f64, f64); 3] =
        [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];
    let secondary = contact.method.secondary();
    if D == 1 {
        return vec![thickness; secondary.len()];
    }
    let place: std::collections::HashMap<usize, usize> = secondary.iter().enumerate().map(|(k, &n)| (n, k)).collect();
    let mut weights = vec![0.0; secondary.len()];
    let y = state.y.as_chunks::<D>().0;
    for facet in &contact.secondary_facets {
        for (xi, w) in RULE {
            let shape = line_shape(facet.len(), xi);
            let tangent: [f64; D] =
                std::array::from_fn(|i| facet.iter().enumerate().map(|(k, &n)| shape.first[k] * y[n][i]).sum());
            let length = tangent.iter().map(|t| t * t).sum::<f64>().sqrt();
            for (k, n) in facet.iter().enumerate() {
                if let Some(&p) = place.get(n) {
                    weights[p] += w * shape.values[k] * length * thickness;
                }
            }
        }
    }
    weights
}

/// Gap of a pair in a state and the unit normal ∂g/∂y of its secondary node; NaN where it has none.
pub(super) fn gap_of<const D: usize>(
    contact: &Contact<D>,
    pair: &carom_contact::Pair,
    state: &State,
) -> (f64, [f64; 2]) {
    let mut gap = Linearised::default();
    let known = contact.method.linearise(&mut pair.clone(), state.y.as_chunks::<D>().0, 0.0, &mut gap);
    known.map_or((f64::NAN, [f64::NAN; 2]), |()| {
        (gap.gap, std::array::from_fn(|i| if i < D { gap.gradient[0][i] } else { 0.0 }))
    })
}

/// Chains of point numbers of every named side, in the order in which the boundary is walked.
pub(super) fn sides<const D: usize>(model: &Model<D>) -> BTreeMap<String, Vec<Vec<usize>>> {
    let mut named = BTreeMap::new();
    for part in &model.parts {
        for (side, facets) in &part.body.mesh().sides {
            let mut chains: Vec<Vec<usize>> = Vec::new();
            for facet in facets {
                let (ends, interior) = facet.nodes.split_at(facet.nodes.len().min(2));
                let walk = ends.iter().take(1).chain(interior).chain(ends.iter().skip(1)).map(|n| n + part.first_node);
                match chains.last_mut() {
                    Some(chain) if chain.last() == Some(&(facet.nodes[0] + part.first_node)) => {
                        chain.extend(walk.skip(1));
                    }
                    _ => chains.push(walk.collect()),
                }
            }
            named.insert(format!("{}.{side}", part.name), chains);
        }
    }
    named
}
