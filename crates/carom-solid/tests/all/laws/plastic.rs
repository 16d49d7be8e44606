//! Plasticity of a point: derivatives, objectivity, isochoric flow, plastic work, histories with a
//! closed form.

use std::sync::atomic::{AtomicUsize, Ordering};

use carom_algebra::Real;
use carom_solid::Past;
use carom_solid::material::{Hardening, Hencky, J2, PlaneStress, Table};

use super::*;

fn metal() -> J2 {
    J2 {
        elastic: Hencky { lambda: LAMBDA, mu: MU },
        hardening: Hardening::Linear { yield_stress: 0.15, modulus: 0.4 },
    }
}

/// The law with a yield stress that is never reached: what hardening has stored is the same.
fn without_flow() -> J2 {
    let hardening = Hardening::Linear { yield_stress: 1e9, modulus: 0.4 };
    J2 { hardening, ..metal() }
}

/// A law in one step from a memory, as a law without: Ψ is then the incremental potential.
struct Step<'a, L> {
    law: &'a L,
    memory: &'a [f64],
}

impl<const D: usize, L: Material<D>> Material<D> for Step<'_, L> {
    type Point = L::Point;

    fn after(&self, h: &Mat<D>, _: &Past) -> Result<L::Point, NotPositive> {
        self.law.after(h, &Past::new(self.memory, 1.0))
    }

    fn energy(&self, point: &L::Point) -> f64 {
        self.law.energy(point) + self.law.dissipated(point)
    }

    fn stress(&self, point: &L::Point) -> Mat<D> {
        self.law.stress(point)
    }

    fn tangent(&self, point: &L::Point, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        self.law.tangent(point, a, b)
    }

    fn lateral(&self, point: &L::Point) -> f64 {
        self.law.lateral(point)
    }
}

/// The memory after steps to these deformations.
fn after<const D: usize, L: Material<D>>(law: &L, path: &[Mat<D>]) -> Vec<f64> {
    let mut memory = vec![0.0; L::MEMORY];
    for h in path {
        let point = law.after(h, &Past::new(&memory, 1.0)).unwrap();
        law.remember(&point, &mut memory);
    }
    memory
}

/// Stress, tangent and increments of a step are derivatives, where flow does not begin within the
/// range of the differences.
fn step_derivatives<const D: usize, L: Material<D>>(law: &L, memory: &[f64], h: &Mat<D>) {
    let step = Step { law, memory };
    let point = step.at(h).unwrap();
    let unit = Mat::<D>::identity().0.map(Vector);
    for k in 0..D {
        for l in 0..D {
            let moved = |s: f64| {
                let mut m = *h;
                m.0[k][l] += s;
                m
            };
            let flows = |s: f64| law.released(&step.at(&moved(s)).unwrap()) > 0.0;
            if flows(2e-3) != flows(-2e-3) || flows(0.0) != flows(2e-3) {
                return;
            }
            let expected = slope(5e-4, &|s| step.energy_at(&moved(s)));
            let p = step.stress(&point).0[k][l];
            assert!((expected - p).abs() < 1e-9, "P{k}{l} is {p}, ∂ΔW/∂F {expected}");
            let mut df = Mat::ZERO;
            df.0[k][l] = 1.0;
            let change = law.change(&point, &df);
            for i in 0..D {
                for j in 0..D {
                    let expected = slope(5e-4, &|s| step.stress_at(&moved(s)).0[i][j]);
                    let block = step.tangent(&point, &unit[j], &unit[l]).0[i][k];
                    assert!((expected - block).abs() < 1e-8, "{expected} against {block}");
                    assert!((change.0[i][j] - block).abs() < 1e-12, "{} against {block}", change.0[i][j]);
                }
            }
        }
    }
}

fn path<const D: usize>(x: &[f64]) -> Vec<Mat<D>> {
    x.chunks_exact(9).map(|entries| matrix(entries, 0.2)).collect()
}

fn of_history<const D: usize>(x: &[f64])
where
    J2: Material<D>,
{
    let law = metal();
    let path = path::<D>(x);
    let memory = after(&law, &path[..3]);
    step_derivatives(&law, &memory, &path[3]);
    // Equal principal stretches, exactly and nearly, of virgin and of strained points.
    for near in [0.0, 1e-15, 1e-9, 1e-5] {
        let mut h = Mat::identity() * (0.1 * x[0]);
        h.0[0][D - 1] += near;
        step_derivatives(&law, &memory, &h);
        step_derivatives(&law, &vec![0.0; <J2 as Material<D>>::MEMORY], &h);
    }
}

