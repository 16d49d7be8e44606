//! Rigid obstacles of a case: their shapes, and the nodes that carry those that move.
//!
//! A carrier is a part of the model without cells: a node, or those of a simplex if the obstacle
//! turns. A prescribed motion moves it like a support; a mass makes it a free particle.

use carom_case::{Case, FormulaSpec, ObstacleMotion, PrimarySpec, Problem};
use carom_contact::{Carrier, Faceted, Obstacle, Polyline};
use carom_mechanics::model::{BodyInstance, Motion, Pivot, Support, Turn};
use carom_solid::{Element, Law, Mesh, Positions};

use super::given::in_space_and_time;

/// The shape of a rigid primary; none for a side.
pub(super) fn shape(primary: &PrimarySpec, contact: usize) -> Result<Option<Obstacle>, Problem> {
    Ok(Some(match primary {
        PrimarySpec::Side(_) => return Ok(None),
        PrimarySpec::Plane { point, normal } => Obstacle::plane(point, normal),
        PrimarySpec::Circle { center, radius, inside } => Obstacle::circle(center, *radius, *inside),
        PrimarySpec::Cylinder { point, axis, radius, inside } => {
            Obstacle::cylinder(point, axis, *radius, *inside)
        }
        PrimarySpec::Surface(surface) => {
            let wrong = |error: carom_case::NoMesh| {
                let what = "the surface cannot be used".to_owned();
                Problem::new(format!("contact[{contact}].primary.surface.file"), what, error.to_string(), "")
            };
            Obstacle::Faceted(Faceted::new(surface.triangles().map_err(wrong)?))
        }
        PrimarySpec::Polyline { points, radius } => {
            let wrong = |error: carom_contact::PolylineError| {
                let what = "the polyline is not a surface".to_owned();
                let help = "move a point, leave one out, or reduce `radius`";
                Problem::new(format!("contact[{contact}].primary.polyline"), what, error.to_string(), help)
            };
            Obstacle::Polyline(Polyline::new(points, *radius).map_err(wrong)?)
        }
    }))
}

/// An obstacle that moves.
pub(super) struct Moving<'a> {
    /// Index of its contact.
    pub(super) contact: usize,
    /// Index of its part.
    pub(super) part: usize,
    pub(super) carrier: Carrier,
    pub(super) motion: &'a ObstacleMotion,
    name: &'a str,
    dimension: usize,
}

/// Adds the parts that carry the moving obstacles of a case; a simplex has edges of this length.
pub(super) fn carriers<'a>(
    case: &'a Case,
    parts: &mut Vec<BodyInstance>,
    length: f64,
) -> Result<Vec<Moving<'a>>, Vec<Problem>> {
    let d = case.dimension;
    let mut moving = Vec::new();
    for (contact, spec) in case.contacts.iter().enumerate() {
        let (origin, mass) = match &spec.motion {
            ObstacleMotion::Fixed => continue,
            ObstacleMotion::Prescribed { rotate: Some((_, about)), .. } => (about.clone(), 0.0),
            ObstacleMotion::Prescribed { .. } => (point_of(&spec.primary), 0.0),
            ObstacleMotion::Free { mass, .. } => (point_of(&spec.primary), *mass),
        };
        let node = parts.last().map_or(0, |part| part.nodes().end);
        let padded = std::array::from_fn(|i| origin.get(i).copied().unwrap_or(0.0));
        let nodes = (node..node + spec.motion.nodes(d)).collect();
        let carrier = Carrier { nodes, origin: padded, length };
        let mesh = Mesh {
            element: [Element::L2, Element::T3, Element::Tet4][d.clamp(1, 3) - 1],
            nodes: Positions::new(d, carrier.places(d)),
            cells: Vec::new(),
            sides: std::collections::BTreeMap::new(),
            regions: Vec::new(),
            repairs: Vec::new(),
        };
        // Without cells the law does not matter.
        let law = Law::LinearElastic { lambda: 0.0, mu: 1.0 };
        let body = carom_solid::body(mesh, law, 0.0, 1.0).map_err(|error| {
            let what = format!("the obstacle of contact \"{}\" cannot be used", spec.name);
            vec![Problem::new(spec.path("primary"), what, error.to_string(), "")]
        })?;
        parts.push(BodyInstance::rigid(spec.name.clone(), node, body, mass));
        let part = parts.len() - 1;
        let motion = &spec.motion;
        moving.push(Moving { contact, part, carrier, motion, name: &spec.name, dimension: d });
    }
    Ok(moving)
}

