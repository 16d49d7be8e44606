//! Every key of every table: name, values, unit, default, meaning, example.

use super::Kind::{
    Choice, Choices, Count, Formula, Formulas, FormulasOr, Name, Number, NumberOrFalse, Numbers, Side,
    SideOr, Sides, Tables, Text, Truth, Variant, Vector,
};
use super::{
    ANY, IN_SPACE, IN_SPACE_AND_TIME, IN_TIME, Kind, NOT_NEGATIVE, POSITIVE, Range, Table, key, schemes,
    shapes,
};

/// The whole file.
pub const CASE: Table = Table {
    name: "the case",
    doc: "One simulation of impact or contact of deformable bodies.",
    keys: &[
        key("title", Text, "Title of figures and report pages. Default: the name of the file.")
            .optional()
            .example("\"Two bars\""),
        key("dimension", Kind::Count(1), "Space dimension: 1 (bars) or 2.").example("2"),
        key(
            "plane",
            Choice(&["strain", "stress"], &["axisymmetric"]),
            "Plane strain or plane stress, in dimension 2. In plane stress, `thickness` is that of the undeformed sheet.",
        )
            .default("\"strain\""),
        key("thickness", Number(POSITIVE), "Out-of-plane thickness; in dimension 1, the area of the cross-section.")
            .unit("length, or length² in dimension 1")
            .default("1.0"),
        key(
            "refine",
            Number(AT_LEAST_ONE),
            "Refinement of all meshes: built-in shapes are made with cells smaller by this factor; numbers of `cells` are multiplied by it and must remain whole; for meshes of files it must be an integer, the number of parts into which every edge is divided.",
        )
        .default("1.0"),
        key("units", Kind::Table(&UNITS), "Unit labels in figures and columns; values are not converted.")
            .optional()
            .example("{ length = \"m\", time = \"s\", mass = \"kg\" }"),
        key("preset", Choice(&["default", "paper"], &[]), "Set of default values; keys given explicitly take precedence.")
            .default("\"default\""),
        key("material", Tables(&MATERIAL), "A material; bodies refer to it by name."),
        key("body", Tables(&BODY), "A deformable body."),
        key("support", Tables(&SUPPORT), "Displacement boundary condition: sides fixed or moved in given directions.").optional(),
        key("load", Tables(&LOAD), "A load: traction or pressure on sides, or body force in a body.").optional(),
        key(
            "initial",
            Kind::Table(&INITIAL),
            "Start from the final state of another run instead of the reference positions.",
        )
        .optional(),
        key(
            "manufactured",
            Kind::Table(&MANUFACTURED),
            "A manufactured solution: load, boundary motion and initial state are derived from it, and errors are measured against it.",
        )
        .optional(),
        key("contact", Tables(&CONTACT), "A contact pair: two sides that may come into contact.").optional(),
        key("time", Kind::Table(&TIME), "Time interval, time step and time integrator."),
        key("newton", Kind::Table(&NEWTON), "Settings of Newton's method.").optional(),
        key("probe", Tables(&PROBE), "A material point whose quantities are recorded as columns of history.csv.").optional(),
        key("output", Kind::Table(&OUTPUT), "What is written, and how often.").optional(),
        key(
            "exact",
            Kind::ByColumn,
            "Exact solution by column, as formulas in t: used by `formula = \"exact\"` in [[expect]] and by `reference = \"exact\"` in a study.",
        )
        .optional()
        .example("{ \"A.uy\" = \"-0.5*9.81*t^2\" }"),
        key("expect", Tables(&EXPECT), "An expected value; a case that has one is also a test.").optional(),
    ],
    later: &[],
};

const UNITS: Table = Table {
    name: "units",
    doc: "Unit labels in figures and columns; values are not converted.",
    keys: &[
        key("length", Text, "Unit label of length.").default("\"m\""),
        key("time", Text, "Unit label of time.").default("\"s\""),
        key("mass", Text, "Unit label of mass.").default("\"kg\""),
    ],
    later: &[],
};

