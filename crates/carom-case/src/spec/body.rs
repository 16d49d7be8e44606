//! Bodies: material, mesh, placement, initial state.

use std::collections::BTreeMap;

use carom_solid::Element;
use serde::{Deserialize, Serialize};

use super::formula::FormulaSpec;
use super::mesh::{self, MeshSpec};
use crate::keys::Kind::{self, Formulas, FormulasOr, Name, NamesByGroup, Number, Points, Variant, Vector};
use crate::keys::{IN_SPACE, IN_TIME, Keys, NOT_NEGATIVE, POSITIVE, Range, View};
use crate::place::{self, PlaceKeys, PlaceSpec};

/// A material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MaterialSpec {
    /// Name by which bodies refer to it.
    pub name: String,
    /// Constitutive law.
    pub law: Law,
    /// Mass per reference volume, ≥ 0.
    pub density: f64,
    /// First Lamé constant Λ.
    pub lambda: f64,
    /// Second Lamé constant μ.
    pub mu: f64,
    /// Constants of the laws of the isochoric invariants; zero of others.
    #[serde(default, skip_serializing_if = "InvariantsSpec::is_none")]
    pub invariants: InvariantsSpec,
    /// Plastic flow; none of an elastic material.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plastic: Option<PlasticSpec>,
}

/// Constants Cᵢⱼ of (Ī₁ − 3)ⁱ (Ī₂ − 3)ʲ in the strain energy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct InvariantsSpec {
    pub c10: f64,
    pub c01: f64,
    pub c20: f64,
    pub c30: f64,
}

impl InvariantsSpec {
    fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// Yield stress over the equivalent plastic strain α.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlasticSpec {
    /// yield + hardening α + rise (1 − exp(−rate α)); linear without a rise.
    Formula {
        /// Yield stress at α = 0.
        yield_stress: f64,
        /// Hardening modulus.
        hardening: f64,
        /// Rise of the yield stress that saturates.
        rise: f64,
        /// Rate of its saturation.
        rate: f64,
    },
    /// Points [α, yield stress], straight between them and constant beyond the last.
    Table(Vec<[f64; 2]>),
}

/// A material, given by lambda and mu or by young and poisson; rubber of the laws `mooney-rivlin`
/// and `yeoh` by the constants of its energy and a bulk modulus.
#[derive(Keys)]
#[keys(name = "[[material]]", later = ["viscosity", "damping"])]
pub(crate) struct MaterialKeys {
    /// Name by which bodies refer to it.
    #[key(Name, example = "\"rubber\"")]
    name: String,
    /// Constitutive law.
    #[key(example = "\"neo-hookean\"")]
    law: Law,
    /// Mass per reference volume; 0 for a massless body.
    #[key(Number(NOT_NEGATIVE), unit = "mass/length³", example = "0.25")]
    density: f64,
    /// First Lamé constant Λ; 3Λ + 2μ > 0.
    #[key(unit = "mass/(length·time²)", example = "200.0")]
    lambda: Option<f64>,
    /// Second Lamé constant (shear modulus) μ.
    #[key(Number(POSITIVE), unit = "mass/(length·time²)", example = "15.0")]
    mu: Option<f64>,
    /// Young's modulus, with poisson instead of lambda and mu.
    #[key(Number(POSITIVE), unit = "mass/(length·time²)", example = "43.95")]
    young: Option<f64>,
    /// Poisson's ratio; given together with young. At 0.5 the material would be incompressible and
    /// its bulk modulus infinite.
    #[key(Number(Range { low: Some((-1.0, false)), high: Some((0.5, false)) }), example = "0.49")]
    poisson: Option<f64>,
    /// Constant C₁₀ of the laws `mooney-rivlin` and `yeoh`.
    #[key(Number(POSITIVE), unit = "mass/(length·time²)", example = "0.4")]
    c10: Option<f64>,
    /// Constant C₀₁ of the law `mooney-rivlin`; 2 (C₁₀ + C₀₁) is the shear modulus.
    #[key(Number(NOT_NEGATIVE), unit = "mass/(length·time²)", example = "0.1")]
    c01: Option<f64>,
    /// Constant C₂₀ of the law `yeoh`; often negative.
    #[key(unit = "mass/(length·time²)", example = "-0.02")]
    c20: Option<f64>,
    /// Constant C₃₀ of the law `yeoh`: it stiffens at large stretches.
    #[key(Number(NOT_NEGATIVE), unit = "mass/(length·time²)", example = "0.004")]
    c30: Option<f64>,
    /// Bulk modulus K of the laws `mooney-rivlin` and `yeoh`.
    #[key(Number(POSITIVE), unit = "mass/(length·time²)", example = "50.0")]
    bulk: Option<f64>,
    /// Plastic flow by von Mises's yield condition with isotropic hardening; with the law `hencky`.
    /// Default: none.
    #[key(example = "{ yield = 355.0, hardening = 1000.0 }")]
    plastic: Option<PlasticKeys>,
}

