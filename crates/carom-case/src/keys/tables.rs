//! Every key of every table: name, values, unit, default, meaning, example.

use super::Kind::{
    Choice, Choices, Count, Formula, Formulas, FormulasOr, Name, Number, NumberOrFalse, Numbers, Side,
    SideOr, Sides, Tables, Text, Truth, Variant, Vector,
};
use super::{
    ANY, IN_SPACE, IN_SPACE_AND_TIME, Kind, NOT_NEGATIVE, POSITIVE, Range, Table, key, schemes, shapes,
};

/// The whole file.
pub const CASE: Table = Table {
    name: "the case",
    doc: "One simulation of impact or contact of deformable bodies.",
    keys: &[
        key("title", Text, "Title for figures and pages; the file's name if left out.")
            .optional()
            .example("\"Two bars\""),
        key("dimension", Kind::Count(1), "Space dimension: 1 (bars) or 2.").example("2"),
        key(
            "plane",
            Choice(&["strain", "stress"], &["axisymmetric"]),
            "Plane state in dimension 2: no strain across the plane, or no stress (the thickness is that of the undeformed sheet).",
        )
            .default("\"strain\""),
        key("thickness", Number(POSITIVE), "Out-of-plane thickness; in dimension 1 the area of the cross-section.")
            .unit("length, or length² in dimension 1")
            .default("1.0"),
        key("units", Kind::Table(&UNITS), "Labels for figures and columns; nothing is converted.")
            .optional()
            .example("{ length = \"m\", time = \"s\", mass = \"kg\" }"),
        key("preset", Choice(&["default", "paper"], &[]), "Set of defaults; keys that are given still win.")
            .default("\"default\""),
        key("material", Tables(&MATERIAL), "A material bodies refer to by name."),
        key("body", Tables(&BODY), "A deformable body."),
        key("support", Tables(&SUPPORT), "Sides held or moved in some directions.").optional(),
        key("load", Tables(&LOAD), "Forces on a side or in a body.").optional(),
        key(
            "initial",
            Kind::Table(&INITIAL),
            "Where the bodies are at the start, if not in their reference positions.",
        )
        .optional(),
        key(
            "manufactured",
            Kind::Table(&MANUFACTURED),
            "A motion whose load, boundary and start are derived from it, to measure errors against.",
        )
        .optional(),
        key("contact", Tables(&CONTACT), "Two sides that may touch.").optional(),
        key("time", Kind::Table(&TIME), "Time interval, step and scheme."),
        key("newton", Kind::Table(&NEWTON), "Newton's method.").optional(),
        key("probe", Tables(&PROBE), "A point whose quantities become columns of history.csv.").optional(),
        key("output", Kind::Table(&OUTPUT), "What is written, and when.").optional(),
        key(
            "exact",
            Kind::ByColumn,
            "What columns should be, as formulas in t: for `formula = \"exact\"` in [[expect]], and a study's `reference = \"exact\"`.",
        )
        .optional()
        .example("{ \"A.uy\" = \"-0.5*9.81*t^2\" }"),
        key("expect", Tables(&EXPECT), "An expected value: makes the case a test.").optional(),
    ],
    later: &[],
};

const UNITS: Table = Table {
    name: "units",
    doc: "Labels for figures and columns; nothing is converted.",
    keys: &[
        key("length", Text, "Label of lengths.").default("\"m\""),
        key("time", Text, "Label of times.").default("\"s\""),
        key("mass", Text, "Label of masses.").default("\"kg\""),
    ],
    later: &[],
};

const MATERIAL: Table = Table {
    name: "[[material]]",
    doc: "A hyperelastic material: lambda and mu, or young and poisson.",
    keys: &[
        key("name", Name, "Name bodies refer to.").example("\"rubber\""),
        key(
            "law",
            Choice(&["neo-hookean", "saint-venant-kirchhoff", "linear-elastic"], &[]),
            "Constitutive law.",
        )
        .example("\"neo-hookean\""),
        key("density", Number(NOT_NEGATIVE), "Mass per reference volume; 0: massless.")
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
            "Poisson's ratio, with young.",
        )
        .optional()
        .example("0.465"),
    ],
    later: &[],
};

