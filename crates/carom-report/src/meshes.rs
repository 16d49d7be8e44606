//! The files beside figures of meshes: the corners of all drawn cells as a table, and a script that
//! redraws them with matplotlib. In space the cells are the facets of the skin; the edges of curved
//! cells pass through their nodes in straight pieces.

use std::fmt::Write as _;

use carom_record::{Block, Cell, FieldSet};

use crate::bodies::{corners, edge_nodes, fill_space};
use crate::figure::Figure;
use crate::labels::with_unit;
use crate::redraw::{filled, quoted};
use crate::space::skin;

/// Largest number of corners; a figure of more has no table.
const MOST: usize = 100_000;

/// A state of the mesh.
pub(crate) struct Pane {
    pub(crate) title: String,
    /// Positions of the points.
    pub(crate) points: Vec<[f64; 3]>,
    /// A quantity at the points; empty if there is none.
    pub(crate) values: Vec<f64>,
}

/// The nodes around every cell of a block of the plane, or of bars.
fn around(block: &Block) -> Vec<Vec<usize>> {
    let outline = |cell: &[usize]| -> Vec<usize> {
        if block.cell == Cell::Curve {
            return cell[..2].to_vec();
        }
        let edge = |e| edge_nodes(block.degree, cell, e).take(block.degree);
        (0..corners(cell)).flat_map(edge).collect()
    };
    block.cells().map(outline).collect()
}

/// The figure with table and script; `value` labels the quantity.
pub(crate) fn with_files(
    figure: Figure,
    fields: &FieldSet,
    panes: &[Pane],
    length: &str,
    value: String,
) -> Figure {
    let solid = fill_space(fields);
    let cells: Vec<(usize, Vec<usize>)> = if solid {
        let outline = |nodes: &[usize], degree| {
            (0..3).flat_map(|e| edge_nodes(degree, nodes, e).take(degree).collect::<Vec<_>>()).collect()
        };
        skin(fields).iter().map(|f| (f.block, outline(&f.nodes, f.degree))).collect()
    } else {
        let of_block = |(k, block)| around(block).into_iter().map(move |cell| (k, cell));
        fields.blocks.iter().enumerate().flat_map(of_block).collect()
    };
    if panes.len() * cells.iter().map(|(_, nodes)| nodes.len()).sum::<usize>() > MOST {
        return figure;
    }
    let mut table = String::from("pane,body,cell,x,y,z,value\n");
    for pane in panes {
        for (cell, (block, nodes)) in cells.iter().enumerate() {
            let (title, body) = (quoted(&pane.title), quoted(&fields.blocks[*block].body));
            for &node in nodes {
                let [x, y, z] = pane.points[node];
                let z = if solid { format!("{z:?}") } else { String::new() };
                let value = pane.values.get(node).map_or_else(String::new, |value| format!("{value:?}"));
                let _ = writeln!(table, "{title},{body},{cell},{x:?},{y:?},{z},{value}");
            }
        }
    }
    let labels = [
        ("@X@", with_unit("x", length)),
        ("@Y@", with_unit("y", length)),
        ("@Z@", with_unit("z", length)),
        ("@VALUE@", value),
    ];
    let script = filled(include_str!("meshes.py"), &labels).replace("@NAME@", &figure.name);
    figure.with(table, script)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::places;

    /// A curved cell has the nodes of its edges in their order around it.
    #[test]
    fn a_cell_is_a_row_for_each_node_of_its_edges() {
        let points = vec![
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0, 2.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
        ];
        let block =
            Block { body: "a \"b\"".into(), cell: Cell::Triangle, degree: 2, connectivity: (0..6).collect() };
        let fields = FieldSet { points, blocks: vec![block], arrays: Vec::new() };
        let pane = Pane { title: "initial".into(), points: places(&fields), values: Vec::new() };
        let figure = Figure::new("setup", "", [String::new(), String::new()]);
        let figure = with_files(figure, &fields, &[pane], "mm", String::new());
        let rows: Vec<&str> = figure.files[0].1.lines().skip(1).collect();
        let place = |x: &str| format!("\"initial\",\"a \"\"b\"\"\",0,{x},,");
        let order = ["0.0,0.0", "1.0,0.0", "2.0,0.0", "1.0,1.0", "0.0,2.0", "0.0,1.0"];
        assert_eq!(rows, order.map(place));
        let script = &figure.files[1].1;
        assert!(!script.contains('@') && script.contains("\"setup-redrawn.pdf\""), "{script}");
        assert!(script.contains("xlabel=\"x (mm)\""), "{script}");
    }
}