/// Yield stress over the equivalent plastic strain α: yield + hardening α, with a rise by Voce; or
/// a table.
#[derive(Keys)]
#[keys(name = "plastic")]
struct PlasticKeys {
    /// Yield stress at α = 0.
    #[key(name = "yield", Number(POSITIVE), unit = "mass/(length·time²)", example = "355.0")]
    yield_stress: Option<f64>,
    /// Hardening modulus dσ_y/dα; 0.0 is perfect plasticity. Default: 0.
    #[key(unit = "mass/(length·time²)", example = "1000.0")]
    hardening: Option<f64>,
    /// Rise of the yield stress that saturates (Voce), added to the above.
    #[key(example = "{ rise = 265.0, rate = 16.93 }")]
    voce: Option<VoceKeys>,
    /// Points [α, yield stress] in place of the other keys, from α = 0 on: straight between them,
    /// constant beyond the last. Of a measured curve of true stress over true strain, α is the
    /// strain less the stress over Young's modulus.
    #[key(Points(1), optional = "[[0.0, 355.0], [0.1, 420.0]]")]
    table: Vec<[f64; 2]>,
}

/// Rise of the yield stress that saturates: rise (1 − exp(−rate α)).
#[derive(Keys)]
#[keys(name = "voce")]
struct VoceKeys {
    /// Rise of the yield stress at large plastic strain.
    #[key(Number(NOT_NEGATIVE), unit = "mass/(length·time²)", example = "265.0")]
    rise: f64,
    /// Rate of saturation: at α = 1/rate, 63 % of the rise.
    #[key(Number(POSITIVE), example = "16.93")]
    rate: f64,
}

impl PlasticKeys {
    fn resolved(self, v: &View) -> Option<PlasticSpec> {
        let Self { yield_stress, hardening, voce, table } = self;
        if v.has("table") {
            return match ["yield", "hardening", "voce"].into_iter().find(|key| v.has(key)) {
                Some(key) => v.wrong_key(
                    key,
                    format!("`table` and `{key}` are given"),
                    "a table contains the whole yield stress",
                    format!("leave out `{key}`, or `table`"),
                ),
                None => checked_table(v, table),
            };
        }
        if !v.has("yield") {
            return v.wrong(
                "",
                "`plastic` has no yield stress",
                "a material flows where its von Mises stress reaches that",
                "add `yield`, or a `table` of yield stresses",
            );
        }
        let yield_stress = yield_stress?;
        let hardening = if v.has("hardening") { hardening? } else { 0.0 };
        let VoceKeys { rise, rate } = if v.has("voce") { voce? } else { VoceKeys::NONE };
        if hardening < 0.0 && yield_stress > 0.0 {
            let gone = (yield_stress + rise) / -hardening;
            let what = format!("with hardening = {hardening} the yield stress softens to zero");
            let why = format!(
                "it is gone at a plastic strain of about {gone:.3}; before that, strain gathers in one row of \
                 cells, so that results depend on the mesh"
            );
            return v.wrong("hardening", what, why, "hardening ≥ 0.0; 0.0 is perfect plasticity");
        }
        Some(PlasticSpec::Formula { yield_stress, hardening, rise, rate })
    }
}

