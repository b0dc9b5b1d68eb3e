//! Rigid motions with a uniform scale: what `move`, `turn` and `scale` become.

use zeroset_catalogue::bounds::Aabb;

/// `x -> scale * rotation * x + offset`, from the shape's own space to the space it is seen in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Rows of an orthonormal matrix (a mirror image is allowed).
    pub rotation: [[f64; 3]; 3],
    /// Uniform scale, > 0.
    pub scale: f64,
    /// Where the shape's origin goes.
    pub offset: [f64; 3],
    /// Whether a turn was asked for, be it by zero degrees: the structure of a program must not depend on numbers.
    pub turns: bool,
    /// Whether a scale was asked for.
    pub scales: bool,
}

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl Placement {
    /// Where the shape was made.
    pub const IDENTITY: Placement = Placement {
        rotation: IDENTITY,
        scale: 1.0,
        offset: [0.0; 3],
        turns: false,
        scales: false,
    };

    /// Whether single precision holds its numbers, as every renderer must.
    pub(crate) fn is_held(&self) -> bool {
        let numbers = self.rotation.iter().flatten().chain(&self.offset);
        numbers
            .chain([&self.scale])
            .all(|x| (*x as f32).is_finite())
            && self.scale as f32 > 0.0
    }

    /// Exchanges y and z, which is a mirror image.
    pub(crate) const UPRIGHT: Placement = Placement {
        rotation: [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
        turns: true,
        ..Placement::IDENTITY
    };

    /// This motion with the plane z = 0 exactly on itself, if it maps it there but for rounding; `None` if a plane shape would
    /// leave its plane.
    pub(crate) fn in_plane(mut self) -> Option<Placement> {
        const ROUNDING: f64 = 1e-9;
        for (i, k) in [(0, 2), (1, 2), (2, 0), (2, 1)] {
            if self.rotation[i][k].abs() > ROUNDING {
                return None;
            }
            self.rotation[i][k] = 0.0;
        }
        // the offset of turns after moves is rounded as well
        let size = self.offset[0].abs() + self.offset[1].abs();
        if self.offset[2].abs() > ROUNDING * size {
            return None;
        }
        self.offset[2] = 0.0;
        Some(self)
    }

    /// Moved by an offset.
    pub fn moved(offset: [f64; 3]) -> Self {
        Placement {
            offset,
            ..Self::IDENTITY
        }
    }

    /// Scaled about the origin; `scale` > 0.
    pub fn scaled(scale: f64) -> Self {
        Placement {
            scale,
            scales: true,
            ..Self::IDENTITY
        }
    }

    /// Turned about an axis through the origin, counter-clockwise when looking against the axis (radians). A zero axis
    /// turns nothing.
    pub fn turned(axis: [f64; 3], angle: f64) -> Self {
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length == 0.0 {
            return Placement {
                turns: true,
                ..Self::IDENTITY
            };
        }
        let (s, c) = (0.5 * angle).sin_cos();
        Self::quaternion([
            axis[0] / length * s,
            axis[1] / length * s,
            axis[2] / length * s,
            c,
        ])
    }

    /// Turned about x, then y, then z (radians).
    pub fn euler([x, y, z]: [f64; 3]) -> Self {
        let turn = |axis, angle| Self::turned(axis, angle);
        turn([0.0, 0.0, 1.0], z)
            .after(&turn([0.0, 1.0, 0.0], y))
            .after(&turn([1.0, 0.0, 0.0], x))
    }

    /// Turned by a quaternion (x, y, z, w), which is normalised first; zero turns nothing.
    pub fn quaternion(q: [f64; 4]) -> Self {
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        let [x, y, z, w] = if length > 0.0 {
            q.map(|c| c / length)
        } else {
            [0.0, 0.0, 0.0, 1.0]
        };
        let rotation = [
            [
                1.0 - 2.0 * (y * y + z * z),
                2.0 * (x * y - w * z),
                2.0 * (x * z + w * y),
            ],
            [
                2.0 * (x * y + w * z),
                1.0 - 2.0 * (x * x + z * z),
                2.0 * (y * z - w * x),
            ],
            [
                2.0 * (x * z - w * y),
                2.0 * (y * z + w * x),
                1.0 - 2.0 * (x * x + y * y),
            ],
        ];
        Placement {
            rotation,
            turns: true,
            ..Self::IDENTITY
        }
    }

    /// First `first`, then this.
    pub fn after(&self, first: &Placement) -> Placement {
        let row = |i: usize, j: usize| {
            (0..3)
                .map(|k| self.rotation[i][k] * first.rotation[k][j])
                .sum()
        };
        Placement {
            rotation: std::array::from_fn(|i| std::array::from_fn(|j| row(i, j))),
            scale: self.scale * first.scale,
            offset: self.apply(first.offset),
            turns: self.turns || first.turns,
            scales: self.scales || first.scales,
        }
    }

    /// Where a point of the shape is seen.
    pub fn apply(&self, p: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| {
            self.offset[i] + self.scale * (0..3).map(|k| self.rotation[i][k] * p[k]).sum::<f64>()
        })
    }

    /// The place in the shape that is seen at `p`.
    pub fn invert(&self, p: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| {
            (0..3)
                .map(|k| self.rotation[k][i] * (p[k] - self.offset[k]))
                .sum::<f64>()
                / self.scale
        })
    }

    /// A box that holds the placed box.
    pub fn bounds(&self, shape: &Aabb) -> Aabb {
        if shape.is_empty() {
            return *shape;
        }
        let mut out = Aabb {
            min: self.offset,
            max: self.offset,
        };
        for i in 0..3 {
            for k in 0..3 {
                let r = self.scale * self.rotation[i][k];
                // a zero entry of the matrix keeps an infinite side out of this coordinate
                if r.abs() > 1e-15 {
                    let (a, b) = (r * shape.min[k], r * shape.max[k]);
                    out.min[i] += a.min(b);
                    out.max[i] += a.max(b);
                }
            }
        }
        out
    }
}
