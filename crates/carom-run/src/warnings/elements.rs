//! Warnings about elements of degree 1: they lock at nearly constant volume, and T3 in bending.
//!
//! A beam of n square cells across its thickness is too stiff in bending by 3/n², as measured on a
//! cantilever with L/h = 20 and ν = 0 (n = 2, 4, 8, 16: 75 %, 19 %, 4.7 %, 1.2 %). Length L and
//! thickness h of a body are the roots of x² − (P/2) x + A = 0, with its area A and its perimeter
//! P: exact for a rectangle, to first order for a strip or ring that is bent.

use carom_case::{BodySpec, Case, MaterialSpec, Plane, Volumetric};
use carom_mechanics::model::{BodyInstance, Model};
use carom_solid::{Element, Facet};

use super::found::{Found, short};

/// Poisson's ratio above which elements of degree 1 lock in plane strain and in space: at 0.45 the
/// bulk modulus is ten times the shear modulus.
const LOCKING: f64 = 0.45;
/// L/h of a body that bends rather than shears: at 5 the shear of a cantilever contributes some
/// three per cent of its deflection.
const SLENDER: f64 = 5.0;
/// Excess of bending stiffness that is warned about.
const TOO_STIFF: f64 = 0.05;

/// In plane stress the thickness changes freely, so nothing locks.
pub(super) fn locking(case: &Case, _: &Model) -> Vec<Found> {
    let mut found = Vec::new();
    let locks = |body: &&BodySpec| match body.element {
        Element::T3 | Element::Q4 => case.plane == Plane::Strain,
        Element::Tet4 | Element::Hex8 => true,
        _ => false,
    };
    let locking = case.bodies.iter().filter(locks).filter(|body| body.volumetric == Volumetric::Pointwise);
    for body in locking {
        let ratio = |of: &MaterialSpec| of.lambda / (2.0 * (of.lambda + of.mu));
        let Some(poisson) = case.materials_of(body).into_iter().map(ratio).reduce(f64::max) else { continue };
        // A ratio given as 0.45 and recomputed from Λ and μ differs in its last digits.
        if poisson > LOCKING + 1e-9 {
            let poisson = (poisson * 1e4).round() / 1e4;
            let what = format!("{:?}{} with Poisson's ratio {poisson}", body.element, plane(body.element));
            found.push(Found::of_body(&body.name, what).with_advice(unlocked(body.element)));
        }
    }
    found
}

/// Bodies in one dimension whose modulus is not Young's. A manufactured solution is one of the law
/// as it is.
pub(super) fn bar_modulus(case: &Case, _: &Model) -> Vec<Found> {
    let mut found = Vec::new();
    for body in case.bodies.iter().filter(|_| case.dimension == 1 && case.manufactured.is_none()) {
        let moduli = |of: &MaterialSpec| {
            let young = of.mu * (3.0 * of.lambda + 2.0 * of.mu) / (of.lambda + of.mu);
            [of.lambda + 2.0 * of.mu, young]
        };
        // Λ computed from a ratio of zero is zero.
        let differ = |[confined, young]: &[f64; 2]| (confined - young).abs() > 1e-9 * young.abs();
        if let Some([confined, young]) = case.materials_of(body).into_iter().map(moduli).find(differ) {
            let [confined, young, ratio] = [confined, young, confined / young].map(short);
            let what = format!("its modulus is Λ + 2μ = {confined}, {ratio} times Young's modulus {young}");
            found.push(Found::of_body(&body.name, what));
        }
    }
    found
}

/// Advice in place of an element that locks.
fn unlocked(element: Element) -> String {
    let quadratic =
        element.with_degree(2).map_or_else(String::new, |other| format!("element = \"{other:?}\""));
    let averages = matches!(element, Element::Q4 | Element::Hex8);
    if averages { format!("{quadratic}, or volumetric = \"mean\"") } else { quadratic }
}

fn plane(element: Element) -> &'static str {
    if element.dimension() == 2 { " in plane strain" } else { "" }
}

pub(super) fn stiff_bending(_: &Case, model: &Model) -> Vec<Found> {
    let thin = model.parts.iter().filter(|part| part.body.mesh().element == Element::T3);
    thin.filter_map(|part| Some(Found::of_body(&part.name, too_stiff(part)?))).collect()
}

fn too_stiff(part: &BodyInstance) -> Option<String> {
    let mesh = part.body.mesh();
    let area = mesh.area();
    let skin = part.skin();
    let length = |facet: &Facet| {
        let [a, b] = [0, 1].map(|k| &mesh.nodes[facet.nodes[k]]);
        (b[0] - a[0]).hypot(b[1] - a[1])
    };
    let half = 0.5 * skin.iter().map(length).sum::<f64>();
    // A disc has no such roots.
    let root = (0.25 * half * half - area).sqrt();
    let length = 0.5 * half + root;
    let thickness = 0.5 * half - root;
    if root.is_nan() || length < SLENDER * thickness {
        return None;
    }
    // Two triangles make a cell of the length of a facet.
    let facet = 2.0 * half / skin.len() as f64;
    let across = 0.5 * mesh.cell_count() as f64 * facet / length;
    let excess = 3.0 / (across * across);
    (excess > TOO_STIFF).then(|| {
        format!(
            "T3 in a body {} times as long as thick with about {} cells across its thickness, too stiff in bending by about {} %",
            short(length / thickness),
            across.round().max(1.0),
            short(100.0 * excess)
        )
    })
}
