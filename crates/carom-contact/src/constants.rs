//! The constants of geometric decisions, all without unit: angles, and lengths relative to a facet
//! where nothing else is said, in the plane as |ξ| − 1. Some follow from others. Here are no
//! accuracies of iterations, no digits of round-off that a bound derives, and no weights of a
//! formula: those stand where they are used.

use std::f64::consts::PI;

use crate::angle::Angle;

// ---- Round-off and meetings

/// Length, ξ, cosine or volume that counts as zero: far above the last digits of a facet whose
/// coordinates are 10⁵ times its size, far below what any answer is asked for.
pub const ROUND_OFF: f64 = 1e-9;
/// Distance at which a path meets a facet or an edge, and excess of θ and ξ over their ranges up to
/// which it does: what starts on a surface, or behind it by round-off, must be detected.
pub(crate) const MEETS: f64 = 1e-6;
/// Change of θ and ξ from an isolated crossing, above which Newton's method has found another one.
pub(crate) const ASTRAY: f64 = 0.05;
/// Difference in θ below which facets are reached together: where they meet, and a path lies in the
/// neighbouring side.
pub(crate) const REACHED_TOGETHER: f64 = 1e-4;
/// Distance of a closest point from a joint up to which it lies there: above round-off, and far
/// below what a node slides in a step.
pub(crate) const AT_JOINT: f64 = 1e-7;

/// Length of a sum of unit vectors, or area between them, below which they cancel or are parallel,
/// as at the tip of a slit.
pub(crate) const CANCELS: f64 = MEETS;
/// Excess |ξ| − 1 up to which a contact point lies on its facet, as a node that slides along a
/// joint within a second-order distance of its end; and growth of the box of a path, relative to
/// its size. Both are more than [`MEETS`].
pub(crate) const ON_FACET: f64 = 10.0 * MEETS;

// ---- Angles

/// Least kink at which a joint is a corner and an edge is sharp, and least slope of a facet that
/// rises in front of another one. A regular polygon of twelve sides has corners, whatever the last
/// digits of its kinks of 30°.
pub(crate) const KINK: Angle = Angle::degrees(29.5);
/// Angle up to which two facets, or two normals, count as parallel.
pub(crate) const PARALLEL: Angle = Angle::degrees(10.0);
/// Angle between two facets up to which a part touches one of them: the rows of both would nearly
/// be the same, and the gap differs by r (1 − cos 3°).
pub(crate) const SAME_NORMAL: Angle = Angle::degrees(3.0);
/// Angle between two outward normals up to which they are alike: gaps depend on each other, and two
/// places are not the faces of one wall.
pub(crate) const ALIKE: Angle = Angle::degrees(60.0);
/// Deviation of two outward normals from opposite directions up to which they oppose each other, as
/// those of a flank and a chamfer of 45° do.
pub(crate) const OPPOSED: Angle = Angle::degrees(45.5);
/// Sine of the angle between edges below which they form no pair.
pub(crate) const EDGES_CROSS: f64 = 0.1;
/// Sine of the angle by which the normal of a new pair of edges lies between the facets' normals at
/// least. Below zero: flat faces that press on each other across their edges turn by their strains,
/// and a pair there that has opened must find back.
pub(crate) const EDGES_BETWEEN: f64 = -0.02;
/// Negative sine of the angle by which the normal of a known pair of edges may lie outside the
/// facets' normals: an edge that lies on a facet is constrained at its end by the edge of the
/// facet.
pub(crate) const EDGES_OUTSIDE: f64 = -0.4;

/// Difference between a depth and that from the extension of a facet past a joint that is no
/// corner; and value of 1 + n₀·n, for the last normal n₀ and the present one n, below which new
/// tangents are chosen.
pub const BESIDE_KINK: f64 = 1.0 - KINK.cosine;
/// Angle of a body at a node below which a node on the boundary cannot be told from one inside a
/// fold.
pub(crate) const SHARPEST: f64 = KINK.radians;
/// Solid angle of a body at a node below which a node on the boundary cannot be told from one
/// inside a fold in space: that of a cone with this opening.
pub(crate) const SHARPEST_SOLID: f64 = 2.0 * PI * (1.0 - KINK.half().cosine);
/// Deviation of the turn of the tangent from −180° up to which two places of a boundary may meet:
/// all but parallel facets that face the same way.
pub(crate) const FOLDED_BACK: f64 = PARALLEL.complement().radians;
/// Cosine of the angle between two outward normals below which two places of one body face each
/// other.
pub(crate) const FACING: f64 = -ALIKE.cosine;
/// Cosines of the angles from the opposite direction up to which a point of a pressure field faces
/// the primary, and beyond which it does not: 60°, and halfway from there to a right angle. Where
/// surfaces meet at a larger angle, one of them ends in a corner, which has a row of its own.
pub(crate) const MORTAR_FACES: [f64; 2] = [ALIKE.cosine, ALIKE.complement().half().sine];

// ---- Ends of facets

