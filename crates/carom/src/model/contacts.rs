//! From the contacts of a case to methods that measure gaps, per dimension: the one line to add for a new contact method is here.

use carom_contact::{ContactMethod, NodeToNode, NodeToPlane, NodeToSegment, Surface};

use crate::case::{ContactSpec, Detection};

/// A side in global node numbers.
#[derive(Clone, Debug)]
pub(super) struct GlobalSide {
    /// Its nodes, each once, in the order of the walk.
    pub nodes: Vec<usize>,
    /// Nodes of each facet.
    pub facets: Vec<Vec<usize>>,
    /// Dimension 1: ±1, the direction out of the body.
    pub outward: f64,
}

/// A dimension in which sides can touch.
pub trait Touching<const D: usize> {
    /// Method for two sides of bodies.
    fn between(spec: &ContactSpec, secondary: &[usize], primary: &[Vec<usize>], outward: f64) -> Box<dyn ContactMethod<D>>;
}

/// Marker that carries the implementations.
pub struct Space;

impl Touching<1> for Space {
    fn between(_: &ContactSpec, secondary: &[usize], primary: &[Vec<usize>], outward: f64) -> Box<dyn ContactMethod<1>> {
        Box::new(NodeToNode::new(secondary[0], primary[0][0], outward))
    }
}

impl Touching<2> for Space {
    fn between(spec: &ContactSpec, secondary: &[usize], primary: &[Vec<usize>], _: f64) -> Box<dyn ContactMethod<2>> {
        let detection = match spec.detection {
            Detection::ClosestPoint => carom_contact::Detection::ClosestPoint,
            Detection::Trajectory => carom_contact::Detection::Trajectory,
        };
        Box::new(NodeToSegment::new(secondary.to_vec(), Surface::new(primary), detection))
    }
}

pub(super) fn against_plane<const D: usize>(
    secondary: &GlobalSide,
    point: &[f64],
    normal: &[f64],
) -> Box<dyn ContactMethod<D>> {
    let array = |v: &[f64]| std::array::from_fn(|i| v[i]);
    Box::new(NodeToPlane::new(secondary.nodes.clone(), array(point), array(normal)))
}
