//! Laws with memory: isotropic damage as an example. What a step computes agrees with finite
//! differences and with the answer in one dimension; damage only grows, and dissipates.
//!
//! ```text
//! Ψ = (1 − d) Ψ₀,   κ = max Ψ₀ so far,   d(κ) = 1 − exp(−(κ − κ₀)/c)  for κ > κ₀
//! 𝒟 = ∫ κ dd = G(κ₁) − G(κ₀),   G(κ) = κ₀ + c − (κ + c) exp(−(κ − κ₀)/c)
//! ```

use carom_algebra::{Mat, Vector, jacobian_error};
use carom_solid::material::{
    Hardening, Hencky, J2, LinearElastic, Material, NeoHookean, NotPositive, Thickness,
};
use carom_solid::{
    Ask, Body, Configuration, Constitutive, Element, Mesh, Past, PlaneState, RegionMaterial, Response,
    VolumeAveraged, body_of_regions, generate, mean_dilatation_body,
};

/// Damage of a hyperelastic law.
#[derive(Clone, Copy, Debug)]
struct Damage<L> {
    of: L,
    threshold: f64,
    scale: f64,
}

struct DamagedPoint<P> {
    of: P,
    /// Ψ₀.
    energy: f64,
    /// κ at the start and at the end of the step.
    history: [f64; 2],
}

impl<L> Damage<L> {
    /// 1 − d.
    fn intact(&self, history: f64) -> f64 {
        if history > self.threshold { (-(history - self.threshold) / self.scale).exp() } else { 1.0 }
    }

    /// G.
    fn lost(&self, history: f64) -> f64 {
        if history <= self.threshold {
            return 0.0;
        }
        self.threshold + self.scale - (history + self.scale) * self.intact(history)
    }
}

impl<const D: usize, L: Material<D> + 'static> Material<D> for Damage<L> {
    const ENERGY_DEGREE: usize = L::ENERGY_DEGREE;
    const OBJECTIVE: bool = L::OBJECTIVE;
    const MEMORY: usize = 1;
    type Point = DamagedPoint<L::Point>;

    fn after(&self, h: &Mat<D>, past: &Past) -> Result<Self::Point, NotPositive> {
        let of = self.of.at(h)?;
        let energy = self.of.energy(&of);
        let start = past.memory[0];
        Ok(DamagedPoint { of, energy, history: [start, start.max(energy)] })
    }

    fn remember(&self, point: &Self::Point, memory: &mut [f64]) {
        memory[0] = point.history[1];
    }

    fn dissipated(&self, point: &Self::Point) -> f64 {
        self.lost(point.history[1]) - self.lost(point.history[0])
    }

    fn energy(&self, point: &Self::Point) -> f64 {
        self.intact(point.history[1]) * point.energy
    }

    fn stress(&self, point: &Self::Point) -> Mat<D> {
        self.of.stress(&point.of) * self.intact(point.history[1])
    }

    fn tangent(&self, point: &Self::Point, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        let intact = self.intact(point.history[1]);
        let elastic = self.of.tangent(&point.of, a, b) * intact;
        let grows = point.history[1] > point.history[0].max(self.threshold);
        if !grows {
            return elastic;
        }
        let stress = self.of.stress(&point.of);
        elastic - stress.apply(a).outer(&stress.apply(b)) * (intact / self.scale)
    }

    fn lateral(&self, point: &Self::Point) -> f64 {
        self.of.lateral(&point.of) * self.intact(point.history[1])
    }
}

impl<L: Material<3> + 'static> Thickness for Damage<L> {}

const RUBBER: Damage<NeoHookean> =
    Damage { of: NeoHookean { lambda: 2.0, mu: 1.5 }, threshold: 0.01, scale: 0.2 };
const BAR: Damage<LinearElastic> =
    Damage { of: LinearElastic { lambda: 0.0, mu: 0.5 }, threshold: 0.005, scale: 0.02 };

fn made(mesh: Mesh, law: &dyn Constitutive) -> Box<dyn Body> {
    body_of_regions(mesh, &[RegionMaterial { law, density: 1.0 }], PlaneState::Strain, 1.0).unwrap()
}

