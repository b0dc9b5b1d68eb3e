//! Bodies of scene volumes: what each is near, by formulas that are cheap (Evans 2006, 9.8).

use super::{Heights, Star};
use std::sync::Arc;
use zeroset_number::{Data, Grid, Real, Vec3, v3};

/// A shape in its own space.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A box around the origin. Exact.
    Cuboid {
        /// Half of its sides.
        half: [f32; 3],
    },
    /// An ellipsoid around the origin: exact for a ball, else to first order near its surface (Quilez 2008).
    Ellipsoid {
        /// From the middle to the surface along each axis.
        radii: [f32; 3],
    },
    /// Distances that were sampled before, of a shape that does not change.
    Grid(Arc<LocalGrid>),
    /// A surface over the plane of x and z, or between two of them, which may be another one each frame.
    Heights(Arc<Heights>),
    /// A surface with one radius for each direction, which may be another one each frame.
    Star(Arc<Star>),
}

/// Sampled distances of a shape.
#[derive(Clone, Debug)]
pub struct LocalGrid {
    data: Data,
    nodes: [u32; 3],
    min: [f32; 3],
    max: [f32; 3],
}

impl LocalGrid {
    /// A grid whose first node is the smallest corner of a box and whose last node is the largest. The surface must lie within the box.
    ///
    /// # Errors
    /// A box without an extent, or with corners that are no numbers.
    pub fn new(grid: Arc<Grid>, min: [f32; 3], max: [f32; 3]) -> Result<LocalGrid, BodyError> {
        for k in 0..3 {
            length("a side of a grid's box", max[k] - min[k])?;
        }
        Ok(LocalGrid {
            nodes: grid.nodes(),
            data: Data {
                params: Vec::new(),
                grids: vec![grid],
            },
            min,
            max,
        })
    }
}

/// Where a body is, how it is turned, and how large it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Its origin.
    pub position: [f32; 3],
    /// Its own x, y and z axis in the world: orthonormal.
    pub axes: [[f32; 3]; 3],
    /// How many times larger it is than in its own space.
    pub scale: f32,
}

impl Pose {
    /// At a place, as it is in its own space.
    pub fn at(position: [f32; 3]) -> Pose {
        Pose {
            position,
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            scale: 1.0,
        }
    }

    /// Turned by so many radians about a unit axis (Rodrigues 1840), after what it is turned already.
    #[must_use]
    pub fn turned(self, axis: [f32; 3], angle: f32) -> Pose {
        let (sin, cos) = angle.sin_cos();
        let k = v3(axis[0], axis[1], axis[2]);
        let axes = self.axes.map(|[x, y, z]| {
            let v = v3(x, y, z);
            let turned = v * cos + k.cross(v) * sin + k * (k.dot(v) * (1.0 - cos));
            turned.array()
        });
        Pose { axes, ..self }
    }

    /// So many times larger.
    #[must_use]
    pub fn scaled(self, by: f32) -> Pose {
        let scale = self.scale * by;
        Pose { scale, ..self }
    }

    /// A place of the world in the body's own space.
    #[inline(always)]
    fn local<R: Real<Scalar = f32>>(&self, p: Vec3<R>) -> Vec3<R> {
        let [x, y, z] = self.position;
        let q = (p - v3(x, y, z)) * (1.0 / self.scale);
        let [a, b, c] = self.axes;
        v3(
            q.dot(v3(a[0], a[1], a[2])),
            q.dot(v3(b[0], b[1], b[2])),
            q.dot(v3(c[0], c[1], c[2])),
        )
    }
}

/// A shape at a place, with a colour.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its shape.
    shape: Shape,
    /// Where it is.
    pose: Pose,
    /// Linear colour.
    colour: [f32; 3],
}

/// Why something is no body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// A length that is none.
    #[error("{what} is {value}: allowed are lengths above 0, up to 1e9")]
    Length {
        /// Of what.
        what: &'static str,
        /// What it is.
        value: f32,
    },
    /// A place that is none.
    #[error("a body is at {0:?}: allowed are coordinates within ±1e9")]
    Place([f32; 3]),
    /// Axes that are not of length 1 at right angles.
    #[error("the axes of a body are {0:?}: they must be of length 1 at right angles")]
    Axes([[f32; 3]; 3]),
    /// A map with too few or too many samples, or another number than it says.
    #[error(
        "a map of {nodes:?} nodes has {values} samples: allowed are 2 to 2048 nodes along an axis, and one sample for each"
    )]
    Map {
        /// Nodes along each axis.
        nodes: [u32; 2],
        /// Samples.
        values: usize,
    },
    /// A sample that is no number.
    #[error("sample {at} of a map is {value}")]
    Sample {
        /// Its place.
        at: usize,
        /// What it is.
        value: f32,
    },
}

pub(super) fn length(what: &'static str, value: f32) -> Result<f32, BodyError> {
    // also refuses NaN
    if value > 0.0 && value <= 1e9 {
        return Ok(value);
    }
    Err(BodyError::Length { what, value })
}

