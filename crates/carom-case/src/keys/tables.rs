//! Keys of the case and of its remaining tables, for each: name, values, unit, default, meaning,
//! example.

use super::Kind::{
    Choice, Choices, Count, Formulas, Name, Number, NumberOrFalse, Numbers, Tables, Text, Truth, Variant,
    Vector,
};
use super::bodies::{BODY, MATERIAL};
use super::contact::CONTACT;
use super::loads::{LOAD, SUPPORT};
use super::{ANY, IN_SPACE_AND_TIME, Kind, NOT_NEGATIVE, POSITIVE, Range, Table, key, schemes, table};
use crate::Quantity;

/// The whole file.
pub const CASE: Table = table(
    "the case",
    "One simulation of impact or contact of deformable bodies.",
    &[
        key("title", Text, "Title of figures and report pages. Default: the name of the file.")
            .optional("\"Two bars\""),
        key("dimension", Kind::Count(1), "Space dimension: 1 (bars), 2 (the plane) or 3.").example("2"),
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
            .optional("{ length = \"m\", time = \"s\", mass = \"kg\" }"),
        key("preset", Choice(&["default", "paper"], &[]), "Set of default values; keys given explicitly take precedence.")
            .default("\"default\""),
        key("material", Tables(&MATERIAL), "A material; bodies refer to it by name."),
        key("body", Tables(&BODY), "A deformable body."),
        key("support", Tables(&SUPPORT), "Displacement boundary condition: sides fixed or moved in given directions.").optional(""),
        key("load", Tables(&LOAD), "A load: traction or pressure on sides, or body force in a body.").optional(""),
        key(
            "initial",
            Kind::Table(&INITIAL),
            "Start from the final state of another run instead of the reference positions.",
        )
        .optional(""),
        key(
            "manufactured",
            Kind::Table(&MANUFACTURED),
            "A manufactured solution: load, boundary motion and initial state are derived from it, and errors are measured against it.",
        )
        .optional(""),
        key("contact", Tables(&CONTACT), "A contact pair: two sides that may come into contact.").optional(""),
        key("time", Kind::Table(&TIME), "Time interval, time step and time integrator."),
        key("newton", Kind::Table(&NEWTON), "Settings of Newton's method.").optional(""),
        key("overlay", Tables(&OVERLAY), "Measured data, drawn with a column of history.csv and compared with it.").optional(""),
        key("probe", Tables(&PROBE), "A material point whose quantities are recorded as columns of history.csv.").optional(""),
        key("output", Kind::Table(&OUTPUT), "What is written, and how often.").optional(""),
        key(
            "exact",
            Kind::ByColumn,
            "Exact solution by column, as formulas in t: used by `formula = \"exact\"` in [[expect]] and by `reference = \"exact\"` in a study.",
        )
        .optional("{ \"A.uy\" = \"-0.5*9.81*t^2\" }"),
        key("expect", Tables(&EXPECT), "An expected value; a case that has one is also a test.").optional(""),
    ],
);

const UNITS: Table = table(
    "units",
    "Unit labels in figures and columns; values are not converted.",
    &[
        key("length", Text, "Unit label of length.").default("\"m\""),
        key("time", Text, "Unit label of time.").default("\"s\""),
        key("mass", Text, "Unit label of mass.").default("\"kg\""),
    ],
);

const INITIAL: Table = table(
    "[initial]",
    "Start from the final state of another run with the same meshes; time starts at 0 again. Or continue from a state that `carom reduce` saved, at its time.",
    &[
        key(
            "from",
            Text,
            "Directory of the finished run, or file of a saved state, relative to the folder of the case.",
        )
        .example("\"runs/preload\""),
        key(
            "velocities",
            Choice(&["keep", "zero"], &[]),
            "Initial velocities: those at the end of the other run, or zero.",
        )
        .default("\"keep\""),
    ],
);