fn metal() -> J2 {
    J2 {
        elastic: Hencky { lambda: 2.0, mu: 1.5 },
        hardening: Hardening::Linear { yield_stress: 0.2, modulus: 0.5 },
    }
}

/// Bodies of rubber that is damaged, and of metal, with mean dilatation too.
fn bodies() -> Vec<Box<dyn Body>> {
    let mut bodies: Vec<_> = meshes().into_iter().map(|mesh| made(mesh, &RUBBER)).collect();
    bodies.extend(of_metal());
    bodies
}

fn of_metal() -> Vec<Box<dyn Body>> {
    let mut bodies = Vec::new();
    for mesh in meshes() {
        bodies.push(made(mesh.clone(), &metal()));
        if [Element::Q4, Element::Hex8].contains(&mesh.element) {
            let material = RegionMaterial { law: &metal() as &dyn VolumeAveraged, density: 1.0 };
            bodies.push(mean_dilatation_body(mesh.clone(), &[material], 1.0).unwrap());
        }
        if mesh.dimension() == 2 {
            let material = RegionMaterial { law: &metal() as &dyn Constitutive, density: 1.0 };
            bodies.push(body_of_regions(mesh, &[material], PlaneState::Stress, 1.0).unwrap());
        }
    }
    bodies
}

fn meshes() -> Vec<Mesh> {
    let plane = |element| generate::rectangle(element, [0.0; 2], [1.0, 2.0], [2, 2]).unwrap();
    let space = |element| generate::cuboid(element, [0.0; 3], [1.0, 2.0, 1.5], [1, 1, 1]).unwrap();
    let mut meshes: Vec<Mesh> = [Element::T3, Element::T6, Element::Q4].map(plane).into();
    meshes.push(generate::interval(Element::L3, 0.0, 2.0, 3).unwrap());
    meshes.extend([Element::Tet4, Element::Hex8].map(space));
    meshes
}

/// Positions strained by about `by`.
fn moved(mesh: &Mesh, by: f64) -> Vec<f64> {
    let d = mesh.dimension();
    let component = |x: &[f64], i: usize| x[i] + by * (x[i] + 0.4 * (1.3 * x[(i + 1) % d]).sin());
    mesh.nodes.iter().flat_map(|x| (0..d).map(move |i| component(x, i))).collect()
}

/// Response of one cell: numbers, energy and new memory.
fn of_cell(body: &dyn Body, cell: usize, at: &Configuration, ask: Ask) -> (Vec<f64>, f64, Vec<f64>) {
    let dofs = body.mesh().element.dofs();
    let count = if let Ask::Tangent = ask { dofs + dofs * dofs } else { dofs };
    let (mut numbers, mut energies, mut memory) = (vec![0.0; count], [0.0], vec![0.0; body.memory()]);
    let out =
        Response { numbers: &mut numbers, energies: &mut energies, memory: &mut memory, dissipated: &mut [] };
    body.respond(cell, at, ask, out).unwrap();
    (numbers, energies[0], memory)
}

/// The memory of all cells after a step to `y`.
fn after(body: &dyn Body, y: &[f64], past: Past) -> Vec<f64> {
    let at = Configuration { before: None, y, past };
    (0..body.mesh().cell_count()).flat_map(|cell| of_cell(body, cell, &at, Ask::Force).2).collect()
}