const MATERIAL: Table = Table {
    name: "[[material]]",
    doc: "A hyperelastic material, given by lambda and mu or by young and poisson.",
    keys: &[
        key("name", Name, "Name by which bodies refer to it.").example("\"rubber\""),
        key(
            "law",
            Choice(&["neo-hookean", "saint-venant-kirchhoff", "linear-elastic"], &[]),
            "Constitutive law.",
        )
        .example("\"neo-hookean\""),
        key("density", Number(NOT_NEGATIVE), "Mass per reference volume; 0 for a massless body.")
            .unit("mass/length³")
            .example("0.25"),
        key("lambda", Number(ANY), "First Lamé constant Λ; 3Λ + 2μ > 0.")
            .unit("mass/(length·time²)")
            .optional()
            .example("200.0"),
        key("mu", Number(POSITIVE), "Second Lamé constant (shear modulus) μ.")
            .unit("mass/(length·time²)")
            .optional()
            .example("15.0"),
        key("young", Number(POSITIVE), "Young's modulus, with poisson instead of lambda and mu.")
            .unit("mass/(length·time²)")
            .optional()
            .example("43.95"),
        key(
            "poisson",
            Number(Range { low: Some((-1.0, false)), high: Some((0.5, false)) }),
            "Poisson's ratio; given together with young. At 0.5 the material would be incompressible and its bulk modulus infinite.",
        )
        .optional()
        .example("0.49"),
    ],
    later: &[],
};

const BODY: Table = Table {
    name: "[[body]]",
    doc: "A deformable body; its sides are written name.side.",
    keys: &[
        key("name", Name, "Name; its sides are written name.side.").example("\"cylinder\""),
        key("material", Name, "Name of its material.").example("\"rubber\""),
        key(
            "element",
            Choice(&["L2", "L3", "L4", "T3", "T6", "T10"], &[]),
            "Cell type: L2 L3 L4 in dimension 1, T3 T6 T10 in dimension 2.",
        )
        .example("\"T6\""),
        key("mesh", Variant(shapes), "Mesh: a built-in shape with its mesh size, or a body of a Gmsh file.")
            .example("{ shape = \"rectangle\", min = [0.0, 0.0], max = [1.0, 1.0], cells = [8, 8] }"),
        key("place", Kind::Table(&PLACE), "Rotation and translation of the mesh, applied before anything else.")
            .optional()
            .example("{ rotate = 30.0, about = [0.0, 0.0], shift = [0.0, 1.0] }"),
        key("position", Formulas(IN_SPACE), "Positions at t = 0 as formulas in X, Y, for a body that starts deformed. Default: X, Y.")
            .unit("length")
            .optional()
            .example("[\"X + 0.1*X*Y\", \"Y\"]"),
        key("gravity", Vector, "Gravitational acceleration. Default: zero.")
            .unit("length/time²")
            .optional()
            .example("[0.0, -9.81]"),
        key(
            "velocity",
            FormulasOr(IN_SPACE, &VELOCITY),
            "Initial velocity: numbers or formulas in X, Y, or the table of a rigid-body motion. Default: zero.",
        )
        .unit("length/time")
        .optional()
        .example("[0.0, -1.0]"),
        key(
            "mass",
            Choice(&["consistent", "lumped", "redistributed", "redistributed-nearest"], &[]),
            "Mass matrix. consistent; lumped: diagonal, by HRZ scaling; redistributed: no mass on contact nodes, and the smallest change at the other \
             nodes that preserves the total mass, the centre of mass and the second moments; redistributed-nearest: no mass on contact nodes, and \
             their mass is added to the nearest other nodes.",
        )
        .default("\"consistent\""),
    ],
    later: &[],
};

const VELOCITY: Table = Table {
    name: "velocity",
    doc: "Initial velocity of a rigid-body motion: linear + angular × (X − about).",
    keys: &[
        key("linear", Vector, "Velocity of the point `about`. Default: zero.")
            .unit("length/time")
            .optional()
            .example("[0.0, -1.0]"),
        key("angular", Number(ANY), "Angular velocity, counter-clockwise; dimension 2.")
            .unit("1/time")
            .default("0.0"),
        key("about", Vector, "Centre of the rotation; required with `angular`.")
            .unit("length")
            .optional()
            .example("[0.0, 1.0]"),
    ],
    later: &[],
};

const PLACE: Table = Table {
    name: "place",
    doc: "Rotation, then translation of a mesh, built in or from a file.",
    keys: &[
        key("rotate", Number(ANY), "Angle of rotation, counter-clockwise; dimension 2.")
            .unit("degrees")
            .default("0.0"),
        key("about", Vector, "Centre of rotation. Default: the origin.")
            .unit("length")
            .optional()
            .example("[0.0, 0.0]"),
        key("shift", Vector, "Translation. Default: zero.").unit("length").optional().example("[0.0, 1.0]"),
    ],
    later: &[],
};

