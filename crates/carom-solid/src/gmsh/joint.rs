//! Where two bodies of one file have the same nodes: cells on both sides of a facet that belong to
//! different bodies are not connected, since every body has its own nodes.

use std::collections::{BTreeSet, HashSet};

use super::error::MshError;
use super::file::{Block, MshFile};
use crate::mesh::Element;

/// Facets with the same nodes in two bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// How many facets.
    pub facets: usize,
    /// How many nodes both bodies have.
    pub nodes: usize,
    /// Least and largest coordinates of these nodes.
    pub extent: [[f64; 3]; 2],
    /// The physical groups that contain such facets.
    pub sides: Vec<String>,
}

/// The corners of a facet, ascending.
type Corners = Vec<usize>;

impl MshFile {
    /// The joint of the bodies that are two physical groups of this dimension, if they have one.
    ///
    /// # Errors
    /// Groups of which no body can be made.
    pub fn joint(&self, dimension: usize, bodies: [&str; 2]) -> Result<Option<Joint>, MshError> {
        let [a, b] = [self.facets(dimension, bodies[0])?, self.facets(dimension, bodies[1])?];
        let common: HashSet<&Corners> = a.intersection(&b).collect();
        if common.is_empty() {
            return Ok(None);
        }
        let nodes = |body: &str| -> BTreeSet<usize> {
            self.blocks(dimension, body).flat_map(|block| block.nodes.iter().copied()).collect()
        };
        let nodes: Vec<usize> = nodes(bodies[0]).intersection(&nodes(bodies[1])).copied().collect();
        let coordinates = |axis: usize| nodes.iter().map(move |&node| self.nodes[node].1[axis]);
        let least = |axis: usize| coordinates(axis).fold(f64::INFINITY, f64::min);
        let largest = |axis: usize| coordinates(axis).fold(f64::NEG_INFINITY, f64::max);
        let contains = |side: &&str| {
            let cells = self.blocks(dimension - 1, side).flat_map(Block::cells);
            let corners = common.iter().next().map_or(0, |corners| corners.len());
            let mut keys = cells.filter_map(|(_, nodes)| nodes.get(..corners).map(sorted));
            keys.any(|key| common.contains(&key))
        };
        let sides = self.names(dimension - 1).into_iter().filter(contains).map(str::to_owned);
        Ok(Some(Joint {
            facets: common.len(),
            nodes: nodes.len(),
            extent: [[0, 1, 2].map(least), [0, 1, 2].map(largest)],
            sides: sides.collect(),
        }))
    }

    /// The facets of all cells of a body.
    fn facets(&self, dimension: usize, body: &str) -> Result<HashSet<Corners>, MshError> {
        let mut facets = HashSet::new();
        for block in self.blocks(dimension, body) {
            let Some(element) = block.kind.element() else {
                let Some(row) = block.rows.first() else { continue };
                return Err(self.at(row, block.kind.unsupported(body, row.tag)));
            };
            let corners = corners(element);
            for (_, nodes) in block.cells() {
                facets.extend(element.facets().iter().map(|facet| {
                    sorted(&facet[..corners].iter().map(|&place| nodes[place]).collect::<Vec<_>>())
                }));
            }
        }
        if facets.is_empty() {
            return Err(MshError::whole(self.no_name(dimension, body)));
        }
        Ok(facets)
    }
}

/// Corners of a facet; they come first, in Gmsh's order of nodes as in ours.
fn corners(element: Element) -> usize {
    element.facet_shape().corners()
}

fn sorted(nodes: &[usize]) -> Corners {
    let mut nodes = nodes.to_vec();
    nodes.sort_unstable();
    nodes
}
