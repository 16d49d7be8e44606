//! Keys of contacts and rigid obstacles.

use super::Kind::{Choice, Formula, Formulas, Name, Number, Side, SideOr, Truth, Vector};
use super::{IN_SPACE_AND_TIME, IN_TIME, Key, Kind, NOT_NEGATIVE, POSITIVE, Range, Table, key, table};

pub(super) const CONTACT: Table = table(
    "[[contact]]",
    "A contact pair: two sides that may come into contact.",
    &[
        key("name", Name, "Name used in records and messages.").example("\"strike\""),
        key("secondary", Side, "Secondary (slave) side: its nodes must not penetrate the primary. `body.skin` is the whole boundary of a body.").example("\"cylinder.arc\"").unless("between"),
        key("primary", SideOr(&RIGID), "Primary (master) side, or a rigid obstacle: a table with one of \
            `plane`, `circle`, `sphere`, `cylinder`, `polyline` and `surface`. If it is the secondary side, this side is in contact \
            with itself.").example("\"prism.top\"").unless("between"),
        key(
            "between",
            Kind::Between,
            "In place of `secondary` and `primary`: contact between all pairs of bodies and of each with \
             itself, for \"all\" bodies or those listed, on their whole boundaries or on a side `body.side`. \
             Of two bodies the softer one (smaller λ + 2μ) is secondary; if they are equal, the first. A \
             pair of bodies with a [[contact]] of its own is excluded. Contacts are named NAME-BODY-BODY and \
             NAME-BODY, or NAME if there is one.",
        )
        .optional("\"all\""),
        key("self", Truth, "With `between`: whether bodies are in contact with themselves, where their boundary folds.").default("true"),
        key("method", Choice(&["node-to-segment"], &["mortar"]), "Discretisation of the contact.")
            .default("\"node-to-segment\""),
        key(
            "enforcement",
            Choice(&["multiplier", "penalty", "augmented"], &[]),
            "How the constraint is enforced: exactly by a Lagrange multiplier; by penalty springs whose energy counts as strain energy; or by an \
             augmented Lagrangian, springs on multipliers that are updated in rounds (Uzawa iterations) until gaps of closed nodes and slips of \
             sticking ones are below 1e-10 of the size of the model.",
        )
        .default("\"multiplier\""),
        key(
            "stiffness",
            Number(POSITIVE),
            "Stiffness of the springs: of a penalty, as a multiple of the reference stiffness of the secondary node; of an augmented Lagrangian, of \
             the diagonal of the step's tangent at the node, which changes the number of rounds; far too soft springs may bisect a step.",
        )
            .default("10.0"),
        key(
            "law",
            Choice(&["position", "predictor", "velocity"], &[]),
            "What contact constrains: positions at the end of the step; positions and the predictor y + Δt v (contact-stabilised); or velocities, \
             by impulses. Default: the law of the scheme.",
        )
        .optional("\"position\""),
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
            "overlap",
            Choice(&["refuse", "relax", "keep-gap"], &[]),
            "Overlap of the bodies at the start: an error; closed before the start, which leaves the bodies in equilibrium under the pressure of an \
             interference fit; or allowed, with the depth of every node at the start added to its gap.",
        )
        .default("\"refuse\""),
        key(
            "mu",
            Formula(IN_SPACE_AND_TIME),
            "Coefficient of Coulomb friction μ, for the slip of the secondary side on the primary one: a node sticks while its tangential force is \
             less than μ times its normal force, and otherwise slips against exactly this force. A number, or a formula of the node's reference \
             position and time. 0: no friction. Default: no friction, or that of `shear`. Dimensions 2 and 3.",
        )
        .optional("0.3"),
        key(
            "mu_dynamic",
            Number(NOT_NEGATIVE),
            "Coefficient of friction of a node that slips, at most `mu`, which is then that of a node that \
             sticks. Where a formula `mu` is smaller, it is used for both. Default: `mu`.",
        )
        .optional("0.2"),
        key(
            "decay",
            Number(POSITIVE),
            "Rate c of the transition to `mu_dynamic`: at a slip rate v, μ = mu_dynamic + (mu − mu_dynamic) \
             exp(−c v). In load steps, v is the rate in the time of their formulas. Default: an immediate \
             transition.",
        )
        .unit("time/length")
        .optional("10.0"),
        key(
            "shear",
            Number(POSITIVE),
            "Largest tangential stress (Tresca friction): a node slips against this stress times its area in the reference configuration if μ times \
             its normal force is larger, or if `mu` is not given.",
        )
        .unit("stress")
        .optional("1e3"),
        key(
            "stick_stiffness",
            Number(POSITIVE),
            "Stiffness of the tangential spring of a node that sticks, as `stiffness`. With enforcement = \"penalty\" its energy counts as strain \
             energy. Default: `stiffness`.",
        )
        .optional("10.0"),
        key(
            "restitution",
            Number(RESTITUTION),
            "Coefficient of restitution e: Newton's, for contact laws on velocities; with energy-momentum \
             and multipliers, e² is the fraction of the energy lost in contact that is returned where nodes \
             close or open (1 elastic, 0 inelastic); with paoli-schatzman, the weight of the previous \
             position.",
        )
        .default("0.0"),
    ],
).later(&["passes", "normals"]);

const RESTITUTION: Range = Range { low: Some((0.0, true)), high: Some((1.0, true)) };

