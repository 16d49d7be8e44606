//! The elimination order, with chosen unknowns B last, and the structure of the factor that follows
//! from it. B is ordered as one vertex of the graph (`symbolic.rs`) and then moved to the end.
//!
//! A (super)node is a run of columns with the same rows below them. The forest of nodes is cut into
//! parts (`forest.rs`) that can be processed in parallel.

use std::ops::Range;

use faer::sparse::FaerError;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;

use crate::forest::{Cut, Partition, cut};
use crate::linear::LinearError;
use crate::pattern::Pattern;
use crate::symbolic::{EliminationTree, Upper, grouped_ordering};

/// Symbolic factor of a sparse matrix. It depends on the pattern and the last unknowns, and serves
/// several matrices.
#[derive(Debug)]
pub struct Elimination {
    /// Place of each unknown in the elimination order.
    pub(crate) place: Vec<u32>,
    /// The unknown at each place of the elimination order.
    pub(crate) order: Vec<u32>,
    /// Index of each unknown in the vector of a solve.
    pub(crate) positions: Vec<u32>,
    /// Number of inner unknowns: those that are not eliminated last.
    pub(crate) inner: usize,
    /// Supernodes in elimination order, and a sentinel that ends the ranges of the last one.
    pub(crate) nodes: Vec<Node>,
    /// Rows below the columns of each supernode, as places in the elimination order, ascending.
    pub(crate) below: Vec<u32>,
    /// Rows below the columns of each supernode, in the numbering of the part to which the
    /// supernode belongs.
    pub(crate) local: Vec<u32>,
    /// Entries of the pattern, supernode by supernode; those between last unknowns come at the end.
    pub(crate) entries: Vec<u32>,
    /// Index of each entry of the pattern in the values of its supernode, or in the Schur
    /// complement.
    pub(crate) slots: Vec<u32>,
    /// The part of the forest that contains all others.
    pub(crate) root: Subtree,
    /// Indices of the pattern's diagonal entries.
    pub(crate) diagonal: Vec<u32>,
}

/// A supernode: consecutive columns with the same rows below them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Node {
    /// First column of the supernode.
    pub(crate) first: u32,
    /// Start of the rows of the supernode in [`Elimination::below`].
    pub(crate) rows: u32,
    /// Start of the entries of the supernode in [`Elimination::entries`].
    pub(crate) entries: u32,
    /// The supernode that contains the first row below the columns; [`LAST`] if that is one of the
    /// last unknowns, or there is none.
    pub(crate) parent: u32,
    /// Start of the values of the supernode: its columns with all their rows, one after the other.
    pub(crate) values: usize,
}

/// Stands for the parent of a supernode whose update goes to the unknowns eliminated last.
pub(crate) const LAST: u32 = u32::MAX;

/// A part of the forest of supernodes. Its section of a vector holds the sections of its child
/// parts, its own columns, and the outer rows that they couple to. Local row numbers refer to the
/// latter two.
#[derive(Debug)]
pub(crate) struct Subtree {
    pub(crate) parts: Option<Box<[Subtree; 2]>>,
    /// Supernodes of the part without those of its child parts.
    pub(crate) nodes: Range<usize>,
    /// Columns of the part without those of its child parts.
    pub(crate) columns: Range<usize>,
    /// Outer rows of the part in the numbering of its parent part; the last unknowns for the root.
    pub(crate) outer: Vec<u32>,
    /// Length of the section of the part in a vector.
    pub(crate) length: usize,
    /// Start of the values of the part, including those of its child parts.
    pub(crate) values: usize,
    /// Size of the stack of update matrices for the part's own supernodes.
    pub(crate) room: usize,
    /// Largest number of rows of a supernode of the part.
    pub(crate) height: usize,
}