impl VoceKeys {
    /// No rise.
    const NONE: Self = Self { rise: 0.0, rate: 1.0 };
}

/// A table of yield stresses, from α = 0 on, that does not fall.
fn checked_table(v: &View, table: Vec<[f64; 2]>) -> Option<PlasticSpec> {
    let [alpha, stress] = *table.first()?;
    if alpha != 0.0 {
        let what = format!("the table of yield stresses begins at a plastic strain of {alpha}");
        let why = "below its first point the yield stress would be unknown";
        return v.wrong("table[0]", what, why, "begin with the yield stress at 0.0");
    }
    if stress <= 0.0 {
        let why = "without strength the material would be a liquid";
        return v.wrong("table[0]", "the first yield stress is not positive", why, "give a yield stress > 0");
    }
    for (k, pair) in table.windows(2).enumerate() {
        let place = format!("table[{}]", k + 1);
        let [[before, strong], [alpha, stress]] = [pair[0], pair[1]];
        if alpha <= before {
            let what = format!("the plastic strain {alpha} of the table follows {before}");
            let why = "plastic strains of a table increase from point to point";
            return v.wrong(&place, what, why, "order the points by plastic strain, each once");
        }
        if stress < strong {
            let what =
                format!("the yield stress falls from {strong} to {stress} at a plastic strain of {alpha}");
            let why = "where a material softens, strain gathers in one row of cells, so that results depend on \
                       the mesh";
            return v.wrong(&place, what, why, "let the yield stress stay constant there");
        }
    }
    Some(PlasticSpec::Table(table))
}

/// The materials of a case.
pub(crate) fn materials(v: &View) -> Option<Vec<Option<MaterialSpec>>> {
    v.each("material", |v| MaterialKeys::read(v)?.resolved(v))
}

impl MaterialKeys {
    fn resolved(self, v: &View) -> Option<MaterialSpec> {
        if v.has("plastic") && self.law != Law::Hencky {
            let what = format!("the law \"{}\" does not yield", self.law.word());
            let why = "plastic flow is computed in logarithmic strains, those of the law \"hencky\"";
            return v.wrong_key("plastic", what, why, "write `law = \"hencky\"`, or leave `plastic` out");
        }
        let wanted: &[&str] = match self.law {
            Law::MooneyRivlin => &["c10", "c01", "bulk"],
            Law::Yeoh => &["c10", "c20", "c30", "bulk"],
            _ => return self.of_two_constants(v),
        };
        let is_wrong = |key: &&str| v.has(key) && !wanted.contains(key);
        let constants = ["lambda", "mu", "young", "poisson", "c10", "c01", "c20", "c30", "bulk"];
        let law = self.law.word();
        if let Some(key) = constants.into_iter().find(is_wrong) {
            let what = format!("the law \"{law}\" has no constant `{key}`");
            let why = format!("its constants are {}", wanted.join(", "));
            return v.wrong_key(key, what, why, format!("leave out `{key}`, or choose another law"));
        }
        if let Some(key) = wanted.iter().find(|key| !v.has(key)) {
            let what = format!("the law \"{law}\" lacks its constant `{key}`");
            let why = format!("its constants are {}", wanted.join(", "));
            return v.wrong("", what, why, format!("give `{key}`; 0.0 where the energy has no such term"));
        }
        self.of_invariants(v)
    }