const SUPPORT: Table = Table {
    name: "[[support]]",
    doc: "Displacement boundary condition: sides fixed in some directions with `fix`, or moved with `move`.",
    keys: &[
        key("name", Name, "Name; the reaction forces of a named support are recorded.").optional().example("\"floor\""),
        key("on", Sides, "Sides that are constrained.").example("[\"prism.bottom\"]"),
        key("fix", Choices(&["x", "y"]), "Directions that are fixed.").optional().example("[\"x\", \"y\"]"),
        key(
            "move",
            Kind::Table(&MOVE),
            "Prescribed displacements by direction, zero at t = 0; velocity and acceleration are the time derivatives of the formula.",
        )
        .optional()
        .example("{ y = \"-0.1*t\" }"),
    ],
    later: &[],
};

const MOVE: Table = Table {
    name: "move",
    doc: "Displacements of a side from its reference position.",
    keys: &[
        key("x", Formula(IN_SPACE_AND_TIME), "Displacement along x.")
            .unit("length")
            .optional()
            .example("\"0.1*t\""),
        key("y", Formula(IN_SPACE_AND_TIME), "Displacement along y.")
            .unit("length")
            .optional()
            .example("\"-0.1*t\""),
    ],
    later: &[],
};

const LOAD: Table = Table {
    name: "[[load]]",
    doc: "A load on sides (`on` with `traction` or `pressure`) or in a body (`body` with `body_force`). Formulas are functions of the reference position X, Y and the time t.",
    keys: &[
        key("name", Name, "Name used in messages.").optional().example("\"press\""),
        key("on", Sides, "Loaded sides, with `traction` or `pressure`.")
            .optional()
            .example("[\"prism.top\"]"),
        key("body", Name, "Loaded body, with `body_force`.").optional().example("\"prism\""),
        key("traction", Formulas(IN_SPACE_AND_TIME), "Dead load per reference area.")
            .unit("mass/(length·time²)")
            .optional()
            .example("[\"0\", \"-5*min(t/0.1, 1)\"]"),
        key(
            "pressure",
            Formula(IN_SPACE_AND_TIME),
            "Follower load per current area, acting against the outward normal.",
        )
        .unit("mass/(length·time²)")
        .optional()
        .example("\"2*t\""),
        key("body_force", Formulas(IN_SPACE_AND_TIME), "Dead load per reference volume.")
            .unit("mass/(length²·time²)")
            .optional()
            .example("[\"0\", \"-3*X\"]"),
        key(
            "table",
            Text,
            "CSV file with the columns t and value: a factor on the load, linearly interpolated in time.",
        )
        .optional()
        .example("\"amplitude.csv\""),
    ],
    later: &[],
};

const INITIAL: Table = Table {
    name: "[initial]",
    doc: "Start from the final state of another run with the same meshes; time starts at 0 again.",
    keys: &[
        key("from", Text, "Directory of the finished run, relative to the folder of the case.")
            .example("\"runs/preload\""),
        key(
            "velocities",
            Choice(&["keep", "zero"], &[]),
            "Initial velocities: those at the end of the other run, or zero.",
        )
        .default("\"keep\""),
    ],
    later: &[],
};

const MANUFACTURED: Table = Table {
    name: "[manufactured]",
    doc: "A manufactured solution for all bodies: the load is ρÿ − Div P, boundary nodes follow the given motion, and history.csv has the columns error_l2 and error_h1.",
    keys: &[key("y", Formulas(IN_SPACE_AND_TIME), "Current positions as formulas in X, Y and t.")
        .unit("length")
        .example("[\"X + 0.1*sin(X + 2*Y)*t\", \"Y - 0.1*cos(X*Y)*t\"]")],
    later: &[],
};

