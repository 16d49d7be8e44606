//! Meshes: built-in shapes, whose numbers must fit together, and files.

use std::sync::LazyLock;

use carom_solid::generate::{self, Frame};
use serde::{Deserialize, Serialize};

use crate::keys::Kind::{Choices, Count, Direction, Number, Points, Variant, Vector};
use crate::keys::{Key, Keys, NOT_NEGATIVE, POSITIVE, Table, Value, Variants, View};
use crate::mesh_file::{FileMesh, Purpose};
use crate::problem::rounded;
use crate::tree::Node;

/// Name of the side that is the whole boundary of a body in the plane, unless its mesh has a side
/// of this name.
pub const SKIN: &str = "skin";

/// Source of a mesh: a built-in shape, or a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Keys)]
#[serde(tag = "shape", rename_all = "kebab-case")]
#[keys(name = "mesh", tag = "shape", tag_doc = "Built-in shape.")]
pub enum MeshSpec {
    /// Dimension 1; sides left, right.
    #[keys(dimension = 1)]
    Interval {
        /// Left end.
        #[key(unit = "length", example = "0.0")]
        min: f64,
        /// Right end.
        #[key(unit = "length", example = "1.0")]
        max: f64,
        /// Number of cells.
        #[key(Count(1), example = "20")]
        cells: usize,
    },
    /// Sides bottom, right, top, left.
    #[keys(dimension = 2)]
    Rectangle {
        /// Lower left corner.
        #[key(Vector, unit = "length", example = "[0.0, 0.0]")]
        min: [f64; 2],
        /// Upper right corner.
        #[key(Vector, unit = "length", example = "[1.0, 1.0]")]
        max: [f64; 2],
        /// Number of squares along x and y, each a quadrilateral or split into two triangles; or
        /// give `size`.
        #[key(optional = "[8, 4]", with = divided)]
        cells: [usize; 2],
        /// Largest side length of the squares; or give `cells`.
        #[key(Number(POSITIVE), unit = "length", optional = "0.1")]
        #[serde(skip)]
        size: (),
    },
    /// Dimension 3; sides left, right (along x), front, back (along y), bottom, top (along z).
    #[keys(dimension = 3)]
    Box {
        /// Lowest corner.
        #[key(Vector, unit = "length", example = "[0.0, 0.0, 0.0]", with = low_corner)]
        min: [f64; 3],
        /// Highest corner.
        #[key(Vector, unit = "length", example = "[1.0, 1.0, 1.0]")]
        max: [f64; 3],
        /// Number of boxes along x, y and z, each a hexahedron or split into six tetrahedra; or
        /// give `size`.
        #[key(optional = "[8, 4, 4]", with = divided)]
        cells: [usize; 3],
        /// Largest side length of the boxes; or give `cells`.
        #[key(Number(POSITIVE), unit = "length", optional = "0.1")]
        #[serde(skip)]
        size: (),
        /// Directions in which a plane of symmetry through the middle of the shape cuts it; the
        /// half with the larger coordinates is meshed, and its cut is the side plane_x, plane_y or
        /// plane_z. A cylinder or a tube is cut only if its axis is a coordinate.
        #[key(Choices(&AXES), optional = "[\"x\", \"y\"]", with = symmetry)]
        #[serde(default, skip_serializing_if = "whole_shape")]
        symmetry: [bool; 3],
    },
    /// Dimension 3; side sphere, and plane_x, plane_y, plane_z where planes of symmetry cut it.
    #[keys(dimension = 3)]
    Ball {
        /// Radius.
        #[key(Number(POSITIVE), unit = "length", example = "0.5")]
        radius: f64,
        /// Centre.
        #[key(Vector, unit = "length", example = "[0.0, 0.0, 1.0]")]
        center: [f64; 3],
        /// Edge length of the cells.
        #[key(Number(POSITIVE), unit = "length", example = "0.1")]
        size: f64,
        /// Directions in which a plane of symmetry through the middle of the shape cuts it; the
        /// half with the larger coordinates is meshed, and its cut is the side plane_x, plane_y or
        /// plane_z. A cylinder or a tube is cut only if its axis is a coordinate.
        #[key(Choices(&AXES), optional = "[\"x\", \"y\"]", with = symmetry)]
        #[serde(default, skip_serializing_if = "whole_shape")]
        symmetry: [bool; 3],
    },
    /// Dimension 3; sides side, bottom, top, and plane_x, plane_y, plane_z where planes of symmetry
    /// cut it.
    #[keys(dimension = 3)]
    Cylinder {
        /// Radius.
        #[key(Number(POSITIVE), unit = "length", example = "0.5")]
        radius: f64,
        /// Length along the axis.
        #[key(Number(POSITIVE), unit = "length", example = "2.0")]
        height: f64,
        /// Centre of the bottom.
        #[key(Vector, unit = "length", example = "[0.0, 0.0, 0.0]")]
        center: [f64; 3],
        /// Direction from the bottom to the top: a coordinate, or a vector of any length.
        #[key(Direction, default = "\"z\"", with = axis)]
        axis: [f64; 3],
        /// Edge length of the cells.
        #[key(Number(POSITIVE), unit = "length", example = "0.1")]
        size: f64,
        /// Directions in which a plane of symmetry through the middle of the shape cuts it; the
        /// half with the larger coordinates is meshed, and its cut is the side plane_x, plane_y or
        /// plane_z. A cylinder or a tube is cut only if its axis is a coordinate.
        #[key(Choices(&AXES), optional = "[\"x\", \"y\"]", with = symmetry)]
        #[serde(default, skip_serializing_if = "whole_shape")]
        symmetry: [bool; 3],
    },
    /// Dimension 3; sides inner, outer, bottom, top, and plane_x, plane_y, plane_z where planes of
    /// symmetry cut it.
    #[keys(dimension = 3)]
    Tube {
        /// Inner radius.
        #[key(Number(POSITIVE), unit = "length", example = "0.4")]
        inner: f64,
        /// Outer radius.
        #[key(Number(POSITIVE), unit = "length", example = "0.5")]
        outer: f64,
        /// Length along the axis.
        #[key(Number(POSITIVE), unit = "length", example = "2.0")]
        height: f64,
        /// Centre of the bottom.
        #[key(Vector, unit = "length", example = "[0.0, 0.0, 0.0]")]
        center: [f64; 3],
        /// Direction from the bottom to the top: a coordinate, or a vector of any length.
        #[key(Direction, default = "\"z\"", with = axis)]
        axis: [f64; 3],
        /// Edge length of the cells.
        #[key(Number(POSITIVE), unit = "length", example = "0.1")]
        size: f64,
        /// Directions in which a plane of symmetry through the middle of the shape cuts it; the
        /// half with the larger coordinates is meshed, and its cut is the side plane_x, plane_y or
        /// plane_z. A cylinder or a tube is cut only if its axis is a coordinate.
        #[key(Choices(&AXES), optional = "[\"x\", \"y\"]", with = symmetry)]
        #[serde(default, skip_serializing_if = "whole_shape")]
        symmetry: [bool; 3],
    },
    /// Dimension 3; a plane shape or a plane mesh of a file from z = 0 to its height; its sides,
    /// and bottom, top (base, lid if it has sides of these names), and plane_x, plane_y, plane_z
    /// where planes of symmetry cut it.
    #[keys(dimension = 3)]
    Extrusion {
        /// The plane shape, or a surface of a Gmsh file; its cells are the faces of the solid
        /// cells.
        #[key(
            Variant(plane_shapes),
            example = "{ shape = \"ring\", inner = 0.4, outer = 0.5, center = [0.0, 0.0], size = 0.1 }",
            with = of_extrusion
        )]
        of: Box<MeshSpec>,
        /// Length along z.
        #[key(Number(POSITIVE), unit = "length", example = "0.2")]
        height: f64,
        /// Number of layers of cells.
        #[key(Count(1), example = "2")]
        layers: usize,
        /// Directions in which a plane of symmetry through the middle of the shape cuts it, as of
        /// other shapes: z, which leaves the upper half of the height; x and y of a rectangle; x of
        /// a disc.
        #[key(Choices(&AXES), optional = "[\"z\"]", with = symmetry)]
        #[serde(default, skip_serializing_if = "whole_shape")]
        symmetry: [bool; 3],
    },
    /// A whole disc; side arc.
    #[keys(dimension = 2)]
    Disc {
        /// Radius.
        #[key(Number(POSITIVE), unit = "length", example = "0.5")]
        radius: f64,
        /// Centre.
        #[key(Vector, unit = "length", example = "[0.0, 1.0]")]
        center: [f64; 2],
        /// Edge length of the cells.
        #[key(Number(POSITIVE), unit = "length", example = "0.1")]
        size: f64,
    },
    /// The half of a disc to the right of its centre; sides arc, axis.
    #[keys(dimension = 2)]
    HalfDisc {
        /// Radius.
        #[key(Number(POSITIVE), unit = "length", example = "0.5")]
        radius: f64,
        /// Centre.
        #[key(Vector, unit = "length", example = "[0.0, 1.0]")]
        center: [f64; 2],
        /// Edge length of the cells.
        #[key(Number(POSITIVE), unit = "length", example = "0.1")]
        size: f64,
    },
    /// The region between two concentric circles; sides inner, outer.
    #[keys(dimension = 2)]
    Ring {
        /// Radius of the inner circle.
        #[key(Number(POSITIVE), unit = "length", example = "0.4")]
        inner: f64,
        /// Radius of the outer circle.
        #[key(Number(POSITIVE), unit = "length", example = "0.5")]
        outer: f64,
        /// Centre.
        #[key(Vector, unit = "length", example = "[0.0, 1.0]")]
        center: [f64; 2],
        /// Edge length of the cells; smaller if the ring is thinner than this length, or if the
        /// inner circle would have fewer than twelve edges.
        #[key(Number(POSITIVE), unit = "length", example = "0.05")]
        size: f64,
    },
    /// Any simple polygon, convex or not; sides side1 (from the first point to the second), side2,
    /// ….
    #[keys(dimension = 2)]
    Polygon {
        /// Corners in order, clockwise or counter-clockwise.
        #[key(Points(3), unit = "length", example = "[[0.0, 0.0], [48.0, 44.0], [48.0, 60.0], [0.0, 44.0]]")]
        points: Vec<[f64; 2]>,
        /// Edge length of the cells; smaller where the outline requires it.
        #[key(Number(POSITIVE), unit = "length", example = "0.1")]
        size: f64,
        /// Regions of local refinement.
        #[key(optional = "[{ near = [48.0, 60.0], radius = 2.0, size = 0.02 }]")]
        refine: Vec<RefineSpec>,
    },
    /// A body of a Gmsh file.
    #[keys(untagged)]
    File(FileMesh),
}