const RIGID: Table = table(
    "a rigid primary",
    "A primary surface that does not deform: exactly one shape, fixed, moved by `motion`, or free with `mass`.",
    &[
        key("plane", Kind::Table(&PLANE), "A rigid half-space.")
            .optional("{ point = [0.0, 0.0], normal = [0.0, 1.0] }"),
        key("circle", Kind::Table(&CIRCLE), "A rigid circle, with bodies outside or inside it; dimension 2.")
            .optional("{ center = [0.0, 0.0], radius = 1.0, inside = true }"),
        key("sphere", Kind::Table(&SPHERE), "A rigid sphere, with bodies outside or inside it; dimension 3.")
            .optional("{ center = [0.0, 0.0, 0.0], radius = 1.0, inside = true }"),
        key("cylinder", Kind::Table(&CYLINDER), "A rigid infinite cylinder, with bodies outside or inside it; dimension 3.")
            .optional("{ point = [0.0, 0.0, 0.0], axis = [0.0, 1.0, 0.0], radius = 0.5 }"),
        key("surface", Kind::Table(&SURFACE), "A rigid triangulated surface from a file, with bodies outside it; dimension 3.")
            .optional("{ file = \"part.stl\" }"),
        key("polyline", Kind::Table(&POLYLINE), "A rigid chain of segments, solid to the left of the direction of travel; dimension 2.")
            .optional("{ points = [[2.0, 0.0], [0.0, 0.0], [-2.0, 1.0]], radius = 0.1 }"),
        key(
            "motion",
            Kind::Table(&MOTION),
            "Prescribed motion by formulas in t, with implicit schemes. Its reaction forces are recorded under the name of the contact, and its work is external_work.",
        )
        .optional("{ x = \"0.1*t\" }"),
        key(
            "mass",
            Number(POSITIVE),
            "Mass of an obstacle that is free in translation and does not turn; its position and velocity are recorded under the name of the contact.",
        )
        .unit("mass")
        .optional("0.5"),
        key("velocity", Vector, "Initial velocity, with `mass`. Default: zero.")
            .unit("length/time")
            .optional("[0.0, -1.0]"),
        key("gravity", Formulas(IN_TIME), "Gravitational acceleration, with `mass`: numbers, or formulas in t. Default: zero.")
            .unit("length/time²")
            .optional("[0.0, -9.81]"),
    ],
).later(&["spring"]);

const CIRCLE: Table = table(
    "circle",
    "A rigid circle.",
    &[
        key("center", Vector, "Its centre.").unit("length").example("[0.0, 0.0]"),
        key("radius", Number(POSITIVE), "Its radius.").unit("length").example("1.0"),
        INSIDE,
    ],
);

const SPHERE: Table = table(
    "sphere",
    "A rigid sphere.",
    &[
        key("center", Vector, "Its centre.").unit("length").example("[0.0, 0.0, 0.0]"),
        key("radius", Number(POSITIVE), "Its radius.").unit("length").example("1.0"),
        INSIDE,
    ],
);

const CYLINDER: Table = table(
    "cylinder",
    "A rigid infinite cylinder.",
    &[
        key("point", Vector, "A point of its axis.").unit("length").example("[0.0, 0.0, 0.0]"),
        key("axis", Vector, "Direction of its axis, of any length > 0.").example("[0.0, 1.0, 0.0]"),
        key("radius", Number(POSITIVE), "Its radius.").unit("length").example("0.5"),
        INSIDE,
    ],
);

const INSIDE: Key = key("inside", Truth, "Whether bodies are inside it; outside otherwise.").default("false");

const SURFACE: Table = table(
    "surface",
    "A rigid triangulated surface, with the vertices of its triangles counter-clockwise as seen from \
        outside. It may be closed, or open: past its rim there is no contact, and behind it a body is inside. \
        Nodes of bodies must not penetrate it; its own edges and vertices do not meet facets of bodies between \
        their nodes. A node that slides across a convex edge of more than 30° leaves the surface; in a groove \
        it is constrained by one of the faces only.",
    &[
        key("file", Kind::Text, "A file in STL, text or binary, or a .msh of Gmsh with triangles of order 1; relative to the folder of the case.")
            .example("\"part.stl\""),
        key("group", Kind::Text, "Physical surface of a .msh. Default: all triangles of the file.").optional("\"tool\""),
        key("scale", Number(POSITIVE), "Factor of the coordinates of the file.").default("1.0"),
        key("reverse", Truth, "Whether inside and outside are exchanged.").default("false"),
    ],
);

const POLYLINE: Table = table(
    "polyline",
    "A rigid chain of straight segments, with the rigid material to the left of the direction of travel.",
    &[
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
            "Radius of the arcs that round the corners, tangent to both segments; 0: sharp corners. At a \
             sharp concave corner a node is constrained by one of the segments only.",
        )
        .unit("length")
        .default("0.0"),
    ],
);

const MOTION: Table = table(
    "motion",
    "Prescribed motion of a rigid obstacle, zero at t = 0: rotation about a point that moves with it.",
    &[
        key("x", Formula(IN_TIME), "Displacement along x.").unit("length").optional("\"0.1*t\""),
        key("y", Formula(IN_TIME), "Displacement along y; dimensions 2 and 3.")
            .unit("length")
            .optional("\"-0.1*t\""),
        key("z", Formula(IN_TIME), "Displacement along z; dimension 3.")
            .unit("length")
            .optional("\"-0.1*t\""),
        key("rotate", Formula(IN_TIME), "Angle of rotation, counter-clockwise; dimension 2.")
            .unit("degrees")
            .optional("\"360*t\""),
        key("about", Vector, "Centre of the rotation at t = 0; required with `rotate`.")
            .unit("length")
            .optional("[0.0, 0.0]"),
    ],
);

const PLANE: Table = table(
    "plane",
    "A rigid half-space.",
    &[
        key("point", Vector, "A point on its boundary.").unit("length").example("[0.0, 0.0]"),
        key("normal", Vector, "Outward normal, of any length > 0.").example("[0.0, 1.0]"),
    ],
);
