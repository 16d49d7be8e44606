//! Keys of supports and loads.

use super::Kind::{Choices, Formula, Formulas, Name, Sides, Text, Vector};
use super::{IN_SPACE_AND_TIME, Kind, Table, key, table};

pub(super) const SUPPORT: Table = table(
    "[[support]]",
    "Displacement boundary condition: sides fixed in some directions with `fix`, or moved with `move`.",
    &[
        key("name", Name, "Name; the reaction forces of a named support are recorded.").optional("\"floor\""),
        key("on", Sides, "Sides that are constrained.").example("[\"prism.bottom\"]"),
        key(
            "fix",
            Choices(&["x", "y", "z", "normal"]),
            "Directions that are fixed; normal: that of the side, which must be plane and normal to x, y or \
             z.",
        )
        .optional("[\"x\", \"y\"]"),
        key(
            "moment_about",
            Vector,
            "Point about which the moment of the reactions is recorded too, for a named support in dimension 2 or 3.",
        )
        .unit("length")
        .optional("[0.0, 0.0]"),
        key(
            "move",
            Kind::Table(&MOVE),
            "Prescribed displacements by direction, zero at t = 0; velocity and acceleration are the time derivatives of the formula.",
        )
        .optional("{ y = \"-0.1*t\" }"),
    ],
);

const MOVE: Table = table(
    "move",
    "Displacements of a side from its reference position.",
    &[
        key("x", Formula(IN_SPACE_AND_TIME), "Displacement along x.").unit("length").optional("\"0.1*t\""),
        key("y", Formula(IN_SPACE_AND_TIME), "Displacement along y.").unit("length").optional("\"-0.1*t\""),
        key("z", Formula(IN_SPACE_AND_TIME), "Displacement along z; dimension 3.")
            .unit("length")
            .optional("\"0.1*t\""),
    ],
);

pub(super) const LOAD: Table = table(
    "[[load]]",
    "A load on sides (`on` with `traction` or `pressure`) or in a body (`body` with `body_force`). Formulas are functions of the reference position X, Y, Z and the time t.",
    &[
        key("name", Name, "Name used in messages.").optional("\"press\""),
        key("on", Sides, "Loaded sides, with `traction` or `pressure`.").optional("[\"prism.top\"]"),
        key("body", Name, "Loaded body, with `body_force`.").optional("\"prism\""),
        key("traction", Formulas(IN_SPACE_AND_TIME), "Dead load per reference area.")
            .unit("mass/(length·time²)")
            .optional("[\"0\", \"-5*min(t/0.1, 1)\"]"),
        key(
            "pressure",
            Formula(IN_SPACE_AND_TIME),
            "Follower load per current area, acting against the outward normal.",
        )
        .unit("mass/(length·time²)")
        .optional("\"2*t\""),
        key("body_force", Formulas(IN_SPACE_AND_TIME), "Dead load per reference volume.")
            .unit("mass/(length²·time²)")
            .optional("[\"0\", \"-3*X\"]"),
        key(
            "table",
            Text,
            "CSV file with the columns t and value: a factor on the load, linearly interpolated in time.",
        )
        .optional("\"amplitude.csv\""),
    ],
);