    /// A material of the isochoric invariants.
    fn of_invariants(self, v: &View) -> Option<MaterialSpec> {
        let Self { name, law, density, c10, c01, c20, c30, bulk, .. } = self;
        let given = |key: &str, value: Option<f64>| if v.has(key) { value } else { Some(0.0) };
        let invariants = InvariantsSpec {
            c10: c10?,
            c01: given("c01", c01)?,
            c20: given("c20", c20)?,
            c30: given("c30", c30)?,
        };
        let InvariantsSpec { c10, c01, c20, c30 } = invariants;
        // dΨ/dĪ₁ = c10 + 2 c20 x + 3 c30 x² is smallest at x = −c20/(3 c30).
        if c20 < 0.0 && c20 * c20 >= 3.0 * c10 * c30 {
            let what = format!("rubber with c10 = {c10}, c20 = {c20}, c30 = {c30} loses its strength");
            let why = "the derivative c10 + 2 c20 x + 3 c30 x² of its energy vanishes at an x = Ī₁ − 3 > 0, from \
                       which on it is stretched by no force";
            let help = format!("c30 > c20²/(3 c10) = {}", c20 * c20 / (3.0 * c10));
            return v.wrong("c20", what, why, help);
        }
        let mu = 2.0 * (c10 + c01);
        let lambda = bulk? - 2.0 * mu / 3.0;
        Some(MaterialSpec { name, law, density, lambda, mu, invariants, plastic: None })
    }

    /// A material of two elastic constants.
    fn of_two_constants(self, v: &View) -> Option<MaterialSpec> {
        if let Some(key) = ["c10", "c01", "c20", "c30", "bulk"].into_iter().find(|key| v.has(key)) {
            let what = format!("the law \"{}\" has no constant `{key}`", self.law.word());
            let why = "it is one of the laws \"mooney-rivlin\" and \"yeoh\"";
            return v.wrong_key(key, what, why, format!("leave out `{key}`, or choose such a law"));
        }
        let given: Vec<_> = ["lambda", "mu", "young", "poisson"].into_iter().filter(|k| v.has(k)).collect();
        let Self { name, law, density, lambda, mu, young, poisson, plastic, .. } = self;
        let invariants = InvariantsSpec::default();
        let plastic = if v.has("plastic") { Some(plastic?.resolved(&v.at("plastic")?)?) } else { None };
        match given.as_slice() {
            ["lambda", "mu"] => {
                let lambda = lambda?;
                let mu = mu?;
                // Of Young's modulus and Poisson's ratio, the ranges of the keys say the same.
                if mu > 0.0 && 3.0 * lambda + 2.0 * mu <= 0.0 {
                    let what =
                        format!("the elastic constants Λ = {lambda}, μ = {mu} are not positive definite");
                    let why = format!("the bulk modulus Λ + 2μ/3 = {} must be > 0", lambda + 2.0 * mu / 3.0);
                    v.wrong::<()>("lambda", what, why, format!("lambda must be > {}", -2.0 * mu / 3.0));
                }
                Some(MaterialSpec { name, law, density, lambda, mu, invariants, plastic })
            }
            ["young", "poisson"] => {
                let young = young?;
                let poisson = poisson?;
                let lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
                let mu = young / (2.0 * (1.0 + poisson));
                Some(MaterialSpec { name, law, density, lambda, mu, invariants, plastic })
            }
            given => {
                let had = if given.is_empty() { "none".to_owned() } else { given.join(", ") };
                let missing = match given {
                    ["young"] => Some("poisson"),
                    ["poisson"] => Some("young"),
                    ["lambda"] => Some("mu"),
                    ["mu"] => Some("lambda"),
                    _ => None,
                };
                let what = missing.map_or_else(
                    || format!("the elastic constants are not a valid pair: {had}"),
                    |missing| format!("`{missing}` is missing beside `{had}`"),
                );
                let help = elastic_help(mu, poisson, given);
                // One from an option is too much, whatever the file says.
                let is_set = |key: &&&str| v.table.get(key).is_some_and(|node| node.origin.source > 0);
                let key = given.iter().find(is_set).copied().unwrap_or("");
                v.wrong_key(key, what, "an isotropic material has two elastic constants", help)
            }
        }
    }
}