#[test]
fn stress_and_tangent_of_a_step_are_derivatives() {
    lists(64, 36, &|x| {
        of_history::<1>(x);
        of_history::<2>(x);
        of_history::<3>(x);
    });
}

/// Two equal principal stretches with flow: the tangent along the third axis, and in the plane of
/// the equal ones.
#[test]
fn equal_stretches_with_flow_keep_the_digits_of_the_tangent() {
    let law = metal();
    let virgin = vec![0.0; <J2 as Material<3>>::MEMORY];
    for near in [0.0, 1e-16, 1e-12, 1e-8, 1e-7, 1e-6, 1e-4] {
        let h = Mat([[0.3, 0.0, 0.0], [0.0, -0.1, 0.5 * near], [0.0, 0.5 * near, -0.1 + near]]);
        step_derivatives(&law, &virgin, &h);
        step_derivatives(&Hencky { lambda: LAMBDA, mu: MU }, &[], &h);
    }
}

/// det C_p⁻¹ from a memory.
fn plastic_volume<const D: usize>(memory: &[f64]) -> f64 {
    let mut c = Mat::<D>::identity();
    let mut next = memory.iter();
    for i in 0..D {
        for j in i..D {
            let entry = next.next().unwrap();
            c.0[i][j] += entry;
            c.0[j][i] = c.0[i][j];
        }
    }
    let across = if D < 3 { 1.0 + next.next().unwrap() } else { 1.0 };
    c.det() * across.powi(3 - D as i32)
}

/// Plane stress: the derivatives of a step, with every kind of hardening; nothing presses across;
/// it is isochoric flow as in space.
#[test]
fn sheets_flow_without_stress_across() {
    let voce = Hardening::Voce { yield_stress: 0.15, modulus: 0.1, rise: 0.2, rate: 9.0 };
    let table = Hardening::Table(Table::new(&[[0.0, 0.15], [0.1, 0.3], [0.2, 0.3]]).unwrap());
    for hardening in [metal().hardening, voce, table] {
        let law = J2 { elastic: metal().elastic, hardening };
        lists(64, 36, &|x| {
            let sheet = PlaneStress(law.clone());
            let path = path::<2>(x);
            let memory = after(&sheet, &path[..3]);
            if !matches!(law.hardening, Hardening::Table(_)) {
                step_derivatives(&sheet, &memory, &path[3]);
            }
            assert!((plastic_volume::<3>(&memory) - 1.0).abs() < 1e-12);
            let past = Past::new(&memory, 1.0);
            let across = sheet.lateral_excess(&sheet.after(&path[3], &past).unwrap());
            let [[a, b], [c, d]] = path[3].0;
            let wide = Mat([[a, b, 0.0], [c, d, 0.0], [0.0, 0.0, across]]);
            let point = law.after(&wide, &past).unwrap();
            assert!(Material::<3>::stress(&law, &point).0[2][2].abs() < 1e-14);
        });
    }
}

/// Histories of ten steps in every dimension: flow keeps the volume, plastic strain does not fall,
/// what is dissipated is not negative; 10 002 of them.
#[test]
fn flow_is_isochoric_and_dissipates() {
    fn history<const D: usize>(x: &[f64]) -> f64
    where
        J2: Material<D>,
    {
        let law = metal();
        let mut memory = vec![0.0; <J2 as Material<D>>::MEMORY];
        let mut total = 0.0;
        for h in path::<D>(x) {
            let point = law.after(&h, &Past::new(&memory, 1.0)).unwrap();
            let start = memory.clone();
            let before = *memory.last().unwrap();
            law.remember(&point, &mut memory);
            let alpha = *memory.last().unwrap();
            let dissipated = Material::<D>::dissipated(&law, &point);
            assert!(dissipated >= 0.0 && alpha >= before);
            assert!((dissipated - 0.15 * (alpha - before)).abs() < 1e-15);
            let strong = without_flow();
            let elastic = Material::<D>::energy(&strong, &strong.after(&h, &Past::new(&start, 1.0)).unwrap());
            let released = elastic - Material::<D>::energy(&law, &point) - dissipated;
            assert!((released - Material::<D>::released(&law, &point)).abs() < 1e-13);
            total += dissipated;
            let volume = plastic_volume::<D>(&memory);
            assert!((volume - 1.0).abs() < 1e-12, "{volume}");
        }
        total
    }
    lists(3334, 90, &|x| {
        let total = history::<1>(x) + history::<2>(x) + history::<3>(x);
        assert!(total > 0.0 || x.iter().all(|x| x.abs() < 0.3));
    });
}

