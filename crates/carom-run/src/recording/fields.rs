//! A state as fields for viewers: displacement, velocity, stress (nodal mean within each body) with
//! its von Mises and principal stresses, principal strains, contact pressure, plastic strain, and
//! where it has yielded.
//!
//! Principal strains are logarithmic (H. Hencky, Z. techn. Phys. 9, 1928): ln λᵢ with the principal
//! stretches λᵢ, the same in the reference and the current configuration, of nodal means of the
//! Green–Lagrange strain, 2E = FᵀF − I, whose principal values are λᵢ² − 1.

use std::collections::BTreeMap;

use carom_algebra::principal;
use carom_case::Case;
use carom_mechanics::model::{Model, past_of, von_mises};
use carom_mechanics::{State, Surfaces, active_rows};
use carom_record::{Block, Cell, CellArray, CellMaterials, FieldSet, LARGEST_VON_MISES, PointArray};
use carom_solid::{Element, Mesh};

/// Fields of a state.
pub(super) fn field_set(case: &Case, model: &Model, surfaces: &Surfaces, state: &State) -> FieldSet {
    let label = case.labels();
    let array = |name: &str, unit: &str, components: usize, values: Vec<f64>| PointArray {
        name: name.into(),
        unit: unit.into(),
        components,
        values,
    };
    // The nodes that carry obstacles come last, and belong to no body.
    let nodes = model.parts.iter().filter(|part| !part.is_rigid()).map(|p| p.nodes().end).max().unwrap_or(0);
    let Means { stress, strain, plastic, yielded } = nodal_means(model, state);
    let mises: Vec<f64> = stress.iter().map(|s| von_mises(&tensor(s))).collect();
    let principal_stress: Vec<f64> = stress.iter().flat_map(|s| principal(tensor(s))).collect();
    let principal_strain: Vec<f64> = strain.iter().flat_map(|e| logarithmic(principal(tensor(e)))).collect();
    let mut set = FieldSet {
        points: in_space(model, &model.reference).collect(),
        blocks: blocks(model),
        arrays: vec![
            array("displacement", &label.length, 3, displacements(model, &state.y)),
            array("velocity", &label.velocity, 3, in_space(model, &state.v).flatten().collect()),
            array("stress", &label.stress, 6, stress.into_flattened()),
            array("von_mises", &label.stress, 1, mises),
            array("principal_stress", &label.stress, 3, principal_stress),
            array("principal_log_strain", "", 3, principal_strain),
            array("contact_pressure", &label.stress, 1, pressures(surfaces, model, state)),
        ],
        of_cells: Vec::new(),
        materials: materials(case, model),
    };
    if case.yielding().next().is_some() {
        let name = LARGEST_VON_MISES.to_owned();
        let values = largest_von_mises(model, state);
        set.of_cells.push(CellArray { name, unit: label.stress.clone(), values });
        set.arrays.push(array("plastic_strain", "", 1, plastic));
        set.arrays.push(array("yielded", "", 1, yielded));
    }
    set.points.truncate(nodes);
    set.arrays.iter_mut().for_each(|array| array.values.truncate(nodes * array.components));
    set
}

/// Principal logarithmic (Hencky) strains ln λᵢ from the principal Green–Lagrange strains
/// Eᵢ = (λᵢ² − 1)/2, in their order; NaN where a stretch is zero.
fn logarithmic(green: [f64; 3]) -> [f64; 3] {
    green.map(|e| Some(0.5 * (2.0 * e).ln_1p()).filter(|x| x.is_finite()).unwrap_or(f64::NAN))
}

/// The initial positions of a model, without other fields.
pub fn initial_fields(case: &Case, model: &Model) -> FieldSet {
    let unit = case.labels().length;
    let values = displacements(model, &model.initial_position);
    FieldSet {
        points: in_space(model, &model.reference).collect(),
        blocks: blocks(model),
        arrays: vec![PointArray { name: "displacement".into(), unit, components: 3, values }],
        of_cells: Vec::new(),
        materials: materials(case, model),
    }
}

/// Materials of the cells of the bodies, if one has several.
fn materials(case: &Case, model: &Model) -> CellMaterials {
    if case.bodies.iter().all(|body| body.material_names().len() == 1) {
        return CellMaterials::default();
    }
    let names: Vec<String> = case.materials.iter().map(|material| material.name.clone()).collect();
    let mut of_cells = Vec::new();
    for (spec, part) in case.bodies.iter().zip(&model.parts) {
        let index = |name: &str| names.iter().position(|known| known == name).unwrap_or(0);
        let of_body: Vec<usize> = spec.material_names().into_iter().map(index).collect();
        let mesh = part.body.mesh();
        of_cells.extend((0..mesh.cell_count()).map(|cell| of_body[mesh.region(cell)]));
    }
    CellMaterials { names, of_cells }
}

/// Values per node, with zeros for directions that the model does not have.
fn in_space<'a>(model: &Model, values: &'a [f64]) -> impl Iterator<Item = [f64; 3]> + use<'a> {
    let nodes = values.chunks_exact(model.dimension);
    nodes.map(|x| std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0)))
}

/// Displacements of the nodes at positions `y`, in space.
pub(super) fn displacements(model: &Model, y: &[f64]) -> Vec<f64> {
    let moved: Vec<f64> = y.iter().zip(&model.reference).map(|(y, x)| y - x).collect();
    in_space(model, &moved).flatten().collect()
}