/// The pair of elastic constants that was probably meant.
fn elastic_help(mu: Option<f64>, poisson: Option<f64>, given: &[&str]) -> String {
    let pairs = "give `lambda` and `mu`, or `young` and `poisson`";
    let [mu, poisson] = [mu, poisson].map(|x| x.filter(|x| x.is_finite()));
    let (Some(mu), Some(poisson), ["lambda", "mu", "poisson"]) = (mu, poisson, given) else {
        return pairs.to_owned();
    };
    // Where there is no such material, the nearest that there is.
    let poisson = poisson.clamp(-0.99, 0.49);
    let lambda = (2.0 * mu * poisson / (1.0 - 2.0 * poisson) * 1e6).round() / 1e6;
    format!("{pairs}; with this `mu`, Poisson's ratio is {poisson} for `lambda = {lambda}`")
}

impl MaterialSpec {
    /// Speed of pressure waves, √((Λ + 2μ)/ρ), with Λ replaced by 2Λμ/(Λ + 2μ) in plane stress;
    /// infinite without density.
    pub fn wave_speed(&self, plane: Plane) -> f64 {
        let Self { lambda, mu, density, .. } = *self;
        let lambda = match plane {
            Plane::Strain => lambda,
            Plane::Stress => 2.0 * lambda * mu / (lambda + 2.0 * mu),
        };
        ((lambda + 2.0 * mu) / density).sqrt()
    }
}

/// Plane state of a two-dimensional body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
#[keys(later = ["axisymmetric"])]
pub enum Plane {
    /// Plane strain: no strain out of the plane.
    #[default]
    Strain,
    /// Plane stress: no stress out of the plane; `thickness` is that of the undeformed sheet.
    Stress,
}

/// Constitutive law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
#[keys(later = ["viscoelastic"])]
pub enum Law {
    /// Ψ = μ(tr E − ln J) + Λ/2 (ln J)².
    NeoHookean,
    /// Ψ = Λ/2 (tr E)² + μ E : E.
    SaintVenantKirchhoff,
    /// Small strain, Ψ = Λ/2 (tr ε)² + μ ε : ε.
    LinearElastic,
    /// Logarithmic strain ε = ½ ln F Fᵀ, Ψ = Λ/2 (tr ε)² + μ ε : ε; the law of metals, which may
    /// yield (`plastic`).
    Hencky,
    /// Rubber: Ψ = c10 (Ī₁ − 3) + c01 (Ī₂ − 3) + bulk/2 (ln J)² with the isochoric invariants of
    /// FᵀF.
    MooneyRivlin,
    /// Rubber that stiffens: Ψ = c10 x + c20 x² + c30 x³ + bulk/2 (ln J)², x = Ī₁ − 3.
    Yeoh,
}

