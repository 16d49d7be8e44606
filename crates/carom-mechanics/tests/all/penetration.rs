//! Depths that a contact allows its nodes, at kinks and elsewhere.

use carom_mechanics::model::{Loads, Motions};
use carom_mechanics::{Penetration, Rejected, State};
use carom_solid::{Element, Law, generate};

use crate::models::{contact, model, parts};

/// Why a state is rejected, if it is, in which a block of this many cells lies this deep in a wider
/// one, whose facets are 0.5 long, from x = 0 to 4, in the plane or in space.
fn too_deep(dimension: usize, cells: usize, from: f64, depth: f64) -> Option<Rejected> {
    let wide = 0.5 * cells as f64;
    let high = 1.0 - depth;
    let law = Law::NeoHookean { lambda: 1.0, mu: 1.0 };
    let (meshes, [below, above]) = if dimension == 2 {
        let block = |min, max, cells| generate::rectangle(Element::T3, min, max, cells).unwrap();
        let upper = block([from, high], [from + wide, high + 1.0], [cells, 1]);
        ([block([0.0, 0.0], [4.0, 1.0], [8, 2]), upper], ["bottom", "top"])
    } else {
        let block = |min, max, cells| generate::cuboid(Element::Tet4, min, max, cells).unwrap();
        let upper = block([from, 1.2, high], [from + wide, 1.2 + wide, high + 1.0], [cells, cells, 1]);
        ([block([0.0; 3], [4.0, 4.0, 1.0], [8, 8, 2]), upper], ["bottom", "top"])
    };
    let parts = parts(meshes, law, 1.0);
    let mut strike = contact(&parts, (1, below), (0, above));
    let mesh = parts[0].body.mesh();
    let facets = mesh.sides[above].iter().map(|facet| facet.nodes.clone()).collect();
    strike.facets.push((mesh.element.facet_shape(), facets));
    let model = model(parts, &[], Motions::default(), Loads::default(), vec![strike]);
    let state = State { y: model.reference.clone(), pairs: vec![Vec::new()], ..State::default() };
    Penetration::of_contacts(&model).check(&model, &state).err()
}

#[test]
fn constrained_nodes_are_held_to_a_millionth_of_a_facet_away_from_kinks() {
    for dimension in [2, 3] {
        for (depth, is_too_deep) in [(4e-7, false), (6e-7, true)] {
            let found = too_deep(dimension, 3, 1.2, depth);
            assert_eq!(found.is_some(), is_too_deep, "{dimension} {depth}");
            if let Some(found) = found {
                let Rejected::Penetration { depth: measured, limit, .. } = found else { panic!("{found}") };
                assert!((measured - depth).abs() < 1e-12 && (limit - 5e-7).abs() < 1e-12);
            }
        }
        // The block with one cell has no other nodes but its corners.
        for (depth, is_too_deep) in [(4e-3, false), (6e-3, true)] {
            let found = too_deep(dimension, 1, 1.2, depth);
            assert_eq!(found.is_some(), is_too_deep, "{dimension} {depth}: {found:?}");
        }
    }
}