impl Elimination {
    /// Orders and analyses a pattern. Unknowns of a group stay together; those in `last` come last.
    ///
    /// # Errors
    /// The engine ran out of memory or indices.
    pub fn new(pattern: &Pattern, groups: &[usize], last: &[usize]) -> Result<Self, LinearError> {
        let n = pattern.size();
        let engine = |error: FaerError| match error {
            FaerError::OutOfMemory => LinearError::Memory { size: n },
            other => LinearError::Engine { size: n, reason: format!("{other:?}") },
        };
        let mut is_last = vec![false; n];
        last.iter().for_each(|&i| is_last[i] = true);
        // Without couplings any order will do, and nothing is worth a thread of its own.
        let is_diagonal = pattern.is_diagonal();
        let whole = groups.iter().max().map_or(0, |g| g + 1);
        let merged: Vec<usize> = (0..n).map(|i| if is_last[i] { whole } else { groups[i] }).collect();
        let mut names = merged.clone();
        names.sort_unstable();
        names.dedup();
        let merged: Vec<usize> = merged.iter().map(|g| names.partition_point(|name| name < g)).collect();
        let forward = if is_diagonal {
            (0..n).collect()
        } else {
            grouped_ordering(pattern, &merged).map_err(engine)?
        };
        let inner = n - last.len();
        let mut order: Vec<u32> = forward.iter().filter(|&&i| !is_last[i]).map(|&i| i as u32).collect();
        order.extend(forward.iter().filter(|&&i| is_last[i]).map(|&i| i as u32));

        let EliminationTree { parents, counts } =
            Upper::new(pattern, &inverse(&order), inner).tree().map_err(engine)?;
        let parent = |j: usize| usize::try_from(parents[j]).ok().filter(|&p| p < inner);
        let weight = |j: usize| if is_diagonal { 0 } else { u64::from(counts[j]) };
        let Partition { order: sorted, tree } = cut(inner, parent, weight);
        let moved: Vec<u32> = sorted.iter().map(|&k| order[k as usize]).collect();
        order[..inner].copy_from_slice(&moved);
        let place = inverse(&order);
        let raw = Upper::new(pattern, &place, inner).supernodes().map_err(engine)?;

        let mut elimination = Self {
            place,
            order,
            positions: Vec::new(),
            inner,
            nodes: Vec::new(),
            below: Vec::new(),
            local: Vec::new(),
            entries: Vec::new(),
            slots: Vec::new(),
            root: Subtree::default(),
            diagonal: (0..n).filter_map(|i| pattern.slot(i, i)).map(|k| k as u32).collect(),
        };
        elimination.collect_nodes(&raw);
        elimination.collect_entries(pattern);
        elimination.local = vec![0; elimination.below.len()];
        let outside: Vec<u32> = (inner as u32..n as u32).collect();
        let mut begin = (0, 0);
        elimination.root = elimination.part(&tree, &mut begin, Some(outside)).0;
        elimination.positions = vec![0; n];
        let mut positions = std::mem::take(&mut elimination.positions);
        elimination.locate(&elimination.root, 0, &mut positions);
        let tail = elimination.root.length - elimination.schur_size();
        (inner..n).for_each(|k| positions[elimination.order[k] as usize] = (tail + k - inner) as u32);
        elimination.positions = positions;
        Ok(elimination)
    }

    /// Number of unknowns eliminated last.
    pub fn schur_size(&self) -> usize {
        self.place.len() - self.inner
    }

    /// Place of an unknown among those eliminated last; none for an inner unknown.
    pub fn schur_place(&self, unknown: usize) -> Option<usize> {
        (self.place[unknown] as usize).checked_sub(self.inner)
    }

    /// Number of parts that do not depend on others and can be processed at the same time.
    pub fn parts(&self) -> usize {
        self.root.leaves()
    }

    /// Number of values of the factor.
    pub(crate) fn len_values(&self) -> usize {
        self.nodes.last().map_or(0, |end| end.values)
    }