/// Shapes of the plane, and a surface of a file, to be extruded.
fn plane_shapes() -> &'static Variants {
    // Built once per process, so it may be leaked.
    static PLANE: LazyLock<Variants> = LazyLock::new(|| {
        let all = MeshSpec::variants();
        let of_file = all.or.map_or(&[][..], |file| file.keys).iter().filter(|key| key.name != "volume");
        let file = Table {
            name: "plane mesh from a file",
            doc: "A surface of a Gmsh file; its sides are the physical curves on its boundary.",
            keys: of_file.map(|key| Key { unless: "", ..*key }).collect::<Vec<_>>().leak(),
            later: &[],
            dimension: None,
        };
        let is_plane = |(_, table): &&(&str, Table)| table.dimension == Some(2);
        Variants {
            name: "of",
            doc: "Shape of the plane.",
            tables: all.tables.iter().filter(is_plane).copied().collect::<Vec<_>>().leak(),
            or: Some(Box::leak(Box::new(file))),
            dimension: Some(2),
            ..*all
        }
    });
    &PLANE
}

/// Names of the coordinates.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Whether a plane of symmetry cuts across x, y and z.
fn symmetry(v: &View) -> Option<[bool; 3]> {
    let words: Vec<String> = v.get("symmetry")?;
    Some(AXES.map(|direction| words.iter().any(|word| word == direction)))
}