impl Body {
    /// A shape at a place.
    ///
    /// # Errors
    /// Sides, radii or a scale that are no lengths, a place or axes that are none.
    pub fn new(shape: Shape, pose: Pose, colour: [f32; 3]) -> Result<Body, BodyError> {
        match &shape {
            Shape::Cuboid { half: lengths } | Shape::Ellipsoid { radii: lengths } => {
                for value in lengths {
                    length("a side or a radius", *value)?;
                }
            }
            Shape::Grid(_) | Shape::Heights(_) | Shape::Star(_) => {}
        }
        length("the scale of a body", pose.scale)?;
        // also refuses NaN
        if !pose.position.iter().all(|x| x.abs() <= 1e9) {
            return Err(BodyError::Place(pose.position));
        }
        let [a, b, c] = pose.axes.map(|[x, y, z]| v3(x, y, z));
        let near = |x: f32, right: f32| (x - right).abs() < 1e-3;
        let units = [a, b, c].iter().all(|v| near(v.dot(*v), 1.0));
        if !(units && near(a.dot(b), 0.0) && near(b.dot(c), 0.0) && near(c.dot(a), 0.0)) {
            return Err(BodyError::Axes(pose.axes));
        }
        Ok(Body {
            shape,
            pose,
            colour,
        })
    }

    /// Its shape.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Where it is.
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// Its linear colour.
    pub fn colour(&self) -> [f32; 3] {
        self.colour
    }

    /// Whether it is near the same at the same place, whatever its colour: shapes of samples are the same if they are one.
    pub fn is_where(&self, other: &Body) -> bool {
        let same = match (&self.shape, &other.shape) {
            (Shape::Cuboid { half: a }, Shape::Cuboid { half: b })
            | (Shape::Ellipsoid { radii: a }, Shape::Ellipsoid { radii: b }) => a == b,
            (Shape::Grid(a), Shape::Grid(b)) => Arc::ptr_eq(a, b),
            (Shape::Heights(a), Shape::Heights(b)) => Arc::ptr_eq(a, b),
            (Shape::Star(a), Shape::Star(b)) => Arc::ptr_eq(a, b),
            _ => false,
        };
        same && self.pose == other.pose
    }

    /// What is shown as its distance, negative inside.
    #[inline(always)]
    pub fn distance<R: Real<Scalar = f32, Store = Data>>(&self, p: Vec3<R>) -> R {
        let q = self.pose.local(p);
        let own = match &self.shape {
            Shape::Cuboid { half } => cuboid(*half, q),
            Shape::Ellipsoid { radii } => ellipsoid(*radii, q),
            Shape::Grid(grid) => grid.distance(q),
            Shape::Heights(heights) => heights.distance(q),
            Shape::Star(star) => star.distance(q),
        };
        own * self.pose.scale
    }

    /// How far a ball of this middle and radius is at least from the body's oriented box.
    pub(super) fn clearance(&self, centre: [f32; 3], radius: f32) -> f32 {
        let [x, y, z] = centre;
        let q = self.pose.local(v3(x, y, z)).array();
        let (min, max) = self.shape.bounds();
        let beyond = [0, 1, 2].map(|k| (min[k] - q[k]).max(q[k] - max[k]).max(0.0));
        f32::norm(beyond) * self.pose.scale - radius
    }
}

impl Shape {
    /// Its box in its own space.
    fn bounds(&self) -> ([f32; 3], [f32; 3]) {
        match self {
            Shape::Cuboid { half: far } | Shape::Ellipsoid { radii: far } => {
                (far.map(|x| -x), *far)
            }
            Shape::Grid(grid) => (grid.min, grid.max),
            Shape::Heights(heights) => heights.bounds(),
            Shape::Star(star) => ([-star.farthest(); 3], [star.farthest(); 3]),
        }
    }
}

#[inline(always)]
fn cuboid<R: Real<Scalar = f32>>(half: [f32; 3], p: Vec3<R>) -> R {
    let q = p.abs() - v3(half[0], half[1], half[2]);
    let inside = q.max_component().min(0.0);
    q.max0().length() + inside
}

#[inline(always)]
fn ellipsoid<R: Real<Scalar = f32>>(radii: [f32; 3], p: Vec3<R>) -> R {
    let [a, b, c] = radii;
    // in the very middle every direction is as good
    let least = a.min(b).min(c) * 1e-4;
    let p = p.abs();
    let p = v3(p.x.max(least), p.y.max(least), p.z.max(least));
    let near = R::norm([p.x * (1.0 / a), p.y * (1.0 / b), p.z * (1.0 / c)]);
    let slope = R::norm([
        p.x * (1.0 / (a * a)),
        p.y * (1.0 / (b * b)),
        p.z * (1.0 / (c * c)),
    ]);
    near * (near - 1.0) / slope
}

impl LocalGrid {
    /// What was sampled; beyond its box the hypotenuse of the way to there and of what is there, which never is too far.
    #[inline(always)]
    fn distance<R: Real<Scalar = f32, Store = Data>>(&self, p: Vec3<R>) -> R {
        let (min, max) = (self.min, self.max);
        let c = v3(
            p.x.clamp(min[0], max[0]),
            p.y.clamp(min[1], max[1]),
            p.z.clamp(min[2], max[2]),
        );
        let nodes = [
            self.nodes[0] as f32,
            self.nodes[1] as f32,
            self.nodes[2] as f32,
        ];
        let place = v3(
            (c.x - min[0]) * ((nodes[0] - 1.0) / (max[0] - min[0])),
            (c.y - min[1]) * ((nodes[1] - 1.0) / (max[1] - min[1])),
            (c.z - min[2]) * ((nodes[2] - 1.0) / (max[2] - min[2])),
        );
        let there = R::sample(&self.data, 0.0, v3(nodes[0], nodes[1], nodes[2]), place);
        let way = (p - c).length();
        R::choose(way.above(0.0), R::norm([way, there]), there)
    }
}
