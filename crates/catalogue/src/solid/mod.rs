//! Solids: centred on the origin, upright along y.
//!
//! Most formulas follow the derivations that Inigo Quilez collected and made popular (iquilezles.org); where his forms lose
//! the gradient on the surface itself (a length that is zero there), the signed distance to the face is taken instead.

use super::*;
use zeroset_number::{Ends, Ops, Vec2, Vec3, differ, inlined, v2, v3};

mod boxes;
mod curve;
mod generalised;
mod periodic;
mod polyhedron;
mod prism;
mod quadric;
mod revolution;
mod round;
mod sheet;

pub use boxes::{BoundBox, BoxFrame, Cuboid, Plane, RoundedBox, Slab};
pub use curve::{BezierTube, Capsule, CapsuleBetween, Helix, PolylineTube};
pub use generalised::{GeneralisedDodecahedron, GeneralisedIcosahedron, GeneralisedOctahedron};
pub use periodic::{Gyroid, Iwp, Neovius, SchwarzD, SchwarzP};
pub use polyhedron::{Dodecahedron, Icosahedron, Octahedron, Pyramid, Tetrahedron};
pub use prism::{HexagonalPrism, RhombicPrism, TriangularPrism};
pub use quadric::{Ellipsoid, Quadric, Superquadric};
pub use revolution::{
    CappedCone, Cone, Cylinder, InfiniteCone, InfiniteCylinder, RoundCone, RoundedCylinder,
};
pub use round::{
    CappedTorus, CutHollowSphere, CutSphere, DeathStar, Link, SolidAngle, Sphere, Torus,
    VesicaSegment,
};
pub use sheet::{Quad, TriangleSheet};

/// What an entry of this module says of itself.
const fn solid(
    group: &'static str,
    name: &'static str,
    doc: &'static str,
    source: &'static str,
    params: &'static [Param],
) -> Info {
    Info {
        name,
        doc,
        source,
        group,
        dimension: Dimension::Three,
        params,
    }
}

/// A length that must not vanish.
const fn size(name: &'static str, default: &'static [f64; 1], doc: &'static str) -> Param {
    number(name, Unit::Length, default, SMALL, LARGE, doc)
}

/// The distance to the corner of a box from the distances `q` to its faces, positive outside: the length of what sticks
/// out, or else the largest. Chosen rather than added, so that the gradient is right on the very surface too.
#[inline(always)]
fn corner<R: Real, const N: usize>(q: [R; N]) -> R {
    let mut largest = q[0];
    let mut out = q;
    for k in 0..N {
        largest = largest.max(q[k]);
        out[k] = q[k].max(0.0);
    }
    R::select(largest.above(0.0), R::norm(out), largest)
}

/// The distance to a face that ends at an edge: `over` is the distance to the face's plane, `beyond` how far the foot on the
/// plane lies past the edge. Below the plane no edge is near.
#[inline(always)]
fn face<R: Real, const N: usize>(over: R, mut beyond: [R; N]) -> R {
    for b in &mut beyond {
        *b = b.max(0.0);
    }
    R::select(over.above(0.0), length2(over, R::norm(beyond)), over)
}

/// The larger and the smaller of two, by one choice: `max` and `min` could both take the gradient of the same one where the
/// two are equal, as they are on planes of symmetry.
#[inline(always)]
fn ordered<R: Real>(a: R, b: R) -> (R, R) {
    let swap = a.below(b);
    (R::select(swap, b, a), R::select(swap, a, b))
}

/// The half plane that turns around y into all of space: distance from the axis, and height.
#[inline(always)]
fn meridian<R: Real>(p: Vec3<R>) -> Vec2<R> {
    v2(length2(p.x, p.z), p.y)
}

/// Scalar product with a constant vector.
#[inline(always)]
fn dot<R: Real>(p: Vec3<R>, c: [f64; 3]) -> R {
    p.dot(v3(R::constant(c[0]), R::constant(c[1]), R::constant(c[2])))
}

/// The box of a ball-rounded curve or sheet with these corners.
fn hull_of(points: &[[f64; 3]], radius: f64) -> Aabb {
    points
        .iter()
        .fold(Aabb::EMPTY, |b, &p| b.hull(&Aabb::new(p, p)))
        .grow(radius)
}

/// Three consecutive parameters.
fn triple(a: &[f64], i: usize) -> [f64; 3] {
    [a[i], a[i + 1], a[i + 2]]
}
