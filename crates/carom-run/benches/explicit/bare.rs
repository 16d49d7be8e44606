//! The forces of neo-Hookean cells alone, in lanes, from data that stay in the cache: no mesh, no
//! energy, no checks. They are compared with those of a body before they are timed.
//!
//! ```text
//! Tet4   P = μ (F − cof F/J) + Λ ln J cof F/J,               f = V P ∇φ, eight cells in lanes
//! Hex8   P = μ (F − cof F/J) + p cof F,  p = Λ ln m/m,  m = Σ J/8        eight points in lanes
//! ```

use std::hint::black_box;
use std::time::Instant;

use carom_algebra::wide;
use carom_solid::{Body, Element, Law, Mesh, RegionMaterial, body, generate, mean_dilatation_body};

const LAMBDA: f64 = 200.0;
const MU: f64 = 15.0;
/// Timings of which the fastest counts, and repetitions in each.
const ROUNDS: usize = 7;
const TIMES: usize = 500;

type Lanes = [f64; 8];
type Mats = [[Lanes; 3]; 3];

/// Eight tetrahedra.
struct Tetrahedra {
    /// Displacements of the nodes.
    u: [[Lanes; 3]; 4],
    /// ∂ξ/∂X.
    inverse: Mats,
    volume: Lanes,
}

/// A hexahedron with parallel faces.
struct Hexahedron {
    u: [[f64; 3]; 8],
    inverse: [[f64; 3]; 3],
    /// Of its eighth.
    volume: f64,
}

/// sum += a b.
#[inline(always)]
fn add(sum: &mut Lanes, a: &Lanes, b: &Lanes) {
    for l in 0..8 {
        sum[l] += a[l] * b[l];
    }
}

/// Cofactor and determinant.
#[inline(always)]
fn cofactor(f: &Mats) -> (Mats, Lanes) {
    let (mut c, mut j) = ([[[0.0; 8]; 3]; 3], [0.0; 8]);
    for i in 0..3 {
        for k in 0..3 {
            let [i1, i2, k1, k2] = [(i + 1) % 3, (i + 2) % 3, (k + 1) % 3, (k + 2) % 3];
            for l in 0..8 {
                c[i][k][l] = f[i1][k1][l] * f[i2][k2][l] - f[i1][k2][l] * f[i2][k1][l];
            }
        }
    }
    for k in 0..3 {
        add(&mut j, &f[0][k], &c[0][k]);
    }
    (c, j)
}

/// ln J for |J − 1| ≤ 0.1: 2 artanh((J − 1)/(J + 1)).
#[inline(always)]
fn ln(j: f64) -> f64 {
    let s = (j - 1.0) / (j + 1.0);
    let t = s * s;
    2.0 * s * (1.0 + t * (1.0 / 3.0 + t * (0.2 + t * (1.0 / 7.0 + t * (1.0 / 9.0 + t / 11.0)))))
}

#[inline(always)]
fn force_of_tetrahedra(cell: &Tetrahedra, force: &mut [[Lanes; 3]; 4]) {
    let mut f = [[[0.0; 8]; 3]; 3];
    for i in 0..3 {
        f[i][i] = [1.0; 8];
        for a in 0..3 {
            let mut edge = [0.0; 8];
            for l in 0..8 {
                edge[l] = cell.u[a + 1][i][l] - cell.u[0][i][l];
            }
            for k in 0..3 {
                add(&mut f[i][k], &edge, &cell.inverse[a][k]);
            }
        }
    }
    let (c, j) = cofactor(&f);
    let (mut shear, mut pressure) = ([0.0; 8], [0.0; 8]);
    for l in 0..8 {
        shear[l] = MU * cell.volume[l];
        pressure[l] = cell.volume[l] * (LAMBDA * ln(j[l]) - MU) / j[l];
    }
    let mut stress = [[[0.0; 8]; 3]; 3];
    for i in 0..3 {
        for k in 0..3 {
            for l in 0..8 {
                stress[i][k][l] = shear[l] * f[i][k][l] + pressure[l] * c[i][k][l];
            }
        }
    }
    for i in 0..3 {
        force[0][i] = [0.0; 8];
        for a in 0..3 {
            let mut sum = [0.0; 8];
            for k in 0..3 {
                add(&mut sum, &stress[i][k], &cell.inverse[a][k]);
            }
            force[a + 1][i] = sum;
            for l in 0..8 {
                force[0][i][l] -= sum[l];
            }
        }
    }
}