#[test]
fn tangents_and_products_are_derivatives() {
    for body in bodies() {
        let body = &*body;
        let (mesh, dofs) = (body.mesh(), body.mesh().element.dofs());
        // In space the motion is nearly a change of volume.
        let most = if mesh.dimension() == 3 { 0.5 } else { 0.15 };
        let memory = after(body, &moved(mesh, most), Past::new(&[], 0.0));
        assert!(memory.iter().any(|number| number.abs() > 1e-3));
        let past = Past::new(&memory, 0.1);
        let before = moved(mesh, most);
        // It unloads, and it loads further.
        for by in [0.67 * most, 1.4 * most] {
            let y = moved(mesh, by);
            for cell in 0..mesh.cell_count() {
                let nodes = mesh.cell(cell).to_vec();
                let d = mesh.dimension();
                let own: Vec<usize> = nodes.iter().flat_map(|n| (0..d).map(move |i| n * d + i)).collect();
                let with = |x: &[f64]| {
                    let mut y = y.clone();
                    own.iter().zip(x).for_each(|(dof, x)| y[*dof] = *x);
                    y
                };
                let x: Vec<f64> = own.iter().map(|dof| y[*dof]).collect();
                let force = |x: &[f64]| {
                    let y = with(x);
                    of_cell(body, cell, &Configuration { before: None, y: &y, past }, Ask::Force).0
                };
                let at = Configuration { before: None, y: &y, past };
                let (tangent, ..) = of_cell(body, cell, &at, Ask::Tangent);
                assert_eq!(tangent[..dofs], force(&x)[..]);
                let error = jacobian_error(&x, 1e-4, force, &tangent[dofs..]);
                assert!(error < 1e-8, "{:?} {by}: {error}", mesh.element);
                // Products, of the force and of the discrete gradient.
                for before in [None, Some(&before[..])] {
                    let at = Configuration { before, y: &y, past };
                    let change: Vec<f64> = (0..y.len()).map(|i| (1.7 * i as f64).sin()).collect();
                    let (product, ..) = of_cell(body, cell, &at, Ask::Product(&change));
                    let step = 1e-6;
                    let [plus, minus] = [step, -step].map(|step| {
                        let y: Vec<f64> = y.iter().zip(&change).map(|(y, u)| y + step * u).collect();
                        of_cell(body, cell, &Configuration { before, y: &y, past }, Ask::Force).0
                    });
                    for i in 0..dofs {
                        let found = (plus[i] - minus[i]) / (2.0 * step);
                        assert!(
                            (found - product[i]).abs() < 1e-7,
                            "{:?} {by}: {found} {}",
                            mesh.element,
                            product[i]
                        );
                    }
                }
            }
        }
    }
}

/// The discrete gradient does the work of what is stored and dissipated; the latter is never
/// negative, and nothing where the law unloads.
#[test]
fn work_is_stored_or_dissipated() {
    let damaged = meshes().into_iter().map(|mesh| (made(mesh, &RUBBER), true));
    for (body, is_damage) in damaged.chain(of_metal().into_iter().map(|body| (body, false))) {
        let body = &*body;
        let mesh = body.mesh();
        let d = mesh.dimension();
        let mut memory = vec![0.0; body.memory() * mesh.cell_count()];
        let mut before = mesh.nodes.flat().to_vec();
        let mut stored = vec![0.0; mesh.cell_count()];
        let mut total = 0.0;
        for by in [0.1, 0.2, 0.19, 0.12, 0.05, 0.25, 0.4, 0.0] {
            let y = moved(mesh, by);
            let at = Configuration { before: Some(&before), y: &y, past: Past::new(&memory, 0.1) };
            let mut next = Vec::new();
            for (cell, stored) in stored.iter_mut().enumerate() {
                let (force, energy, remembered) = of_cell(body, cell, &at, Ask::Force);
                let nodes = mesh.cell(cell).iter();
                let dofs = nodes.flat_map(|n| (0..d).map(move |i| n * d + i));
                let work: f64 = dofs.zip(&force).map(|(dof, f)| f * (y[dof] - before[dof])).sum();
                let dissipated = work - (energy - *stored);
                assert!(dissipated > -1e-14, "{:?} {by}: {dissipated}", mesh.element);
                let unloads = if is_damage { [0.12, 0.05, 0.0].contains(&by) } else { by == 0.19 };
                if unloads {
                    assert!(dissipated.abs() < 1e-14, "{:?} {by}: {dissipated}", mesh.element);
                }
                total += dissipated;
                *stored = energy;
                next.extend(remembered);
            }
            assert!(!is_damage || memory.iter().zip(&next).all(|(before, after)| before <= after));
            memory = next;
            before = y;
        }
        assert!(total > 0.01, "{total}");
    }
}