/// A rotation of the deformed body turns the stress; what is remembered does not turn.
#[test]
fn rotations_turn_the_stress_alone() {
    lists(256, 29, &|x| {
        let [a, b] = [3.0 * x[27], 3.0 * x[28]];
        let law = metal();
        let path = path::<3>(&x[..27]);
        let memory = after(&law, &path[..2]);
        let q = rotation([a, b, 0.7]);
        let turned = q * (Mat::identity() + path[2]) - Mat::identity();
        objectivity(&Step { law: &law, memory: &memory }, &path[2], &q);
        let remembers = |h: &Mat<3>| {
            let mut end = memory.clone();
            law.remember(&law.after(h, &Past::new(&memory, 1.0)).unwrap(), &mut end);
            end
        };
        let differences = remembers(&path[2]).into_iter().zip(remembers(&turned));
        assert!(differences.into_iter().all(|(one, other)| (one - other).abs() < 1e-13));
    });
}

/// Plane strain is the law in space without strain across.
#[test]
fn plane_strain_is_the_law_in_space() {
    lists(256, 27, &|x| {
        let law = metal();
        let plane = path::<2>(x);
        let space: Vec<Mat<3>> = plane
            .iter()
            .map(|h| Mat([[h.0[0][0], h.0[0][1], 0.0], [h.0[1][0], h.0[1][1], 0.0], [0.0; 3]]))
            .collect();
        let one = after(&law, &plane);
        let other = after(&law, &space);
        // 11 12 22 33 α, and 11 12 13 22 23 33 α.
        for (narrow, wide) in [0, 1, 3, 5, 6].iter().enumerate() {
            assert!((one[narrow] - other[*wide]).abs() < 1e-13);
        }
        let last = law.after(&plane[2], &Past::new(&one, 1.0)).unwrap();
        let wide = law.after(&space[2], &Past::new(&other, 1.0)).unwrap();
        let cauchy = Material::<3>::cauchy(&law, &wide, &space[2]);
        assert!((Material::<2>::lateral(&law, &last) - cauchy.0[2][2]).abs() < 1e-12);
    });
}

/// Steps of 1e-9 of the yield strain keep their digits: shear beyond yield, with hardening, has
/// τ = G_ep γ with G_ep = G H/(3G + H).
#[test]
fn small_strains_beyond_yield_are_exact() {
    let law = J2 {
        elastic: Hencky { lambda: LAMBDA, mu: MU },
        hardening: Hardening::Linear { yield_stress: 1e-9 * 3.0_f64.sqrt(), modulus: 0.4 },
    };
    let yields = 1e-9 / MU;
    let gamma = 3.0 * yields;
    let h = Mat([[0.0, 0.5 * gamma], [0.5 * gamma, 0.0]]);
    let memory = [0.0; 5];
    let point = law.after(&h, &Past::new(&memory, 1.0)).unwrap();
    let expected = 1e-9 + MU * 0.4 / (3.0 * MU + 0.4) * (gamma - yields);
    let found = Material::<2>::stress(&law, &point).0[0][1];
    assert!((found / expected - 1.0).abs() < 1e-8, "{found:e} {expected:e}");
}

/// Simple shear up to γ = 8 without hardening: τ₁₂ rises to Y/√3 and stays there, and the normal
/// stresses vanish; τ₁₂ never exceeds Y/√3.
#[test]
fn large_shear_does_not_oscillate() {
    let yields = 1e-3;
    let law = J2 {
        elastic: Hencky { lambda: LAMBDA, mu: MU },
        hardening: Hardening::Linear { yield_stress: yields, modulus: 0.0 },
    };
    let mut memory = vec![0.0; <J2 as Material<3>>::MEMORY];
    for step in 1..=800 {
        let gamma = 0.01 * f64::from(step);
        let h = Mat([[0.0, gamma, 0.0], [0.0; 3], [0.0; 3]]);
        let point = law.after(&h, &Past::new(&memory, 1.0)).unwrap();
        law.remember(&point, &mut memory);
        let cauchy = Material::<3>::cauchy(&law, &point, &h).0;
        let limit = yields / 3.0_f64.sqrt();
        assert!(cauchy[0][1] <= limit * (1.0 + 1e-12));
        if gamma > 0.1 {
            assert!((cauchy[0][1] / limit - 1.0).abs() < 1e-4, "{gamma}: {}", cauchy[0][1] / limit);
            assert!((cauchy[0][0] / limit).abs() < 0.02, "{gamma}: {}", cauchy[0][0] / limit);
        }
    }
    // γ/√3 less the elastic part.
    let alpha = memory.last().unwrap();
    assert!((alpha / (8.0 / 3.0_f64.sqrt()) - 1.0).abs() < 1e-3, "{alpha}");
}