    /// Columns of a supernode.
    #[inline(always)]
    pub(crate) fn columns(&self, s: usize) -> Range<usize> {
        self.nodes[s].first as usize..self.nodes[s + 1].first as usize
    }

    /// Range of the rows below the columns of a supernode.
    #[inline(always)]
    pub(crate) fn rows(&self, s: usize) -> Range<usize> {
        self.nodes[s].rows as usize..self.nodes[s + 1].rows as usize
    }

    /// Collects the columns of the inner unknowns into supernodes.
    fn collect_nodes(&mut self, raw: &SymbolicSupernodalCholesky<u32>) {
        let inner = self.inner;
        let mut node_of = vec![LAST; self.place.len()];
        let mut values = 0;
        for s in 0..raw.n_supernodes() {
            let first = raw.supernode_begin()[s] as usize;
            let end = raw.supernode_end()[s] as usize;
            if first >= inner {
                break;
            }
            self.nodes.push(Node {
                first: first as u32,
                rows: self.below.len() as u32,
                values,
                ..Node::default()
            });
            let own = end.min(inner);
            node_of[first..own].fill(s as u32);
            self.below.extend(own as u32..end as u32);
            let start = raw.col_ptr_for_row_idx()[s] as usize;
            self.below.extend_from_slice(&raw.row_idx()[start..][..raw.nnz_per_super()[s] as usize]);
            let below = self.below.len() - self.nodes[s].rows as usize;
            values += (own - first) * (own - first + below);
        }
        self.nodes.push(Node {
            first: inner as u32,
            rows: self.below.len() as u32,
            values,
            ..Node::default()
        });
        for s in 0..self.nodes.len() - 1 {
            self.nodes[s].parent =
                self.below[self.rows(s)].first().map_or(LAST, |&row| node_of[row as usize]);
        }
    }

    /// Determines the index of each entry of the pattern in the factor.
    fn collect_entries(&mut self, pattern: &Pattern) {
        let n = pattern.size();
        let inner = self.inner;
        let place = &self.place;
        let entry = |i: usize, j: usize| (place[i].max(place[j]), place[i].min(place[j]));
        // Sorted by columns first.
        let mut fill = vec![0_u32; n + 1];
        for j in 0..n {
            pattern.column(j).iter().for_each(|&i| fill[entry(i, j).1 as usize + 1] += 1);
        }
        (0..n).for_each(|j| fill[j + 1] += fill[j]);
        let starts = fill.clone();
        let mut rows = vec![0_u32; pattern.len()];
        let mut entries = vec![0_u32; pattern.len()];
        for j in 0..n {
            for k in pattern.starts[j]..pattern.starts[j + 1] {
                let (row, column) = entry(pattern.rows[k], j);
                let target = fill[column as usize] as usize;
                fill[column as usize] += 1;
                rows[target] = row;
                entries[target] = k as u32;
            }
        }
        let mut slots = rows;
        let mut row_of = vec![0_u32; n];
        for s in 0..self.nodes.len() - 1 {
            let columns = self.columns(s);
            let below = &self.below[self.rows(s)];
            let height = columns.len() + below.len();
            columns.clone().for_each(|row| row_of[row] = (row - columns.start) as u32);
            below.iter().enumerate().for_each(|(k, &row)| row_of[row as usize] = (columns.len() + k) as u32);
            for j in columns.clone() {
                for slot in &mut slots[starts[j] as usize..starts[j + 1] as usize] {
                    *slot = row_of[*slot as usize] + ((j - columns.start) * height) as u32;
                }
            }
            self.nodes[s].entries = starts[columns.start];
        }
        if let Some(end) = self.nodes.last_mut() {
            end.entries = starts[inner];
        }
        for j in inner..n {
            for slot in &mut slots[starts[j] as usize..starts[j + 1] as usize] {
                *slot = ((j - inner) * (n - inner) + *slot as usize - inner) as u32;
            }
        }
        self.entries = entries;
        self.slots = slots;
    }