const BODY: Table = Table {
    name: "[[body]]",
    doc: "A deformable body; its sides are called name.side.",
    keys: &[
        key("name", Name, "Name; sides are called name.side.").example("\"cylinder\""),
        key("material", Name, "Name of its material.").example("\"rubber\""),
        key(
            "element",
            Choice(&["L2", "L3", "L4", "T3", "T6", "T10"], &[]),
            "Cell type: L2 L3 L4 in dimension 1, T3 T6 T10 in dimension 2.",
        )
        .example("\"T6\""),
        key("mesh", Variant(shapes), "Shape and fineness.")
            .example("{ shape = \"rectangle\", min = [0.0, 0.0], max = [1.0, 1.0], cells = [8, 8] }"),
        key("place", Kind::Table(&PLACE), "Turns and moves the mesh before anything else sees it.")
            .optional()
            .example("{ rotate = 30.0, about = [0.0, 0.0], shift = [0.0, 1.0] }"),
        key("position", Formulas(IN_SPACE), "Positions at t = 0 of the places X, Y: the body starts strained; X, Y if left out.")
            .unit("length")
            .optional()
            .example("[\"X + 0.1*X*Y\", \"Y\"]"),
        key("gravity", Vector, "Acceleration by gravity; zero if left out.")
            .unit("length/time²")
            .optional()
            .example("[0.0, -9.81]"),
        key(
            "velocity",
            FormulasOr(IN_SPACE, &VELOCITY),
            "Initial velocity, uniform or formulas in X, Y; zero if left out.",
        )
        .unit("length/time")
        .optional()
        .example("[0.0, -1.0]"),
        key(
            "mass",
            Choice(&["consistent", "lumped", "redistributed", "redistributed-nearest"], &[]),
            "Mass matrix: consistent, diagonal by scaling (HRZ), or without mass on the nodes of contacts: total, centre and second moments kept by the \
             least change of the other nodes, or the lost mass given to the next nodes.",
        )
        .default("\"consistent\""),
    ],
    later: &[],
};

const VELOCITY: Table = Table {
    name: "velocity",
    doc: "Initial velocity of a rigid motion: linear + angular × (X − about).",
    keys: &[
        key("linear", Vector, "Velocity of the point `about`; zero if left out.")
            .unit("length/time")
            .optional()
            .example("[0.0, -1.0]"),
        key("angular", Number(ANY), "Angular velocity, anticlockwise, in dimension 2.")
            .unit("1/time")
            .default("0.0"),
        key("about", Vector, "Centre of the rotation, needed with angular.")
            .unit("length")
            .optional()
            .example("[0.0, 1.0]"),
    ],
    later: &[],
};

const PLACE: Table = Table {
    name: "place",
    doc: "Turns and moves a mesh, built in or from a file: first the rotation, then the shift.",
    keys: &[
        key("rotate", Number(ANY), "Angle counter-clockwise; dimension 2.").unit("degrees").default("0.0"),
        key("about", Vector, "Point it turns about; the origin if left out.")
            .unit("length")
            .optional()
            .example("[0.0, 0.0]"),
        key("shift", Vector, "Distance it is moved by; zero if left out.")
            .unit("length")
            .optional()
            .example("[0.0, 1.0]"),
    ],
    later: &[],
};

