//! Keys of meshes: built-in shapes and files.

use super::Kind::{Choices, Count, Counts, Direction, Number, Points, Tables, Text, Truth, Variant, Vector};
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
        ("rectangle", RECTANGLE),
        (
            "box",
            Table {
                name: "mesh of shape \"box\"",
                doc: "Dimension 3; sides left, right (along x), front, back (along y), bottom, top (along z).",
                keys: &[
                    key("min", Vector, "Lowest corner.").unit("length").example("[0.0, 0.0, 0.0]"),
                    key("max", Vector, "Highest corner.").unit("length").example("[1.0, 1.0, 1.0]"),
                    key("cells", Counts(1), "Number of boxes along x, y and z, each a hexahedron or split into six tetrahedra; or give `size`.")
                        .optional()
                        .example("[8, 4, 4]"),
                    key("size", Number(POSITIVE), "Largest side length of the boxes; or give `cells`.")
                        .unit("length")
                        .optional()
                        .example("0.1"),
                    SYMMETRY,
                ],
                later: &[],
            },
        ),
        (
            "ball",
            Table {
                name: "mesh of shape \"ball\"",
                doc: "Dimension 3; side sphere, and plane_x, plane_y, plane_z where planes of symmetry cut it.",
                keys: &[
                    key("radius", Number(POSITIVE), "Radius.").unit("length").example("0.5"),
                    key("center", Vector, "Centre.").unit("length").example("[0.0, 0.0, 1.0]"),
                    SIZE,
                    SYMMETRY,
                ],
                later: &[],
            },
        ),
        (
            "cylinder",
            Table {
                name: "mesh of shape \"cylinder\"",
                doc: "Dimension 3; sides side, bottom, top, and plane_x, plane_y, plane_z where planes of symmetry cut it.",
                keys: &[
                    key("radius", Number(POSITIVE), "Radius.").unit("length").example("0.5"),
                    HEIGHT,
                    BOTTOM,
                    AXIS,
                    SIZE,
                    SYMMETRY,
                ],
                later: &[],
            },
        ),
        (
            "tube",
            Table {
                name: "mesh of shape \"tube\"",
                doc: "Dimension 3; sides inner, outer, bottom, top, and plane_x, plane_y, plane_z where planes of symmetry cut it.",
                keys: &[
                    key("inner", Number(POSITIVE), "Inner radius.").unit("length").example("0.4"),
                    key("outer", Number(POSITIVE), "Outer radius.").unit("length").example("0.5"),
                    HEIGHT,
                    BOTTOM,
                    AXIS,
                    SIZE,
                    SYMMETRY,
                ],
                later: &[],
            },
        ),
        (
            "extrusion",
            Table {
                name: "mesh of shape \"extrusion\"",
                doc: "Dimension 3; a plane shape or a plane mesh of a file from z = 0 to its height; its sides, \
                    and bottom, top (base, lid if it has sides of these names), and plane_x, plane_y, plane_z \
                    where planes of symmetry cut it.",
                keys: &[
                    key("of", Variant(plane_shapes), "The plane shape, or a surface of a Gmsh file; its cells are \
                        the faces of the solid cells.")
                        .example("{ shape = \"ring\", inner = 0.4, outer = 0.5, center = [0.0, 0.0], size = 0.1 }"),
                    key("height", Number(POSITIVE), "Length along z.").unit("length").example("0.2"),
                    key("layers", Count(1), "Number of layers of cells.").example("2"),
                    key(
                        "symmetry",
                        Choices(&["x", "y", "z"]),
                        "Directions in which a plane of symmetry through the middle of the shape cuts it, as of \
                            other shapes: z, which leaves the upper half of the height; x and y of a rectangle; x \
                            of a disc.",
                    )
                    .optional()
                    .example("[\"z\"]"),
                ],
                later: &[],
            },
        ),
        ("disc", DISC),
        ("half-disc", HALF_DISC),
        ("ring", RING),
        ("polygon", POLYGON),
    ],
    or: Some(&MESH_FILE),
    dimension: None,
    later: &[],
    later_keys: &[],
};

/// Shapes of the plane, to be extruded.
fn plane_shapes() -> &'static Variants {
    &PLANE
}

const PLANE: Variants = Variants {
    name: "of",
    tag: "shape",
    doc: "Shape of the plane.",
    tables: &[
        ("rectangle", RECTANGLE),
        ("disc", DISC),
        ("half-disc", HALF_DISC),
        ("ring", RING),
        ("polygon", POLYGON),
    ],
    or: Some(&PLANE_FILE),
    dimension: Some(2),
    later: &[],
    later_keys: &[],
};

const RECTANGLE: Table = Table {
                name: "mesh of shape \"rectangle\"",
                doc: "Sides bottom, right, top, left.",
                keys: &[
                    key("min", Vector, "Lower left corner.").unit("length").example("[0.0, 0.0]"),
                    key("max", Vector, "Upper right corner.").unit("length").example("[1.0, 1.0]"),
                    key("cells", Counts(1), "Number of squares along x and y, each a quadrilateral or split into two triangles; or give `size`.")
                        .optional()
                        .example("[8, 4]"),
                    key("size", Number(POSITIVE), "Largest side length of the squares; or give `cells`.")
                        .unit("length")
                        .optional()
                        .example("0.1"),
                ],
                later: &[],
            };

