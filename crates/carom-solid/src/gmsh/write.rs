//! Writes bodies as a .msh file, version 4.1, text. [`read`](super::read()) and
//! [`body`](super::MshFile::body) recover them bitwise, and Gmsh opens the file. Each body is a
//! surface, each of its sides a curve; sides of the same name on several bodies are one physical
//! curve.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::cell_type::number;
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

    let mut out = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n");
    let quoted = |name: &str| name.replace(['"', '\n'], "'");
    // Writing to a String cannot fail.
    let _ = writeln!(out, "{}", names.len() + bodies.len());
    for name in &names {
        let _ = writeln!(out, "1 {} \"{}\"", group(name), quoted(name));
    }
    for (i, (name, _)) in bodies.iter().enumerate() {
        let _ = writeln!(out, "2 {} \"{}\"", i + 1, quoted(name));
    }
    let _ = writeln!(out, "$EndPhysicalNames\n$Entities\n0 {} {} 0", sides.len(), bodies.len());
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
        let _ = writeln!(out, "2 {} 0 {}", i + 1, mesh.nodes.len());
        for n in 0..mesh.nodes.len() {
            let _ = writeln!(out, "{}", first[i] + n);
        }
        for x in &mesh.nodes {
            let _ = writeln!(out, "{:e} {:e} 0", x[0], x[1]);
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
        let line = number(edge(bodies[*body].1.element));
        let _ = writeln!(out, "1 {} {line} {}", s + 1, facets.len());
        facets.iter().for_each(|f| cell(&mut out, &f.nodes, first[*body]));
    }
    for (i, (_, mesh)) in bodies.iter().enumerate() {
        let _ = writeln!(out, "2 {} {} {}", i + 1, number(mesh.element), mesh.cell_count());
        (0..mesh.cell_count()).for_each(|c| cell(&mut out, mesh.cell(c), first[i]));
    }
    out.push_str("$EndElements\n");
    out
}

/// The line element on the edge of a triangle.
fn edge(element: Element) -> Element {
    match element.degree() {
        1 => Element::L2,
        2 => Element::L3,
        _ => Element::L4,
    }
}

/// Lower and upper corner of the box around points, z = 0.
fn corners<'a>(places: impl Iterator<Item = &'a [f64]>) -> String {
    let start = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    let [a, b, c, d] =
        places.fold(start, |[a, b, c, d], x| [a.min(x[0]), b.min(x[1]), c.max(x[0]), d.max(x[1])]);
    format!("{a:e} {b:e} 0 {c:e} {d:e} 0")
}
