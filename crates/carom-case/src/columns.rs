//! The columns of history.csv, in the order that the run directory specifies: the one list of their
//! names, units and meanings. Their values: `recording/columns.rs` of `carom-run`.

use carom_record::Column;
use carom_record::units::Labels;

use super::{
    BodySpec, Case, ContactSpec, Fallback, ObstacleMotion, ProbeSpec, Quantity, SupportSpec, TieSpec,
};

/// Whether a quantity exists in a space of this dimension: its name has no axis beyond it, or it is
/// the normal stress or strain across the plane.
pub(super) fn exists(of: Quantity, dimension: usize) -> bool {
    let axes = of.word().trim_start_matches("sigma_").trim_start_matches("strain_");
    let lacks = |axis: &str| axes.len() == 2 && axes.contains(axis);
    let is_across = matches!(of, Quantity::SigmaZz | Quantity::StrainZz) && dimension == 2;
    is_across || !(dimension < 2 && (lacks("y") || of == Quantity::VonMises) || dimension < 3 && lacks("z"))
}

impl Case {
    /// Unit labels of the recorded quantities.
    pub fn labels(&self) -> Labels {
        Labels::of(&self.units.length, &self.units.time, &self.units.mass)
    }

    /// A message about quantities with the labels of this case in place of their dimensions, which
    /// mechanics writes in brackets: `0.1 [length]`.
    pub fn in_units(&self, message: &str) -> String {
        let labels = self.labels();
        let put = |message: String, (dimension, label): (&str, &String)| {
            let label = if label.is_empty() { String::new() } else { format!(" {label}") };
            message.replace(&format!(" [{dimension}]"), &label)
        };
        let known = [("length", &labels.length), ("time", &labels.time), ("energy", &labels.energy)];
        known.into_iter().fold(message.to_owned(), put)
    }
}

/// The columns of history.csv of a case, in their order.
pub fn history_columns(case: &Case) -> Vec<Column> {
    Recorded::of(case).columns(&case.labels())
}

/// Parts of a case that determine the columns of history.csv.
pub(super) struct Recorded<'a> {
    pub(super) dimension: usize,
    pub(super) bodies: Vec<&'a BodySpec>,
    /// Names of the bodies that yield.
    pub(super) yielding: Vec<&'a str>,
    pub(super) contacts: Vec<&'a ContactSpec>,
    /// Whether the force of each contact is recorded.
    pub(super) by_contact: bool,
    pub(super) ties: Vec<&'a TieSpec>,
    pub(super) supports: Vec<&'a SupportSpec>,
    pub(super) probes: Vec<&'a ProbeSpec>,
    pub(super) manufactured: bool,
    pub(super) fallback: Fallback,
}

/// A list of columns under construction; `axes` are the names of the coordinates.
struct Columns {
    axes: &'static [&'static str],
    list: Vec<Column>,
}

impl Columns {
    fn push(&mut self, name: &str, unit: &str, description: &str, integer: bool) {
        let [name, unit, description] = [name, unit, description].map(str::to_owned);
        self.list.push(Column { name, unit, description, integer });
    }

    fn add(&mut self, name: &str, unit: &str, description: &str) {
        self.push(name, unit, description, false);
    }

    fn count(&mut self, name: &str, description: &str) {
        self.push(name, "", description, true);
    }

    fn vector(&mut self, name: &str, unit: &str, description: &str) {
        for axis in self.axes {
            self.add(&format!("{name}_{axis}"), unit, description);
        }
    }

    /// Adds the columns of a rotational quantity: one number in the plane, a vector in space,
    /// nothing in dimension 1.
    fn rotational(&mut self, name: &str, unit: &str, description: &str) {
        match self.axes.len() {
            2 => self.add(name, unit, description),
            3 => self.vector(name, unit, description),
            _ => {}
        }
    }
}

