//! Axis-aligned boxes in up to three dimensions; axes that a point does not have are 0..0.

/// Axis-aligned box. It is conservative: a coordinate that is not finite makes it unbounded along
/// that axis.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    // NaN for an empty box: comparisons with it are false, and `min` and `max` ignore it.
    low: [f64; 3],
    high: [f64; 3],
}

impl Bounds {
    /// The empty box.
    pub const EMPTY: Self = Self { low: [f64::NAN; 3], high: [f64::NAN; 3] };

    /// Box of one point of one to three coordinates.
    #[must_use]
    pub fn of(point: &[f64]) -> Self {
        let mut bounds = Self::EMPTY;
        bounds.add(point);
        bounds
    }

    /// Extends the box to a point of one to three coordinates.
    pub fn add(&mut self, point: &[f64]) {
        for i in 0..3 {
            let x = point.get(i).copied().unwrap_or(0.0);
            let (low, high) = if x.is_finite() { (x, x) } else { (f64::NEG_INFINITY, f64::INFINITY) };
            self.low[i] = self.low[i].min(low);
            self.high[i] = self.high[i].max(high);
        }
    }

    /// The smallest box around both.
    #[must_use]
    #[inline]
    pub fn union(mut self, other: &Self) -> Self {
        for i in 0..3 {
            self.low[i] = self.low[i].min(other.low[i]);
            self.high[i] = self.high[i].max(other.high[i]);
        }
        self
    }

    /// Enlarged by `by` ≥ 0 on every side; an empty box stays empty.
    #[must_use]
    pub fn grown(mut self, by: f64) -> Self {
        let by = if by.is_nan() { f64::INFINITY } else { by };
        for i in 0..3 {
            self.low[i] -= by;
            self.high[i] += by;
        }
        self
    }

    /// Translated by a vector.
    #[must_use]
    pub fn moved(mut self, by: [f64; 3]) -> Self {
        for (i, by) in by.into_iter().enumerate() {
            self.low[i] += by;
            self.high[i] += by;
        }
        self
    }

    /// Whether the boxes have a point in common, possibly on their boundaries. An empty box meets
    /// none.
    #[must_use]
    #[inline]
    pub fn meets(&self, other: &Self) -> bool {
        (0..3).all(|i| self.low[i] <= other.high[i] && other.low[i] <= self.high[i])
    }

    /// Whether a point of one to three coordinates lies in the box, including its boundary. A point
    /// that is not finite lies in no bounded box.
    #[must_use]
    pub fn contains(&self, point: &[f64]) -> bool {
        (0..3).all(|i| {
            let x = point.get(i).copied().unwrap_or(0.0);
            self.low[i] <= x && x <= self.high[i]
        })
    }

    /// Distance of a point of one to three coordinates to the box, 0 inside; NaN for an empty box.
    #[must_use]
    pub fn distance(&self, point: &[f64]) -> f64 {
        let mut square = 0.0;
        for i in 0..3 {
            let x = point.get(i).copied().unwrap_or(0.0);
            let outside = if x < self.low[i] {
                self.low[i] - x
            } else if x <= self.high[i] {
                0.0
            } else {
                x - self.high[i]
            };
            square += outside * outside;
        }
        square.sqrt()
    }

    /// Longest edge; 0 for an empty box.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.extents().into_iter().fold(0.0, f64::max)
    }

    /// Lengths of the edges; NaN for an empty box.
    #[must_use]
    pub fn extents(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.high[i] - self.low[i])
    }

    /// Centre; 0 along an unbounded axis and for an empty box.
    #[must_use]
    pub fn centre(&self) -> [f64; 3] {
        // Halved first: the sum of two large coordinates may overflow.
        let middle = |i: usize| 0.5 * self.low[i] + 0.5 * self.high[i];
        std::array::from_fn(|i| if middle(i).is_finite() { middle(i) } else { 0.0 })
    }

    /// Lowest coordinates; NaN for an empty box.
    #[must_use]
    pub fn low(&self) -> [f64; 3] {
        self.low
    }

    /// Highest coordinates; NaN for an empty box.
    #[must_use]
    pub fn high(&self) -> [f64; 3] {
        self.high
    }
}

impl<P: AsRef<[f64]>> FromIterator<P> for Bounds {
    /// The smallest box around points.
    fn from_iter<I: IntoIterator<Item = P>>(points: I) -> Self {
        let mut bounds = Self::EMPTY;
        points.into_iter().for_each(|point| bounds.add(point.as_ref()));
        bounds
    }
}