/// σ = (1 − d) ε in a bar with E = 1, loaded, unloaded and loaded again.
#[test]
fn a_bar_has_the_exact_stress() {
    let body = made(generate::interval(Element::L2, 0.0, 1.0, 1).unwrap(), &BAR);
    let body = &*body;
    let mut memory = vec![0.0];
    let mut largest = 0.0_f64;
    for strain in [0.05, 0.15, 0.2, 0.08, -0.1, 0.18, 0.3, -0.4] {
        let y = [0.0, 1.0 + strain];
        let at = Configuration { before: None, y: &y, past: Past::new(&memory, 1.0) };
        let (force, energy, next) = of_cell(body, 0, &at, Ask::Force);
        largest = largest.max(0.5 * strain * strain);
        let intact = (-(largest - 0.005).max(0.0) / 0.02).exp();
        assert!((force[1] - intact * strain).abs() < 1e-15, "{strain}: {}", force[1]);
        assert!((energy - 0.5 * intact * strain * strain).abs() < 1e-15);
        assert!((next[0] - largest).abs() < 1e-16);
        let state = body.point(0, &[0.5], &y, &Past::new(&next, 0.0)).unwrap();
        assert!((state.cauchy[0][0] - intact * strain).abs() < 1e-15);
        memory = next;
    }
}

/// Plane stress: σ = (1 − d) E ε of a sheet that is pulled along x and free across.
#[test]
fn a_sheet_has_the_exact_stress() {
    let law = Damage { of: LinearElastic { lambda: 1.0, mu: 1.0 }, threshold: 0.005, scale: 0.02 };
    let mesh = generate::rectangle(Element::T3, [0.0; 2], [1.0; 2], [1, 1]).unwrap();
    let material = RegionMaterial { law: &law as &dyn Constitutive, density: 1.0 };
    let body = body_of_regions(mesh, &[material], PlaneState::Stress, 1.0).unwrap();
    let mut memory = vec![0.0; 2];
    let mut largest = 0.0_f64;
    for strain in [0.05, 0.15, 0.08, -0.1, 0.2] {
        // E = 5/2, ν = 1/4.
        let y: Vec<f64> = body
            .mesh()
            .nodes
            .iter()
            .flat_map(|x| [x[0] * (1.0 + strain), x[1] * (1.0 - 0.25 * strain)])
            .collect();
        memory = after(&*body, &y, Past::new(&memory, 1.0));
        largest = largest.max(1.25 * strain * strain);
        let intact = (-(largest - 0.005).max(0.0) / 0.02).exp();
        let state = body.point(0, &[0.2, 0.3], &y, &Past::new(&memory, 0.0)).unwrap();
        assert!((state.cauchy[0][0] - 2.5 * intact * strain).abs() < 1e-14, "{strain}");
        assert!(state.cauchy[1][1].abs() < 1e-14);
    }
}

/// Stress and strain that vary linearly are projected exactly to nodes, as those of a law without
/// memory: a bent sheet that does not yet yield, its strains small.
#[test]
fn linear_fields_are_projected_exactly() {
    let elastic = Hencky { lambda: 2.0, mu: 1.5 };
    let strong = Hardening::Linear { yield_stress: 1e9, modulus: 0.0 };
    for element in [Element::T6, Element::Q9] {
        let mesh = || generate::rectangle(element, [0.0, 0.0], [2.0, 1.0], [3, 2]).unwrap();
        let remembering = made(mesh(), &J2 { elastic, hardening: strong.clone() });
        let direct = made(mesh(), &elastic);
        let bent = |x: &[f64]| [x[0] + 1e-7 * x[0] * x[1], x[1] - 0.5e-7 * x[0] * x[0]];
        let y: Vec<f64> = mesh().nodes.iter().flat_map(bent).collect();
        let memory = vec![0.0; remembering.memory() * mesh().cell_count()];
        let past = Past::new(&memory, 0.0);
        for cell in 0..mesh().cell_count() {
            for xi in direct.reference_nodes() {
                let found = remembering.point(cell, &xi, &y, &past).unwrap();
                let expected = direct.point(cell, &xi, &y, &Past::default()).unwrap();
                let pairs = [(found.cauchy, expected.cauchy), (found.strain, expected.strain)];
                for (found, expected) in pairs {
                    for (a, b) in found.as_flattened().iter().zip(expected.as_flattened()) {
                        assert!((a - b).abs() < 1e-13, "{a:e} {b:e}");
                    }
                }
                assert_eq!((found.plastic_strain, found.yielded), (0.0, 0.0));
            }
        }
    }
}

