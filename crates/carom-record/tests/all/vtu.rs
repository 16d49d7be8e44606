//! Field files: VTK unstructured grids of cells of degree 1 to 3, with appended raw binary data.

use carom_record::{Block, Cell, CellArray, CellMaterials, FieldSet, PointArray};

/// Two bodies: a curve of order 3 and two triangles of order 2, with every kind of array.
pub(crate) fn sample() -> FieldSet {
    let points: Vec<[f64; 3]> = (0..13).map(|i| [f64::from(i), 0.1 * f64::from(i * i), 0.0]).collect();
    let values = |n: usize| (0..13 * n).map(|i| (i as f64).sqrt() - 1e-300 * i as f64).collect();
    let array = |name: &str, unit: &str, components| PointArray {
        name: name.into(),
        unit: unit.into(),
        components,
        values: values(components),
    };
    FieldSet {
        points,
        blocks: vec![
            Block { body: "bar <1>".into(), cell: Cell::Curve, degree: 3, connectivity: vec![0, 1, 2, 3] },
            Block {
                body: "disc".into(),
                cell: Cell::Triangle,
                degree: 2,
                connectivity: vec![4, 5, 6, 7, 8, 9, 5, 4, 10, 7, 11, 12],
            },
        ],
        arrays: vec![
            array("displacement", "m", 3),
            array("stress", "N/m²", 6),
            array("contact_pressure", "", 1),
        ],
        of_cells: vec![CellArray {
            name: "largest".into(),
            unit: "Pa".into(),
            values: vec![1.5, f64::MIN_POSITIVE, -0.0],
        }],
        materials: CellMaterials { names: vec!["steel".into(), "a \"b\"".into()], of_cells: vec![0, 1, 0] },
    }
}

#[test]
fn reads_what_it_wrote() {
    let bytes = sample().to_vtu(0.1 + 0.2).unwrap();
    assert_eq!(FieldSet::from_vtu(&bytes).unwrap(), sample());
}

#[test]
fn damage_is_an_error_and_never_a_panic() {
    let bytes = sample().to_vtu(1.0).unwrap();
    for end in 0..bytes.len() {
        assert!(FieldSet::from_vtu(&bytes[..end.min(bytes.len() - 40)]).is_err(), "cut at {end}");
    }
    for at in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x15;
        let _ = FieldSet::from_vtu(&damaged);
    }
}

#[test]
fn contradicting_lengths_are_an_error() {
    let mut fields = sample();
    fields.arrays[0].values.pop();
    assert!(fields.to_vtu(0.0).unwrap_err().to_string().contains("displacement"));
    let mut fields = sample();
    fields.blocks[1].connectivity[3] = 13;
    assert!(fields.to_vtu(0.0).unwrap_err().to_string().contains("13 points"));
}