const CONTACT: Table = Table {
    name: "[[contact]]",
    doc: "A contact pair: two sides that may come into contact.",
    keys: &[
        key("name", Name, "Name used in records and messages.").example("\"strike\""),
        key("secondary", Side, "Secondary (slave) side: its nodes may not penetrate the primary.").example("\"cylinder.arc\""),
        key("primary", SideOr(&RIGID), "Primary (master) side, or a rigid obstacle: a table with one of `plane`, `circle` and `polyline`.").example("\"prism.top\""),
        key("method", Choice(&["node-to-segment"], &["mortar"]), "Discretisation of the contact.")
            .default("\"node-to-segment\""),
        key(
            "enforcement",
            Choice(&["multiplier", "penalty"], &["augmented"]),
            "How the constraint is enforced: exactly by a Lagrange multiplier, or by penalty springs whose energy counts as strain energy.",
        )
        .default("\"multiplier\""),
        key("stiffness", Number(POSITIVE), "Penalty stiffness, as a multiple of the reference stiffness of the secondary node.")
            .default("10.0"),
        key(
            "law",
            Choice(&["position", "predictor", "velocity"], &[]),
            "What contact constrains: positions at the end of the step; positions and the predictor y + Δt v (contact-stabilised); or velocities, \
             by impulses. Default: the law of the scheme.",
        )
        .optional()
        .example("\"position\""),
        key(
            "force",
            Choice(&["alpha_f", "end"], &[]),
            "How the contact force enters the balance of a step: averaged with α_f (eq. 15), or at the end of the step.",
        )
        .default("\"alpha_f\""),
        key(
            "persistency",
            Choice(&["project", "none"], &[]),
            "Velocities and accelerations at activation: projected onto the constraints, so that they are compatible with them, or left unchanged.",
        )
        .default("\"project\"")
        .paper("\"none\""),
        key(
            "active_set",
            Choice(&["within", "after"], &[]),
            "When the active set is updated: within Newton's method, or after it has converged.",
        )
        .default("\"within\"")
        .paper("\"after\""),
        key(
            "detection",
            Choice(&["closest-point", "trajectory"], &[]),
            "Gap that decides whether a pair becomes active: at the closest point, or at the ξ where the trajectories cross (eq. 8 as printed in the paper).",
        )
        .default("\"closest-point\"")
        .paper("\"trajectory\""),
        key(
            "xi",
            Choice(&["closest", "frozen"], &[]),
            "Point of the primary facet at which the gap is measured during a step: the closest point, recomputed in every iteration; or, as printed \
             in the paper, that of the trajectory crossing in the first step of a contact and the closest point at the start of the step in later ones.",
        )
        .default("\"closest\""),
        key(
            "restitution",
            Number(RESTITUTION),
            "Coefficient of restitution e: Newton's, for contact laws on velocities; with energy-momentum and multipliers, e² is the fraction of the \
             energy taken by contact that is returned where nodes close or open (1 elastic, 0 inelastic); with paoli-schatzman, the weight of the previous position.",
        )
        .default("0.0"),
    ],
    later: &["passes", "normals", "overlap", "between", "friction"],
};

const FRACTION: Range = Range { low: Some((0.0, true)), high: Some((1.0, false)) };
const AT_LEAST_ONE: Range = Range { low: Some((1.0, true)), high: None };
const RESTITUTION: Range = Range { low: Some((0.0, true)), high: Some((1.0, true)) };

const RIGID: Table = Table {
    name: "a rigid primary",
    doc: "A primary surface that does not deform: exactly one shape, fixed, moved by `motion`, or free with `mass`.",
    keys: &[
        key("plane", Kind::Table(&PLANE), "A rigid half-space.")
            .optional()
            .example("{ point = [0.0, 0.0], normal = [0.0, 1.0] }"),
        key("circle", Kind::Table(&CIRCLE), "A rigid circle, with bodies outside or inside it; dimension 2.")
            .optional()
            .example("{ center = [0.0, 0.0], radius = 1.0, inside = true }"),
        key("polyline", Kind::Table(&POLYLINE), "A rigid chain of segments; dimension 2.")
            .optional()
            .example("{ points = [[2.0, 0.0], [0.0, 0.0], [-2.0, 1.0]], radius = 0.1 }"),
        key(
            "motion",
            Kind::Table(&MOTION),
            "Prescribed motion by formulas in t. Its reaction forces are recorded under the name of the contact, and its work is external_work.",
        )
        .optional()
        .example("{ x = \"0.1*t\" }"),
        key(
            "mass",
            Number(POSITIVE),
            "Mass of an obstacle that is free in translation and does not turn; its position and velocity are recorded under the name of the contact.",
        )
        .unit("mass")
        .optional()
        .example("0.5"),
        key("velocity", Vector, "Initial velocity, with `mass`. Default: zero.")
            .unit("length/time")
            .optional()
            .example("[0.0, -1.0]"),
        key("gravity", Vector, "Gravitational acceleration, with `mass`. Default: zero.")
            .unit("length/time²")
            .optional()
            .example("[0.0, -9.81]"),
    ],
    later: &["spring"],
};

