//! Extrusion: a mesh of the plane along z. Its triangles become prisms and these tetrahedra, its
//! quadrilaterals hexahedra; every node stands above one of the plane.

use std::collections::HashMap;

use super::lattice::{HEXAHEDRON, Key, Lattice, PRISM};
use super::{MeshError, lerp, positive};
use crate::element_shape::of_shape;
use crate::mesh::{Element, Mesh};
use crate::shape::lattice;

/// A mesh of the plane from z = 0 to the height, in layers of cells; its sides, and `bottom` and
/// `top`, or if it has these, `base` and `lid`.
///
/// # Errors
/// If the height is not positive, there are no layers, or the mesh is not plane.
///
/// ```
/// use carom_solid::{Element, generate};
/// let disc = generate::disc(Element::T6, 1.0, [0.0, 0.0], 0.5)?;
/// let coin = generate::extrusion(&disc, 0.2, 2)?;
/// assert_eq!((coin.element, coin.cell_count()), (Element::Tet10, 6 * disc.cell_count()));
/// # Ok::<(), carom_solid::generate::MeshError>(())
/// ```
pub fn extrusion(plane: &Mesh, height: f64, layers: usize) -> Result<Mesh, MeshError> {
    let element = extruded(plane.element)
        .ok_or(MeshError::Dimension { element: plane.element, dimension: plane.dimension() })?;
    positive(&[("height", height)])?;
    if layers == 0 {
        return Err(MeshError::Cells { cells: vec![layers] });
    }
    let k = element.degree();
    let levels = k * layers;
    let place = |key: Key| {
        let x = &plane.nodes[key[0] as usize];
        [x[0], x[1], lerp(0.0, height, key[1] as f64 / levels as f64)]
    };
    let mut mesh = Lattice::new(element, place)?;
    // The node of a plane cell at a point of its lattice.
    let other = MeshError::Dimension { element: plane.element, dimension: 2 };
    let places = of_shape!(2, plane.element, lattice(), return Err(other));
    let local: HashMap<[usize; 2], usize> = places.into_iter().enumerate().map(|(a, at)| (at, a)).collect();
    let solid = if plane.element.facets().len() == 3 { &PRISM } else { &HEXAHEDRON };
    for cell in 0..plane.cell_count() {
        let nodes = plane.cell(cell);
        for layer in 0..layers {
            mesh.add(solid, |[x, y, z]| [nodes[local[&[x, y]]] as i64, (k * layer + z) as i64, 0, 0]);
        }
    }
    let mut of_edge: HashMap<[i64; 2], Vec<&str>> = HashMap::new();
    for (name, facets) in &plane.sides {
        for facet in facets {
            let [a, b] = [facet.nodes[0] as i64, facet.nodes[1] as i64];
            of_edge.entry([a.min(b), a.max(b)]).or_default().push(name);
        }
    }
    let free = |name: &'static str, other| if plane.sides.contains_key(name) { other } else { name };
    let bottom = free("bottom", "base");
    let top = free("top", "lid");
    let mut mesh = mesh.into_mesh(|corners: [Key; 3]| {
        let ends = corners.map(|key| key[0]);
        match corners.map(|key| key[1]) {
            [0, 0, 0] => vec![bottom],
            heights if heights == [levels as i64; 3] => vec![top],
            _ => {
                let low = ends.into_iter().min();
                let high = ends.into_iter().max();
                let edge = low.zip(high).map(|(low, high)| [low, high]);
                edge.and_then(|edge| of_edge.get(&edge)).cloned().unwrap_or_default()
            }
        }
    });
    mesh.regions = plane.regions_of_children(mesh.cell_count());
    Ok(mesh)
}

/// The cells of the extrusion of cells of the plane.
pub fn extruded(plane: Element) -> Option<Element> {
    match plane {
        Element::T3 => Some(Element::Tet4),
        Element::T6 => Some(Element::Tet10),
        Element::T10 => Some(Element::Tet20),
        Element::Q4 => Some(Element::Hex8),
        Element::Q9 => Some(Element::Hex27),
        _ => None,
    }
}

/// The cells of the plane whose extrusion gives these cells.
pub fn plane_of(element: Element) -> Option<Element> {
    [Element::T3, Element::T6, Element::T10, Element::Q4, Element::Q9]
        .into_iter()
        .find(|plane| extruded(*plane) == Some(element))
}
