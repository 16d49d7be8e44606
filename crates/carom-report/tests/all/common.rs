//! A synthetic run that looks like a half disc striking a block: smooth formulas instead of a
//! simulation, written by the real writer.

use std::f64::consts::PI;
use std::path::Path;

use carom_case::Case;
use carom_record::{
    Block, Cell, Column, ContactFacts, Event, Expectation, Facts, FieldSet, Held, Manifest, PointArray,
    RunWriter, Source, Status, Warning,
};
use serde_json::{Value, json};

const N: usize = 7;
const START: f64 = 0.32;
const END: f64 = 0.56;

/// The manifest of a run of a stored case.
pub(crate) fn manifest(case: Value, columns: Vec<Column>) -> Manifest {
    let facts = Case::from_json(case.clone()).unwrap().facts();
    Manifest::new("0.1.0", facts, case, Source::default(), columns, 1)
}

/// A case as it is stored, with these parts in place of a small one of dimension 2.
pub(crate) fn case(parts: &Value) -> Value {
    let body = json!({
        "name": "", "material": "rubber", "element": "T3", "gravity": [], "velocity": [], "mass": "consistent",
        "mesh": {"shape": "rectangle", "min": [0.0, 0.0], "max": [1.0, 1.0], "cells": [1, 1]},
    });
    let contact = json!({
        "name": "", "secondary": "", "primary": {"side": ""}, "enforcement": "multiplier", "stiffness": 1.0,
        "force": "end", "persistency": "project", "active_set": "within", "detection": "closest-point",
        "law": null, "restitution": 0.0,
    });
    let defaults = [
        ("bodies", body),
        ("supports", json!({"name": null, "on": [], "fix": []})),
        ("contacts", contact),
        ("loads", json!({"name": null, "table": null})),
        ("probes", json!({"record": ["uy"]})),
    ];
    let mut whole = json!({
        "title": "", "dimension": 2, "plane": "strain", "thickness": 1.0,
        "units": {"length": "m", "time": "s", "mass": "kg"}, "preset": "default", "materials": [], "bodies": [],
        "supports": [], "loads": [], "contacts": [], "newton": {"tolerance": 1e-9, "max_iterations": 20}, "probes": [],
        "output": {"fields_every": 1, "at_times": [], "history_every": 1, "checkpoint_every": 1}, "expects": [],
        "time": {
            "end": 1.0, "step": 0.1, "energy_guard": null,
            "scheme": {"kind": "chung-hulbert", "rho_inf": 0.1, "forces": "average-forces"},
        },
    });
    for (key, value) in parts.as_object().unwrap() {
        whole[key] = value.clone();
    }
    for (key, default) in defaults {
        for item in whole[key].as_array_mut().into_iter().flatten() {
            let mut complete = default.clone();
            for (key, value) in item.as_object().unwrap() {
                complete[key] = value.clone();
            }
            *item = complete;
        }
    }
    whole
}

/// T10 cells on a lattice of 3n × 3m intervals, two per square.
fn lattice(n: usize, m: usize, map: impl Fn(f64, f64) -> [f64; 2]) -> (Vec<[f64; 3]>, Vec<usize>) {
    let (w, h) = (3 * n, 3 * m);
    let node = |i: usize, j: usize| j * (w + 1) + i;
    let at = |k: usize| map((k % (w + 1)) as f64 / w as f64, (k / (w + 1)) as f64 / h as f64);
    let points = (0..(w + 1) * (h + 1)).map(|k| [at(k)[0], at(k)[1], 0.0]).collect();
    let local = [[0, 0], [3, 0], [0, 3], [1, 0], [2, 0], [2, 1], [1, 2], [0, 2], [0, 1], [1, 1]];
    let mut cells = Vec::new();
    for (i, j) in (0..n * m).map(|c| (3 * (c % n), 3 * (c / n))) {
        cells.extend(local.map(|[a, b]| node(i + a, j + b)));
        cells.extend(local.map(|[a, b]| node(i + 3 - a, j + 3 - b)));
    }
    (points, cells)
}

/// Progress of the contact: 0 outside it, 1 at its middle.
fn press(t: f64) -> f64 {
    if (START..END).contains(&t) { (PI * (t - START) / (END - START)).sin() } else { 0.0 }
}

/// Vertical position of the disc's centre relative to its start.
fn fall(t: f64) -> f64 {
    let (v, g) = (-9.81 * START, 9.81);
    match t {
        t if t < START => -0.5 * g * t * t,
        t if t < END => -0.5 * g * START * START + 0.24 * v * (END - START) * press(t) / PI * 2.4,
        t => -0.5 * g * START * START + 0.8 * -v * (t - END) - 0.5 * g * (t - END) * (t - END),
    }
}

