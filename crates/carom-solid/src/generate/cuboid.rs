//! Box of nx × ny × nz boxes: hexahedra, or each cut into six tetrahedra around the diagonal from
//! its lowest to its highest corner (H. Freudenthal, Ann. Math. 43 (1942) 580–582): one tetrahedron
//! for every order in which a path along the edges takes the three directions. Neighbouring boxes
//! cut their common rectangle along the same diagonal. All nodes lie on the lattice that divides
//! every edge by the degree, and every point of the lattice is a node.

use std::collections::BTreeMap;

use super::{MeshError, check, lerp};
use crate::element_shape::of_shape;
use crate::mesh::{Element, Facet, Mesh};
use crate::shape::lattice;
use crate::subdivide::freudenthal;

/// Sides: axis, and whether at its upper end.
const SIDES: [(&str, usize, bool); 6] = [
    ("left", 0, false),
    ("right", 0, true),
    ("front", 1, false),
    ("back", 1, true),
    ("bottom", 2, false),
    ("top", 2, true),
];

/// Box from `min` to `max`, `cells` along x, y and z; sides `left` (−x), `right` (+x), `front`
/// (−y), `back` (+y), `bottom` (−z), `top` (+z).
///
/// # Errors
/// If an extent is not positive, there are no cells, or the element does not fill space.
///
/// ```
/// use carom_solid::{Element, generate};
/// let block = generate::cuboid(Element::Tet10, [0.0; 3], [3.0, 2.0, 1.0], [3, 2, 1])?;
/// assert_eq!((block.cell_count(), block.nodes.len()), (36, 7 * 5 * 3));
/// # Ok::<(), carom_solid::generate::MeshError>(())
/// ```
pub fn cuboid(element: Element, min: [f64; 3], max: [f64; 3], cells: [usize; 3]) -> Result<Mesh, MeshError> {
    check(element, &min, &max, &cells)?;
    Ok(filled(element, [min, max], cells, &pieces(element)?, &SIDES))
}

/// Box in any dimension of boxes that these cells fill, by their nodes in the lattice of one of
/// them; its sides are each at an end of an axis.
pub(super) fn filled<const D: usize>(
    element: Element,
    [min, max]: [[f64; D]; 2],
    cells: [usize; D],
    pieces: &[Vec<[usize; D]>],
    named: &[(&str, usize, bool)],
) -> Mesh {
    let k = element.degree();
    let counts = cells.map(|n| k * n + 1);
    let number = |at: [usize; D]| (0..D).rev().fold(0, |sum, i| sum * counts[i] + at[i]);
    // Of all points of a lattice, the first axis fastest.
    let place = |counts: [usize; D], mut code: usize| {
        counts.map(|count| {
            let at = code % count;
            code /= count;
            at
        })
    };
    let node = |code: usize| -> [f64; D] {
        let at = place(counts, code);
        std::array::from_fn(|i| lerp(min[i], max[i], at[i] as f64 / (counts[i] - 1) as f64))
    };
    let nodes: Vec<[f64; D]> = (0..counts.iter().product()).map(node).collect();
    let mut numbers = Vec::new();
    let mut sides: BTreeMap<String, Vec<Facet>> =
        named.iter().map(|(name, ..)| ((*name).to_owned(), Vec::new())).collect();
    for code in 0..cells.iter().product() {
        let lowest = place(cells, code);
        for piece in pieces {
            let at = |a: usize| -> [usize; D] { std::array::from_fn(|i| k * lowest[i] + piece[a][i]) };
            let cell = numbers.len() / piece.len();
            numbers.extend((0..piece.len()).map(|a| number(at(a))));
            for facet in element.facets() {
                for (name, axis, upper) in named {
                    let end = if *upper { k * cells[*axis] } else { 0 };
                    if facet.iter().all(|&a| at(a)[*axis] == end) {
                        let nodes = facet.iter().map(|&a| number(at(a))).collect();
                        sides.entry((*name).to_owned()).or_default().push(Facet { cell, nodes });
                    }
                }
            }
        }
    }
    Mesh { element, nodes: nodes.into(), cells: numbers, regions: Vec::new(), sides, repairs: Vec::new() }
}

/// The cells that fill one box, by their nodes in its lattice.
fn pieces(element: Element) -> Result<Vec<Vec<[usize; 3]>>, MeshError> {
    let other = MeshError::Dimension { element, dimension: 3 };
    let cell = of_shape!(3, element, lattice(), return Err(other));
    if matches!(element, Element::Hex8 | Element::Hex27) {
        return Ok(vec![cell]);
    }
    let tetrahedron = |corners: [[usize; 3]; 4]| {
        let node = |at: &[usize; 3]| {
            let weights = [element.degree() - at.iter().sum::<usize>(), at[0], at[1], at[2]];
            [0, 1, 2].map(|i| (0..4).map(|c| weights[c] * corners[c][i]).sum())
        };
        cell.iter().map(node).collect()
    };
    Ok(freudenthal([0; 3]).map(tetrahedron).collect())
}
