//! Gaps with their gradients: one row per constraint over the nodes on which it depends, in
//! compressed rows.
//!
//! A gap g(y) is a frame-indifferent scalar; g < 0 is penetration. The force of a traction λ ≤ 0 is
//! λ ∇g, which implies balance of force and moment.

use carom_algebra::Vector;

use crate::constants::CANCELS;

/// Constraint rows: gaps with their gradients, all over positions of one dimension.
#[derive(Clone, Debug)]
pub struct Rows {
    dimension: usize,
    gaps: Vec<f64>,
    /// Start of the nodes of each row, and end of the last.
    starts: Vec<usize>,
    nodes: Vec<usize>,
    /// Gradient ∂g/∂y of each gap by each node of its row.
    gradients: Vec<f64>,
    /// Whether the first node of each row belongs to the primary side.
    reversed: Vec<bool>,
    /// For each row, the number of its first nodes that belong to one side.
    own: Vec<usize>,
}

/// A constraint row: a gap with its gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row<'a> {
    /// Gap g; infinite for a remote pair without a unique closest point.
    pub gap: f64,
    /// Global numbers of the nodes on which the gap depends; the node that faces a facet comes
    /// first.
    pub nodes: &'a [usize],
    /// Gradient ∂g/∂y of the gap, node-major.
    pub gradient: &'a [f64],
    /// Whether the first node of the row belongs to the primary side and the others to the
    /// secondary one.
    pub reversed: bool,
    /// Number of the first nodes of the row that belong to one side: one, or those of an edge.
    pub own: usize,
}

impl Rows {
    /// An empty set of rows, for positions of a dimension.
    pub fn new(dimension: usize) -> Self {
        Self {
            dimension,
            gaps: Vec::new(),
            starts: vec![0],
            nodes: Vec::new(),
            gradients: Vec::new(),
            reversed: Vec::new(),
            own: Vec::new(),
        }
    }

