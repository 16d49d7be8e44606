//! A table of a case → its numbers, with the checks that concern this table alone.

use super::load;
use super::mesh;
use super::mesh_file::Purpose;
use super::obstacle;
use super::place;
use super::read_scheme::scheme;
use super::view::{View, word};
use super::{
    BodySpec, ContactSpec, FrictionSpec, InitialSpec, MaterialSpec, NewtonSpec, ObstacleMotion, OutputSpec,
    PrimarySpec, ProbeSpec, SupportSpec, TimeSpec,
};

pub(super) fn material(v: &View) -> Option<MaterialSpec> {
    let (name, law, density) = (v.text("name"), v.choice("law"), v.number("density"));
    let given: Vec<_> = ["lambda", "mu", "young", "poisson"].into_iter().filter(|k| v.has(k)).collect();
    let (lambda, mu) = match given.as_slice() {
        ["lambda", "mu"] => (v.number("lambda")?, v.number("mu")?),
        ["young", "poisson"] => {
            let (young, poisson) = (v.number("young")?, v.number("poisson")?);
            (young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson)))
        }
        given => {
            if !v.has_unknown_key() || given.len() > 2 {
                let had = if given.is_empty() { "none".to_owned() } else { given.join(", ") };
                let what = format!("the elastic constants are not a valid pair: {had}");
                let help = elastic_help(v, given);
                // One from an option is too much, whatever the file says.
                let is_set = |key: &&&str| v.table.get(key).is_some_and(|node| node.origin.source > 0);
                let key = given.iter().find(is_set).copied().unwrap_or("");
                return v.report(
                    v.problem(key, what, "an isotropic material has two elastic constants", help).at_key(),
                );
            }
            return None;
        }
    };
    // Of Young's modulus and Poisson's ratio, the ranges of the keys say the same.
    if given[0] == "lambda" && mu > 0.0 && 3.0 * lambda + 2.0 * mu <= 0.0 {
        let what = format!("the elastic constants Λ = {lambda}, μ = {mu} are not positive definite");
        let why = format!("the bulk modulus Λ + 2μ/3 = {} must be > 0", lambda + 2.0 * mu / 3.0);
        let help = format!("lambda must be > {}", -2.0 * mu / 3.0);
        v.wrong::<()>("lambda", what, why, help);
    }
    Some(MaterialSpec { name: name?, law: law?, density: density?, lambda, mu })
}

pub(super) fn body(v: &View, dimension: usize, refine: f64) -> Option<BodySpec> {
    let purpose = Purpose { dimension, element: v.choice("element"), extruded: false };
    let mesh = mesh::read(&v.at("mesh")?, purpose)?;
    Some(BodySpec {
        name: v.text("name")?,
        material: v.text("material")?,
        element: v.choice("element")?,
        volumetric: v.choice("volumetric")?,
        mesh: mesh.refined(refine),
        place: if v.has("place") { Some(place::read(&v.at("place")?, dimension)?) } else { None },
        position: if v.has("position") { Some(v.formulas("position")?) } else { None },
        gravity: if v.has("gravity") { v.formulas("gravity")? } else { Vec::new() },
        velocity: load::velocity(v, dimension)?,
        mass: v.choice("mass")?,
    })
}

pub(super) fn support(v: &View) -> Option<SupportSpec> {
    let fix = if v.has("fix") { v.texts("fix")? } else { Vec::new() };
    let (normal, axes): (Vec<_>, Vec<_>) = fix.into_iter().partition(|direction| direction == "normal");
    let axes = axes.iter().map(|d| ["x", "y", "z"].iter().position(|x| x == d)).collect::<Option<_>>()?;
    Some(SupportSpec {
        name: v.text("name"),
        on: v.texts("on")?,
        fix: axes,
        normal: !normal.is_empty(),
        moment_about: if v.has("moment_about") { Some(v.numbers("moment_about")?) } else { None },
        moves: load::motion(v)?,
    })
}

pub(super) fn initial(v: &View) -> Option<InitialSpec> {
    Some(InitialSpec { from: v.file("from")?, velocities: v.choice("velocities")? })
}