const CIRCLE: Table = Table {
    name: "circle",
    doc: "A rigid circle.",
    keys: &[
        key("center", Vector, "Its centre.").unit("length").example("[0.0, 0.0]"),
        key("radius", Number(POSITIVE), "Its radius.").unit("length").example("1.0"),
        key("inside", Truth, "Whether bodies are inside it; outside otherwise.").default("false"),
    ],
    later: &[],
};

const POLYLINE: Table = Table {
    name: "polyline",
    doc: "A rigid chain of straight segments, with the rigid material to the left of the direction of travel.",
    keys: &[
        key(
            "points",
            Kind::Points(2),
            "Its points in order; closed if the last one repeats the first. The first and last segment of an open chain continue to infinity.",
        )
        .unit("length")
        .example("[[2.0, 0.0], [0.0, 0.0], [-2.0, 1.0]]"),
        key(
            "radius",
            Number(NOT_NEGATIVE),
            "Radius of the arcs that round the corners, tangent to both segments; 0: sharp corners. A sharp corner that is concave holds a node by one of its segments only.",
        )
        .unit("length")
        .default("0.0"),
    ],
    later: &[],
};

const MOTION: Table = Table {
    name: "motion",
    doc: "Prescribed motion of a rigid obstacle, zero at t = 0: rotation about a point that moves with it.",
    keys: &[
        key("x", Formula(IN_TIME), "Displacement along x.").unit("length").optional().example("\"0.1*t\""),
        key("y", Formula(IN_TIME), "Displacement along y; dimension 2.")
            .unit("length")
            .optional()
            .example("\"-0.1*t\""),
        key("rotate", Formula(IN_TIME), "Angle of rotation, counter-clockwise; dimension 2.")
            .unit("degrees")
            .optional()
            .example("\"360*t\""),
        key("about", Vector, "Centre of the rotation at t = 0; required with `rotate`.")
            .unit("length")
            .optional()
            .example("[0.0, 0.0]"),
    ],
    later: &[],
};

const PLANE: Table = Table {
    name: "plane",
    doc: "A rigid half-space.",
    keys: &[
        key("point", Vector, "A point on its boundary.").unit("length").example("[0.0, 0.0]"),
        key("normal", Vector, "Outward normal, of any length > 0.").example("[0.0, 1.0]"),
    ],
    later: &[],
};

const TIME: Table = Table {
    name: "[time]",
    doc: "Time interval, time step and time integrator.",
    keys: &[
        key("end", Number(POSITIVE), "End time, a multiple of the time step.").unit("time").example("0.75"),
        key("step", Number(POSITIVE), "Time step.")
            .unit("time")
            .example("1.875e-3")
            .later("a table { initial, min, max, … }"),
        key(
            "phase",
            Number(FRACTION),
            "Fraction of a step by which all instants are earlier: the first step is shorter by it, and the last one has this length. Runs that differ in it meet contact at different instants of a step.",
        )
        .default("0.0"),
        key("scheme", Variant(schemes), "Time integrator.")
            .example("{ kind = \"chung-hulbert\", rho_inf = 0.1 }"),
        key(
            "energy_guard",
            NumberOrFalse(POSITIVE),
            "The run stops if total − external_work rises above its running minimum by more than this fraction of the energy scale so far, the largest kinetic + strain energy or Σ |ΔW| of the external work; false: the run never stops for this reason.",
        )
        .default("0.02")
        .paper("false"),
    ],
    later: &[],
};

const NEWTON: Table = Table {
    name: "[newton]",
    doc: "Settings of Newton's method.",
    keys: &[
        key(
            "tolerance",
            Number(Range { low: Some((0.0, false)), high: Some((1.0, false)) }),
            "Convergence tolerance on ‖Δy‖∞/L and ‖r‖/Σ‖f‖.",
        )
        .default("1e-9"),
        key("max_iterations", Count(1), "Largest number of iterations before a step is rejected.").default("20"),
        key(
            "tangent",
            Choice(&["frozen", "frozen-double", "full"], &[]),
            "When the tangent is factorised. frozen: the factorisation is reused as a preconditioner over iterations and steps as long as this reduces the cost; with 10 000 unknowns or more it is in single precision where this suffices. frozen-double: the same, always in double precision. full: in every iteration.",
        )
        .default("\"frozen\""),
        key(
            "mixing",
            Count(0),
            "Number of earlier corrections with the same factorisation that accelerate the next one (the restart length of the Krylov method); 0 disables mixing.",
        )
        .default("4"),
    ],
    later: &[],
};

