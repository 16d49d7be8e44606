//! Principal strains in the fields, against exact stretches of bodies whose boundary is moved.

use std::sync::atomic::AtomicBool;

use carom_record::Source;
use carom_run::recording::run_in_memory;

use super::common::case;

/// The principal logarithmic strains of all nodes at the end of a run whose boundary is moved by
/// `motion`.
fn strains(dimension: &str, law: &str, element: &str, mesh: &str, motion: &str) -> Vec<[f64; 3]> {
    let sides = if dimension.starts_with('3') { ", \"b.front\", \"b.back\"" } else { "" };
    let text = format!(
        "dimension = {dimension}\n\
         material = [{{ name = \"m\", law = \"{law}\", density = 1.0, lambda = 200.0, mu = 15.0 }}]\n\
         body = [{{ name = \"b\", material = \"m\", element = \"{element}\", mesh = {{ {mesh} }} }}]\n\
         support = [{{ on = [\"b.left\", \"b.right\", \"b.bottom\", \"b.top\"{sides}], move = {{ {motion} }} }}]\n\
         [time]\nend = 1.0\nstep = 0.25\nscheme = {{ kind = \"static\" }}\n\
         [newton]\ntolerance = 1e-12\n[output]\nfields_every = 1\n"
    );
    let go = AtomicBool::new(false);
    let case = case(&text, &[""; 0]);
    let (_, record) = run_in_memory(&case, Source::default(), 1, &mut |_| (), &go).unwrap();
    let fields = record.fields.last().unwrap();
    let array = fields.array("principal_log_strain").unwrap();
    assert_eq!((array.components, array.unit.as_str()), (3, ""));
    array.values.as_chunks::<3>().0.to_vec()
}

const SQUARE: &str = "shape = \"rectangle\", min = [0.0, 0.0], max = [1.0, 1.0], cells = [2, 2]";
const CUBE: &str = "shape = \"box\", min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 1.0], cells = [2, 1, 1]";

fn all_are(found: &[[f64; 3]], expected: [f64; 3]) {
    assert!(found.len() > 8);
    for strain in found {
        assert!(strain.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-11), "{strain:?} {expected:?}");
    }
}

/// A shear of γ has the principal stretches γ/2 ± √(1 + γ²/4), so ln λ = ± arsinh(γ/2).
#[test]
fn simple_shear() {
    let exact = 0.4_f64.asinh();
    let shear = "x = \"0.8*t*Y\", y = \"0*t\"";
    let plane = strains("2\nplane = \"strain\"", "neo-hookean", "T6", SQUARE, shear);
    all_are(&plane, [exact, 0.0, -exact]);
    let space = "x = \"0.8*t*Z\", y = \"0*t\", z = \"0*t\"";
    all_are(&strains("3", "neo-hookean", "Hex27", CUBE, space), [exact, 0.0, -exact]);
}

/// A sheet of the Saint Venant–Kirchhoff law stretched by 1.3 along x and held along y becomes
/// thinner: E₃₃ = −Λ E₁₁/(Λ + 2μ) = −0.345·200/230 = −0.3, so λ₃² = 0.4. In plane strain λ₃ = 1.
#[test]
fn stretch_of_a_sheet() {
    let stretch = "x = \"0.3*t*X\", y = \"0*t\"";
    let of = |plane: &str| strains(plane, "saint-venant-kirchhoff", "Q9", SQUARE, stretch);
    all_are(&of("2\nplane = \"stress\""), [1.3_f64.ln(), 0.0, 0.5 * 0.4_f64.ln()]);
    all_are(&of("2\nplane = \"strain\""), [1.3_f64.ln(), 0.0, 0.0]);
}

/// A small strain keeps its digits: ln(1 + 10⁻⁹) is 10⁻⁹ − 5·10⁻¹⁹.
#[test]
fn small_strains_keep_their_digits() {
    let found = strains("2", "linear-elastic", "T3", SQUARE, "x = \"1e-9*t*X\", y = \"0*t\"");
    assert!(found.iter().all(|strain| (strain[0] - 1e-9).abs() < 1e-15), "{found:?}");
}