/// Lowest corner of the part of a box that planes of symmetry leave.
fn low_corner(v: &View) -> Option<[f64; 3]> {
    let min: [f64; 3] = v.get("min")?;
    let max: [f64; 3] = v.get("max")?;
    let symmetry = symmetry(v)?;
    let is_cut = |i: usize| symmetry[i] && min[i] < max[i];
    Some(std::array::from_fn(|i| if is_cut(i) { 0.5 * (min[i] + max[i]) } else { min[i] }))
}

/// Numbers of cells between the corners, given or by their size.
fn divided<const D: usize>(v: &View) -> Option<[usize; D]> {
    let min = if D == 3 { low_corner(v)?.as_slice().try_into().ok()? } else { v.get("min")? };
    cells_between(v, min, v.get("max")?)
}

/// The direction of an axis.
fn axis(v: &View) -> Option<[f64; 3]> {
    match v.value("axis")?.text() {
        Some(word) => Some(AXES.map(|direction| f64::from(u8::from(direction == word)))),
        None => v.get("axis"),
    }
}

/// Whether no plane of symmetry cuts a shape.
#[allow(clippy::trivially_copy_pass_by_ref)] // as serde calls it
fn whole_shape(symmetry: &[bool; 3]) -> bool {
    *symmetry == [false; 3]
}