const MANUFACTURED: Table = table(
    "[manufactured]",
    "A manufactured solution for all bodies: the load is ρÿ − Div P, boundary nodes follow the given motion, and history.csv has the columns error_l2 and error_h1.",
    &[key("y", Formulas(IN_SPACE_AND_TIME), "Current positions as formulas in X, Y, Z and t.")
        .unit("length")
        .example("[\"X + 0.1*sin(X + 2*Y)*t\", \"Y - 0.1*cos(X*Y)*t\"]")],
);

const FRACTION: Range = Range { low: Some((0.0, true)), high: Some((1.0, false)) };

const AT_LEAST_ONE: Range = Range { low: Some((1.0, true)), high: None };

const TIME: Table = table(
    "[time]",
    "Time interval, time step and time integrator.",
    &[
        key("end", Number(POSITIVE), "End time, a multiple of the time step.").unit("time").example("0.75"),
        key("step", Number(POSITIVE), "Time step.")
            .unit("time")
            .example("1.875e-3")
            .later("a table { initial, min, max, … }"),
        key(
            "phase",
            Number(FRACTION),
            "Fraction of a step by which all instants are shifted to earlier times: the first step is \
             shorter by it, and the last one has this length. With another phase, contact begins at another \
             instant within a step.",
        )
        .default("0.0"),
        key("scheme", Variant(schemes), "Time integrator.")
            .example("{ kind = \"chung-hulbert\", rho_inf = 0.1 }"),
        key(
            "energy_guard",
            NumberOrFalse(POSITIVE),
            "The run stops if total − external_work rises above its running minimum, beyond the work that the means of a step miss, by more than this fraction of the energy scale so far, the largest kinetic + strain energy or Σ |ΔW| of the external work; false: the run never stops for this reason.",
        )
        .default("0.02")
        .paper("false"),
        key(
            "fallback",
            Choice(&["none", "velocity"], &[]),
            "What takes a grid step at which the run would stop, because no substep is accepted or the energy guard stops it: nothing; or backward \
             Euler with contact implicit in velocity, which dissipates energy in this step. Its steps are counted in the column `fallbacks`. For \
             implicit schemes, multipliers without friction and restitution, and bodies with mass.",
        )
        .default("\"none\""),
    ],
);

