//! Keys of meshes: built-in shapes and files.

use super::Kind::{Choices, Count, Counts, Direction, Number, Points, Tables, Text, Truth, Variant, Vector};
use super::{ANY, Key, NOT_NEGATIVE, POSITIVE, Table, Variants, key, table};

/// Built-in shapes.
pub fn shapes() -> &'static Variants {
    &SHAPES
}

const SHAPES: Variants = Variants {
    name: "mesh",
    tag: "shape",
    doc: "Built-in shape.",
    tables: &[
        ("interval", INTERVAL),
        ("rectangle", RECTANGLE),
        ("box", BOX),
        ("ball", BALL),
        ("cylinder", CYLINDER),
        ("tube", TUBE),
        ("extrusion", EXTRUSION),
        ("disc", DISC),
        ("half-disc", HALF_DISC),
        ("ring", RING),
        ("polygon", POLYGON),
    ],
    or: Some(&MESH_FILE),
    dimension: None,
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
};

const INTERVAL: Table = table(
    "mesh of shape \"interval\"",
    "Dimension 1; sides left, right.",
    &[
        key("min", Number(ANY), "Left end.").unit("length").example("0.0"),
        key("max", Number(ANY), "Right end.").unit("length").example("1.0"),
        key("cells", Count(1), "Number of cells.").example("20"),
    ],
);

const BOX: Table = table(
    "mesh of shape \"box\"",
    "Dimension 3; sides left, right (along x), front, back (along y), bottom, top (along z).",
    &[
        key("min", Vector, "Lowest corner.").unit("length").example("[0.0, 0.0, 0.0]"),
        key("max", Vector, "Highest corner.").unit("length").example("[1.0, 1.0, 1.0]"),
        key("cells", Counts(1), "Number of boxes along x, y and z, each a hexahedron or split into six tetrahedra; or give `size`.")
            .optional("[8, 4, 4]"),
        key("size", Number(POSITIVE), "Largest side length of the boxes; or give `cells`.")
            .unit("length")
            .optional("0.1"),
        SYMMETRY,
    ],
);

const BALL: Table = table(
    "mesh of shape \"ball\"",
    "Dimension 3; side sphere, and plane_x, plane_y, plane_z where planes of symmetry cut it.",
    &[RADIUS, key("center", Vector, "Centre.").unit("length").example("[0.0, 0.0, 1.0]"), SIZE, SYMMETRY],
);

const CYLINDER: Table = table(
    "mesh of shape \"cylinder\"",
    "Dimension 3; sides side, bottom, top, and plane_x, plane_y, plane_z where planes of symmetry cut it.",
    &[RADIUS, HEIGHT, BOTTOM, AXIS, SIZE, SYMMETRY],
);

const TUBE: Table = table(
    "mesh of shape \"tube\"",
    "Dimension 3; sides inner, outer, bottom, top, and plane_x, plane_y, plane_z where planes of symmetry cut it.",
    &[
        key("inner", Number(POSITIVE), "Inner radius.").unit("length").example("0.4"),
        key("outer", Number(POSITIVE), "Outer radius.").unit("length").example("0.5"),
        HEIGHT,
        BOTTOM,
        AXIS,
        SIZE,
        SYMMETRY,
    ],
);

const EXTRUSION: Table = table(
    "mesh of shape \"extrusion\"",
    "Dimension 3; a plane shape or a plane mesh of a file from z = 0 to its height; its sides, \
        and bottom, top (base, lid if it has sides of these names), and plane_x, plane_y, plane_z \
        where planes of symmetry cut it.",
    &[
        key(
            "of",
            Variant(plane_shapes),
            "The plane shape, or a surface of a Gmsh file; its cells are \
            the faces of the solid cells.",
        )
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
        .optional("[\"z\"]"),
    ],
);

const RECTANGLE: Table = table(
    "mesh of shape \"rectangle\"",
    "Sides bottom, right, top, left.",
    &[
        key("min", Vector, "Lower left corner.").unit("length").example("[0.0, 0.0]"),
        key("max", Vector, "Upper right corner.").unit("length").example("[1.0, 1.0]"),
        key("cells", Counts(1), "Number of squares along x and y, each a quadrilateral or split into two triangles; or give `size`.")
            .optional("[8, 4]"),
        key("size", Number(POSITIVE), "Largest side length of the squares; or give `cells`.")
            .unit("length")
            .optional("0.1"),
    ],
);

const DISC: Table = table("mesh of shape \"disc\"", "A whole disc; side arc.", ROUND);

const HALF_DISC: Table = table(
    "mesh of shape \"half-disc\"",
    "The half of a disc to the right of its centre; sides arc, axis.",
    ROUND,
);

const RING: Table = table(
    "mesh of shape \"ring\"",
    "The region between two concentric circles; sides inner, outer.",
    &[
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
);

const POLYGON: Table = table(
    "mesh of shape \"polygon\"",
    "Any simple polygon, convex or not; sides side1 (from the first point to the second), side2, ….",
    &[
        key("points", Points(3), "Corners in order, clockwise or counter-clockwise.")
            .unit("length")
            .example("[[0.0, 0.0], [48.0, 44.0], [48.0, 60.0], [0.0, 44.0]]"),
        key("size", Number(POSITIVE), "Edge length of the cells; smaller where the outline requires it.")
            .unit("length")
            .example("0.1"),
        key("refine", Tables(&REFINE), "Regions of local refinement.")
            .optional("[{ near = [48.0, 60.0], radius = 2.0, size = 0.02 }]"),
    ],
);

const RADIUS: Key = key("radius", Number(POSITIVE), "Radius.").unit("length").example("0.5");

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
.optional("[\"x\", \"y\"]");

const REFINE: Table = table(
    "refine",
    "A region of local refinement; outside its radius, the edge length grows by 3/10 of the distance, up to the size of the mesh.",
    &[
        key("near", Vector, "Centre of the region.").unit("length").example("[48.0, 60.0]"),
        key("radius", Number(NOT_NEGATIVE), "Radius of the region.").unit("length").default("0.0"),
        key("size", Number(POSITIVE), "Edge length of the cells in the region.")
            .unit("length")
            .example("0.02"),
    ],
);

const MESH_FILE: Table = table(
    "mesh from a file",
    "A body from a Gmsh file; its sides are the physical curves (dimension 1: points, dimension 3: surfaces) on its boundary. A group without a name is called by its number.",
    &[
        FILE,
        key("surface", Text, "Name of the physical surface (dimension 1: curve) that is the body; in dimension 3 give `volume`.")
            .unless("volume")
            .example("\"cylinder\""),
        key("volume", Text, "Dimension 3: name of the physical volume that is the body.")
            .optional("\"part\""),
        SLITS,
    ],
);

const PLANE_FILE: Table = table(
    "plane mesh from a file",
    "A surface of a Gmsh file; its sides are the physical curves on its boundary.",
    &[
        FILE,
        key("surface", Text, "Name of the physical surface that is extruded.").example("\"profile\""),
        SLITS,
    ],
);

const FILE: Key =
    key("file", Text, "Path of a .msh file of version 4.1 or 2.2, relative to the folder of the case.")
        .example("\"impact.msh\"");

const SLITS: Key = key(
    "slits",
    Truth,
    "Whether neighbouring cells may have separate nodes at the same place: a closed slit, or pieces that touch. Otherwise this is an error.",
)
.default("false");

const ROUND: &[Key] = &[RADIUS, key("center", Vector, "Centre.").unit("length").example("[0.0, 1.0]"), SIZE];