/// ∂φ/∂ξ of the eight nodes at the eight points.
fn gradients() -> [[Lanes; 3]; 8] {
    let sign = |k: usize, axis: usize| if k >> axis & 1 == 1 { 1.0 } else { -1.0 };
    // Nodes go round the bottom and the top.
    let node = |a: usize, axis: usize| sign([0, 1, 3, 2, 4, 5, 7, 6][a], axis);
    let at = |point: usize, axis: usize| sign(point, axis) / 3.0_f64.sqrt();
    std::array::from_fn(|a| {
        std::array::from_fn(|j| {
            std::array::from_fn(|point| {
                let factor = |axis: usize| {
                    if axis == j { node(a, axis) } else { 1.0 + node(a, axis) * at(point, axis) }
                };
                0.125 * (0..3).map(factor).product::<f64>()
            })
        })
    })
}

#[inline(always)]
fn force_of_hexahedron(cell: &Hexahedron, gradients: &[[Lanes; 3]; 8], force: &mut [[f64; 3]; 8]) {
    let mut h = [[[0.0; 8]; 3]; 3];
    for a in 0..8 {
        for i in 0..3 {
            for j in 0..3 {
                add(&mut h[i][j], &[cell.u[a][i]; 8], &gradients[a][j]);
            }
        }
    }
    let mut f = [[[0.0; 8]; 3]; 3];
    for i in 0..3 {
        f[i][i] = [1.0; 8];
        for k in 0..3 {
            for j in 0..3 {
                add(&mut f[i][k], &h[i][j], &[cell.inverse[j][k]; 8]);
            }
        }
    }
    let (c, j) = cofactor(&f);
    let mean = 0.125 * j.iter().sum::<f64>();
    let pressure = LAMBDA * ln(mean) / mean;
    let mut stress = [[[0.0; 8]; 3]; 3];
    for i in 0..3 {
        for k in 0..3 {
            for l in 0..8 {
                stress[i][k][l] = cell.volume * (MU * f[i][k][l] + (pressure - MU / j[l]) * c[i][k][l]);
            }
        }
    }
    let mut pulled = [[[0.0; 8]; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            for k in 0..3 {
                add(&mut pulled[i][j], &stress[i][k], &[cell.inverse[j][k]; 8]);
            }
        }
    }
    for a in 0..8 {
        for i in 0..3 {
            let mut sum = [0.0; 8];
            for j in 0..3 {
                add(&mut sum, &pulled[i][j], &gradients[a][j]);
            }
            force[a][i] = sum.iter().sum();
        }
    }
}

/// Inverse and determinant of a matrix.
fn inverse(m: [[f64; 3]; 3]) -> ([[f64; 3]; 3], f64) {
    let (c, j) = cofactor(&m.map(|row| row.map(|x| [x; 8])));
    (std::array::from_fn(|i| std::array::from_fn(|k| c[k][i][0] / j[0])), j[0])
}

/// A box of a few cells with displacements of some per cent.
fn deformed(element: Element, cells: usize) -> (Mesh, Vec<[f64; 3]>) {
    let mesh = generate::cuboid(element, [0.0; 3], [1.0, 1.2, 0.8], [cells; 3]).expect("it is a box");
    let u = |[x, y, z]: &[f64; 3]| [0.03 * (2.0 * y).sin(), 0.02 * x * z, -0.04 * z + 0.02 * x * y];
    let u = mesh.nodes.of_dimension().iter().map(u).collect();
    (mesh, u)
}