fn fields(t: f64) -> FieldSet {
    // Elliptical mapping of a square to the half disc.
    let disc = |s: f64, r: f64| {
        let r = 2.0 * r - 1.0;
        [0.5 * s * (1.0 - 0.5 * r * r).sqrt(), 1.0 + 0.5 * r * (1.0 - 0.5 * s * s).sqrt()]
    };
    let (mut points, disc_cells) = lattice(N, 2 * N, disc);
    let disc_points = points.len();
    let (block_points, block_cells) = lattice(8, 4, |s, r| [s, -0.5 + 0.5 * r]);
    points.extend(block_points);
    let p = press(t);
    let (mut u, mut stress) = (Vec::new(), Vec::new());
    for (k, [x, y, _]) in points.iter().enumerate() {
        let (dx, dy, s) = if k < disc_points {
            let h = (y - 0.5) / 0.3;
            let bulge = 0.16 * p * x * (-h * h).exp() * 2.0;
            (
                bulge,
                fall(t) + 0.17 * p * (-h).exp() * (1.0 - x * x),
                -38.0 * p * (-(x * x) / 0.05 - h).exp() + 2.5 * p * (6.0 * y).sin(),
            )
        } else {
            let w = (-(x * x) / 0.08).exp();
            (
                0.12 * p * x * w * (y + 0.5) * 2.0,
                -0.2 * p * w * (1.0 + 2.0 * y) + 0.03 * p * (x - 0.4) * (1.0 + 2.0 * y),
                -33.0 * p * w * (1.0 + 0.6 * y) + 4.0 * p * x,
            )
        };
        u.extend([dx, dy, 0.0]);
        stress.extend([0.3 * s, s, 0.2 * s, 0.0, 0.0, 0.0]);
    }
    let mises = stress.chunks_exact(6).map(|s: &[f64]| s[1].abs()).collect();
    let array = |name: &str, unit: &str, components, values| PointArray {
        name: name.into(),
        unit: unit.into(),
        components,
        values,
    };
    let block =
        |body: &str, connectivity| Block { body: body.into(), cell: Cell::Triangle, degree: 3, connectivity };
    FieldSet {
        points,
        blocks: vec![
            block("cylinder", disc_cells),
            block("prism", block_cells.into_iter().map(|k| k + disc_points).collect()),
        ],
        arrays: vec![
            array("displacement", "m", 3, u),
            array("von_mises", "N/m^2", 1, mises),
            array("stress", "N/m^2", 6, stress),
        ],
        ..FieldSet::default()
    }
}

const COLUMNS: [(&str, &str); 27] = [
    ("step", ""),
    ("time", "s"),
    ("kinetic", "J"),
    ("strain", "J"),
    ("potential", "J"),
    ("total", "J"),
    ("external_work", "J"),
    ("contact_work", "J"),
    ("dissipation", "J"),
    ("contact_force_x", "N"),
    ("contact_force_y", "N"),
    ("contact_impulse_x", "N·s"),
    ("contact_impulse_y", "N·s"),
    ("active", ""),
    ("newton", ""),
    ("rejected", ""),
    ("penetration", "m"),
    ("cylinder.center_x", "m"),
    ("cylinder.center_y", "m"),
    ("cylinder.velocity_x", "m/s"),
    ("cylinder.velocity_y", "m/s"),
    ("prism.velocity_x", "m/s"),
    ("prism.velocity_y", "m/s"),
    ("A.uy", "m"),
    ("B.uy", "m"),
    ("B.sigma_yy", "N/m^2"),
    ("min_det_f", ""),
];

/// The facts of the case below.
fn facts(title: &str) -> Facts {
    let held = |axis| Held { body: "prism".into(), axis: Some(axis), displacement: None };
    let strike = ContactFacts {
        name: "strike".into(),
        secondary: "cylinder.arc".into(),
        primary: Some("prism.top".into()),
        ..ContactFacts::default()
    };
    Facts {
        title: title.into(),
        dimension: 2,
        contacts: vec![strike],
        held: [0, 1].map(held).into(),
        probes: ["A", "B"].map(String::from).into(),
        ..Facts::default()
    }
}