const PROBE: Table = Table {
    name: "[[probe]]",
    doc: "A material point whose quantities are recorded as columns name.quantity.",
    keys: &[
        key("name", Name, "Name; its columns are name.quantity.").example("\"A\""),
        key("at", Vector, "Reference position of the point.").unit("length").example("[0.0, 1.5]"),
        key("body", Name, "Body it belongs to.").example("\"cylinder\""),
        key(
            "record",
            Choices(QUANTITIES),
            "Recorded quantities: displacement, velocity, acceleration, Cauchy stress, von Mises stress, volume ratio.",
        )
        .example("[\"uy\", \"sigma_yy\"]"),
    ],
    later: &[],
};

const QUANTITIES: &[&str] =
    &["ux", "uy", "vx", "vy", "ax", "ay", "sigma_xx", "sigma_yy", "sigma_xy", "von_mises", "det_f"];

const OUTPUT: Table = Table {
    name: "[output]",
    doc: "What is written, and how often.",
    keys: &[
        key(
            "fields_every",
            Count(0),
            "Steps between two outputs of the fields; 0: none. Default: 20, or 0 if at_times is given.",
        )
        .optional()
        .example("20"),
        key(
            "format",
            Choice(&["vtu", "vtkhdf"], &[]),
            "Field format: one VTU file per output, listed in fields.pvd, or a single file, fields.vtkhdf.",
        )
        .default("\"vtu\""),
        key("at_times", Numbers, "Fields are also written at the steps nearest to these times.")
            .unit("time")
            .default("[]"),
        key("history_every", Count(1), "Steps between two rows of history.csv.").default("1"),
        key("checkpoint_every", Count(1), "Steps between two checkpoints.").default("50"),
    ],
    later: &[],
};

/// One expected value, of a case, an arm or a study.
pub const EXPECT: Table = Table {
    name: "[[expect]]",
    doc: "An expected value with one bound: `value` and `tolerance`, `value` and `relative`, `at_most`, or `at_least`. With a `formula`, `tolerance` alone is sufficient.",
    keys: &[
        key(
            "what",
            Text,
            "Quantity: min | max | first | last | at T | time of min | time of max | range | drift | peak | rms of a column or of [ columns with + - * / ]; \
             the name of a metric; `stopped`; or an expression of these. Operators need blanks on both sides.",
        )
        .example("\"min A.uy\""),
        key("formula", Text, "Expected values of the column `what`, as a formula in t; the bound is on the norm of the deviation from it.")
            .optional()
            .example("\"-0.5*9.81*t^2\""),
        key(
            "norm",
            Choice(&["max", "rms"], &[]),
            "Norm of the deviation: largest absolute value, or root mean square over the rows. Default: max; for an order, rms.",
        )
        .optional()
        .example("\"rms\""),
        key("scale", Number(POSITIVE), "Number that divides the deviation.").default("1.0"),
        key("after", Number(ANY), "Only rows strictly after this time are used.").unit("time").optional().example("0.52"),
        key("before", Number(ANY), "Only rows strictly before this time are used.").unit("time").optional().example("1.147"),
        key("value", Number(ANY), "Expected value.").optional().example("-0.7827"),
        key("tolerance", Number(NOT_NEGATIVE), "Absolute tolerance.").optional().example("4e-3"),
        key("relative", Number(NOT_NEGATIVE), "Relative tolerance.").optional().example("0.01"),
        key("at_most", Number(ANY), "Upper bound.").optional().example("0.0"),
        key("at_least", Number(ANY), "Lower bound.").optional().example("0.0"),
        key("source", Text, "Where the expected value comes from.").optional().example("\"exact solution\""),
        key("of", Text, "In a study, with what = \"order\": the quantity or column whose order of convergence is observed.")
            .optional()
            .example("\"last A.uy\""),
        key("against", Text, "With what = \"order\": the key of the case that is refined from arm to arm.")
            .optional()
            .example("\"time.step\""),
        key("where", Text, "With what = \"order\": only arms whose names contain these whole words.").optional().example("\"hu\""),
        key("exact", Number(ANY), "With what = \"order\": the exact value that errors are computed against.").optional().example("1.0"),
        key("slow", Truth, "Skipped by `carom verify --fast`.").default("false"),
    ],
    later: &[],
};