    /// Dimension of the positions.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.gaps.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.gaps.is_empty()
    }

    /// Removes all rows and keeps the memory.
    pub fn clear(&mut self) {
        self.gaps.clear();
        self.starts.truncate(1);
        self.nodes.clear();
        self.gradients.clear();
        self.reversed.clear();
        self.own.clear();
    }

    /// Adds a row from its gap and its nodes with their gradients ∂g/∂y, of which as many
    /// components are used as there are dimensions.
    pub fn push<const P: usize>(&mut self, gap: f64, nodes: impl IntoIterator<Item = (usize, [f64; P])>) {
        self.gaps.push(gap);
        self.reversed.push(false);
        self.own.push(1);
        for (node, gradient) in nodes {
            self.nodes.push(node);
            self.gradients.extend_from_slice(&gradient[..self.dimension]);
        }
        self.starts.push(self.nodes.len());
    }

    /// Adds a row from its gap and the gradients ∂g/∂y for the nodes of one side, then for those of
    /// the other.
    pub(crate) fn push_both<const P: usize>(
        &mut self,
        gap: f64,
        [own, other]: [&[usize]; 2],
        slopes: impl Iterator<Item = Vector<P>>,
    ) {
        let nodes = own.iter().chain(other);
        self.push(gap, nodes.zip(slopes).map(|(&node, slope)| (node, slope.0)));
    }

    /// Adds a row from its gap and the gradients for its nodes, of which the first `own` belong to
    /// the secondary side.
    pub(crate) fn push_of_many<const P: usize>(
        &mut self,
        gap: f64,
        nodes: &[usize],
        own: usize,
        slopes: &[Vector<P>],
    ) {
        self.push(gap, nodes.iter().zip(slopes).map(|(&node, slope)| (node, slope.0)));
        self.begin_with_edge(own);
    }

    /// Adds the row of a remote pair: it depends on nothing.
    pub fn push_open(&mut self) {
        self.push::<0>(f64::INFINITY, []);
    }

    /// Removes the last row and returns its gap, infinite if there was none.
    pub fn pop(&mut self) -> f64 {
        let Some(&gap) = self.gaps.last() else { return f64::INFINITY };
        self.truncate(self.len() - 1);
        gap
    }

    /// Removes all rows from `first` on.
    pub(crate) fn truncate(&mut self, first: usize) {
        self.gaps.truncate(first);
        self.starts.truncate(first + 1);
        self.reversed.truncate(first);
        self.own.truncate(first);
        let end = self.starts.last().copied().unwrap_or(0);
        self.nodes.truncate(end);
        self.gradients.truncate(end * self.dimension);
    }

    /// Adds a copy of a row of the same dimension.
    pub fn push_row(&mut self, row: Row) {
        self.gaps.push(row.gap);
        self.reversed.push(row.reversed);
        self.own.push(row.own);
        self.nodes.extend_from_slice(row.nodes);
        self.gradients.extend_from_slice(row.gradient);
        self.starts.push(self.nodes.len());
    }

    /// Adds a copy of a row with only those of its nodes that are at some places.
    pub fn push_part(&mut self, row: Row, places: &[usize]) {
        let d = row.dimension();
        self.gaps.push(row.gap);
        self.reversed.push(row.reversed);
        self.own.push(places.iter().filter(|&&place| place < row.own).count());
        for &place in places {
            self.nodes.push(row.nodes[place]);
            self.gradients.extend_from_slice(&row.gradient[place * d..(place + 1) * d]);
        }
        self.starts.push(self.nodes.len());
    }

    /// Adds a linear combination, with these factors, of consecutive rows over the same nodes, from
    /// the row `first` of `rows` on.
    pub fn push_combined(&mut self, rows: &Self, first: usize, factors: &[f64]) {
        self.push_row(rows.row(first));
        let last = self.len() - 1;
        self.gaps[last] *= factors[0];
        self.gradient_mut(last).iter_mut().for_each(|slope| *slope *= factors[0]);
        for (i, factor) in factors.iter().enumerate().skip(1) {
            let row = rows.row(first + i);
            self.gaps[last] += factor * row.gap;
            self.gradient_mut(last)
                .iter_mut()
                .zip(row.gradient)
                .for_each(|(sum, slope)| *sum += factor * slope);
        }
    }

    /// Replaces the rows from `first` on by the means of every `stride`-th of them, each over all
    /// their nodes: the nodes, or the nodes of the edges, with which the rows begin, then the
    /// others, each in the order of the rows.
    pub(crate) fn average_from(&mut self, first: usize, stride: usize) {
        let end = self.len();
        (first..(first + stride).min(end)).for_each(|row| self.push_mean(row, end, stride));
        let [from, to] = [first, end].map(|row| self.starts[row]);
        self.gaps.drain(first..end);
        self.reversed.drain(first..end);
        self.own.drain(first..end);
        self.nodes.drain(from..to);
        self.gradients.drain(self.dimension * from..self.dimension * to);
        self.starts.drain(first..end);
        self.starts[first..].iter_mut().for_each(|start| *start -= to - from);
    }

    /// Adds the mean of every `stride`-th row from `first` to `end`.
    fn push_mean(&mut self, first: usize, end: usize, stride: usize) {
        let rows = (first..end).step_by(stride);
        let share = 1.0 / rows.len() as f64;
        let d = self.dimension;
        let start = self.nodes.len();
        let gap: f64 = rows.clone().map(|row| share * self.gaps[row]).sum();
        let mut own = 0;
        for is_own in [true, false] {
            for row in rows.clone() {
                let [from, to] = [self.starts[row], self.starts[row + 1]];
                // An open row has no nodes.
                let middle = (from + self.own[row]).min(to);
                for k in if is_own { from..middle } else { middle..to } {
                    let node = self.nodes[k];
                    let known = self.nodes[start..].iter().position(|&other| other == node);
                    let at = start + known.unwrap_or(self.nodes.len() - start);
                    if known.is_none() {
                        self.nodes.push(node);
                        self.gradients.resize(d * self.nodes.len(), 0.0);
                    }
                    for i in 0..d {
                        self.gradients[d * at + i] += share * self.gradients[d * k + i];
                    }
                }
            }
            own = if is_own { self.nodes.len() - start } else { own };
        }
        self.gaps.push(gap);
        self.reversed.push(false);
        self.own.push(own);
        self.starts.push(self.nodes.len());
    }

    /// The unit tangents of a slip in space, whose rows begin with `first`: the orthonormal pair
    /// nearest to the rows' gradients for the first node. Over a joint these are means over several
    /// facets and shorter across it; the nearest pair does not turn, however often it is carried
    /// there and back. The gradients themselves where they are parallel; zero in the plane, where
    /// the normal gives the tangent.
    pub fn tangents(&self, first: usize) -> [[f64; 3]; 2] {
        if self.dimension != 3 {
            return [[0.0; 3]; 2];
        }
        let [along, across] = [first, first + 1].map(|row| Vector(self.row(row).first()));
        // The orthogonal factor of a polar decomposition, by the root of the Gram matrix.
        let mixed = along.dot(&across);
        let squares = [along.dot(&along), across.dot(&across)];
        let area = (squares[0] * squares[1] - mixed * mixed).max(0.0).sqrt();
        if area <= CANCELS * (squares[0] + squares[1]) {
            return [along.0, across.0];
        }
        let scale = area * (squares[0] + squares[1] + 2.0 * area).sqrt();
        let unit = |own: Vector<3>, of_other: f64, other: Vector<3>| {
            (own * (of_other + area) - other * mixed) * scale.recip()
        };
        [unit(along, squares[1], across).0, unit(across, squares[0], along).0]
    }

    /// Turns two consecutive rows a, b over the same nodes, from `first` on, to ia + jb and ib −
    /// ja.
    pub fn turn(&mut self, first: usize, [i, j]: [f64; 2]) {
        let mixed = |[a, b]: [f64; 2]| [i * a + j * b, i * b - j * a];
        let gaps = mixed([self.gaps[first], self.gaps[first + 1]]);
        self.gaps[first..first + 2].copy_from_slice(&gaps);
        let start = self.dimension * self.starts[first];
        let size = self.dimension * (self.starts[first + 1] - self.starts[first]);
        for k in start..start + size {
            let turned = mixed([self.gradients[k], self.gradients[k + size]]);
            [self.gradients[k], self.gradients[k + size]] = turned;
        }
    }

    /// The row with a given index.
    pub fn row(&self, row: usize) -> Row<'_> {
        let range = self.starts[row]..self.starts[row + 1];
        let gradients = range.start * self.dimension..range.end * self.dimension;
        Row {
            gap: self.gaps[row],
            nodes: &self.nodes[range],
            gradient: &self.gradients[gradients],
            reversed: self.reversed[row],
            own: self.own[row],
        }
    }

    /// Marks the rows from `first` on as those of a node of the primary side against the secondary
    /// one, or not.
    pub(crate) fn reverse_from(&mut self, first: usize, reversed: bool) {
        self.reversed[first..].fill(reversed);
    }

    /// Marks the last row as that of an edge, which its first `own` nodes form.
    pub(crate) fn begin_with_edge(&mut self, own: usize) {
        if let Some(last) = self.own.last_mut() {
            *last = own;
        }
    }

    /// All rows in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Row<'_>> {
        (0..self.len()).map(|row| self.row(row))
    }

    /// The gradient of a row for changes: a discrete gradient replaces that at the midpoint.
    pub fn gradient_mut(&mut self, row: usize) -> &mut [f64] {
        &mut self.gradients[self.starts[row] * self.dimension..self.starts[row + 1] * self.dimension]
    }

    /// The gap of a row for changes: conserving springs accumulate their own.
    pub fn gap_mut(&mut self, row: usize) -> &mut f64 {
        &mut self.gaps[row]
    }
}