/// A sheet whose upper half has yielded: the share of the quadrature points that have, and a
/// projected plastic strain that is nowhere negative.
#[test]
fn what_has_yielded_is_a_share_of_the_points() {
    let law = J2 {
        elastic: Hencky { lambda: 2.0, mu: 1.5 },
        hardening: Hardening::Linear { yield_stress: 0.15, modulus: 0.1 },
    };
    let body = made(generate::rectangle(Element::T6, [0.0, 0.0], [1.0, 1.0], [1, 1]).unwrap(), &law);
    let mesh = body.mesh();
    let y: Vec<f64> = mesh.nodes.iter().flat_map(|x| [x[0] * (1.0 + 0.1 * x[1] * x[1]), x[1]]).collect();
    let memory = after(&*body, &y, Past::new(&[], 0.0));
    let past = Past::new(&memory, 0.0);
    let mut shares = Vec::new();
    for cell in 0..mesh.cell_count() {
        for xi in body.reference_nodes() {
            let point = body.point(cell, &xi, &y, &past).unwrap();
            assert!(point.plastic_strain >= 0.0);
            shares.push(point.yielded);
        }
    }
    assert!(shares.iter().any(|share| *share > 0.0 && *share < 1.0), "{shares:?}");
}

/// A region that remembers nothing, in a body of which another one does.
#[test]
fn elastic_cells_of_a_body_that_yields_are_those_of_an_elastic_body() {
    let elastic = metal().elastic;
    for mesh in meshes() {
        let count = mesh.cell_count();
        let mut mixed = mesh.clone();
        mixed.regions = (0..count).map(|cell| u16::from(cell == count - 1)).collect();
        if count == 1 {
            continue;
        }
        let laws: [&dyn Constitutive; 2] = [&metal(), &elastic];
        let materials = laws.map(|law| RegionMaterial { law, density: 1.0 });
        let mut bodies = vec![
            [
                body_of_regions(mixed.clone(), &materials, PlaneState::Strain, 1.0),
                Ok(made(mesh.clone(), &elastic)),
            ]
            .map(Result::unwrap),
        ];
        if mesh.element == Element::Q4 {
            let laws: [&dyn VolumeAveraged; 2] = [&metal(), &elastic_law()];
            let materials = laws.map(|law| RegionMaterial { law, density: 1.0 });
            let alone = RegionMaterial { law: &elastic_law() as &dyn VolumeAveraged, density: 1.0 };
            bodies.push([
                mean_dilatation_body(mixed, &materials, 1.0).unwrap(),
                mean_dilatation_body(mesh.clone(), &[alone], 1.0).unwrap(),
            ]);
        }
        let [start, end] = [0.1, 0.2].map(|by| moved(&mesh, by));
        let change: Vec<f64> = end.iter().map(|y| (3.0 * y).sin()).collect();
        for [mixed, elastic] in &bodies {
            let memory = vec![0.0; count * mixed.memory()];
            for before in [None, Some(&start[..])] {
                for ask in [Ask::Force, Ask::Tangent, Ask::Product(&change)] {
                    let answers = [(mixed, &memory[..]), (elastic, &[])].map(|(body, memory)| {
                        let past = Past::new(memory, 0.1);
                        of_cell(&**body, count - 1, &Configuration { before, y: &end, past }, ask)
                    });
                    let [got, wanted] = answers.map(|(numbers, energy, _)| [numbers, vec![energy]].concat());
                    let size = wanted.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
                    let apart = got.iter().zip(&wanted).all(|(a, b)| (a - b).abs() <= 1e-13 * size);
                    assert!(size > 0.0 && apart, "{:?} {ask:?}: {got:?} {wanted:?}", mesh.element);
                }
            }
        }
    }
}

fn elastic_law() -> carom_solid::Law {
    let Hencky { lambda, mu } = metal().elastic;
    carom_solid::Law::Hencky { lambda, mu }
}
