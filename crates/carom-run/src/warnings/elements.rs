//! Warnings about elements of degree 1: they lock at nearly constant volume, and in bending.
//!
//! A beam of n square cells of two T3 across its thickness is too stiff in bending by 3/n², as
//! measured on a cantilever with L/h = 20 and ν = 0 (n = 2, 4, 8, 16: 75 %, 19 %, 4.7 %, 1.2 %). Of
//! n cells Q4 with length a and height b it is too stiff by
//!
//! ```text
//! [(1/(1 − ν) + (a/b)²/2)/(1 + ν) − 1] / n²        in plane stress; in plane strain with ν/(1 − ν)
//! ```
//!
//! (with a mean dilatation 1 in place of 1/(1 − ν)), because sides that stay straight shear, G
//! (κx)²/2, where the cell is bent by κ, and leave no curvature across. Boxes of Hex8 are as stiff,
//! and those of Tet4 stiffer. Length L and thickness h of a body in the plane are the roots of x² −
//! (P/2) x + A = 0, with its area A and its perimeter P, and numbers of cells along them the same
//! with the counts of cells and of facets: exact for a rectangle, to first order for a strip or
//! ring that is bent.

use carom_case::{BodySpec, Case, MaterialSpec, MeshSpec, Plane, Volumetric};
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
        let materials = case.materials_of(body);
        if let Some([confined, young]) = materials.iter().copied().map(moduli).find(differ) {
            let [confined, young, ratio] = [confined, young, confined / young].map(short);
            let what = format!("its modulus is Λ + 2μ = {confined}, {ratio} times Young's modulus {young}");
            found.push(Found::of_body(&body.name, what));
        } else if materials.iter().any(|material| material.plastic.is_some()) {
            let what = "where it yields its sides are held: plastic flow would narrow it";
            found.push(Found::of_body(&body.name, what.into()));
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

pub(super) fn stiff_bending(case: &Case, model: &Model) -> Vec<Found> {
    let too_stiff = |(part, spec): (&BodyInstance, &BodySpec)| {
        let element = spec.element;
        let what = match element {
            Element::T3 => triangles_across(part),
            Element::Q4 => Across::of_rectangle(part).and_then(|across| across.too_stiff(case, spec)),
            Element::Hex8 | Element::Tet4 => {
                Across::of_box(spec).and_then(|across| across.too_stiff(case, spec))
            }
            _ => None,
        }?;
        let quadratic = element.with_degree(2)?;
        let advice = format!("element = \"{quadratic:?}\", or more cells across the thickness");
        Some(Found::of_body(&part.name, what).with_advice(advice))
    };
    model.parts.iter().zip(&case.bodies).filter_map(too_stiff).collect()
}

/// Length and thickness of a body, and the numbers of cells along them.
struct Across {
    sizes: [f64; 2],
    cells: [f64; 2],
}

/// The roots of x² − `half` x + `product` = 0, the larger one first; of a disc, which has none,
/// equal ones.
fn roots(half: f64, product: f64) -> [f64; 2] {
    let root = (0.25 * half * half - product).max(0.0).sqrt();
    [0.5 * half + root, 0.5 * half - root]
}

impl Across {
    fn of_rectangle(part: &BodyInstance) -> Option<Self> {
        let mesh = part.body.mesh();
        let skin = part.skin();
        let sizes = roots(0.5 * perimeter(part), mesh.area());
        let cells = roots(0.5 * skin.len() as f64, mesh.cell_count() as f64);
        (sizes[1] > 0.0 && cells[1] > 0.0).then_some(Self { sizes, cells })
    }

    fn of_box(spec: &BodySpec) -> Option<Self> {
        let MeshSpec::Box { min, max, cells, .. } = &spec.mesh else { return None };
        let along = |i: usize| (max[i] - min[i], cells[i] as f64);
        let mut all = [0, 1, 2].map(along);
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        Some(Self { sizes: [all[0].0, all[2].0], cells: [all[0].1, all[2].1] })
    }

    fn too_stiff(&self, case: &Case, spec: &BodySpec) -> Option<String> {
        let ratio = |of: &MaterialSpec| of.lambda / (2.0 * (of.lambda + of.mu));
        let poisson = case.materials_of(spec).into_iter().map(ratio).reduce(f64::max)?;
        let is_strain = spec.element.dimension() == 2 && case.plane == Plane::Strain;
        let poisson = if is_strain { poisson / (1.0 - poisson) } else { poisson };
        // The change of volume in bending has no mean in a cell: a mean dilatation lets it go.
        let averages = spec.volumetric == Volumetric::Mean;
        let [length, thickness] = self.sizes;
        let [along, across] = self.cells;
        let aspect = (length / along) / (thickness / across);
        let sheared = 0.5 * aspect * aspect / (1.0 + poisson);
        let across_it = if averages { 1.0 } else { 1.0 / (1.0 - poisson) };
        let squeezed = across_it / (1.0 + poisson) - 1.0;
        let excess = (sheared + squeezed) / (across * across);
        let is_bent = length >= SLENDER * thickness && excess > TOO_STIFF;
        let by = if spec.element == Element::Tet4 { "more than" } else { "about" };
        is_bent.then(|| told(spec.element, length / thickness, across, by, excess))
    }
}

/// Perimeter of a body in the plane.
fn perimeter(part: &BodyInstance) -> f64 {
    let mesh = part.body.mesh();
    let length = |facet: &Facet| {
        let [a, b] = [0, 1].map(|k| &mesh.nodes[facet.nodes[k]]);
        (b[0] - a[0]).hypot(b[1] - a[1])
    };
    part.skin().iter().map(length).sum()
}

fn told(element: Element, slenderness: f64, across: f64, by: &str, excess: f64) -> String {
    format!(
        "{element:?} in a body {} times as long as thick with about {} cells across its thickness, too stiff in bending by {by} {} %",
        short(slenderness),
        across.round().max(1.0),
        short(100.0 * excess)
    )
}

fn triangles_across(part: &BodyInstance) -> Option<String> {
    let mesh = part.body.mesh();
    let half = 0.5 * perimeter(part);
    let [length, thickness] = roots(half, mesh.area());
    if length < SLENDER * thickness {
        return None;
    }
    // Two triangles make a cell of the length of a facet.
    let facet = 2.0 * half / part.skin().len() as f64;
    let across = 0.5 * mesh.cell_count() as f64 * facet / length;
    let excess = 3.0 / (across * across);
    (excess > TOO_STIFF).then(|| told(Element::T3, length / thickness, across, "about", excess))
}