/// The cells of the bodies.
fn blocks(model: &Model) -> Vec<Block> {
    let bodies = model.parts.iter().filter(|part| !part.is_rigid());
    bodies.map(|part| block(&part.name, part.body.mesh(), part.first_node)).collect()
}

/// The cells of a body whose nodes begin with this number.
pub fn block(name: &str, mesh: &Mesh, first: usize) -> Block {
    let cell = match mesh.element {
        Element::L2 | Element::L3 | Element::L4 => Cell::Curve,
        Element::T3 | Element::T6 | Element::T10 => Cell::Triangle,
        Element::Q4 | Element::Q9 => Cell::Quadrilateral,
        Element::Tet4 | Element::Tet10 | Element::Tet20 => Cell::Tetrahedron,
        Element::Hex8 | Element::Hex27 => Cell::Hexahedron,
    };
    Block {
        body: name.to_owned(),
        cell,
        degree: mesh.element.degree(),
        connectivity: mesh.cells.iter().map(|n| n + first).collect(),
    }
}

/// Components XX YY ZZ XY YZ XZ of a symmetric tensor.
type Components = [f64; 6];

fn components(s: &[[f64; 3]; 3]) -> Components {
    [s[0][0], s[1][1], s[2][2], s[0][1], s[1][2], s[0][2]]
}

fn tensor(&[xx, yy, zz, xy, yz, xz]: &Components) -> [[f64; 3]; 3] {
    [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
}

/// Means over the cells of each node where they exist; NaN if they exist in none (J ≤ 0).
struct Means {
    /// Cauchy stress.
    stress: Vec<Components>,
    /// Green–Lagrange strain.
    strain: Vec<Components>,
    /// Equivalent plastic strain.
    plastic: Vec<f64>,
    /// Share of the quadrature points that have yielded.
    yielded: Vec<f64>,
}

fn nodal_means(model: &Model, state: &State) -> Means {
    let nodes = model.mass.nodes();
    let mut means = [vec![[0.0; 6]; nodes], vec![[0.0; 6]; nodes]];
    let mut plastic = vec![0.0; nodes];
    let mut yielded = vec![0.0; nodes];
    let mut count = vec![0.0_f64; nodes];
    for (k, part) in model.parts.iter().enumerate() {
        let past = past_of(&model.parts, k, state.materials.past(0.0).memory);
        let mesh = part.body.mesh();
        let y = part.of(&state.y);
        let places = part.body.reference_nodes();
        for cell in 0..mesh.cell_count() {
            let points = part.body.points(cell, &places, y, &past);
            for (&node, point) in mesh.cell(cell).iter().zip(points) {
                let node = part.first_node + node;
                let Ok(point) = point else { continue };
                count[node] += 1.0;
                plastic[node] += point.plastic_strain;
                yielded[node] += point.yielded;
                for (mean, value) in means.iter_mut().zip([point.cauchy, point.strain]) {
                    mean[node].iter_mut().zip(components(&value)).for_each(|(sum, c)| *sum += c);
                }
            }
        }
    }
    for mean in &mut means {
        mean.iter_mut().zip(&count).for_each(|(sum, n)| sum.iter_mut().for_each(|x| *x /= n));
    }
    for mean in [&mut plastic, &mut yielded] {
        mean.iter_mut().zip(&count).for_each(|(sum, n)| *sum /= n);
    }
    let [stress, strain] = means;
    Means { stress, strain, plastic, yielded }
}

/// Largest von Mises stress of each cell at its quadrature points, where yielding is decided; NaN
/// where J ≤ 0.
fn largest_von_mises(model: &Model, state: &State) -> Vec<f64> {
    let mut values = Vec::new();
    for (k, part) in model.parts.iter().enumerate().filter(|(_, part)| !part.is_rigid()) {
        let past = past_of(&model.parts, k, state.materials.past(0.0).memory);
        let y = part.of(&state.y);
        let largest = |cell: usize| {
            let points = part.body.quadrature_points(cell, y, &past).ok()?;
            points.iter().map(|point| von_mises(&point.cauchy)).reduce(f64::max)
        };
        values.extend((0..part.body.mesh().cell_count()).map(|cell| largest(cell).unwrap_or(f64::NAN)));
    }
    values
}

fn pressures(surfaces: &Surfaces, model: &Model, state: &State) -> Vec<f64> {
    let mut at_nodes = vec![0.0; model.mass.nodes()];
    for (node, pressure) in surfaces.pressures(model, state, &active_rows(model, state)).largest() {
        at_nodes[node] = pressure;
    }
    at_nodes
}

/// Chains of point numbers of every named side, in the order of traversal; in space one for every
/// face.
pub(super) fn sides(model: &Model) -> BTreeMap<String, Vec<Vec<usize>>> {
    let mut named = BTreeMap::new();
    for part in &model.parts {
        for (side, facets) in &part.body.mesh().sides {
            let mut chains: Vec<Vec<usize>> = Vec::new();
            for facet in facets {
                let walk = facet.walk(model.dimension).map(|n| n + part.first_node);
                let continues = |chain: &Vec<usize>| {
                    model.dimension == 2 && chain.last() == Some(&(facet.nodes[0] + part.first_node))
                };
                match chains.last_mut() {
                    Some(chain) if continues(chain) => {
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
