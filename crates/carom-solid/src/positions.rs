//! Points in one, two or three dimensions, contiguous in memory: the interface of a mesh to
//! everything above the cells. A kernel of known dimension reads them as `&[[f64; D]]`.

use std::ops::{Index, IndexMut};

/// Points of one dimension.
///
/// ```
/// use carom_solid::Positions;
/// let corners = Positions::from(vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0]]);
/// assert_eq!((corners.dimension(), corners.len(), corners[2][1]), (2, 3, 1.0));
/// assert_eq!(corners.of_dimension::<2>()[1], [2.0, 0.0]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Positions {
    dimension: usize,
    values: Vec<f64>,
}

impl Positions {
    /// Points from their coordinates, point after point.
    ///
    /// # Panics
    /// If the number of coordinates is not a multiple of the dimension.
    pub fn new(dimension: usize, values: Vec<f64>) -> Self {
        assert!(dimension > 0 && values.len().is_multiple_of(dimension), "coordinates of whole points");
        Self { dimension, values }
    }

    /// Number of coordinates of each point.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.values.len() / self.dimension
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// All coordinates, point after point.
    pub fn flat(&self) -> &[f64] {
        &self.values
    }

    /// The points as arrays.
    ///
    /// # Panics
    /// If they have another dimension.
    #[inline(always)]
    pub fn of_dimension<const D: usize>(&self) -> &[[f64; D]] {
        assert!(self.dimension == D);
        self.values.as_chunks().0
    }

    /// The points one by one.
    pub fn iter(&self) -> std::slice::ChunksExact<'_, f64> {
        self.values.chunks_exact(self.dimension)
    }

    /// The points one by one, mutable.
    pub fn iter_mut(&mut self) -> std::slice::ChunksExactMut<'_, f64> {
        self.values.chunks_exact_mut(self.dimension)
    }

    /// Diagonal of the box around the points.
    pub fn diameter(&self) -> f64 {
        let extent = |i: usize| {
            let low = self.iter().map(|x| x[i]).fold(f64::INFINITY, f64::min);
            let high = self.iter().map(|x| x[i]).fold(f64::NEG_INFINITY, f64::max);
            (high - low) * (high - low)
        };
        (0..self.dimension).map(extent).sum::<f64>().sqrt()
    }
}

impl<const D: usize> From<Vec<[f64; D]>> for Positions {
    fn from(points: Vec<[f64; D]>) -> Self {
        Self { dimension: D, values: points.into_flattened() }
    }
}

impl Index<usize> for Positions {
    type Output = [f64];

    fn index(&self, point: usize) -> &[f64] {
        &self.values[point * self.dimension..(point + 1) * self.dimension]
    }
}

impl IndexMut<usize> for Positions {
    fn index_mut(&mut self, point: usize) -> &mut [f64] {
        &mut self.values[point * self.dimension..(point + 1) * self.dimension]
    }
}

impl<'a> IntoIterator for &'a Positions {
    type Item = &'a [f64];
    type IntoIter = std::slice::ChunksExact<'a, f64>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<'a> IntoIterator for &'a mut Positions {
    type Item = &'a mut [f64];
    type IntoIter = std::slice::ChunksExactMut<'a, f64>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter_mut()
    }
}
