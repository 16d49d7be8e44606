//! Drawn parts of the bodies: triangles between nodes, their edges, and the cells of solids.

use std::collections::{BTreeMap, HashSet};

use carom_record::{Block, Cell, FieldSet};

use crate::axis::range;
use crate::bodies::{is_plane, triangles};
use crate::recorded::Recorded;
use crate::space::{Facet, corners, skin};

/// Half the width of a bar, over the length of all bars.
const BAR: f64 = 0.03;

/// Triangles of the bodies in numbers of the kept nodes.
pub(super) struct Mesh {
    /// Kept points of the field files; of bars each point twice, at the lower and the upper edge.
    pub(super) nodes: Vec<usize>,
    /// Position of each kept node across a bar; zero otherwise.
    pub(super) across: Vec<f64>,
    /// Triangles, the lowest degree first.
    pub(super) facets: Vec<Facet>,
    /// For each triangle: bits 0 to 2 say which sides are edges of cells, two bits after them for
    /// each side whether it lies on a secondary (1) or primary (2) side of a contact.
    pub(super) flags: Vec<u16>,
    /// Cells of solids by shape and degree; empty where their inside is not kept.
    pub(super) cells: BTreeMap<(bool, usize), Vec<usize>>,
}

impl Mesh {
    /// The mesh of a run, whose first field file this is; `inside` keeps the cells of solids.
    pub(super) fn new(run: &Recorded, fields: &FieldSet, inside: bool) -> Self {
        if fields.blocks.iter().all(|block| block.cell == Cell::Curve) {
            return Self::of_bars(fields);
        }
        let mut facets = skin(fields);
        facets.extend(fields.blocks.iter().enumerate().flat_map(|(k, block)| of_plane(k, block)));
        facets.sort_by_key(|facet| facet.degree);
        let flags = flags(run, &facets);
        let mut cells: BTreeMap<(bool, usize), Vec<usize>> = BTreeMap::new();
        for block in fields.blocks.iter().filter(|block| inside && !is_plane(block)) {
            let key = (block.cell == Cell::Hexahedron, block.degree);
            cells.entry(key).or_default().extend(&block.connectivity);
        }
        let mut nodes: Vec<usize> = facets.iter().flat_map(|facet| facet.nodes.iter().copied()).collect();
        nodes.extend(cells.values().flatten());
        nodes.sort_unstable();
        nodes.dedup();
        let number = |node: &mut usize| *node = nodes.partition_point(|known| *known < *node);
        facets.iter_mut().flat_map(|facet| &mut facet.nodes).for_each(number);
        cells.values_mut().flatten().for_each(number);
        let across = vec![0.0; nodes.len()];
        Self { nodes, across, facets, flags, cells }
    }

    /// Bars as strips of triangles along the x axis.
    fn of_bars(fields: &FieldSet) -> Self {
        let count = fields.points.len();
        let xs: Vec<f64> = fields.points.iter().map(|point| point[0]).collect();
        let (low, high) = range(&xs);
        let half = BAR * (high - low);
        let mut facets = Vec::new();
        for (block, cell) in
            fields.blocks.iter().enumerate().flat_map(|(k, b)| b.cells().map(move |c| (k, c)))
        {
            let mut walk = cell.to_vec();
            walk.sort_by(|&a, &b| xs[a].total_cmp(&xs[b]));
            for (k, pair) in walk.windows(2).enumerate() {
                let [a, b] = [pair[0], pair[1]];
                let lower = Facet {
                    degree: 1,
                    nodes: vec![a, b, b + count],
                    sides: [true, k + 2 == walk.len(), false],
                    face: vec![],
                    block,
                };
                let upper = Facet {
                    degree: 1,
                    nodes: vec![a, b + count, a + count],
                    sides: [false, true, k == 0],
                    face: vec![],
                    block,
                };
                facets.extend([lower, upper]);
            }
        }
        let flags = facets.iter().map(edges).collect();
        let nodes = (0..count).chain(0..count).collect();
        let across = [-half, half].into_iter().flat_map(|y| vec![y; count]).collect();
        Self { nodes, across, facets, flags, cells: BTreeMap::new() }
    }
}

/// The triangles of the cells of a plane body.
fn of_plane(number: usize, block: &Block) -> Vec<Facet> {
    let mut facets = Vec::new();
    for cell in block.cells().filter(|_| is_plane(block)) {
        let halves = triangles(cell);
        let sides: &[[bool; 3]] =
            if halves.len() == 1 { &[[true; 3]] } else { &[[true, true, false], [false, true, true]] };
        for (nodes, sides) in halves.into_iter().zip(sides) {
            facets.push(Facet {
                degree: block.degree,
                nodes,
                sides: *sides,
                face: Vec::new(),
                block: number,
            });
        }
    }
    facets
}

/// Bits of the sides that are edges of cells.
fn edges(facet: &Facet) -> u16 {
    (0..3).filter(|&side| facet.sides[side]).map(|side| 1 << side).sum()
}

/// Edges of cells and sides of contacts.
fn flags(run: &Recorded, facets: &[Facet]) -> Vec<u16> {
    let mut flags: Vec<u16> = facets.iter().map(edges).collect();
    let contacts = run.case.contacts.iter();
    let named = contacts
        .flat_map(|c| c.primary.side().map(|side| (2, side)).into_iter().chain([(1, c.secondary.as_str())]));
    for (class, side) in named {
        let Some(parts) = run.manifest.sides.get(side) else { continue };
        let chain: HashSet<usize> = parts.iter().flatten().copied().collect();
        let faces: HashSet<Vec<usize>> = if run.case.dimension == 3 {
            parts.iter().map(|face| corners(face)).collect()
        } else {
            HashSet::new()
        };
        for (flag, facet) in flags.iter_mut().zip(facets) {
            let is_face = faces.contains(&facet.face);
            for edge in 0..3 {
                let ends = [facet.nodes[edge], facet.nodes[(edge + 1) % 3]];
                let is_on =
                    is_face || (run.case.dimension == 2 && ends.iter().all(|node| chain.contains(node)));
                if is_on && *flag & 1 << edge != 0 {
                    *flag |= class << (3 + 2 * edge);
                }
            }
        }
    }
    flags
}

/// Planes of symmetry of a half model, as axis and coordinate: sides in a plane across an axis that
/// are fixed along this axis only, with all bodies on one side of the plane.
pub(super) fn symmetries(run: &Recorded, fields: &FieldSet) -> Vec<(usize, f64)> {
    let dimension = run.case.dimension;
    let supports = &run.case.supports;
    let mut found: Vec<(usize, f64)> = Vec::new();
    for side in supports.iter().flat_map(|support| &support.on) {
        let of_side = || supports.iter().filter(|support| support.on.contains(side));
        let points: Vec<[f64; 3]> = run
            .manifest
            .sides
            .get(side)
            .into_iter()
            .flatten()
            .flatten()
            .filter_map(|&k| fields.points.get(k).copied())
            .collect();
        let Some(first) = points.first().filter(|_| dimension > 1) else { continue };
        for axis in 0..dimension {
            let extent = range(fields.points.iter().map(|point| &point[axis]));
            let near = 1e-9 * (extent.1 - extent.0);
            let is_flat = points.iter().all(|point| (point[axis] - first[axis]).abs() <= near);
            let is_free = of_side()
                .all(|support| support.moves.is_empty() && (support.normal || support.fix == [axis]));
            let is_end = first[axis] <= extent.0 + near || first[axis] >= extent.1 - near;
            if is_flat && is_free && is_end && found.iter().all(|known| known.0 != axis) {
                found.push((axis, first[axis]));
            }
        }
    }
    found
}