/// Distance past an end up to which a facet is extrapolated.
pub(crate) const EXTENDED: f64 = 0.2;
/// Distance past an end beyond which a pair is handed over to the next facet before Newton's method
/// has converged, within which a node beside a joint with a kink may lie over either facet, and up
/// to which a side in space is faced past its end: where two edges of either block meet, neither
/// corner faces the other block.
pub(crate) const PAST_END: f64 = 0.02;

/// |ξ| up to which a facet in the plane is extrapolated.
pub(crate) const REACH_XI: f64 = 1.0 + EXTENDED;
/// |ξ| of a pair that is handed over.
pub(crate) const HAND_OVER_XI: f64 = 1.0 + PAST_END;
/// Distance past an end beyond which a pair is handed back to the facet that it came from before
/// Newton's method has converged: half of the distance by which facets are extrapolated.
pub(crate) const HAND_BACK: f64 = 0.5 * EXTENDED;
/// |ξ| of a pair that is handed back.
pub(crate) const HAND_BACK_XI: f64 = 1.0 + HAND_BACK;
/// Distance past a corner or the end of a side, in the plane, above which a closest point is past
/// it: where sides of equal length are pressed together, their ends bulge differently.
pub(crate) const PAST_SIDE: f64 = 1e-3;
/// Distance along the surface up to which a corner and a node of the other side meet: just where
/// the node begins to face the side.
pub(crate) const NEAR_END: f64 = 0.5 * PAST_SIDE;
/// Distance along the surface, in space, up to which a corner and a node of the other side meet.
pub(crate) const NEAR_END_SPACE: f64 = 0.5 * PAST_END;
/// Lengths past an end up to which the closest point of a pair is followed before Newton's method
/// has converged.
pub(crate) const WANDER: f64 = 2.0;
/// |ξ| up to which it is followed.
pub(crate) const WANDER_XI: f64 = 1.0 + 2.0 * WANDER;
/// |η| up to which a closest point of a pressure field is followed: at a kink of 30°, a point as far
/// away as the facet is long has its closest point 1 + 2 tan 15° = 1.54 from the middle.
pub(crate) const MORTAR_BEYOND: f64 = 1.6;
/// Share of the area of a multiplier that must face the primary for a pressure of its own.
pub(crate) const MORTAR_COVERED: f64 = 0.05;
/// Second derivative of half the squared distance of a centre from a facet, over that from a
/// straight one, below which the facet follows the part.
pub(crate) const FOLLOWS: f64 = 0.5;
/// Distance 1 − |ξ| from a corner that the contact point of a new pair of edges has at least: the
/// point must not slide past the corner ([`PAST_END`]) in the next iterations.
pub(crate) const EDGES_CORNER: f64 = 2.0 * PAST_END;
/// Distance 1 − |ξ| from a corner, on both edges, up to which two edges meet at their corners: as
/// far as facets are extrapolated.
pub(crate) const EDGES_NEAR_CORNER: f64 = EXTENDED;
/// Distance between the contact points of edges that continue each other, below which one pair
/// constrains both if their normals are parallel.
pub(crate) const EDGES_TOGETHER: f64 = 0.1;

// ---- Depths

/// Depth that a chord of a curved facet may feign: a node may have it on its path, bodies without a
/// contact may overlap by it, and a point that is less deep is looked at from the curved facet.
pub const SHALLOW: f64 = 0.01;
/// Height or depth up to which a node, or a corner, is at a facet, and distance past its end up to
/// which contact holds a node. What is deeper at the start of a step has entered elsewhere, if the
/// whole boundary of the body is known.
pub const FLUSH: f64 = 0.02;
/// Depth above which a contact is doubtful, whatever its law allows, that edges may have on their
/// path, and beyond which, at the start of a step, a node in space has not crossed a facet.
pub const DEEP: f64 = 0.1;
/// Largest depth of parts between nodes: of edges at the end of the step in which they meet, of
/// chords of facets that lie on a circle, and of curved facets that bulge beside a sharp edge.
pub const DEEPEST: f64 = 0.25;

/// Largest depth of two edges before the step in which they meet, if they approach by as much in
/// that step.
pub(crate) const EDGES_BEHIND: f64 = 0.05;
/// Distance up to which facets behind a facet are the other face of the same wall.
pub(crate) const WALL: f64 = 3.0;

// ---- Search

/// Margin around the path of a node in the search for facets, relative to the path.
pub(crate) const PATH_MARGIN: f64 = 0.1;
/// Margin around the path of a facet within which a node is tracked, relative to the path: before
/// contact, and as far as facets are extrapolated.
pub(crate) const WATCHED: f64 = 0.35;

/// Margin around the path of a facet within which a node is tracked, relative to the path, where
/// only contacts within the step matter.
pub(crate) const WITHIN_STEP: f64 = SHALLOW;
/// Share of a depth up to which motion decides; round-off is far below the rest.
pub(crate) const SURE: f64 = 1.0 - SHALLOW;
/// Distance up to which another facet is near, as far as parts between nodes may be deep; and past
/// an edge up to which the search for a point on a facet may go.
pub(crate) const NEAR_FACET: f64 = DEEPEST;
