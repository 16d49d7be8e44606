//! The factor `refine` of a case: it multiplies numbers of cells, which must remain whole.

use super::problem::{Problem, rounded};
use super::tree::{Node, Table};

/// Relative distance of a product from an integer, for factors such as 1.3333333333.
const WHOLE: f64 = 1e-9;

/// The numbers of a mesh that are multiplied by the factor.
pub struct Counts {
    /// Path of the mesh or of its numbers.
    pub path: String,
    /// Whether its cells are those of a file: every edge is one part.
    pub of_file: bool,
    /// Numbers of cells.
    pub numbers: Vec<usize>,
}

impl Counts {
    /// Numbers of cells of the mesh at `path`; none if it is given by the size of its cells.
    pub(super) fn of(mesh: &Table, path: String) -> Option<Self> {
        if mesh.get("file").is_some() {
            return Some(Self { path, of_file: true, numbers: vec![1] });
        }
        if let (Some(layers), Some(of)) =
            (mesh.get("layers").and_then(Node::count), mesh.get("of").and_then(Node::table))
        {
            let of = Self::of(of, format!("{path}.of"));
            if let Some(of) = of.as_ref().filter(|of| of.of_file) {
                return Some(Self { path: of.path.clone(), of_file: true, numbers: vec![1] });
            }
            let of = of.map_or(Vec::new(), |of| of.numbers);
            let numbers = [&of[..], &[layers]].concat();
            return (layers > 0).then(|| Self {
                path: if of.is_empty() {
                    format!("{path}.layers")
                } else {
                    format!("{path} with its layers")
                },
                of_file: false,
                numbers,
            });
        }
        let cells = mesh.get("cells")?;
        let counts = match cells.list() {
            Some(list) => list.iter().map(Node::count).collect::<Option<Vec<_>>>()?,
            None => vec![cells.count()?],
        };
        let path = format!("{path}.cells");
        counts.iter().all(|n| *n > 0).then_some(Self { path, of_file: false, numbers: counts })
    }
}

/// The problem of a factor with which the numbers of a mesh do not remain whole.
pub fn problem(factor: f64, meshes: &[Counts]) -> Option<Problem> {
    let Counts { path, of_file, numbers } =
        meshes.iter().find(|mesh| !whole(factor, divisor(&mesh.numbers)))?;
    let (what, why) = if *of_file {
        let what = format!("`refine` = {factor} is not an integer, and {path} comes from a file");
        (what, "the cells of a file are divided into whole parts")
    } else {
        let products: Vec<_> = numbers.iter().map(|n| rounded(*n as f64 * factor).to_string()).collect();
        let what = format!("`refine` = {factor} makes {path} = {numbers:?} into [{}]", products.join(", "));
        (what, "numbers of cells are multiplied by it, and must remain whole")
    };
    // Factors with which the cells of all meshes are whole are the multiples of 1/n.
    let n = divisor(&meshes.iter().flat_map(|mesh| &mesh.numbers).copied().collect::<Vec<_>>()) as f64;
    let [below, above] = [(factor * n).floor() / n, (factor * n).ceil() / n];
    let help = if below >= 1.0 {
        format!("write `refine = {}` or `refine = {}`", rounded(below), rounded(above))
    } else {
        format!("write `refine = {}`", rounded(above))
    };
    Some(Problem::new("refine", what, why, help))
}

/// Whether a number times a factor is whole.
pub(crate) fn whole(factor: f64, n: usize) -> bool {
    let product = factor * n as f64;
    (product - product.round()).abs() <= WHOLE * product
}

/// The greatest common divisor: the multiples of 1/n are the factors with which all are whole.
fn divisor(numbers: &[usize]) -> usize {
    let of_two = |a: usize, b: usize| {
        let mut a = a;
        let mut b = b;
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    numbers.iter().copied().fold(0, of_two)
}