/// A region of local refinement; outside its radius, the edge length grows by 3/10 of the distance,
/// up to the size of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Keys)]
#[keys(name = "refine")]
pub struct RefineSpec {
    /// Centre of the region.
    #[key(Vector, unit = "length", example = "[48.0, 60.0]")]
    pub near: [f64; 2],
    /// Radius of the region.
    #[key(Number(NOT_NEGATIVE), unit = "length", default = "0.0")]
    pub radius: f64,
    /// Edge length of the cells in the region.
    #[key(Number(POSITIVE), unit = "length", example = "0.02")]
    pub size: f64,
}

/// Reads the mesh of a body.
pub(crate) fn of_body(body: &View) -> Option<MeshSpec> {
    let purpose = Purpose { dimension: body.dimension?, element: body.get("element"), extruded: false };
    let materials = body.table.get("materials").and_then(Node::table);
    read(&View { materials, ..body.clone() }, "mesh", purpose)
}

/// Reads the mesh that is extruded, as far as planes of symmetry leave it.
fn of_extrusion(v: &View) -> Option<Box<MeshSpec>> {
    let purpose = Purpose { dimension: 2, element: v.element, extruded: true };
    let of = read(v, "of", purpose)?;
    half(of, &v.at("of")?, symmetry(v)?).map(Box::new)
}

fn read(outer: &View, key: &str, purpose: Purpose) -> Option<MeshSpec> {
    let v = &View { element: purpose.element, ..outer.at(key)? };
    let mesh = MeshSpec::of(outer.table.get(key)?, v)?;
    if let MeshSpec::File(file) = mesh {
        return file.resolved(v, purpose).map(MeshSpec::File);
    }
    fits(&mesh, v)?;
    Some(mesh)
}

/// Whether the numbers of a shape fit together.
fn fits(mesh: &MeshSpec, v: &View) -> Option<()> {
    match *mesh {
        MeshSpec::Interval { min, max, .. } => ordered(v, min, max, ""),
        MeshSpec::Disc { radius, size, .. }
        | MeshSpec::HalfDisc { radius, size, .. }
        | MeshSpec::Ball { radius, size, .. } => fitting(v, size, "radius", radius),
        MeshSpec::Ring { inner, outer, size, .. } => {
            radii(v, inner, outer, "the ring would have no width")?;
            fitting(v, size, "outer radius", outer)
        }
        MeshSpec::Cylinder { radius, height, size, .. } => {
            directed(mesh, v)?;
            fitting(v, size, "longest extent", radius.max(height))
        }
        MeshSpec::Tube { inner, outer, height, size, .. } => {
            directed(mesh, v)?;
            radii(v, inner, outer, "the tube would have no wall")?;
            fitting(v, size, "longest extent", outer.max(height))
        }
        MeshSpec::Polygon { ref points, .. } => {
            let Err(error) = generate::outline(points) else { return Some(()) };
            let why = "the outline of a polygon must not touch or intersect itself";
            v.wrong("points", error.to_string(), why, "list its corners in order")
        }
        MeshSpec::Rectangle { .. }
        | MeshSpec::Box { .. }
        | MeshSpec::Extrusion { .. }
        | MeshSpec::File(_) => Some(()),
    }
}