impl<'a> Recorded<'a> {
    pub(super) fn of(case: &'a Case) -> Self {
        Self {
            dimension: case.dimension,
            bodies: case.bodies.iter().collect(),
            yielding: case.yielding().map(|k| case.bodies[k].name.as_str()).collect(),
            contacts: case.contacts.iter().collect(),
            by_contact: case.contacts.len() > 1,
            ties: case.ties.iter().collect(),
            supports: case.supports.iter().collect(),
            probes: case.probes.iter().collect(),
            manufactured: case.manufactured.is_some(),
            fallback: case.time.fallback,
        }
    }

    pub(super) fn columns(&self, label: &Labels) -> Vec<Column> {
        let axes = &["x", "y", "z"][..self.dimension.clamp(1, 3)];
        let mut columns = Columns { axes, list: Vec::new() };
        columns.count("step", "step on the grid of times");
        columns.add("time", &label.time, "time, step × Δt");
        columns.add("dt", &label.time, "time step of the grid");
        for (name, what) in ENERGIES {
            columns.add(name, &label.energy, what);
        }
        columns.vector("momentum", &label.momentum, "momentum of all bodies");
        let unit = &label.angular_momentum;
        columns.rotational("angular_momentum", unit, "angular momentum about the origin");
        let what = "contact force on the secondary sides at the end of the step; \
                    with energy-momentum its mean over the step";
        columns.vector("contact_force", &label.force, what);
        let what = "time integral of the contact force, including projections";
        columns.vector("contact_impulse", &label.momentum, what);
        let what = "part of contact_impulse that projections and changes of the step move between velocities and algorithmic accelerations";
        columns.vector("algorithmic_impulse", &label.momentum, what);
        for (name, what) in COUNTS {
            columns.count(name, what);
        }
        if self.fallback != Fallback::None {
            columns.count("fallbacks", "grid steps that the fallback took since the previous row");
        }
        let what = "depth of the deepest node of either side of a contact in the other body, in space also of points of its sharp edges, since the previous row";
        columns.add("penetration", &label.length, what);
        let what =
            "the same of the nodes that the contact constrains: secondary nodes and corners of the primary";
        columns.add("penetration_secondary", &label.length, what);
        columns.add("min_det_f", "", "smallest J over all quadrature points");
        if self.contacts.iter().any(|contact| contact.friction.exists()) {
            columns.count("sticking", "pairs in contact that stick");
            columns.add("stick_time", &label.time, "stick time, summed over pairs, cumulative");
            columns.add("rub_time", &label.time, "time in contact, summed over pairs with friction");
            columns.add("slip", &label.length, "largest slip of a pair since it closed, so far");
        }
        let moving = || self.contacts.iter().filter(|contact| !contact.motion.is_fixed());
        let bodies = self.bodies.iter().map(|body| (&body.name, "centre of mass"));
        let obstacles =
            moving().map(|contact| (&contact.name, "point of the moving obstacle that `about` names"));
        for (name, point) in bodies.chain(obstacles) {
            columns.vector(&format!("{name}.center"), &label.length, point);
            columns.vector(&format!("{name}.velocity"), &label.velocity, &format!("velocity of the {point}"));
        }
        if !self.yielding.is_empty() {
            let what = "work of plastic flow on the bodies that is dissipated, cumulative, ≤ 0";
            columns.add("plastic_work", &label.energy, what);
        }
        for name in &self.yielding {
            let what = "plastic_work of the body";
            columns.add(&format!("{name}.plastic_work"), &label.energy, what);
            let what = "largest equivalent plastic strain over its quadrature points";
            columns.add(&format!("{name}.plastic_strain"), "", what);
        }
        for contact in self.contacts.iter().filter(|_| self.by_contact) {
            let what = "contact force on its secondary side";
            columns.vector(&format!("{}.force", contact.name), &label.force, what);
        }
        for tie in &self.ties {
            let what = "force of the tie on its secondary side";
            columns.vector(&format!("{}.force", tie.name), &label.force, what);
        }
        let named = self.supports.iter().filter_map(|support| Some((support.name.as_ref()?, *support)));
        let prescribed = moving().filter(|c| matches!(c.motion, ObstacleMotion::Prescribed { .. }));
        let about = "moment of the reaction forces about the given point";
        let supports = named.map(|(name, support)| (name, support.moment_about.as_ref().map(|_| about)));
        let torque = "moment of the reaction forces about the centre of rotation, which travels along";
        let turns =
            |motion: &ObstacleMotion| matches!(motion, ObstacleMotion::Prescribed { rotate: Some(_), .. });
        let obstacles = prescribed.map(|contact| (&contact.name, turns(&contact.motion).then_some(torque)));
        for (name, moment) in supports.chain(obstacles) {
            let what = "force of the support, or of the obstacle, on the bodies";
            columns.vector(&format!("{name}.reaction"), &label.force, what);
            if let Some(what) = moment {
                columns.rotational(&format!("{name}.moment"), &label.moment, what);
            }
        }
        for probe in &self.probes {
            for quantity in &probe.record {
                let (unit, mut what) = of_point(*quantity, label);
                if quantity.is_stress() && self.yielding.contains(&&*probe.body) {
                    what.push_str(", projected from the quadrature points: it may exceed the yield stress");
                }
                columns.add(&format!("{}.{}", probe.name, quantity.word()), unit, &what);
            }
        }
        if self.manufactured {
            columns.add("error_l2", "", "√∫|y_h − y|² dΩ₀ against the motion of [manufactured]");
            columns.add("error_h1", "", "√∫|∂y_h/∂X − ∂y/∂X|² dΩ₀ against the motion of [manufactured]");
        }
        columns.list
    }
}

