//! The columns of history.csv, in the order that the run directory specifies.

use super::{BodySpec, Case, ContactSpec, Fallback, ObstacleMotion, ProbeSpec, Quantity, SupportSpec};

const SCALARS: [&str; 13] = [
    "step",
    "time",
    "dt",
    "kinetic",
    "strain",
    "potential",
    "total",
    "external_work",
    "contact_work",
    "friction_work",
    "dissipation",
    "energy_created",
    "energy_scale",
];
const COUNTS: [&str; 5] = ["active", "activations", "releases", "newton", "rejected"];

const SMALLEST: [&str; 3] = ["penetration", "penetration_secondary", "min_det_f"];

const FRICTION: [&str; 4] = ["sticking", "stick_time", "rub_time", "slip"];

const ERRORS: [&str; 2] = ["error_l2", "error_h1"];

/// Name of a quantity in column names.
pub(super) fn quantity(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Ux => "ux",
        Quantity::Uy => "uy",
        Quantity::Uz => "uz",
        Quantity::Vx => "vx",
        Quantity::Vy => "vy",
        Quantity::Vz => "vz",
        Quantity::Ax => "ax",
        Quantity::Ay => "ay",
        Quantity::Az => "az",
        Quantity::SigmaXx => "sigma_xx",
        Quantity::SigmaYy => "sigma_yy",
        Quantity::SigmaZz => "sigma_zz",
        Quantity::SigmaXy => "sigma_xy",
        Quantity::SigmaYz => "sigma_yz",
        Quantity::SigmaXz => "sigma_xz",
        Quantity::VonMises => "von_mises",
        Quantity::DetF => "det_f",
    }
}

impl Quantity {
    /// Its name in columns.
    pub fn name(self) -> &'static str {
        quantity(self)
    }
}

/// Whether a quantity exists in a space of this dimension: its name has no axis beyond it.
pub(super) fn exists(of: Quantity, dimension: usize) -> bool {
    let axes = quantity(of).trim_start_matches("sigma_");
    let lacks = |axis: &str| axes.len() == 2 && axes.contains(axis);
    !(dimension < 2 && lacks("y") || dimension < 3 && lacks("z"))
}

/// Names of the columns of history.csv of a case, in their order.
pub fn history_columns(case: &Case) -> Vec<String> {
    of(
        case.dimension,
        &case.bodies.iter().cloned().map(Some).collect::<Vec<_>>(),
        &case.contacts.iter().cloned().map(Some).collect::<Vec<_>>(),
        &case.supports.iter().cloned().map(Some).collect::<Vec<_>>(),
        &case.probes.iter().cloned().map(Some).collect::<Vec<_>>(),
        case.manufactured.is_some(),
        case.time.fallback,
    )
}

/// Column names of a case in the given dimension.
pub(super) fn of(
    dimension: usize,
    bodies: &[Option<BodySpec>],
    contacts: &[Option<ContactSpec>],
    supports: &[Option<SupportSpec>],
    probes: &[Option<ProbeSpec>],
    manufactured: bool,
    fallback: Fallback,
) -> Vec<String> {
    let axes = &["x", "y", "z"][..dimension.clamp(1, 3)];
    let mut columns: Vec<String> = SCALARS.iter().map(ToString::to_string).collect();
    let vector = |columns: &mut Vec<String>, name: &str| {
        columns.extend(axes.iter().map(|axis| format!("{name}_{axis}")));
    };
    vector(&mut columns, "momentum");
    match dimension {
        2 => columns.push("angular_momentum".to_owned()),
        3 => vector(&mut columns, "angular_momentum"),
        _ => {}
    }
    vector(&mut columns, "contact_force");
    vector(&mut columns, "contact_impulse");
    vector(&mut columns, "algorithmic_impulse");
    columns.extend(COUNTS.map(String::from));
    columns.extend((fallback != Fallback::None).then(|| "fallbacks".to_owned()));
    columns.extend(SMALLEST.map(String::from));
    if contacts.iter().flatten().any(|contact| contact.friction.exists()) {
        columns.extend(FRICTION.map(String::from));
    }
    for body in bodies.iter().flatten() {
        vector(&mut columns, &format!("{}.center", body.name));
        vector(&mut columns, &format!("{}.velocity", body.name));
    }
    let moving = || contacts.iter().flatten().filter(|contact| !contact.motion.is_fixed());
    for contact in moving() {
        vector(&mut columns, &format!("{}.center", contact.name));
        vector(&mut columns, &format!("{}.velocity", contact.name));
    }
    for contact in contacts.iter().flatten().filter(|_| contacts.len() > 1) {
        vector(&mut columns, &format!("{}.force", contact.name));
    }
    for support in supports.iter().flatten() {
        let Some(name) = &support.name else { continue };
        vector(&mut columns, &format!("{name}.reaction"));
        match (dimension, &support.moment_about) {
            (2, Some(_)) => columns.push(format!("{name}.moment")),
            (3, Some(_)) => vector(&mut columns, &format!("{name}.moment")),
            _ => {}
        }
    }
    for contact in moving().filter(|c| matches!(c.motion, ObstacleMotion::Prescribed { .. })) {
        vector(&mut columns, &format!("{}.reaction", contact.name));
    }
    for probe in probes.iter().flatten() {
        columns.extend(probe.record.iter().map(|q| format!("{}.{}", probe.name, quantity(*q))));
    }
    columns.extend(ERRORS.iter().filter(|_| manufactured).map(ToString::to_string));
    columns
}
