//! Writes a field file with one cell of every kind and a cubic sampled at its nodes, for `tests/vtk_reads.py` to read with VTK itself.

use carom_record::{Block, Cell, FieldSet, PointArray};

/// A cubic in both coordinates; the script knows the same one.
fn cubic(x: f64, y: f64) -> f64 {
    1.0 + 2.0 * x - y + 0.5 * x * y + x * x * x - 3.0 * x * y * y + 0.25 * y * y * y
}

/// Barycentric positions of a triangle's nodes: corners, edges in their direction, interior.
fn triangle(degree: usize) -> Vec<[f64; 2]> {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let mut nodes = corners.to_vec();
    for edge in 0..3 {
        let (a, b) = (corners[edge], corners[(edge + 1) % 3]);
        nodes.extend((1..degree).map(|i| {
            let t = i as f64 / degree as f64;
            [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
        }));
    }
    if degree == 3 {
        nodes.push([1.0 / 3.0, 1.0 / 3.0]);
    }
    nodes
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("give the file to write")?;
    let mut fields = FieldSet::default();
    for degree in 1..=3 {
        let shift = 2.0 * degree as f64;
        let ends_first = [0, degree].into_iter().chain(1..degree).map(|i| [i as f64 / degree as f64, -1.0]);
        let cells = [(Cell::Triangle, "T", triangle(degree)), (Cell::Curve, "L", ends_first.collect())];
        for (cell, name, nodes) in cells {
            let start = fields.points.len();
            fields.points.extend(nodes.iter().map(|n| [n[0] + shift, n[1], 0.0]));
            let connectivity = (start..fields.points.len()).collect();
            fields.blocks.push(Block { body: format!("{name}{degree}"), cell, degree, connectivity });
        }
    }
    let field: Vec<f64> = fields.points.iter().map(|p| cubic(p[0], p[1])).collect();
    let stress = field.iter().flat_map(|f| (0..6).map(move |i| f + f64::from(i))).collect();
    fields.arrays = vec![
        PointArray { name: "cubic".into(), unit: "m/s²".into(), components: 1, values: field },
        PointArray { name: "stress".into(), unit: "Pa".into(), components: 6, values: stress },
    ];
    std::fs::write(path, fields.to_vtu(0.25)?)?;
    Ok(())
}
