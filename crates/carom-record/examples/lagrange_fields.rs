//! Writes fields of one cell of every kind, with a cubic sampled at its nodes, for
//! `tests/vtk_reads.py` to read with VTK: one instant as `cells.vtu`, and twenty instants that grow
//! with time as `run/fields.vtkhdf`.

use std::path::Path;

use carom_record::{Block, Cell, FieldFormat, FieldSet, Manifest, PointArray, RunWriter, Source};

/// A cubic in both coordinates; the script uses the same one.
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
    let place = std::env::args().nth(1).ok_or("give the folder to write into")?;
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
    let sampled = |time: f64| {
        let field: Vec<f64> = fields.points.iter().map(|p| (1.0 + time) * cubic(p[0], p[1])).collect();
        let moved = field.iter().flat_map(|f| [*f, -f, 0.0]).collect();
        let stress = field.iter().flat_map(|f| (0..6).map(move |i| f + f64::from(i))).collect();
        let array = |name: &str, unit: &str, components, values| PointArray {
            name: name.into(),
            unit: unit.into(),
            components,
            values,
        };
        let arrays = vec![
            array("cubic", "m/s²", 1, field),
            array("displacement", "m", 3, moved),
            array("stress", "Pa", 6, stress),
        ];
        FieldSet { arrays, ..fields.clone() }
    };
    let place = Path::new(&place);
    std::fs::write(place.join("cells.vtu"), sampled(0.0).to_vtu(0.25)?)?;
    let mut manifest = Manifest::new("0", serde_json::json!({}), Source::default(), vec![], 1);
    let mut writer = RunWriter::create(&place.join("run"), &manifest, b"")?;
    writer.field_format(FieldFormat::VtkHdf);
    for i in 0..20_u32 {
        let time = f64::from(i) * 0.1;
        writer.fields(5 * u64::from(i), time, &sampled(time))?;
    }
    writer.finish(&mut manifest)?;
    Ok(())
}
