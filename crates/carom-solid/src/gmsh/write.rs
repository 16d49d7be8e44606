//! Writes bodies as a .msh file, version 4.1, text. [`read`](super::read()) and
//! [`body`](super::MshFile::body) or [`volume`](super::MshFile::volume) recover them bitwise, and
//! Gmsh opens the file. Each body is a surface, each of its sides a curve, in space a volume and a
//! surface; sides of the same name on several bodies are one physical group.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::cell_type::number;
use super::order;
use crate::facet::FacetShape;
use crate::mesh::{Element, Facet, Mesh};

/// Named bodies as a .msh file. A `"` in a name becomes `'`.
///
/// ```
/// use carom_solid::{Element, generate, gmsh};
/// let prism = generate::rectangle(Element::T10, [0.0, -0.5], [1.0, 0.0], [8, 4])?;
/// let file = gmsh::read(gmsh::write_msh41(&[("prism", &prism)]).as_bytes())?;
/// assert_eq!(file.body("prism")?.nodes, prism.nodes);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_msh41(bodies: &[(&str, &Mesh)]) -> String {
    let sides: Vec<(usize, &str, &[Facet])> = bodies
        .iter()
        .enumerate()
        .flat_map(|(i, (_, mesh))| {
            mesh.sides.iter().map(move |(name, facets)| (i, name.as_str(), facets.as_slice()))
        })
        .filter(|side| !side.2.is_empty())
        .collect();
    let names: Vec<&str> = sides.iter().map(|s| s.1).collect::<BTreeSet<_>>().into_iter().collect();
    let group = |name: &str| names.iter().position(|n| *n == name).map_or(0, |i| i + 1);

    let dimension = bodies.first().map_or(2, |(_, mesh)| mesh.dimension());
    let lower = dimension - 1;
    let mut out = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n");
    let quoted = |name: &str| name.replace(['"', '\n'], "'");
    // Writing to a String cannot fail.
    let _ = writeln!(out, "{}", names.len() + bodies.len());
    for name in &names {
        let _ = writeln!(out, "{lower} {} \"{}\"", group(name), quoted(name));
    }
    for (i, (name, _)) in bodies.iter().enumerate() {
        let _ = writeln!(out, "{dimension} {} \"{}\"", i + 1, quoted(name));
    }
    let entities = match dimension {
        3 => format!("0 0 {} {}", sides.len(), bodies.len()),
        _ => format!("0 {} {} 0", sides.len(), bodies.len()),
    };
    let _ = writeln!(out, "$EndPhysicalNames\n$Entities\n{entities}");
    for (tag, (body, name, facets)) in sides.iter().enumerate() {
        let mesh = bodies[*body].1;
        let places = facets.iter().flat_map(|f| &f.nodes).map(|&n| &mesh.nodes[n]);
        let _ = writeln!(out, "{} {} 1 {} 0", tag + 1, corners(places), group(name));
    }
    for (i, (_, mesh)) in bodies.iter().enumerate() {
        let own: Vec<_> =
            (0..sides.len()).filter(|&s| sides[s].0 == i).map(|s| format!(" {}", s + 1)).collect();
        let _ = writeln!(
            out,
            "{} {} 1 {} {}{}",
            i + 1,
            corners(mesh.nodes.iter()),
            i + 1,
            own.len(),
            own.concat()
        );
    }

    let first: Vec<usize> =
        bodies.iter().scan(1, |next, (_, m)| Some(std::mem::replace(next, *next + m.nodes.len()))).collect();
    let total: usize = bodies.iter().map(|(_, m)| m.nodes.len()).sum();
    let _ =
        writeln!(out, "$EndEntities\n$Nodes\n{} {total} {} {total}", bodies.len(), usize::from(total > 0));
    for (i, (_, mesh)) in bodies.iter().enumerate() {
        let _ = writeln!(out, "{dimension} {} 0 {}", i + 1, mesh.nodes.len());
        for n in 0..mesh.nodes.len() {
            let _ = writeln!(out, "{}", first[i] + n);
        }
        for x in &mesh.nodes {
            let _ = match x.get(2) {
                Some(z) => writeln!(out, "{:e} {:e} {z:e}", x[0], x[1]),
                None => writeln!(out, "{:e} {:e} 0", x[0], x[1]),
            };
        }
    }

    let cells: usize =
        sides.iter().map(|s| s.2.len()).chain(bodies.iter().map(|(_, m)| m.cell_count())).sum();
    let blocks = sides.len() + bodies.len();
    let _ = writeln!(out, "$EndNodes\n$Elements\n{blocks} {cells} {} {cells}", usize::from(cells > 0));
    let mut tag = 0;
    let mut cell = |out: &mut String, nodes: &[usize], first: usize| {
        tag += 1;
        let _ = write!(out, "{tag}");
        for n in nodes {
            let _ = write!(out, " {}", first + n);
        }
        out.push('\n');
    };
    for (s, (body, _, facets)) in sides.iter().enumerate() {
        let kind = number(facet(bodies[*body].1.element));
        let _ = writeln!(out, "{lower} {} {kind} {}", s + 1, facets.len());
        facets.iter().for_each(|f| cell(&mut out, &f.nodes, first[*body]));
    }
    for (i, (_, mesh)) in bodies.iter().enumerate() {
        let _ = writeln!(out, "{dimension} {} {} {}", i + 1, number(mesh.element), mesh.cell_count());
        (0..mesh.cell_count())
            .for_each(|c| cell(&mut out, &order::written(mesh.element, mesh.cell(c)), first[i]));
    }
    out.push_str("$EndElements\n");
    out
}

/// The element that is a facet of another.
fn facet(element: Element) -> Element {
    match element.facet_shape() {
        FacetShape::Point | FacetShape::L2 => Element::L2,
        FacetShape::L3 => Element::L3,
        FacetShape::L4 => Element::L4,
        FacetShape::T3 => Element::T3,
        FacetShape::T6 => Element::T6,
        FacetShape::T10 => Element::T10,
        FacetShape::Q4 => Element::Q4,
        FacetShape::Q9 => Element::Q9,
    }
}

/// Lower and upper corner of the box around points; z = 0 in the plane.
fn corners<'a>(places: impl Iterator<Item = &'a [f64]>) -> String {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for x in places {
        for i in 0..3 {
            let x = x.get(i).copied().unwrap_or(0.0);
            (low[i], high[i]) = (low[i].min(x), high[i].max(x));
        }
    }
    // A zero is written as before, without an exponent.
    let text = |x: [f64; 3], flat: bool| {
        if flat { format!("{:e} {:e} 0", x[0], x[1]) } else { format!("{:e} {:e} {:e}", x[0], x[1], x[2]) }
    };
    let flat = low[2] == 0.0 && high[2] == 0.0;
    format!("{} {}", text(low, flat), text(high, flat))
}
