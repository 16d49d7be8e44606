//! Kernels of one cell under a deformation of a few per cent: force, tangent and discrete gradient
//! for every shape, the tangent for every law.
//!
//!     cargo bench -p carom-solid              times
//!     bench/instructions.py carom-solid       instructions

use std::hint::black_box;

use carom_solid::{Ask, Body, Configuration, Element, Law, Response, body, generate};
use divan::Bencher;

const SHAPES: [Element; 3] = [Element::T3, Element::T6, Element::T10];
const RUBBER: Law = Law::NeoHookean { lambda: 200.0, mu: 15.0 };
const LAWS: [Law; 3] = [
    RUBBER,
    Law::SaintVenantKirchhoff { lambda: 200.0, mu: 15.0 },
    Law::LinearElastic { lambda: 200.0, mu: 15.0 },
];
/// An interior cell.
const CELL: usize = 5;

fn main() {
    divan::main();
}

/// A square of 32 cells, its reference and deformed positions.
fn square(element: Element, law: Law) -> (Box<dyn Body>, Vec<f64>, Vec<f64>) {
    let mesh = generate::rectangle(element, [0.0, 0.0], [1.0, 1.0], [4, 4]).expect("valid");
    let at = mesh.nodes.flat().to_vec();
    let bent = |[x, y]: &[f64; 2]| [x + 0.05 * (2.0 * y).sin(), y - 0.1 * y * x];
    let moved = mesh.nodes.of_dimension().iter().flat_map(bent).collect();
    (body(mesh, law, 0.25, 1.0).expect("valid"), at, moved)
}

/// Whether a cell is valid.
fn responds(body: &dyn Body, at: &Configuration, ask: Ask, numbers: &mut [f64]) -> bool {
    let out = Response { numbers, energies: &mut [0.0], memory: &mut [], dissipated: &mut [] };
    body.respond(black_box(CELL), at, ask, out).is_ok()
}

#[divan::bench(args = SHAPES)]
fn force(bencher: Bencher, shape: Element) {
    let (body, _, y) = square(shape, RUBBER);
    let mut force = vec![0.0; 2 * shape.nodes()];
    bencher.bench_local(|| responds(&*body, &Configuration::at(&y), Ask::Force, &mut force));
}

/// Certified J > 0 in the whole of the cell.
#[divan::bench(args = SHAPES)]
fn margin(bencher: Bencher, shape: Element) {
    let (body, _, y) = square(shape, RUBBER);
    bencher.bench_local(|| body.cell_margin(black_box(CELL), &y).is_ok());
}

#[divan::bench(args = SHAPES)]
fn tangent(bencher: Bencher, shape: Element) {
    tangent_of(bencher, shape, RUBBER);
}

#[divan::bench(args = LAWS)]
fn tangent_of_law(bencher: Bencher, law: Law) {
    tangent_of(bencher, Element::T6, law);
}

fn tangent_of(bencher: Bencher, shape: Element, law: Law) {
    let (body, _, y) = square(shape, law);
    let dofs = 2 * shape.nodes();
    let mut numbers = vec![0.0; dofs + dofs * dofs];
    bencher.bench_local(|| responds(&*body, &Configuration::at(&y), Ask::Tangent, &mut numbers));
}

#[divan::bench(args = SHAPES)]
fn discrete_gradient(bencher: Bencher, shape: Element) {
    let (body, before, now) = square(shape, RUBBER);
    let mut force = vec![0.0; 2 * shape.nodes()];
    let at = Configuration { before: Some(&before), ..Configuration::at(&now) };
    bencher.bench_local(|| responds(&*body, &at, Ask::Force, &mut force));
}

#[divan::bench(args = SHAPES)]
fn mass(bencher: Bencher, shape: Element) {
    let (body, ..) = square(shape, RUBBER);
    let mut mass = vec![0.0; shape.nodes() * shape.nodes()];
    bencher.bench_local(|| body.cell_mass(black_box(CELL), &mut mass));
}
