//! Tables whose keys depend on one of them: shapes of meshes, kinds of schemes.

use super::Kind::{Choice, Count, Counts, Number, Points, Tables, Text, Vector};
use super::{ANY, Key, NOT_NEGATIVE, POSITIVE, Range, Table, Variants, key};

/// Built-in shapes.
pub const SHAPES: Variants = Variants {
    name: "mesh",
    tag: "shape",
    doc: "Built-in shape.",
    tables: &[
        (
            "interval",
            Table {
                name: "mesh of shape \"interval\"",
                doc: "Dimension 1; sides left, right.",
                keys: &[
                    key("min", Number(ANY), "Left end.").unit("length").example("0.0"),
                    key("max", Number(ANY), "Right end.").unit("length").example("1.0"),
                    key("cells", Count(1), "Number of cells.").example("20"),
                ],
                later: &[],
            },
        ),
        (
            "rectangle",
            Table {
                name: "mesh of shape \"rectangle\"",
                doc: "Sides bottom, right, top, left.",
                keys: &[
                    key("min", Vector, "Lower left corner.").unit("length").example("[0.0, 0.0]"),
                    key("max", Vector, "Upper right corner.").unit("length").example("[1.0, 1.0]"),
                    key("cells", Counts(1), "Squares along x and y, each cut into two triangles; or size.")
                        .optional()
                        .example("[8, 4]"),
                    key("size", Number(POSITIVE), "Largest side of the squares; or cells.")
                        .unit("length")
                        .optional()
                        .example("0.1"),
                ],
                later: &[],
            },
        ),
        ("disc", Table { name: "mesh of shape \"disc\"", doc: "A whole disc; side arc.", keys: ROUND, later: &[] }),
        (
            "half-disc",
            Table {
                name: "mesh of shape \"half-disc\"",
                doc: "The half of a disc right of its centre; sides arc, axis.",
                keys: ROUND,
                later: &[],
            },
        ),
        (
            "ring",
            Table {
                name: "mesh of shape \"ring\"",
                doc: "What lies between two concentric circles; sides inner, outer.",
                keys: &[
                    key("inner", Number(POSITIVE), "Radius of the inner circle.").unit("length").example("0.4"),
                    key("outer", Number(POSITIVE), "Radius of the outer circle.").unit("length").example("0.5"),
                    key("center", Vector, "Centre.").unit("length").example("[0.0, 1.0]"),
                    key(
                        "size",
                        Number(POSITIVE),
                        "Length of a cell's edge; shorter where the ring is thinner than that or the inner circle needs twelve.",
                    )
                    .unit("length")
                    .example("0.05"),
                ],
                later: &[],
            },
        ),
        (
            "polygon",
            Table {
                name: "mesh of shape \"polygon\"",
                doc: "Any simple polygon, convex or not; sides side1 (from the first point to the second), side2, ….",
                keys: &[
                    key("points", Points(3), "Corners in order, either way round.")
                        .unit("length")
                        .example("[[0.0, 0.0], [48.0, 44.0], [48.0, 60.0], [0.0, 44.0]]"),
                    key("size", Number(POSITIVE), "Length of a cell's edge; shorter where the outline asks for it.")
                        .unit("length")
                        .example("0.1"),
                    key("refine", Tables(&REFINE), "Places with finer cells.")
                        .optional()
                        .example("[{ near = [48.0, 60.0], radius = 2.0, size = 0.02 }]"),
                ],
                later: &[],
            },
        ),
    ],
    or: Some(&MESH_FILE),
    later: &[],
    later_keys: &[],
};

const REFINE: Table = Table {
    name: "refine",
    doc: "A place with finer cells; from its radius on, edges grow by 3/10 of the distance to the mesh's size.",
    keys: &[
        key("near", Vector, "Its centre.").unit("length").example("[48.0, 60.0]"),
        key("radius", Number(NOT_NEGATIVE), "Edges have the size up to this distance from the centre.")
            .unit("length")
            .default("0.0"),
        key("size", Number(POSITIVE), "Length of a cell's edge there.").unit("length").example("0.02"),
    ],
    later: &[],
};

const MESH_FILE: Table = Table {
    name: "mesh from a file",
    doc: "A body of a Gmsh file; its sides are the named physical curves (dimension 1: points) on its boundary.",
    keys: &[
        key("file", Text, "Path of a .msh file of version 4.1 or 2.2, from the folder of the case.")
            .example("\"impact.msh\""),
        key("surface", Text, "Name of the physical surface (dimension 1: curve) that is the body.")
            .example("\"cylinder\""),
    ],
    later: &[],
};

const ROUND: &[Key] = &[
    key("radius", Number(POSITIVE), "Radius.").unit("length").example("0.5"),
    key("center", Vector, "Centre.").unit("length").example("[0.0, 1.0]"),
    key("size", Number(POSITIVE), "Length of a cell's edge.").unit("length").example("0.1"),
];