/// That a body has the same force in a cell.
fn agrees(body: &dyn Body, u: &[[f64; 3]], cell: usize, force: &[[f64; 3]]) {
    let moved = body.mesh().nodes.of_dimension::<3>().iter().zip(u);
    let y: Vec<f64> = moved.flat_map(|(x, u)| [x[0] + u[0], x[1] + u[1], x[2] + u[2]]).collect();
    let mut exact = vec![0.0; 3 * force.len()];
    body.cell_force(cell, &y, &mut exact).expect("the cell is valid");
    let largest = exact.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
    for (f, exact) in force.as_flattened().iter().zip(&exact) {
        assert!((f - exact).abs() < 1e-11 * largest, "cell {cell}: {f} and {exact}");
    }
}

/// Nanoseconds of one of `cells` cells.
fn fastest(cells: usize, mut work: impl FnMut()) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..ROUNDS {
        let begin = Instant::now();
        (0..TIMES).for_each(|_| work());
        best = best.min(begin.elapsed().as_secs_f64());
    }
    1e9 * best / (TIMES * cells) as f64
}

/// Nanoseconds of the force of a Tet4 cell.
pub(crate) fn tetrahedra() -> f64 {
    let (mesh, u) = deformed(Element::Tet4, 3);
    let x = mesh.nodes.of_dimension::<3>();
    let mut packed = Vec::new();
    for first in (0..128).step_by(8) {
        let mut cells = Tetrahedra { u: [[[0.0; 8]; 3]; 4], inverse: [[[0.0; 8]; 3]; 3], volume: [0.0; 8] };
        for l in 0..8 {
            let nodes = mesh.cell(first + l);
            // ∂X/∂ξ.
            let edges = std::array::from_fn(|i| std::array::from_fn(|a| x[nodes[a + 1]][i] - x[nodes[0]][i]));
            let (inverse, det) = inverse(edges);
            cells.volume[l] = det / 6.0;
            for i in 0..3 {
                (0..3).for_each(|k| cells.inverse[i][k][l] = inverse[i][k]);
                (0..4).for_each(|a| cells.u[a][i][l] = u[nodes[a]][i]);
            }
        }
        packed.push(cells);
    }
    let mut forces = vec![[[[0.0; 8]; 3]; 4]; packed.len()];
    let mut all = || {
        let (packed, forces) = (black_box(&packed), black_box(&mut forces));
        wide(
            #[inline(always)]
            || packed.iter().zip(forces).for_each(|(cell, force)| force_of_tetrahedra(cell, force)),
        );
    };
    let time = fastest(128, &mut all);
    let body = body(mesh, Law::NeoHookean { lambda: LAMBDA, mu: MU }, 1.0, 1.0).expect("it is valid");
    for cell in 0..128 {
        let force = forces[cell / 8].map(|f| f.map(|lanes| lanes[cell % 8]));
        agrees(&*body, &u, cell, &force);
    }
    time
}

/// Nanoseconds of the force of a Hex8 cell with mean dilatation.
pub(crate) fn hexahedra() -> f64 {
    let (mesh, u) = deformed(Element::Hex8, 3);
    let x = mesh.nodes.of_dimension::<3>();
    let cells: Vec<Hexahedron> = (0..mesh.cell_count())
        .map(|cell| {
            let nodes = mesh.cell(cell);
            let along = [1, 3, 4];
            let half = std::array::from_fn(|i| {
                std::array::from_fn(|j| 0.5 * (x[nodes[along[j]]][i] - x[nodes[0]][i]))
            });
            let (inverse, volume) = inverse(half);
            Hexahedron { u: std::array::from_fn(|a| u[nodes[a]]), inverse, volume }
        })
        .collect();
    let gradients = gradients();
    let mut forces = vec![[[0.0; 3]; 8]; cells.len()];
    let mut all = || {
        let (cells, forces) = (black_box(&cells), black_box(&mut forces));
        wide(
            #[inline(always)]
            || {
                cells
                    .iter()
                    .zip(forces)
                    .for_each(|(cell, force)| force_of_hexahedron(cell, &gradients, force));
            },
        );
    };
    let time = fastest(cells.len(), &mut all);
    let law = Law::NeoHookean { lambda: LAMBDA, mu: MU };
    let body = mean_dilatation_body(mesh, &[RegionMaterial { law, density: 1.0 }], 1.0).expect("it is valid");
    forces.iter().enumerate().for_each(|(cell, force)| agrees(&*body, &u, cell, force));
    time
}
