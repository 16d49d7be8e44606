//! Pieces: nodes of a body that its cells connect. A mesh with slits may consist of several, which
//! only contact holds together.

use super::body_instance::BodyInstance;
use super::points::Points;

/// A piece of a deformable body.
pub(crate) struct Piece {
    /// Index of the body.
    pub part: usize,
    /// Global numbers of its nodes, ascending.
    pub nodes: Vec<usize>,
}

/// The pieces of all deformable bodies, those together that ties connect.
pub(crate) fn tied_pieces(parts: &[BodyInstance], points: &Points) -> Vec<Vec<Piece>> {
    let pieces: Vec<Piece> = parts
        .iter()
        .enumerate()
        .filter(|(_, part)| !part.is_rigid())
        .flat_map(|(place, part)| pieces(place, part))
        .collect();
    let piece_of = |node: usize| pieces.iter().position(|piece| piece.nodes.binary_search(&node).is_ok());
    let mut group: Vec<usize> = (0..pieces.len()).collect();
    for point in points.iter() {
        for (carrier, _) in &point.weights {
            let (Some(a), Some(b)) = (piece_of(point.node), piece_of(*carrier)) else { continue };
            let [low, high] = [group[a].min(group[b]), group[a].max(group[b])];
            group.iter_mut().filter(|group| **group == high).for_each(|group| *group = low);
        }
    }
    let mut groups: Vec<Vec<Piece>> = pieces.iter().map(|_| Vec::new()).collect();
    pieces.into_iter().zip(group).for_each(|(piece, group)| groups[group].push(piece));
    groups.retain(|group| !group.is_empty());
    groups
}

/// The pieces of a body. A node of no cell is none.
fn pieces(place: usize, part: &BodyInstance) -> Vec<Piece> {
    let first_of = part.body.mesh().pieces();
    let mut nodes: Vec<Vec<usize>> = vec![Vec::new(); first_of.len()];
    for (node, &first) in first_of.iter().enumerate() {
        nodes[first].push(part.first_node + node);
    }
    nodes.retain(|nodes| nodes.len() > 1);
    nodes.into_iter().map(|nodes| Piece { part: place, nodes }).collect()
}
