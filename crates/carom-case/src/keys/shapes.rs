//! Shapes of meshes.

use super::Kind::{Count, Counts, Number, Points, Tables, Text, Vector};
use super::{ANY, Key, NOT_NEGATIVE, POSITIVE, Table, Variants, key};

/// Built-in shapes.
pub fn shapes() -> &'static Variants {
    &SHAPES
}

const SHAPES: Variants = Variants {
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