/// Writes the run; `title` and `reason` are text from the user.
pub(crate) fn write(directory: &Path, title: &str, reason: Option<&str>) {
    let columns = COLUMNS.map(|(name, unit)| Column {
        name: name.into(),
        unit: unit.into(),
        description: String::new(),
        integer: matches!(name, "step" | "active" | "newton" | "rejected"),
    });
    let case = case(&json!({
        "title": title, "dimension": 2, "units": {"length": "m", "time": "s", "mass": "kg"},
        "materials": [{"name": "rubber", "law": "neo-hookean", "density": 0.25, "lambda": 200.0, "mu": 15.0}],
        "bodies": [
            {"name": "cylinder", "material": "rubber", "element": "T10", "gravity": [0.0, -9.81]},
            {"name": "prism"},
        ],
        "supports": [{"on": ["prism.bottom"], "fix": [0, 1]}, {"on": ["prism.left"], "fix": [0]}],
        "contacts": [{"name": "strike", "secondary": "cylinder.arc", "primary": {"side": "prism.top"}}],
        "probes": [
            {"name": "A", "at": [0.0, 1.5], "body": "cylinder"},
            {"name": "B", "at": [0.0, 0.0], "body": "prism"},
        ],
        "time": {
            "end": 0.75, "step": 1.875e-3, "energy_guard": null,
            "scheme": {"kind": "chung-hulbert", "rho_inf": 0.1, "forces": "average-forces"},
        },
    }));
    let source = Source {
        text: format!("title = \"{title}\"\n# …\n"),
        sets: vec!["time.end=0.75".into(), "title='x'".into()],
        ..Source::default()
    };
    let mut manifest = Manifest::new("0.1.0", facts(title), case, source, columns.to_vec(), 1);
    // The points of the prism follow those of the disc; its lattice has 25 × 13 points.
    let first = (3 * N + 1) * (6 * N + 1);
    let sides: [(&str, Vec<usize>); 3] = [
        ("prism.bottom", (first..first + 25).collect()),
        ("prism.top", (0..25).map(|i| first + 12 * 25 + 24 - i).collect()),
        ("prism.left", (0..13).map(|j| first + 25 * (12 - j)).collect()),
    ];
    manifest.sides = sides.map(|(name, chain)| (name.into(), vec![chain])).into();
    let mut writer = RunWriter::create(directory, &manifest, b"").unwrap();
    let (dt, mut impulse) = (1.875e-3, 0.0);
    let noise = |i: usize| ((i * 7919 % 101) as f64 / 101.0 - 0.5) * 2.0;
    for i in 0..=400usize {
        let t = i as f64 * dt;
        let p = press(t);
        let force = 17.0 * p * (1.0 + 0.12 * noise(i));
        impulse += force * dt;
        let kinetic = 0.5 * 0.098 * 9.0 * (t.min(START) / START).powi(2) * (1.0 - 0.9 * p);
        let strain = 0.33 * p;
        let potential = 0.098 * 9.81 * fall(t);
        let total = kinetic + strain + potential;
        let velocity = (fall(t + 1e-6) - fall(t - 1e-6)) / 2e-6;
        let newton = if i == 0 { 0.0 } else { 3.0 + 2.0 * (p * 3.0).floor() };
        let row = [
            i as f64,
            t,
            kinetic,
            strain,
            potential,
            total,
            0.0,
            -0.002 * p,
            0.03 * t - 0.002 * p,
            1e-17,
            force,
            0.0,
            impulse,
            (6.0 * p).ceil(),
            newton,
            f64::from(i % 90 == 89),
            0.0,
            0.2,
            1.0 + fall(t),
            0.0,
            velocity,
            0.0,
            0.01 * p,
            fall(t) + 0.02 * (40.0 * t).sin() * t,
            -0.1 * p + 0.01 * (50.0 * t).sin() * f64::from(t > START),
            -33.0 * p * (1.0 + 0.1 * noise(i)) + 2.0 * (60.0 * t).sin() * f64::from(t > START),
            0.8,
        ];
        writer.history(&row).unwrap();
        if i % 90 == 89 {
            writer
                .log(&Event::new(
                    i as u64,
                    t,
                    "rejected",
                    "Newton's method did not converge in 20 iterations <&>",
                ))
                .unwrap();
        }
        if i % 8 == 0 {
            writer.fields(i as u64, t, &fields(t)).unwrap();
        }
    }
    manifest.status = if reason.is_some() { Status::Failed } else { Status::Finished };
    manifest.reason = reason.map(String::from);
    let words =
        ["coarse-secondary", "contact \"strike\"", "0.2 against 0.1", "nodes may slip through", "to swap"];
    let [id, place, what, why, advice] = words.map(String::from);
    manifest.warnings = vec![Warning { id, place, what, why, advice }];
    manifest.counters = [("steps".into(), 400), ("newton".into(), 1532)].into();
    manifest.timings =
        [("assembly".into(), 1.25), ("factor".into(), 0.75), ("cpu".into(), 2.25), ("total".into(), 2.5)]
            .into();
    let expectation = |what: &str, got, pass| Expectation {
        what: what.into(),
        expected: "-0.7827 ± 0.004".into(),
        got,
        pass,
        value: Some(-0.7827),
        tolerance: Some(4e-3),
        why: None,
        slow: false,
        source: Some("two unrelated codes agree".into()),
    };
    manifest.expectations =
        vec![expectation("min A.uy", Some(-0.7811), true), expectation("min <B>.uy", None, false)];
    writer.finish(&mut manifest).unwrap();
}