impl Row<'_> {
    /// Dimension of the positions.
    pub fn dimension(&self) -> usize {
        if self.nodes.is_empty() { 0 } else { self.gradient.len() / self.nodes.len() }
    }

    /// Whether the gradient for the node at a place is zero.
    pub fn is_zero_at(&self, place: usize) -> bool {
        let d = self.dimension();
        self.gradient[place * d..(place + 1) * d].iter().all(|slope| *slope == 0.0)
    }

    /// Global dofs of the row with the components of ∂g/∂y, in order.
    pub fn entries(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let d = self.dimension();
        let dofs = self.nodes.iter().flat_map(move |node| (0..d).map(move |i| node * d + i));
        dofs.zip(self.gradient.iter().copied())
    }

    /// Scalar product ∇g·x of the gradient with a vector over all dofs.
    pub fn along(&self, x: &[f64]) -> f64 {
        self.entries().map(|(dof, slope)| slope * x[dof]).sum()
    }

    /// Cosine of the angle between the gradients of two rows; 0 of an open one.
    pub fn alike(&self, other: &Row) -> f64 {
        let square = |row: &Row| row.gradient.iter().map(|slope| slope * slope).sum::<f64>();
        let same = |(dof, slope): (usize, f64)| {
            other.entries().filter(|(of, _)| *of == dof).map(|(_, of)| slope * of).sum::<f64>()
        };
        let lengths = (square(self) * square(other)).sqrt();
        if lengths > 0.0 { self.entries().map(same).sum::<f64>() / lengths } else { 0.0 }
    }

    /// Adds a multiple of the gradient ∇g to a force over all dofs.
    pub fn add_to(&self, factor: f64, force: &mut [f64]) {
        for (dof, slope) in self.entries() {
            force[dof] += factor * slope;
        }
    }

    /// The gradient of the first node, or of the first edge as a whole, padded with zeros to space.
    pub fn first(&self) -> [f64; 3] {
        let d = self.dimension();
        let of = |i: usize| {
            let rest = (1..self.own).map(|node| self.gradient[node * d + i]);
            rest.fold(self.gradient[i], |sum, slope| sum + slope)
        };
        std::array::from_fn(|i| if i < d { of(i) } else { 0.0 })
    }

    /// Nodes of the first edge with their shares in its contact point; for a node, the node itself
    /// with the share one.
    pub fn shares(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let d = self.dimension();
        let whole = self.first();
        let share = move |node: usize| (0..d).map(|i| self.gradient[node * d + i] * whole[i]).sum::<f64>();
        (0..self.own).map(move |k| (self.nodes[k], if self.own == 1 { 1.0 } else { share(k) }))
    }

    /// Outward unit normal of the primary side, padded with zeros to space: the gradient ∂g/∂y for
    /// the first node, with the other sign if that node belongs to the primary.
    pub fn normal(&self) -> [f64; 3] {
        let sign = if self.reversed { -1.0 } else { 1.0 };
        self.first().map(|slope| sign * slope)
    }
}
