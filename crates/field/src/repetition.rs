//! Copies on a grid and around an axis, with the neighbour search that keeps distances true.
//!
//! At a point only the nearest copies are evaluated: two along every repeated axis. All others lie behind a wall whose
//! distance is known, so the value is `min(nearest copies, distance to the wall)`: it never overestimates, has slope 1 and
//! is continuous, because a copy enters the search only where the wall already limits the value.

use zeroset_catalogue::bounds::Aabb;

/// Copies on a grid along any of the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repetition {
    /// Distance between copies along each axis; 0 where it is not repeated.
    pub spacing: [f64; 3],
    /// Number of copies along each axis, centred on the origin; 0 for without end.
    pub count: [u32; 3],
    /// Every copy is moved by a random offset between minus and plus this, the same for the same cell.
    pub vary: [f64; 3],
    /// Chooses other random offsets.
    pub seed: u32,
}

/// The largest number of copies along an axis: beyond it single precision no longer holds a cell's place.
pub const MAX_COPIES: u32 = 100_000;

impl Repetition {
    /// Whether axis `k` is repeated.
    pub fn repeats(&self, k: usize) -> bool {
        self.spacing[k] > 0.0 && self.count[k] != 1
    }

    /// The shape's extent along axis `k`, with its random offset.
    pub(crate) fn extent(&self, shape: &Aabb, k: usize) -> (f64, f64) {
        (shape.min[k] - self.vary[k], shape.max[k] + self.vary[k])
    }

    /// Whether a plane shape stays in its plane.
    pub(crate) fn check_plane(&self) -> Result<(), String> {
        if self.spacing[2] > 0.0 || self.vary[2] > 0.0 {
            return Err(
                "a plane shape lies in the plane z = 0, where there is no room for copies along z: give a spacing and vary \
                 with 0 for z, or make a solid of it with extrude(...) first"
                    .into(),
            );
        }
        Ok(())
    }

    pub(crate) fn check(&self, shape: &Aabb) -> Result<(), String> {
        let axes = ["x", "y", "z"];
        if !(0..3).any(|k| self.spacing[k] > 0.0) {
            return Err("give a spacing above 0 along at least one axis".into());
        }
        for (k, axis) in axes.into_iter().enumerate() {
            let (c, v) = (self.spacing[k], self.vary[k]);
            if !(0.0..=1e6).contains(&c) || !(0.0..=1e6).contains(&v) {
                return Err(format!(
                    "spacing and vary along {} must be 0 to 1e6, not {c} and {v}",
                    axis
                ));
            }
            if self.count[k] > MAX_COPIES {
                return Err(format!(
                    "{} copies along {}: at most {MAX_COPIES}",
                    self.count[k], axis
                ));
            }
            if !self.repeats(k) {
                continue;
            }
            let (lo, hi) = self.extent(shape, k);
            if !shape.is_empty() && !(-lo.min(0.0)).max(hi.max(0.0)).is_finite() {
                return Err(format!(
                    "the shape has no end along {}: intersect it with a box first",
                    axis
                ));
            }
            if !shape.is_empty() && (hi > 0.95 * c || lo < -0.95 * c) {
                return Err(format!(
                    "along {} the shape reaches from {lo:.4} to {hi:.4} with its random offset, which must lie within \
                     0.95 of the spacing {c}: use a spacing of at least {:.4}",
                    axis,
                    hi.max(-lo) / 0.95
                ));
            }
        }
        Ok(())
    }

    pub(crate) fn bounds(&self, shape: &Aabb) -> Aabb {
        if shape.is_empty() {
            return *shape;
        }
        let mut out = *shape;
        for k in 0..3 {
            (out.min[k], out.max[k]) = self.extent(shape, k);
            if self.repeats(k) {
                let reach = if self.count[k] == 0 {
                    f64::INFINITY
                } else {
                    0.5 * self.spacing[k] * f64::from(self.count[k] - 1)
                };
                out.min[k] -= reach;
                out.max[k] += reach;
            }
        }
        out
    }
}

/// Copies around the y axis, the first one where the shape is. Copies of a plane shape lie in its plane, around the z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polar {
    /// Number of copies.
    pub count: u32,
}

/// Copies that are all evaluated where the shape is too wide for its sector.
pub const MAX_WIDE_COPIES: u32 = 64;

impl Polar {
    /// Angle between copies.
    pub fn sector(&self) -> f64 {
        std::f64::consts::TAU / f64::from(self.count.max(1))
    }

    /// Smallest and largest angle (from x towards z) of a shape that does not reach the axis.
    pub(crate) fn angles(shape: &Aabb) -> Option<(f64, f64)> {
        let (min, max) = (shape.min, shape.max);
        if shape.is_empty()
            || min[0] <= 0.0
            || ![min[0], min[2], max[0], max[2]]
                .iter()
                .all(|x| x.is_finite())
        {
            return None;
        }
        let low = min[2].atan2(if min[2] < 0.0 { min[0] } else { max[0] });
        let high = max[2].atan2(if max[2] > 0.0 { min[0] } else { max[0] });
        Some((low, high))
    }

    /// Whether two copies and a wall are enough.
    pub(crate) fn is_narrow(&self, shape: &Aabb) -> bool {
        self.count > 4
            && Self::angles(shape).is_some_and(|(low, high)| {
                low > -0.95 * self.sector() && high < 0.95 * self.sector()
            })
    }

    pub(crate) fn check(&self, shape: &Aabb) -> Result<(), String> {
        if self.count == 0 || self.count > MAX_COPIES {
            return Err(format!(
                "{} copies: allowed are 1 to {MAX_COPIES}",
                self.count
            ));
        }
        if self.count > MAX_WIDE_COPIES && !self.is_narrow(shape) {
            return Err(format!(
                "{} copies of a shape that is wider than its sector of {:.3} degrees or does not lie on the side of +x: \
                 at most {MAX_WIDE_COPIES} such copies; move the shape outwards along x or make it smaller",
                self.count,
                self.sector().to_degrees()
            ));
        }
        Ok(())
    }

    /// The box of all copies, from the box of one of them.
    pub(crate) fn bounds(&self, shape: &Aabb) -> Aabb {
        if shape.is_empty() {
            return *shape;
        }
        let r = shape.radius_about(1);
        Aabb::new([-r, shape.min[1], -r], [r, shape.max[1], r])
    }

    /// A plane shape's box with y and z exchanged: what goes around z goes around y then, and back.
    pub(crate) fn upright(shape: &Aabb) -> Aabb {
        let swap = |p: [f64; 3]| [p[0], p[2], p[1]];
        Aabb {
            min: swap(shape.min),
            max: swap(shape.max),
        }
    }
}
