//! The impact with every kind of scheme, with its sides swapped, and at twice the size: each run
//! finishes, with the same rebound.

use crate::common::{COARSE, IMPACT, Place, text};
use serde_json::Value;

/// Last event of a run of the impact: extremes of the probes, expectations.
fn outcome(place: &Place, sets: &[&str]) -> Value {
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    let arguments: Vec<&str> =
        ["run", "case.toml", "--no-report", "--json"].into_iter().chain(sets).collect();
    let done = place.carom(&arguments);
    assert_eq!(done.status.code(), Some(0), "{arguments:?}: {}", text(&done.stderr));
    serde_json::from_str(text(&done.stdout).lines().last().unwrap()).unwrap()
}

/// Lowest position of the top of the cylinder, and the end of contact.
fn rebound(done: &Value) -> (f64, f64) {
    let end = done["expectations"].as_array().unwrap().iter().find(|e| e["what"] == "contact_end").unwrap();
    assert_eq!(done["extremes"][0]["column"], "A.uy");
    (done["extremes"][0]["min"].as_f64().unwrap(), end["got"].as_f64().unwrap())
}

fn near(got: f64, wanted: f64, tolerance: f64, what: &str) {
    assert!((got - wanted).abs() <= tolerance, "{what}: {got}, not {wanted} ± {tolerance}");
}

/// The tolerances cover the results of two independent codes on finer meshes; Hu's scheme has order
/// 1 and a larger error.
#[test]
fn the_impact_with_every_scheme() {
    let place = Place::new("schemes");
    place.file("case.toml", IMPACT);
    let coarse = [COARSE[1], COARSE[3], "output.fields_every=0"];
    for scheme in [
        "kind=\"hu\"",
        "kind=\"newmark\",rho_inf=0.6",
        "kind=\"newmark\",beta=0.25,gamma=0.5",
        "kind=\"hht\",alpha=0.05",
        "kind=\"wbz\",rho_inf=0.1",
        "kind=\"chung-hulbert\",rho_inf=0.0",
        "kind=\"chung-hulbert\",rho_inf=0.6",
        "kind=\"chung-hulbert\",rho_inf=0.6,forces=\"average-state\"",
        "kind=\"generalized-alpha\",alpha_m=0.5,alpha_f=0.5,beta=0.25,gamma=0.5",
    ] {
        let set = format!("time.scheme={{{scheme}}}");
        let (lowest, end) = rebound(&outcome(&place, &[&coarse[..], &[set.as_str()]].concat()));
        near(lowest, -0.7827, if scheme.contains("hu\"") { 0.012 } else { 0.004 }, scheme);
        near(end, 0.555, 0.003, scheme);
    }
    let swapped = [
        "contact.strike.secondary=prism.top",
        "contact.strike.primary=cylinder.arc",
        "time.scheme.rho_inf=0.1",
    ];
    let (lowest, end) = rebound(&outcome(&place, &[&coarse[..], &swapped].concat()));
    near(lowest, -0.7827, 0.004, "swapped");
    near(end, 0.555, 0.003, "swapped");
}

/// Radius 1 onto a prism of 2 × 1: more than half of the arc comes into contact.
#[test]
fn the_larger_impact_from_two_heights() {
    let place = Place::new("larger");
    place.file("case.toml", IMPACT);
    let prism = "body.prism.mesh={shape=\"rectangle\",min=[0.0,-1.0],max=[2.0,0.0],cells=[4,2]}";
    // Gap 0.5: benchmark values of an explicit code with a penalty. Gap 1.0: the two
    // schemes are compared with each other.
    for (gap, lowest, end) in [(0.5, -1.146, 0.830), (1.0, -1.746, 0.901)] {
        let cylinder = format!(
            "body.cylinder.mesh={{shape=\"half-disc\",radius=1.0,center=[0.0,{:?}],size=0.5}}",
            1.0 + gap
        );
        let top = format!("probe.A.at=[0.0,{:?}]", 2.0 + gap);
        for rho in ["0.1", "0.8"] {
            let scheme = format!("time.scheme.rho_inf={rho}");
            let sets = [prism, &cylinder, &top, &scheme, "time.end=1.125", "output.fields_every=0"];
            let got = rebound(&outcome(&place, &sets));
            near(got.0, lowest, 0.005, &scheme);
            near(got.1, end, 0.005, &scheme);
        }
    }
}