/// Four points at once, of which some flow and some do not, are what each of them is by itself: the
/// same stress, energies and memory, bit by bit.
#[test]
fn four_points_at_once_are_single_points() {
    fn compared<const D: usize>(law: &J2, x: &[f64], mixed: &AtomicUsize) {
        let path = path::<D>(x);
        let scales = [1.0, 0.02, 0.5, 0.1];
        let size = <J2 as Material<D>>::MEMORY;
        let memory: Vec<f64> =
            scales.iter().flat_map(|scale| after(law, &[path[0] * *scale, path[1] * *scale])).collect();
        let ends = scales.map(|scale| path[3] * scale);
        let mut lanes = Mat::<D, Four>::ZERO;
        for i in 0..D {
            for j in 0..D {
                lanes.0[i][j] = Four(ends.map(|h| h.0[i][j]));
            }
        }
        let mut remembered = vec![0.0; 4 * size];
        let past = Past::new(&memory, 1.0);
        let four = law.four(&lanes, &past, 4, &mut remembered).unwrap();
        let df = path[2];
        let along = law.four_along(&lanes, Some(&Mat(df.0.map(|row| row.map(Four::of)))), &past, 4).unwrap();
        let mut moduli = [[[[[0.0; 4]; D]; D]; D]; D];
        let by_moduli = law.moduli(&lanes, &past, 4, &mut [], &mut moduli).unwrap();
        let unit = Mat::<D>::identity().0.map(Vector);
        for (l, h) in ends.iter().enumerate() {
            let of_point = l * size..(l + 1) * size;
            let past = Past::new(&memory[of_point.clone()], 1.0);
            let point = Material::<D>::after(law, h, &past).unwrap();
            let mut own = past.memory.to_vec();
            law.remember(&point, &mut own);
            assert_eq!(own, remembered[of_point]);
            assert_eq!(law.energy(&point), four.stored.0[l]);
            assert_eq!(law.dissipated(&point), four.dissipated.0[l]);
            let stress = law.stress(&point);
            let lane = |of: &Mat<D, Four>| Mat(of.0.map(|row| row.map(|x| x.0[l])));
            assert_eq!(stress, lane(&four.stress));
            assert_eq!(stress, lane(&along.at.stress));
            assert_eq!(stress, lane(&by_moduli.stress));
            // The stress without flow, and its change, are those of a law that never yields.
            let strong = without_flow();
            let elastic = Material::<D>::after(&strong, h, &past).unwrap();
            let change = law.change(&point, &df);
            let near = |a: Mat<D>, b: Mat<D>| {
                assert!((a - b).double_dot(&(a - b)).sqrt() < 1e-13, "{a:?} against {b:?}");
            };
            near(lane(&along.change), change);
            near(lane(&along.released_stress), Material::<D>::stress(&strong, &elastic) - stress);
            near(lane(&along.released_change), strong.change(&elastic, &df) - change);
            for j in 0..D {
                for k in 0..D {
                    let block = Mat(moduli[j][k].map(|row| row.map(|x| x[l])));
                    near(block, law.tangent(&point, &unit[j], &unit[k]));
                }
            }
        }
        let is_mixed = four.dissipated.0.iter().any(|lost| *lost > 0.0) && four.dissipated.0.contains(&0.0);
        mixed.fetch_add(usize::from(is_mixed), Ordering::Relaxed);
    }
    let mixed = AtomicUsize::new(0);
    let voce = Hardening::Voce { yield_stress: 0.15, modulus: 0.1, rise: 0.2, rate: 9.0 };
    let table = Hardening::Table(Table::new(&[[0.0, 0.15], [0.1, 0.3], [0.2, 0.3]]).unwrap());
    for hardening in [metal().hardening, voce, table] {
        let law = J2 { elastic: metal().elastic, hardening };
        lists(64, 36, &|x| {
            compared::<2>(&law, x, &mixed);
            compared::<3>(&law, x, &mixed);
        });
    }
    assert!(mixed.load(Ordering::Relaxed) > 100);
}