    /// Builds a part and its child parts, beginning at supernode and column `begin`. Also returns
    /// the outer rows, unless they are given.
    fn part(
        &mut self,
        tree: &Cut,
        begin: &mut (usize, usize),
        outside: Option<Vec<u32>>,
    ) -> (Subtree, Vec<u32>) {
        let values = self.nodes[begin.0].values;
        let mut below = tree.parts.as_ref().map(|parts| {
            let [a, b] = &**parts;
            [self.part(a, begin, None), self.part(b, begin, None)]
        });
        let (first, start) = *begin;
        // A node that spans two parts belongs to the one in which it ends.
        let mut end = first;
        while end + 1 < self.nodes.len() && self.nodes[end + 1].first as usize <= tree.end {
            end += 1;
        }
        let stop = (self.nodes[end].first as usize).max(start);
        *begin = (end, stop);
        let own = stop - start;
        let outside = outside.unwrap_or_else(|| {
            let rows = self.below[self.nodes[first].rows as usize..self.nodes[end].rows as usize].iter();
            let deeper = below.iter().flatten().flat_map(|(_, outer)| outer);
            let mut outer: Vec<u32> =
                rows.chain(deeper).copied().filter(|&row| row as usize >= stop).collect();
            outer.sort_unstable();
            outer.dedup();
            outer
        });
        let number = |row: u32| match (row as usize).checked_sub(stop) {
            None => row - start as u32,
            Some(_) => (own + outside.partition_point(|&other| other < row)) as u32,
        };
        for k in self.nodes[first].rows as usize..self.nodes[end].rows as usize {
            self.local[k] = number(self.below[k]);
        }
        let mut length = own + outside.len();
        for (part, outer) in below.iter_mut().flatten() {
            part.outer = outer.iter().map(|&row| number(row)).collect();
            length += part.length;
        }
        let height = (first..end).map(|s| self.columns(s).len() + self.rows(s).len()).max().unwrap_or(0);
        let room = self.room(first..end);
        let parts = below.map(|[(a, _), (b, _)]| Box::new([a, b]));
        let outer = Vec::new();
        (
            Subtree { parts, nodes: first..end, columns: start..stop, outer, length, values, room, height },
            outside,
        )
    }

    /// Largest size of the stack of update matrices while supernodes are factored in order.
    fn room(&self, nodes: Range<usize>) -> usize {
        let mut waiting: Vec<(u32, usize)> = Vec::new();
        let mut stacked = 0;
        let mut room = 0;
        for s in nodes {
            let square = self.rows(s).len().pow(2);
            room = room.max(stacked + square);
            while let Some((_, size)) = waiting.pop_if(|(parent, _)| *parent as usize == s) {
                stacked -= size;
            }
            stacked += square;
            waiting.push((self.nodes[s].parent, square));
        }
        room
    }

    /// Sets the indices of the unknowns of a part in a vector in which its section begins at
    /// `start`.
    fn locate(&self, part: &Subtree, start: usize, positions: &mut [u32]) {
        let mut own = start;
        for part in part.parts.iter().flat_map(|parts| parts.iter()) {
            self.locate(part, own, positions);
            own += part.length;
        }
        for (k, j) in part.columns.clone().enumerate() {
            positions[self.order[j] as usize] = (own + k) as u32;
        }
    }
}

impl Subtree {
    fn leaves(&self) -> usize {
        self.parts.as_ref().map_or(1, |parts| parts.iter().map(Self::leaves).sum())
    }
}

impl Default for Subtree {
    fn default() -> Self {
        let outer = Vec::new();
        Self { parts: None, nodes: 0..0, columns: 0..0, outer, length: 0, values: 0, room: 0, height: 0 }
    }
}

fn inverse(order: &[u32]) -> Vec<u32> {
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(k, &i)| place[i as usize] = k as u32);
    place
}