/// The point of a shape that its motion refers to.
fn point_of(primary: &PrimarySpec) -> Vec<f64> {
    match primary {
        PrimarySpec::Side(_) => Vec::new(),
        // The origin of its coordinates.
        PrimarySpec::Surface(_) => vec![0.0; 3],
        PrimarySpec::Plane { point, .. } | PrimarySpec::Cylinder { point, .. } => point.clone(),
        PrimarySpec::Circle { center, .. } => center.clone(),
        PrimarySpec::Polyline { points, .. } => points.first().map_or_else(Vec::new, |p| p.to_vec()),
    }
}

impl Moving<'_> {
    /// Initial velocity of its nodes; zero if the motion is prescribed.
    pub(super) fn velocity(&self) -> Vec<f64> {
        match self.motion {
            ObstacleMotion::Free { velocity, .. } => velocity.clone(),
            motion => vec![0.0; motion.nodes(self.dimension) * self.dimension],
        }
    }

    /// Gravity; none if the motion is prescribed.
    pub(super) fn gravity(&self) -> &[FormulaSpec] {
        match self.motion {
            ObstacleMotion::Free { gravity, .. } => gravity,
            _ => &[],
        }
    }

    /// All its dofs, if its motion is prescribed.
    pub(super) fn prescribed(&self) -> impl Iterator<Item = usize> {
        let d = self.dimension;
        let is_prescribed = matches!(self.motion, ObstacleMotion::Prescribed { .. });
        let nodes = self.carrier.nodes.iter().copied().filter(move |_| is_prescribed);
        nodes.flat_map(move |node| node * d..(node + 1) * d)
    }

    /// The dofs that do not move.
    pub(super) fn fixed(&self) -> Vec<usize> {
        match self.motion {
            ObstacleMotion::Prescribed { moves, rotate: None, .. } => {
                let moves = |dof: &usize| moves.iter().any(|(axis, _)| *axis == dof % self.dimension);
                self.prescribed().filter(|dof| !moves(dof)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Its prescribed motions, with the dofs that follow each.
    pub(super) fn motions(&self, case: &Case) -> Result<Vec<(Vec<usize>, Motion)>, Problem> {
        let ObstacleMotion::Prescribed { moves, rotate, axis } = self.motion else { return Ok(Vec::new()) };
        let path = format!("{}.motion", case.contacts[self.contact].path("primary"));
        let read = |formula: &FormulaSpec| in_space_and_time(case, formula, &path);
        if let Some((angle, about)) = rotate {
            let along =
                |axis: usize| moves.iter().find(|(i, _)| *i == axis).map(|(_, formula)| read(formula));
            let turn = Turn {
                label: self.label(),
                moves: (0..self.dimension).map(|axis| along(axis).transpose()).collect::<Result<_, _>>()?,
                angle: read(angle)?,
                centre: about.clone(),
                axis: unit(axis.as_deref().unwrap_or(&[0.0, 0.0, 1.0])),
            };
            return Ok(vec![(self.prescribed().collect(), Motion::Rigid(turn))]);
        }
        let along = |(axis, formula): &(usize, FormulaSpec)| {
            let dofs = self.prescribed().filter(|dof| dof % self.dimension == *axis).collect();
            Ok((dofs, Motion::Displacement { label: self.label(), formula: read(formula)? }))
        };
        moves.iter().map(along).collect()
    }

    /// The support whose reaction is that of the obstacle; none if it is free.
    pub(super) fn support(&self) -> Option<Support> {
        let dofs: Vec<usize> = self.prescribed().collect();
        let name = self.name.to_owned();
        let moment_about = self.carrier.turns().then_some(Pivot::Node(self.carrier.nodes[0]));
        (!dofs.is_empty()).then_some(Support { name, dofs, moment_about })
    }

    /// Description for messages.
    pub(super) fn label(&self) -> String {
        format!("the motion of the obstacle of contact \"{}\"", self.name)
    }
}

/// A direction as a vector of length one.
fn unit(axis: &[f64]) -> [f64; 3] {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    std::array::from_fn(|i| axis[i] / length)
}
