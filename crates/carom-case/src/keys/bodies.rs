//! Keys of materials and bodies.

use super::Kind::{Choice, Formulas, FormulasOr, Name, Number, Variant, Vector};
use super::{ANY, IN_SPACE, IN_TIME, Kind, NOT_NEGATIVE, POSITIVE, Range, Table, key, shapes, table};

pub(super) const MATERIAL: Table = table(
    "[[material]]",
    "A hyperelastic material, given by lambda and mu or by young and poisson.",
    &[
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
            .optional("200.0"),
        key("mu", Number(POSITIVE), "Second Lamé constant (shear modulus) μ.")
            .unit("mass/(length·time²)")
            .optional("15.0"),
        key("young", Number(POSITIVE), "Young's modulus, with poisson instead of lambda and mu.")
            .unit("mass/(length·time²)")
            .optional("43.95"),
        key(
            "poisson",
            Number(Range { low: Some((-1.0, false)), high: Some((0.5, false)) }),
            "Poisson's ratio; given together with young. At 0.5 the material would be incompressible and its bulk modulus infinite.",
        )
        .optional("0.49"),
    ],
);

pub(super) const BODY: Table = table(
    "[[body]]",
    "A deformable body; its sides are written name.side.",
    &[
        key("name", Name, "Name; its sides are written name.side.").example("\"cylinder\""),
        key("material", Name, "Name of its material.").example("\"rubber\""),
        key(
            "element",
            Choice(&["L2", "L3", "L4", "T3", "T6", "T10", "Q4", "Q9", "Tet4", "Tet10", "Tet20", "Hex8", "Hex27"], &[]),
            "Cell type: lines (L) in dimension 1, triangles (T) or quadrilaterals (Q) in dimension 2, tetrahedra (Tet) or hexahedra (Hex) in dimension 3. Of the built-in shapes, Q4 and Q9 fill rectangles; Hex8 and Hex27 fill those of space, and extrusions of rectangles.",
        )
        .example("\"T6\""),
        key(
            "volumetric",
            Choice(&["pointwise", "mean"], &[]),
            "Change of volume on which the volumetric energy depends. pointwise: that at each quadrature \
             point; mean: the mean over the cell (mean dilatation), with which Q4 and Hex8 do not lock in \
             nearly incompressible materials.",
        )
        .default("\"pointwise\""),
        key("mesh", Variant(shapes), "Mesh: a built-in shape with its mesh size, or a body of a Gmsh file.")
            .example("{ shape = \"rectangle\", min = [0.0, 0.0], max = [1.0, 1.0], cells = [8, 8] }"),
        key("place", Kind::Table(&PLACE), "Rotation and translation of the mesh, applied before anything else.")
            .optional("{ rotate = 30.0, about = [0.0, 0.0], shift = [0.0, 1.0] }"),
        key("position", Formulas(IN_SPACE), "Positions at t = 0 as formulas in X, Y, Z, for a body that starts deformed. Default: X, Y, Z.")
            .unit("length")
            .optional("[\"X + 0.1*X*Y\", \"Y\"]"),
        key("gravity", Formulas(IN_TIME), "Gravitational acceleration: numbers, or formulas in t. Default: zero.")
            .unit("length/time²")
            .optional("[0.0, -9.81]"),
        key(
            "velocity",
            FormulasOr(IN_SPACE, &VELOCITY),
            "Initial velocity: numbers or formulas in X, Y, Z, or the table of a rigid-body motion. Default: zero.",
        )
        .unit("length/time")
        .optional("[0.0, -1.0]"),
        key(
            "mass",
            Choice(&["consistent", "lumped", "redistributed"], &[]),
            "Mass matrix. consistent; lumped: diagonal, by HRZ scaling; redistributed: no mass on contact nodes, and the smallest change at the other \
             nodes that preserves the total mass, the centre of mass and the second moments.",
        )
        .default("\"consistent\""),
    ],
);

const VELOCITY: Table = table(
    "velocity",
    "Initial velocity of a rigid-body motion: linear + angular × (X − about).",
    &[
        key("linear", Vector, "Velocity of the point `about`. Default: zero.")
            .unit("length/time")
            .optional("[0.0, -1.0]"),
        key(
            "angular",
            Kind::Angular,
            "Angular velocity: counter-clockwise in dimension 2, [ωx, ωy, ωz] in dimension 3. Default: zero.",
        )
        .unit("1/time")
        .optional("2.0"),
        key("about", Vector, "Centre of the rotation; required with `angular`.")
            .unit("length")
            .optional("[0.0, 1.0]"),
    ],
);

const ROTATION: Table = table(
    "rotate",
    "A rotation in space.",
    &[
        key("axis", Vector, "Direction of the axis, of any length.").example("[0.0, 0.0, 1.0]"),
        key("angle", Number(ANY), "Angle, right-handed about the axis.").unit("degrees").example("30.0"),
    ],
);

const PLACE: Table = table(
    "place",
    "Rotation, then translation of a mesh, built in or from a file.",
    &[
        key("rotate", Kind::Rotation(&ROTATION), "Angle of rotation, counter-clockwise, in dimension 2; the table of axis and angle in dimension 3. Default: none.")
            .unit("degrees")
            .optional("30.0"),
        key("about", Vector, "Centre of rotation. Default: the origin.")
            .unit("length")
            .optional("[0.0, 0.0]"),
        key("shift", Vector, "Translation. Default: zero.").unit("length").optional("[0.0, 1.0]"),
    ],
);