/// A deformable body; its sides are written name.side.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Keys)]
#[keys(name = "[[body]]")]
pub struct BodySpec {
    /// Name; its sides are written name.side.
    #[key(Name, example = "\"cylinder\"")]
    pub name: String,
    /// Name of its material; of a body of several materials give `materials`.
    #[key(Name, unless = "materials", example = "\"rubber\"", with = single_material)]
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub material: String,
    /// Several materials in one mesh from a file, whose cells share nodes: the name of the material
    /// of each physical group of cells. Every cell of the body belongs to exactly one of these
    /// groups; without `surface` or `volume` in `mesh`, the body consists of them.
    #[key(NamesByGroup, optional = "{ steel = \"plate\", rubber = \"pad\" }")]
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub materials: BTreeMap<String, String>,
    /// Cell type: lines (L) in dimension 1, triangles (T) or quadrilaterals (Q) in dimension 2,
    /// tetrahedra (Tet) or hexahedra (Hex) in dimension 3. Of the built-in shapes, Q4 and Q9 fill
    /// rectangles; Hex8 and Hex27 fill those of space, and extrusions of rectangles.
    #[key(example = "\"T6\"")]
    pub element: Element,
    /// Change of volume on which the volumetric energy depends.
    #[key(default = "\"pointwise\"")]
    #[serde(default, skip_serializing_if = "Volumetric::is_pointwise")]
    pub volumetric: Volumetric,
    /// Mesh: a built-in shape with its mesh size, or a body of a Gmsh file.
    #[key(
        Variant(MeshSpec::variants),
        example = "{ shape = \"rectangle\", min = [0.0, 0.0], max = [1.0, 1.0], cells = [8, 8] }",
        with = mesh::of_body
    )]
    pub mesh: MeshSpec,
    /// Rotation and translation of the mesh, applied before anything else.
    #[key(
        crate::keys::Kind::Table(&PlaceKeys::TABLE),
        example = "{ rotate = 30.0, about = [0.0, 0.0], shift = [0.0, 1.0] }",
        with = place::read
    )]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<PlaceSpec>,
    /// Positions at t = 0 as formulas in X, Y, Z, for a body that starts deformed. Default: X, Y,
    /// Z.
    #[key(Formulas(IN_SPACE), unit = "length", example = "[\"X + 0.1*X*Y\", \"Y\"]")]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<Vec<FormulaSpec>>,
    /// Gravitational acceleration: numbers, or formulas in t. Default: zero.
    #[key(Formulas(IN_TIME), unit = "length/time²", optional = "[0.0, -9.81]")]
    pub gravity: Vec<FormulaSpec>,
    /// Initial velocity: numbers or formulas in X, Y, Z, or the table of a rigid-body motion from
    /// where the body is at t = 0. Default: zero.
    #[key(
        FormulasOr(IN_SPACE, &Velocity::TABLE),
        unit = "length/time",
        optional = "[0.0, -1.0]",
        with = velocity
    )]
    pub velocity: Vec<FormulaSpec>,
    /// Mass matrix.
    #[key(default = "\"consistent\"")]
    pub mass: MassKind,
}

/// The material of a whole body; empty if its groups have materials.
fn single_material(v: &View) -> Option<String> {
    if v.has("materials") { Some(String::new()) } else { v.get("material") }
}