const RHO_INF: Range = Range { low: Some((0.0, true)), high: Some((1.0, true)) };
const THETA: Range = Range { low: Some((0.5, true)), high: Some((1.0, true)) };
const BELOW_ONE: Range = Range { low: None, high: Some((1.0, false)) };
const ALPHA: Range = Range { low: Some((0.0, true)), high: Some((1.0, false)) };
const FORCES: Key = key(
    "forces",
    Choice(&["average-forces", "average-state"], &[]),
    "What is averaged over the step with α_f: the forces (eq. 15), or the state they are evaluated at.",
)
.default("\"average-forces\"");
const SPECTRAL_RADIUS: Key =
    key("rho_inf", Number(RHO_INF), "Spectral radius at infinite frequency: 0 damps it within steps, 1 not at all.")
        .example("0.8");
const SPECTRAL: &[Key] = &[SPECTRAL_RADIUS, FORCES];
const RADIUS: &[Key] = &[SPECTRAL_RADIUS];

const fn without_parameters(name: &'static str, doc: &'static str) -> Table {
    Table { name, doc, keys: &[], later: &[] }
}

/// Time integrators.
pub const SCHEMES: Variants = Variants {
    name: "scheme",
    tag: "kind",
    doc: "Published name of the integrator.",
    tables: &[
        (
            "newmark",
            Table {
                name: "scheme \"newmark\"",
                doc: "Newmark: beta and gamma, or rho_inf.",
                keys: &[
                    key("beta", Number(POSITIVE), "Newmark's β.").optional().example("0.25"),
                    key("gamma", Number(POSITIVE), "Newmark's γ.").optional().example("0.5"),
                    key(
                        "rho_inf",
                        Number(RHO_INF),
                        "Spectral radius at infinite frequency, instead of beta and gamma.",
                    )
                    .optional()
                    .example("1.0"),
                    FORCES,
                ],
                later: &[],
            },
        ),
        ("hu", Table { name: "scheme \"hu\"", doc: "Hu: β = 1, γ = 3/2, first order.", keys: &[FORCES], later: &[] }),
        (
            "hht",
            Table {
                name: "scheme \"hht\"",
                doc: "Hilber–Hughes–Taylor.",
                keys: &[
                    key("alpha", Number(ALPHA), "α = α_f ≥ 0: the share of the old forces.").example("0.1"),
                    FORCES,
                ],
                later: &[],
            },
        ),
        ("wbz", Table { name: "scheme \"wbz\"", doc: "Wood–Bossak–Zienkiewicz.", keys: SPECTRAL, later: &[] }),
        (
            "chung-hulbert",
            Table {
                name: "scheme \"chung-hulbert\"", doc: "Chung–Hulbert generalised α.", keys: SPECTRAL, later: &[]
            },
        ),
        (
            "generalized-alpha",
            Table {
                name: "scheme \"generalized-alpha\"",
                doc: "The four parameters as they are.",
                keys: &[
                    key("alpha_m", Number(BELOW_ONE), "Share of the old inertia force.").example("0.0"),
                    key("alpha_f", Number(BELOW_ONE), "Share of the old other forces.").example("0.0"),
                    key("beta", Number(POSITIVE), "Newmark's β.").example("0.25"),
                    key("gamma", Number(POSITIVE), "Newmark's γ.").example("0.5"),
                    FORCES,
                ],
                later: &[],
            },
        ),
        (
            "backward-euler",
            without_parameters("scheme \"backward-euler\"", "All forces at the end; first order, ρ∞ = 0."),
        ),
        ("bdf2", without_parameters("scheme \"bdf2\"", "Two-step backward differentiation; second order, ρ∞ = 0.")),
        (
            "tr-bdf2",
            without_parameters(
                "scheme \"tr-bdf2\"",
                "Trapezoidal rule, then backward differentiation; second order, ρ∞ = 0.",
            ),
        ),
        (
            "bathe",
            Table { name: "scheme \"bathe\"", doc: "Composite rule of Noh and Bathe.", keys: RADIUS, later: &[] },
        ),
        (
            "energy-momentum",
            without_parameters(
                "scheme \"energy-momentum\"",
                "Midpoint rule with a discrete gradient; conserves energy and momenta.",
            ),
        ),
        (
            "central-difference",
            without_parameters(
                "scheme \"central-difference\"",
                "Explicit central differences, lumped mass; contact by forward increments.",
            ),
        ),
        (
            "paoli-schatzman",
            without_parameters(
                "scheme \"paoli-schatzman\"",
                "Explicit, lumped mass; contact with the restitution of [[contact]].",
            ),
        ),
        (
            "moreau-jean",
            Table {
                name: "scheme \"moreau-jean\"",
                doc: "The θ-method with impulses: contact holds velocities.",
                keys: &[key(
                    "theta",
                    Number(THETA),
                    "Share of the new velocity and force: ½ is of order 2, 1 damps most.",
                )
                .example("0.5")],
                later: &[],
            },
        ),
        (
            "nonsmooth-generalized-alpha",
            Table {
                name: "scheme \"nonsmooth-generalized-alpha\"",
                doc: "Chung–Hulbert between impacts, impulses at them.",
                keys: &[key(
                    "rho_inf",
                    Number(RHO_INF),
                    "Spectral radius at infinite frequency: 0 damps it within steps, 1 not at all.",
                )
                .example("0.8")],
                later: &[],
            },
        ),
        (
            "static",
            without_parameters(
                "scheme \"static\"",
                "Equilibrium at every step, without inertia: t is the load parameter.",
            ),
        ),
    ],
    or: None,
    later: &[],
    later_keys: &[],
};