const SUPPORT: Table = Table {
    name: "[[support]]",
    doc: "Sides held in some directions with fix, or moved with move.",
    keys: &[
        key("name", Name, "A named support records its reactions.").optional().example("\"floor\""),
        key("on", Sides, "Sides that are held.").example("[\"prism.bottom\"]"),
        key("fix", Choices(&["x", "y"]), "Directions that are held.").optional().example("[\"x\", \"y\"]"),
        key(
            "move",
            Kind::Table(&MOVE),
            "Directions that are moved: displacements, zero at t = 0; velocity and acceleration are the formula's own.",
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
    doc: "Forces on sides (on, with traction or pressure) or in a body (body, with body_force). Formulas in X, Y (reference place) and t.",
    keys: &[
        key("name", Name, "Name in messages.").optional().example("\"press\""),
        key("on", Sides, "Sides that are loaded, with traction or pressure.")
            .optional()
            .example("[\"prism.top\"]"),
        key("body", Name, "Body that is loaded, with body_force.").optional().example("\"prism\""),
        key("traction", Formulas(IN_SPACE_AND_TIME), "Dead force per reference area.")
            .unit("mass/(length·time²)")
            .optional()
            .example("[\"0\", \"-5*min(t/0.1, 1)\"]"),
        key(
            "pressure",
            Formula(IN_SPACE_AND_TIME),
            "Follower force per current area, against the outward normal.",
        )
        .unit("mass/(length·time²)")
        .optional()
        .example("\"2*t\""),
        key("body_force", Formulas(IN_SPACE_AND_TIME), "Dead force per reference volume.")
            .unit("mass/(length²·time²)")
            .optional()
            .example("[\"0\", \"-3*X\"]"),
        key(
            "table",
            Text,
            "CSV file with columns t, value: a factor, linear between its lines, on the load.",
        )
        .optional()
        .example("\"amplitude.csv\""),
    ],
    later: &[],
};

const INITIAL: Table = Table {
    name: "[initial]",
    doc: "Start from the end of another run of the same meshes; time begins at 0 anew.",
    keys: &[
        key("from", Text, "Directory of the finished run, from the folder of the case.")
            .example("\"runs/preload\""),
        key("velocities", Choice(&["keep", "zero"], &[]), "Whether its velocities are taken over.")
            .default("\"keep\""),
    ],
    later: &[],
};

const MANUFACTURED: Table = Table {
    name: "[manufactured]",
    doc: "A motion of all bodies: the load is ρÿ − Div P, the nodes of the boundary move with it, and history.csv gets error_l2 and error_h1.",
    keys: &[key("y", Formulas(IN_SPACE_AND_TIME), "Positions at the time t of the places X, Y.")
        .unit("length")
        .example("[\"X + 0.1*sin(X + 2*Y)*t\", \"Y - 0.1*cos(X*Y)*t\"]")],
    later: &[],
};

const CONTACT: Table = Table {
    name: "[[contact]]",
    doc: "Two sides that may touch.",
    keys: &[
        key("name", Name, "Name in records and messages.").example("\"strike\""),
        key("secondary", Side, "Side whose nodes are kept out of the primary.").example("\"cylinder.arc\""),
        key("primary", SideOr(&RIGID), "Side, or rigid plane, they are kept out of.").example("\"prism.top\""),
        key("method", Choice(&["node-to-segment"], &["mortar"]), "Discretisation of the contact.")
            .default("\"node-to-segment\""),
        key(
            "enforcement",
            Choice(&["multiplier", "penalty"], &["augmented"]),
            "How the constraint is kept: exactly, by a multiplier, or by springs whose energy counts as strain energy.",
        )
        .default("\"multiplier\""),
        key("stiffness", Number(POSITIVE), "Of a penalty: times the reference stiffness of the secondary node.")
            .default("10.0"),
        key(
            "law",
            Choice(&["position", "predictor", "velocity"], &[]),
            "What contact holds: positions at the end, those and the predictor y + Δt v (contact-stabilised), or velocities by impulses; the one of \
             the scheme if left out.",
        )
        .optional()
        .example("\"position\""),
        key(
            "force",
            Choice(&["alpha_f", "end"], &[]),
            "When in a step the contact force acts: averaged with α_f (eq. 15), or at its end.",
        )
        .default("\"alpha_f\""),
        key(
            "persistency",
            Choice(&["project", "none"], &[]),
            "Velocities and accelerations where contact begins: projected on the constraints, or left.",
        )
        .default("\"project\"")
        .paper("\"none\""),
        key(
            "active_set",
            Choice(&["within", "after"], &[]),
            "The active set may change within Newton's method, or after it converged.",
        )
        .default("\"within\"")
        .paper("\"after\""),
        key(
            "detection",
            Choice(&["closest-point", "trajectory"], &[]),
            "Which gap decides: at the closest point, or at the trajectory's ξ (eq. 8 as printed).",
        )
        .default("\"closest-point\"")
        .paper("\"trajectory\""),
        key(
            "restitution",
            Number(RESTITUTION),
            "Newton's e of a contact that holds velocities; of paoli-schatzman the share of the old position.",
        )
        .default("0.0"),
    ],
    later: &["passes", "normals", "overlap", "between", "friction"],
};

const RESTITUTION: Range = Range { low: Some((0.0, true)), high: Some((1.0, true)) };

const RIGID: Table = Table {
    name: "a rigid primary",
    doc: "A primary that does not deform.",
    keys: &[key("plane", Kind::Table(&PLANE), "A rigid half-space.")
        .example("{ point = [0.0, 0.0], normal = [0.0, 1.0] }")],
    later: &["circle", "motion"],
};

const PLANE: Table = Table {
    name: "plane",
    doc: "A rigid half-space.",
    keys: &[
        key("point", Vector, "A point of its boundary.").unit("length").example("[0.0, 0.0]"),
        key("normal", Vector, "Direction out of it, of any length > 0.").example("[0.0, 1.0]"),
    ],
    later: &[],
};

const TIME: Table = Table {
    name: "[time]",
    doc: "Time interval, step and scheme.",
    keys: &[
        key("end", Number(POSITIVE), "End time, a multiple of the step.").unit("time").example("0.75"),
        key("step", Number(POSITIVE), "Time step.")
            .unit("time")
            .example("1.875e-3")
            .later("a table { initial, min, max, … }"),
        key("scheme", Variant(schemes), "Time integrator.")
            .example("{ kind = \"chung-hulbert\", rho_inf = 0.1 }"),
        key(
            "energy_guard",
            NumberOrFalse(POSITIVE),
            "Fraction of the largest energy so far by which total − external_work may rise above its running minimum before the run stops; false: never.",
        )
        .default("0.02")
        .paper("false"),
    ],
    later: &[],
};

const NEWTON: Table = Table {
    name: "[newton]",
    doc: "Newton's method.",
    keys: &[
        key(
            "tolerance",
            Number(Range { low: Some((0.0, false)), high: Some((1.0, false)) }),
            "‖Δy‖∞/L and ‖r‖/Σ‖f‖ at convergence.",
        )
        .default("1e-9"),
        key("max_iterations", Count(1), "Iterations before a step is rejected.").default("20"),
        key(
            "tangent",
            Choice(&["frozen", "frozen-double", "full"], &[]),
            "A factored tangent is kept over iterations and steps as a preconditioner while that pays (factors of 10 000 unknowns and more in single precision where that is enough, or all in double), or the tangent is formed and factored in every iteration.",
        )
        .default("\"frozen\""),
        key(
            "mixing",
            Count(0),
            "Earlier corrections with the kept factor that the next one is improved by: the restart length of the Krylov method; 0 switches it off.",
        )
        .default("4"),
    ],
    later: &[],
};

const PROBE: Table = Table {
    name: "[[probe]]",
    doc: "A point whose quantities become columns name.quantity.",
    keys: &[
        key("name", Name, "Name; columns are name.quantity.").example("\"A\""),
        key("at", Vector, "Reference point of the body.").unit("length").example("[0.0, 1.5]"),
        key("body", Name, "Body it belongs to.").example("\"cylinder\""),
        key(
            "record",
            Choices(QUANTITIES),
            "Displacement, velocity, acceleration, Cauchy stress, volume ratio.",
        )
        .example("[\"uy\", \"sigma_yy\"]"),
    ],
    later: &[],
};

const QUANTITIES: &[&str] =
    &["ux", "uy", "vx", "vy", "ax", "ay", "sigma_xx", "sigma_yy", "sigma_xy", "von_mises", "det_f"];

const OUTPUT: Table = Table {
    name: "[output]",
    doc: "What is written, and when.",
    keys: &[
        key(
            "fields_every",
            Count(0),
            "Fields every so many steps, 0: none; 20 if left out, or 0 if at_times is given.",
        )
        .optional()
        .example("20"),
        key(
            "format",
            Choice(&["vtu", "vtkhdf"], &[]),
            "Fields as a VTU file each with fields.pvd, or in one file, fields.vtkhdf.",
        )
        .default("\"vtu\""),
        key("at_times", Numbers, "Fields at the steps nearest to these times.").unit("time").default("[]"),
        key("history_every", Count(1), "Rows of history.csv every so many steps.").default("1"),
        key("checkpoint_every", Count(1), "Checkpoints every so many steps.").default("50"),
    ],
    later: &[],
};

/// One expected value, of a case, an arm or a study.
pub const EXPECT: Table = Table {
    name: "[[expect]]",
    doc: "An expected value with value and tolerance, value and relative, at_most, or at_least; with a formula, tolerance alone is enough.",
    keys: &[
        key(
            "what",
            Text,
            "min | max | first | last | at T | time of min | time of max | range | drift | peak | rms of a column or of [ columns with + - * / ], a \
             metric by name, `stopped`, or an expression of these; blanks around every sign.",
        )
        .example("\"min A.uy\""),
        key("formula", Text, "What the column `what` should be, in t: its largest (norm) deviation from it is what is bounded.")
            .optional()
            .example("\"-0.5*9.81*t^2\""),
        key(
            "norm",
            Choice(&["max", "rms"], &[]),
            "How a deviation is measured: largest value, or root of the mean square over the rows; max if left out, rms for an order.",
        )
        .optional()
        .example("\"rms\""),
        key("scale", Number(POSITIVE), "What divides the deviation.").default("1.0"),
        key("after", Number(ANY), "Only rows after this time, strictly, count.").unit("time").optional().example("0.52"),
        key("before", Number(ANY), "Only rows before this time, strictly, count.").unit("time").optional().example("1.147"),
        key("value", Number(ANY), "Expected value.").optional().example("-0.7827"),
        key("tolerance", Number(NOT_NEGATIVE), "Absolute tolerance.").optional().example("4e-3"),
        key("relative", Number(NOT_NEGATIVE), "Relative tolerance.").optional().example("0.01"),
        key("at_most", Number(ANY), "Upper bound.").optional().example("0.0"),
        key("at_least", Number(ANY), "Lower bound.").optional().example("0.0"),
        key("source", Text, "Where the expected value comes from.").optional().example("\"exact solution\""),
        key("of", Text, "In a study, with what = \"order\": the question, or column, whose order of convergence is observed.")
            .optional()
            .example("\"last A.uy\""),
        key("against", Text, "With what = \"order\": the key of the case the arms differ in.")
            .optional()
            .example("\"time.step\""),
        key("where", Text, "With what = \"order\": only arms whose names contain these whole words.").optional().example("\"hu\""),
        key("exact", Number(ANY), "With what = \"order\": the exact value, from which errors are taken.").optional().example("1.0"),
        key("slow", Truth, "Left out by `carom verify --fast`.").default("false"),
    ],
    later: &[],
};
