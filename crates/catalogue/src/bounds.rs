//! What every node of a field tree knows about itself: its box, how true its distance is, how steep it can be.

/// An axis-aligned box that holds the solid `f <= 0`. A side may be infinite; an empty box has `min > max` on an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest corner.
    pub min: [f64; 3],
    /// Largest corner.
    pub max: [f64; 3],
}

impl Aabb {
    /// All of space.
    pub const WHOLE: Aabb = Aabb {
        min: [f64::NEG_INFINITY; 3],
        max: [f64::INFINITY; 3],
    };
    /// Nothing.
    pub const EMPTY: Aabb = Aabb {
        min: [f64::INFINITY; 3],
        max: [f64::NEG_INFINITY; 3],
    };

    /// The box between two corners.
    pub fn new(min: [f64; 3], max: [f64; 3]) -> Self {
        Aabb { min, max }
    }

    /// The box centred on the origin with these half sides.
    pub fn centred(half: [f64; 3]) -> Self {
        Aabb {
            min: half.map(|h| -h),
            max: half,
        }
    }

    /// Whether the box holds no point.
    pub fn is_empty(&self) -> bool {
        (0..3).any(|k| self.min[k] > self.max[k])
    }

    /// Whether every side is finite.
    pub fn is_finite(&self) -> bool {
        self.min.iter().chain(&self.max).all(|x| x.is_finite())
    }

    /// The smallest box that holds both.
    pub fn hull(&self, other: &Self) -> Self {
        Aabb {
            min: std::array::from_fn(|k| self.min[k].min(other.min[k])),
            max: std::array::from_fn(|k| self.max[k].max(other.max[k])),
        }
    }

    /// What both boxes hold.
    pub fn intersect(&self, other: &Self) -> Self {
        Aabb {
            min: std::array::from_fn(|k| self.min[k].max(other.min[k])),
            max: std::array::from_fn(|k| self.max[k].min(other.max[k])),
        }
    }

    /// The box grown by `by` on every side.
    pub fn grow(&self, by: f64) -> Self {
        if self.is_empty() {
            return *self;
        }
        Aabb {
            min: self.min.map(|x| x - by),
            max: self.max.map(|x| x + by),
        }
    }

    /// The middle of the box; zero along an infinite axis.
    pub fn centre(&self) -> [f64; 3] {
        std::array::from_fn(|k| {
            let c = 0.5 * (self.min[k] + self.max[k]);
            if c.is_finite() { c } else { 0.0 }
        })
    }

    /// Half sides.
    pub fn half(&self) -> [f64; 3] {
        std::array::from_fn(|k| 0.5 * (self.max[k] - self.min[k]))
    }

    /// The eight corners (with infinities where the box is infinite).
    pub fn corners(&self) -> [[f64; 3]; 8] {
        std::array::from_fn(|i| {
            std::array::from_fn(|k| {
                if i >> k & 1 == 0 {
                    self.min[k]
                } else {
                    self.max[k]
                }
            })
        })
    }

    /// Whether `p` lies in the box.
    pub fn contains(&self, p: [f64; 3]) -> bool {
        (0..3).all(|k| self.min[k] <= p[k] && p[k] <= self.max[k])
    }

    /// Largest distance from the axis `axis` (0 = x, 1 = y, 2 = z) to a point of the box; infinite if the box is.
    pub fn radius_about(&self, axis: usize) -> f64 {
        let reach = |k: usize| self.min[k].abs().max(self.max[k].abs());
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        if self.is_empty() {
            0.0
        } else {
            reach(a).hypot(reach(b))
        }
    }
}

/// How far the value of a field is from the distance to its surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exactness {
    /// The distance, inside and outside.
    Exact,
    /// The distance outside; inside a bound.
    Outside,
    /// Never more than the distance (Hart 1996: a signed distance bound).
    Bound,
    /// An estimate without a proof (the usual distance estimators of fractals, a constant stated by hand).
    Estimate,
}