const ENERGIES: [(&str, &str); 10] = [
    ("kinetic", "kinetic energy ½ vᵀM v"),
    ("strain", "strain energy"),
    ("potential", "potential of constant conservative loads"),
    ("total", "kinetic + strain + potential"),
    (
        "external_work",
        "work of the loads without potential, of the supports and of moved obstacles, cumulative",
    ),
    (
        "contact_work",
        "work of the contact forces without friction on the bodies and of projections, cumulative",
    ),
    ("friction_work", "work of friction on the bodies, cumulative"),
    (
        "dissipation",
        "external_work + contact_work + friction_work + plastic_work − (total − total at the start); negative if energy was created",
    ),
    (
        "energy_created",
        "largest rise of total − external_work above its running minimum so far; not what velocities are ahead of the works of loads, supports and obstacles",
    ),
    (
        "energy_scale",
        "largest kinetic + strain energy at the end of a step so far, or Σ |change of external_work| if that is larger",
    ),
];

const COUNTS: [(&str, &str); 5] = [
    ("active", "pairs in contact"),
    ("activations", "nodes that came into contact since the previous row"),
    ("releases", "nodes that left contact since the previous row"),
    ("newton", "Newton iterations since the previous row"),
    ("rejected", "rejected (bisected) steps since the previous row"),
];

/// Unit and meaning of a probe's column.
fn of_point(quantity: Quantity, label: &Labels) -> (&str, String) {
    use Quantity::{Ax, Ay, Az, DetF, PlasticStrain, Ux, Uy, Uz, VonMises, Vx, Vy, Vz, Yielded};
    let axis = &quantity.word()[1..];
    match quantity {
        Ux | Uy | Uz => (&label.length, format!("displacement along {axis}")),
        Vx | Vy | Vz => (&label.velocity, format!("velocity along {axis}")),
        Ax | Ay | Az => (&label.acceleration, format!("acceleration along {axis}")),
        VonMises => (&label.stress, "von Mises stress (from the Cauchy stress)".to_owned()),
        DetF => (&label.none, "volume ratio J".to_owned()),
        PlasticStrain => (
            &label.none,
            "equivalent plastic strain, projected from the quadrature points: it may decrease".to_owned(),
        ),
        Yielded => (&label.none, "share of the quadrature points of the cell that have yielded".to_owned()),
        strain if strain.word().starts_with("strain") => (&label.none, "Green–Lagrange strain".to_owned()),
        _ => (&label.stress, "Cauchy stress".to_owned()),
    }
}