const DISC: Table =
    Table { name: "mesh of shape \"disc\"", doc: "A whole disc; side arc.", keys: ROUND, later: &[] };

const HALF_DISC: Table = Table {
    name: "mesh of shape \"half-disc\"",
    doc: "The half of a disc to the right of its centre; sides arc, axis.",
    keys: ROUND,
    later: &[],
};

const RING: Table = Table {
                name: "mesh of shape \"ring\"",
                doc: "The region between two concentric circles; sides inner, outer.",
                keys: &[
                    key("inner", Number(POSITIVE), "Radius of the inner circle.").unit("length").example("0.4"),
                    key("outer", Number(POSITIVE), "Radius of the outer circle.").unit("length").example("0.5"),
                    key("center", Vector, "Centre.").unit("length").example("[0.0, 1.0]"),
                    key(
                        "size",
                        Number(POSITIVE),
                        "Edge length of the cells; smaller if the ring is thinner than this length, or if the inner circle would have fewer than twelve edges.",
                    )
                    .unit("length")
                    .example("0.05"),
                ],
                later: &[],
            };

const POLYGON: Table = Table {
    name: "mesh of shape \"polygon\"",
    doc: "Any simple polygon, convex or not; sides side1 (from the first point to the second), side2, ….",
    keys: &[
        key("points", Points(3), "Corners in order, clockwise or counter-clockwise.")
            .unit("length")
            .example("[[0.0, 0.0], [48.0, 44.0], [48.0, 60.0], [0.0, 44.0]]"),
        key("size", Number(POSITIVE), "Edge length of the cells; smaller where the outline requires it.")
            .unit("length")
            .example("0.1"),
        key("refine", Tables(&REFINE), "Regions of local refinement.")
            .optional()
            .example("[{ near = [48.0, 60.0], radius = 2.0, size = 0.02 }]"),
    ],
    later: &[],
};

const HEIGHT: Key = key("height", Number(POSITIVE), "Length along the axis.").unit("length").example("2.0");

const BOTTOM: Key = key("center", Vector, "Centre of the bottom.").unit("length").example("[0.0, 0.0, 0.0]");

const AXIS: Key =
    key("axis", Direction, "Direction from the bottom to the top: a coordinate, or a vector of any length.")
        .default("\"z\"");

const SIZE: Key = key("size", Number(POSITIVE), "Edge length of the cells.").unit("length").example("0.1");

const SYMMETRY: Key = key(
    "symmetry",
    Choices(&["x", "y", "z"]),
    "Directions in which a plane of symmetry through the middle of the shape cuts it; the half with the larger coordinates is meshed, and its cut is the side plane_x, plane_y or plane_z. A cylinder or a tube is cut only if its axis is a coordinate.",
)
.optional()
.example("[\"x\", \"y\"]");

const REFINE: Table = Table {
    name: "refine",
    doc: "A region of local refinement; outside its radius, the edge length grows by 3/10 of the distance, up to the size of the mesh.",
    keys: &[
        key("near", Vector, "Centre of the region.").unit("length").example("[48.0, 60.0]"),
        key("radius", Number(NOT_NEGATIVE), "Radius of the region.").unit("length").default("0.0"),
        key("size", Number(POSITIVE), "Edge length of the cells in the region.")
            .unit("length")
            .example("0.02"),
    ],
    later: &[],
};

const MESH_FILE: Table = Table {
    name: "mesh from a file",
    doc: "A body from a Gmsh file; its sides are the named physical curves (dimension 1: points, dimension 3: surfaces) on its boundary.",
    keys: &[
        FILE,
        key("surface", Text, "Name of the physical surface (dimension 1: curve) that is the body; in dimension 3 give `volume`.")
            .unless("volume")
            .example("\"cylinder\""),
        key("volume", Text, "Dimension 3: name of the physical volume that is the body.")
            .optional()
            .example("\"part\""),
        SLITS,
    ],
    later: &[],
};

const PLANE_FILE: Table = Table {
    name: "plane mesh from a file",
    doc: "A surface of a Gmsh file; its sides are the named physical curves on its boundary.",
    keys: &[
        FILE,
        key("surface", Text, "Name of the physical surface that is extruded.").example("\"profile\""),
        SLITS,
    ],
    later: &[],
};

const FILE: Key =
    key("file", Text, "Path of a .msh file of version 4.1 or 2.2, relative to the folder of the case.")
        .example("\"impact.msh\"");

const SLITS: Key = key(
    "slits",
    Truth,
    "Whether neighbouring cells may have separate nodes at the same place: a closed slit, or pieces that touch. Otherwise this is an error.",
)
.default("false");

const ROUND: &[Key] = &[
    key("radius", Number(POSITIVE), "Radius.").unit("length").example("0.5"),
    key("center", Vector, "Centre.").unit("length").example("[0.0, 1.0]"),
    key("size", Number(POSITIVE), "Edge length of the cells.").unit("length").example("0.1"),
];