pub(super) fn contact(v: &View, entry: usize, dimension: Option<usize>) -> Option<ContactSpec> {
    let between = v.has("between");
    let (secondary, primary, motion) = if between {
        (String::new(), PrimarySpec::Side(String::new()), ObstacleMotion::Fixed)
    } else {
        let (primary, motion) = obstacle::read(v, dimension)?;
        (v.text("secondary")?, primary, motion)
    };
    Some(ContactSpec {
        name: v.text("name")?,
        entry,
        between,
        secondary,
        primary,
        motion,
        enforcement: v.choice("enforcement")?,
        stiffness: v.number("stiffness")?,
        force: v.choice("force")?,
        persistency: v.choice("persistency")?,
        active_set: v.choice("active_set")?,
        detection: v.choice("detection")?,
        xi: v.choice("xi")?,
        law: v.choice("law"),
        overlap: v.choice("overlap")?,
        friction: friction(v),
        restitution: v.number("restitution")?,
    })
}

/// What depends on a misspelt key is not judged.
fn friction(v: &View) -> FrictionSpec {
    let mu = v.formula("mu");
    if v.has_unknown_key() {
        return FrictionSpec { mu, ..FrictionSpec::default() };
    }
    FrictionSpec {
        mu,
        mu_dynamic: v.number("mu_dynamic"),
        decay: v.number("decay"),
        shear: v.number("shear"),
        stick_stiffness: v.number("stick_stiffness"),
    }
}

/// The pair of elastic constants that was probably meant.
fn elastic_help(v: &View, given: &[&str]) -> String {
    let pairs = "give `lambda` and `mu`, or `young` and `poisson`";
    let ([mu, poisson], ["lambda", "mu", "poisson"]) =
        (["mu", "poisson"].map(|key| v.number(key).filter(|x| x.is_finite())), given)
    else {
        return pairs.to_owned();
    };
    let (Some(mu), Some(poisson)) = (mu, poisson) else { return pairs.to_owned() };
    // Where there is no such material, the nearest that there is.
    let poisson = poisson.clamp(-0.99, 0.49);
    let lambda = (2.0 * mu * poisson / (1.0 - 2.0 * poisson) * 1e6).round() / 1e6;
    format!("{pairs}; with this `mu`, Poisson's ratio is {poisson} for `lambda = {lambda}`")
}

pub(super) fn probe(v: &View) -> Option<ProbeSpec> {
    let record = v.texts("record")?.iter().map(|q| word(q)).collect::<Option<_>>()?;
    Some(ProbeSpec { name: v.text("name")?, at: v.numbers("at")?, body: v.text("body")?, record })
}

pub(super) fn time(v: &View) -> Option<TimeSpec> {
    let scheme = v.at("scheme").and_then(|v| scheme(&v));
    Some(TimeSpec {
        end: v.number("end")?,
        step: v.number("step")?,
        phase: v.number("phase")?,
        scheme: scheme?,
        energy_guard: v.value("energy_guard")?.number(),
        fallback: v.choice("fallback")?,
    })
}

pub(super) fn newton(v: &View) -> Option<NewtonSpec> {
    Some(NewtonSpec {
        tolerance: v.number("tolerance")?,
        max_iterations: v.count("max_iterations")?,
        linear: v.choice("linear")?,
        tangent: v.choice("tangent")?,
        mixing: v.count("mixing")?,
    })
}

pub(super) fn output(v: &View) -> Option<OutputSpec> {
    if v.text("format")? != "vtu" {
        return v.wrong(
            "format",
            "fields are written as VTU, the only format",
            "one file per output remains readable if the run is killed; a single file for viewers is made after it",
            "leave format out; after the run, carom.open(DIRECTORY).to_vtkhdf(FILE) in Python makes one VTKHDF file",
        );
    }
    let fields_every = match (v.has("fields_every"), v.has("at_times")) {
        (true, _) => Some(v.count("fields_every")?),
        (false, true) => Some(0),
        (false, false) => None,
    };
    Some(OutputSpec {
        fields_every,
        at_times: v.numbers("at_times")?,
        history_every: v.count("history_every")?,
        checkpoint_every: v.count("checkpoint_every")?,
    })
}