impl BodySpec {
    /// Names of its materials, each once.
    pub fn material_names(&self) -> Vec<&str> {
        let mut names = Vec::new();
        for name in self.materials.values() {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        if names.is_empty() { vec![&self.material] } else { names }
    }

    /// Index in [`Self::material_names`] of the material of each region of its mesh, in the order
    /// of regions.
    pub fn materials_of_regions(&self) -> Vec<usize> {
        let names = self.material_names();
        let index = |name: &String| names.iter().position(|known| known == name).unwrap_or(0);
        self.materials.values().map(index).collect()
    }

    /// Whether one of its materials yields.
    pub(crate) fn yields(&self, materials: &[&MaterialSpec]) -> bool {
        let names = self.material_names();
        let is_own = |material: &&&MaterialSpec| names.contains(&material.name.as_str());
        materials.iter().filter(is_own).any(|material| material.plastic.is_some())
    }

    /// Whether it has an initial velocity.
    pub(crate) fn starts_moving(&self) -> bool {
        !self.velocity.iter().all(FormulaSpec::is_zero)
    }
}

/// Initial velocity of a rigid-body motion: linear + angular × (x − about), with x the place of a
/// point at t = 0.
#[derive(Keys)]
#[keys(name = "velocity")]
struct Velocity {
    /// Velocity of the point `about`. Default: zero.
    #[key(Vector, unit = "length/time", optional = "[0.0, -1.0]", with = linear)]
    linear: Vec<f64>,
    /// Angular velocity: counter-clockwise in dimension 2, [ωx, ωy, ωz] in dimension 3. Default:
    /// zero.
    #[key(Kind::Angular, unit = "1/time", optional = "2.0", with = angular)]
    angular: Vec<f64>,
    /// Centre of the rotation; required with `angular`.
    #[key(Vector, unit = "length", example = "[0.0, 1.0]")]
    about: Option<Vec<f64>>,
}

fn linear(v: &View) -> Option<Vec<f64>> {
    v.vector("linear")
}

/// The angular velocity in space.
fn angular(v: &View) -> Option<Vec<f64>> {
    match v.get::<Option<f64>>("angular").flatten() {
        Some(about_z) => Some(vec![0.0, 0.0, about_z]),
        None if v.has("angular") => v.get("angular"),
        None => Some(vec![0.0; 3]),
    }
}

/// Reads a body's initial velocity; a rigid-body motion is converted to formulas.
fn velocity(v: &View) -> Option<Vec<FormulaSpec>> {
    let dimension = v.dimension?;
    if v.table.get("velocity").is_some_and(|node| node.table().is_none()) {
        return v.get("velocity");
    }
    let position: Option<Vec<FormulaSpec>> = if v.has("position") { v.get("position")? } else { None };
    let v = v.at("velocity")?;
    let Velocity { linear, angular, about } = Velocity::read(&v)?;
    if linear.len() != dimension || angular.len() != 3 {
        return None;
    }
    if angular.iter().all(|component| *component == 0.0) {
        return Some(linear.into_iter().map(FormulaSpec::Number).collect());
    }
    if dimension == 1 {
        let why = "the case has dimension = 1";
        return v.wrong("angular", "a bar cannot rotate", why, "leave `angular` out");
    }
    if !v.has("about") {
        let help = if dimension == 2 { "add `about = [x, y]`" } else { "add `about = [x, y, z]`" };
        return v.wrong("angular", "the rotation has no centre", "a body rotates about a point", help);
    }
    let about = about.filter(|about| about.len() == dimension)?;
    let place = places(&v, position, dimension)?;
    // Component i of linear + ω × (x − about), without the terms that vanish.
    let component = |i: usize| {
        let [j, k] = [(i + 1) % 3, (i + 2) % 3];
        let term = |sign: &str, omega: f64, axis: usize| {
            let exists = axis < dimension && omega != 0.0;
            let arm = || format!(" {sign} {omega:?}*({} - {:?})", place[axis], about[axis]);
            exists.then(arm).unwrap_or_default()
        };
        format!("{:?}{}{}", linear[i], term("+", angular[j], k), term("-", angular[k], j))
    };
    Some((0..dimension).map(|i| FormulaSpec::Text(component(i))).collect())
}

/// Formulas of the place at t = 0 of a point that rotates: those of the body's `position`, or its
/// coordinates in the mesh.
fn places(v: &View, position: Option<Vec<FormulaSpec>>, dimension: usize) -> Option<Vec<String>> {
    let Some(position) = position else {
        return Some(["X", "Y", "Z"][..dimension].iter().map(ToString::to_string).collect());
    };
    if position.iter().any(|place| place.function().is_some()) {
        let why = "the velocity of a rotating point is written as a formula of its place";
        let help = "give `position` as formulas, or `velocity` as functions";
        return v.wrong("angular", "`position` is a function of the program", why, help);
    }
    (position.len() == dimension).then(|| position.iter().map(|place| format!("({place})")).collect())
}

/// Change of volume on which the volumetric energy of a cell depends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum Volumetric {
    /// That at each quadrature point.
    #[default]
    Pointwise,
    /// The mean over the cell (mean dilatation), with which Q4 and Hex8 do not lock in nearly
    /// incompressible materials.
    Mean,
}

impl Volumetric {
    #[allow(clippy::trivially_copy_pass_by_ref)] // as serde calls it
    fn is_pointwise(&self) -> bool {
        *self == Self::Pointwise
    }
}

/// Distribution of the inertia over the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum MassKind {
    /// ∫ρ₀ NᵀN.
    Consistent,
    /// Diagonal, by HRZ scaling.
    Lumped,
    /// No mass on contact nodes, and the smallest change at the other nodes that preserves the
    /// total mass, the centre of mass and the second moments.
    Redistributed,
}

impl MassKind {
    /// Whether contact nodes have no mass.
    pub fn is_redistributed(self) -> bool {
        self == Self::Redistributed
    }
}
