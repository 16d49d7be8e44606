//! A law and a kernel from outside the crates: a St. Venant–Kirchhoff law that only delegates, so
//! that plane stress is solved by the default method, and the trapezoidal rule written anew.

use carom_algebra::{Mat, Vector};
use carom_run::Setup;
use carom_run::case::Case;
use carom_solid::Past;
use carom_solid::material::{Material, NotPositive, SaintVenantKirchhoff, Thickness};
use carom_time::{Kernel, Memory, Stage};

use super::common::{DISCS, case, finish};

const STRETCHED: &str = r#"
title = "A sheet pulled at its end"
dimension = 2
plane = "stress"
material = [{ name = "sheet", law = "saint-venant-kirchhoff", density = 1.0, young = 100.0, poisson = 0.3 }]
support = [{ on = ["sheet.left"], fix = ["x", "y"] }]
load = [{ on = ["sheet.right"], traction = ["5*sin(9*t)", "2*t"] }]
[[body]]
name = "sheet"
material = "sheet"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [2.0, 1.0], cells = [4, 2] }
[time]
end = 0.5
step = 0.01
scheme = { kind = "newmark", rho_inf = 1.0 }
"#;

#[derive(Clone)]
struct Own(SaintVenantKirchhoff);

impl<const D: usize> Material<D> for Own {
    const ENERGY_DEGREE: usize = <SaintVenantKirchhoff as Material<D>>::ENERGY_DEGREE;
    type Point = <SaintVenantKirchhoff as Material<D>>::Point;

    fn after(&self, h: &Mat<D>, _: &Past) -> Result<Self::Point, NotPositive> {
        self.0.at(h)
    }

    fn energy(&self, point: &Self::Point) -> f64 {
        Material::<D>::energy(&self.0, point)
    }

    fn stress(&self, point: &Self::Point) -> Mat<D> {
        self.0.stress(point)
    }

    fn tangent(&self, point: &Self::Point, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        self.0.tangent(point, a, b)
    }

    fn lateral(&self, point: &Self::Point) -> f64 {
        Material::<D>::lateral(&self.0, point)
    }
}

impl Thickness for Own {}

/// y = y_s + Δt v_s + Δt²/4 (a_s + a), v = v_s + Δt/2 (a_s + a), M a + f = 0 at the end.
#[derive(Debug)]
struct Trapezoidal;

impl Kernel for Trapezoidal {
    fn stages(&self) -> usize {
        1
    }

    fn stage_into(&self, _: usize, dt: f64, memory: &Memory, stage: &mut Stage) {
        let (_, v, a) = memory.states[0];
        stage.at_the_end(1.0, [0.0, 0.5, 0.5]);
        (stage.velocity.slope, stage.acceleration.slope) = (2.0 / dt, 4.0 / (dt * dt));
        stage.velocity.at_start = v.iter().map(|v| -v).collect();
        stage.acceleration.at_start = v.iter().zip(a).map(|(v, a)| -4.0 / dt * v - a).collect();
    }
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn own_law() {
    for plane in ["stress", "strain"] {
        let case = case(STRETCHED, &[format!("plane=\"{plane}\"")]);
        let built_in = finish(Setup::new(&case).start().unwrap()).into_state();
        let spec = &case.materials[0];
        let own = || Own(SaintVenantKirchhoff { lambda: spec.lambda, mu: spec.mu });
        let same = finish(Setup::new(&case).material("sheet", own()).start().unwrap()).into_state();
        assert!(apart(&same.y, &built_in.y) < 1e-12, "{plane}: {:e}", apart(&same.y, &built_in.y));
        let other = Own(SaintVenantKirchhoff { lambda: spec.lambda, mu: 0.5 * spec.mu });
        let other = finish(Setup::new(&case).material("sheet", other).start().unwrap()).into_state();
        assert!(apart(&other.y, &built_in.y) > 1e-2, "the law is used");
        let error = Setup::new(&case).material("plate", own()).start().err().unwrap();
        assert!(error.to_string().contains("no material \"plate\""), "{error}");
    }
}

#[test]
fn own_kernel() {
    let built_in = Case::from_text(STRETCHED, &[]).unwrap();
    let damped = Case::from_text(STRETCHED, &["time.scheme={ kind = \"hu\" }"]).unwrap();
    let end = |setup: Setup| finish(setup.start().unwrap()).into_state();
    let (wanted, hu) = (end(Setup::new(&built_in)), end(Setup::new(&damped)));
    let own = end(Setup::new(&damped).kernel(Trapezoidal));
    assert!(apart(&own.y, &wanted.y) < 1e-10 && apart(&own.v, &wanted.v) < 1e-8);
    assert!(apart(&hu.y, &wanted.y) > 1e-3);
}

/// Two equal halves of a step.
#[derive(Debug)]
struct Twice;

impl Kernel for Twice {
    fn stages(&self) -> usize {
        2
    }

    fn stage_into(&self, _: usize, dt: f64, memory: &Memory, stage: &mut Stage) {
        Trapezoidal.stage_into(0, dt, memory, stage);
    }
}

/// What a contact is built for, and another kernel would not do.
#[test]
fn kernels_that_contacts_do_not_allow() {
    let why = |sets: &[&str], kernel: fn(Setup) -> Setup| {
        kernel(Setup::new(&case(DISCS, sets)))
            .build()
            .err()
            .map(|problems| problems.to_string())
            .unwrap_or_default()
    };
    let conserving = "time.scheme={ kind = \"energy-momentum\" }";
    let refused = why(&[conserving], |setup| setup.kernel(Trapezoidal));
    assert!(refused.contains("cannot replace the scheme energy-momentum in contact"), "{refused}");
    let frozen = ["contact.strike.detection=trajectory", "contact.strike.xi=frozen"];
    let refused = why(&frozen, |setup| setup.kernel(Twice));
    assert!(refused.contains("this kernel has 2 stages"), "{refused}");
    assert_eq!(why(&frozen, |setup| setup.kernel(Trapezoidal)), "");
    assert_eq!(why(&[], |setup| setup.kernel(Twice)), "");
    let free = case(STRETCHED, &[conserving]);
    assert!(Setup::new(&free).kernel(Trapezoidal).build().is_ok());
}