/// Whether the axis of a shape has a direction, along which planes of symmetry may cut it.
fn directed(mesh: &MeshSpec, v: &View) -> Option<()> {
    let (MeshSpec::Cylinder { center, axis, symmetry, .. } | MeshSpec::Tube { center, axis, symmetry, .. }) =
        *mesh
    else {
        return Some(());
    };
    let Err(error) = Frame::along(axis, center).and_then(|frame| frame.cuts(symmetry)) else {
        return Some(());
    };
    let why = "an axis has a direction; planes of symmetry need one along x, y or z";
    v.wrong("axis", error.to_string(), why, "write for example axis = \"z\"")
}

/// Part of a plane shape that remains after cuts along planes of symmetry across x and y: the one
/// with the larger coordinates.
fn half(of: MeshSpec, v: &View, [x, y, _]: [bool; 3]) -> Option<MeshSpec> {
    match of {
        _ if !x && !y => Some(of),
        MeshSpec::Rectangle { min, max, size, .. } => {
            let middle = |i: usize, cut: bool| if cut { 0.5 * (min[i] + max[i]) } else { min[i] };
            let min = [middle(0, x), middle(1, y)];
            Some(MeshSpec::Rectangle { min, max, cells: cells_between(v, min, max)?, size })
        }
        MeshSpec::Disc { radius, center, size } if !y => Some(MeshSpec::HalfDisc { radius, center, size }),
        _ => {
            let across = if y { "y" } else { "x" };
            let what = format!("`symmetry` has \"{across}\", and this plane shape is not cut by that plane");
            let why = "a rectangle is cut across x and y, a disc across x, and every extrusion across z";
            let help = "extrude a polygon or a plane mesh that is the half, and hold its side";
            v.wrong("shape", what, why, help)
        }
    }
}

/// Numbers of cells between two corners, given or by their size.
fn cells_between<const D: usize>(v: &View, min: [f64; D], max: [f64; D]) -> Option<[usize; D]> {
    for i in 0..D {
        ordered(v, min[i], max[i], &format!("[{i}]"))?;
    }
    let extents: [f64; D] = std::array::from_fn(|i| max[i] - min[i]);
    match (v.has("cells"), v.has("size")) {
        (true, false) => {
            let cells = v.table.get("cells")?.list()?.iter().map(Node::count);
            cells.collect::<Option<Vec<_>>>()?.try_into().ok()
        }
        (false, true) => {
            let size = v.get("size").filter(|size| *size > 0.0)?;
            let name = if D == 2 { "longer side" } else { "longest side" };
            fitting(v, size, name, extents.iter().copied().fold(0.0, f64::max))?;
            Some(extents.map(|extent| (extent / size - 1e-9).ceil().max(1.0) as usize))
        }
        (both, _) => {
            let shape = if D == 2 { "rectangle" } else { "box" };
            let what = if both {
                format!("a {shape} has `cells` or `size`, not both")
            } else {
                format!("the {shape} has neither `cells` nor `size`")
            };
            let example = if D == 2 { "[8, 4]" } else { "[8, 4, 4]" };
            let why = "each of them sets the size of the cells";
            v.wrong("", what, why, format!("write for example `cells = {example}`"))
        }
    }
}

/// Reports cells that are larger than their body.
fn fitting(v: &View, size: f64, extent: &str, length: f64) -> Option<()> {
    // A value that is not positive is reported elsewhere.
    if size > length && length > 0.0 {
        let what = format!("`size` = {size} is larger than the {extent}, {}", rounded(length));
        let why = "it is the edge length of the cells, and none would fit";
        let help = format!("give size ≤ {}, for example size = {}", rounded(length), rounded(length / 5.0));
        return v.wrong("size", what, why, help);
    }
    Some(())
}

/// Reports an outer radius that is not greater than the inner one, and why it must be.
fn radii(v: &View, inner: f64, outer: f64, why: &str) -> Option<()> {
    if inner >= outer {
        let what = format!("`outer` = {outer} is not greater than `inner` = {inner}");
        return v.wrong("outer", what, why, "give outer > inner");
    }
    Some(())
}

/// Reports ends of an extent in the wrong order; `index`: of its direction.
fn ordered(v: &View, min: f64, max: f64, index: &str) -> Option<()> {
    if min < max {
        return Some(());
    }
    if min.is_finite() && max.is_finite() {
        let what = format!("`max` = {max} is not greater than `min` = {min}");
        return v.wrong(&format!("max{index}"), what, "the shape would have no extent", "give max > min");
    }
    None
}