const NEWTON: Table = table(
    "[newton]",
    "Settings of Newton's method.",
    &[
        key(
            "tolerance",
            Number(Range { low: Some((0.0, false)), high: Some((1.0, false)) }),
            "Convergence tolerance on ‖Δy‖∞/L and ‖r‖/Σ‖f‖.",
        )
        .default("1e-9"),
        key("max_iterations", Count(1), "Largest number of Newton iterations before a step is rejected. Each may take several linear solves, \
             which the column `newton` counts.").default("40"),
        key(
            "linear",
            Choice(&["auto", "direct", "iterative"], &[]),
            "Linear solver for systems with the tangent. direct: factorisation. iterative: conjugate \
             gradients, preconditioned by the diagonal blocks of the nodes; only the rows of closed contacts \
             are factorised. auto: iterative for dynamics in space with 5 000 unknowns or more and without \
             friction; otherwise direct.",
        )
        .default("\"auto\""),
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
);

const PROBE: Table = table(
    "[[probe]]",
    "A material point whose quantities are recorded as columns name.quantity.",
    &[
        key("name", Name, "Name; its columns are name.quantity.").example("\"A\""),
        key("at", Vector, "Reference position of the point.").unit("length").example("[0.0, 1.5]"),
        key("body", Name, "Body it belongs to.").example("\"cylinder\""),
        key(
            "record",
            Choices(&Quantity::NAMES),
            "Recorded quantities: displacement, velocity, acceleration, Cauchy stress, von Mises stress, volume ratio.",
        )
        .example("[\"uy\", \"sigma_yy\"]"),
    ],
);

const OUTPUT: Table = table(
    "[output]",
    "What is written, and how often.",
    &[
        key(
            "fields_every",
            Count(0),
            "Steps between two outputs of the fields; 0: none. Default: 0 if at_times is given; otherwise about 80 outputs spread over the run, fewer of a large model, and up to 72 more while contact is closed.",
        )
        .optional("20"),
        key(
            "format",
            Text,
            "Field format: one VTU file per output, listed in fields.pvd; Run.to_vtkhdf in Python makes one file of them.",
        )
        .default("\"vtu\""),
        key("at_times", Numbers, "Fields are also written at the steps nearest to these times.")
            .unit("time")
            .default("[]"),
        key("history_every", Count(1), "Steps between two rows of history.csv.").default("1"),
        key("checkpoint_every", Count(1), "Steps between two checkpoints, from which a run that is killed is continued; after a power failure, from the last one that was flushed to the disk (at most one in five seconds).").default("50"),
    ],
);

/// Measured data of a column, of a case or a study.
pub const OVERLAY: Table = table(
    "[[overlay]]",
    "Measured data of one column: drawn with it, and compared by the metrics `overlay_rms:NAME`, `overlay_peak:NAME` and `overlay_shift:NAME`.",
    &[
        key("name", Name, "Name in figures and metrics.").example("\"test-3\""),
        key("file", Text, "CSV file with a line of headings, relative to the folder of the case or study; its lines that begin with # are comments.")
            .example("\"measured.csv\""),
        key("column", Text, "The column of history.csv that was measured.").example("\"A.uy\""),
        key("time", Text, "Heading of the times in the file.").default("\"t\""),
        key("value", Text, "Heading of the values in the file.").default("\"value\""),
        key("time_scale", Number(POSITIVE), "Times of the case in one unit of those of the file: 1e-3 for ms in a case in s.")
            .default("1.0"),
        key("scale", Number(ANY), "Values of the column in one unit of those of the file: −1e-3 for mm downwards in a case in m upwards.")
            .default("1.0"),
        key("source", Text, "Where the data come from.").optional("\"own test, 3 May\""),
    ],
);

/// One expected value, of a case, an arm or a study.
pub const EXPECT: Table = table(
    "[[expect]]",
    "An expected value with one bound: `value` and `tolerance`, `value` and `relative`, `at_most`, or `at_least`. With a `formula`, `tolerance` alone is sufficient.",
    &[
        key(
            "what",
            Text,
            "Quantity: min | max | first | last | at T | time of min | time of max | range | drift | peak | rms of a column or of [ columns with + - * / ]; \
             the name of a metric; `stopped`; or an expression of these. Operators need blanks on both sides.",
        )
        .example("\"min A.uy\""),
        key("formula", Text, "Expected values of the column `what`, as a formula in t; the bound is on the norm of the deviation from it.")
            .optional("\"-0.5*9.81*t^2\""),
        key(
            "norm",
            Choice(&["max", "rms"], &[]),
            "Norm of the deviation: largest absolute value, or root mean square over the rows. Default: max; for an order, rms.",
        )
        .optional("\"rms\""),
        key("scale", Number(POSITIVE), "Number that divides the deviation.").default("1.0"),
        key("after", Number(ANY), "Only rows strictly after this time are used.").unit("time").optional("0.52"),
        key("before", Number(ANY), "Only rows strictly before this time are used.").unit("time").optional("1.147"),
        key("value", Number(ANY), "Expected value.").optional("-0.7827"),
        key("tolerance", Number(NOT_NEGATIVE), "Absolute tolerance.").optional("4e-3"),
        key("relative", Number(NOT_NEGATIVE), "Relative tolerance.").optional("0.01"),
        key("at_most", Number(ANY), "Upper bound.").optional("0.0"),
        key("at_least", Number(ANY), "Lower bound.").optional("0.0"),
        key("source", Text, "Where the expected value comes from.").optional("\"exact solution\""),
        key("of", Text, "In a study, with what = \"order\": the quantity or column whose order of convergence is observed.")
            .optional("\"last A.uy\""),
        key("against", Text, "With what = \"order\": the key of the case that is refined from arm to arm.")
            .optional("\"time.step\""),
        key("where", Text, "With what = \"order\": only arms whose names contain these whole words.").optional("\"hu\""),
        key("exact", Number(ANY), "With what = \"order\": the exact value that errors are computed against.").optional("1.0"),
        key("slow", Truth, "Skipped by `carom verify --fast`.").default("false"),
    ],
);
