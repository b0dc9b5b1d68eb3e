//! Ambient occlusion, apart from the loops that sample the field: what the samples weigh.
//!
//! Eleven cones are the default. The *clearance* of a direction is the largest angle around it that holds no surface:
//! `min_t f(x + w t) / t` is its sine. It is found by sphere tracing, so the samples lie where the field is small, and it
//! changes smoothly from place to place. It ends at the surface itself: for all that a ray knows that hit something, the edge
//! may be just beside it or far away. But clearance changes by at most the angle between two directions. So a direction that is
//! blocked has at most the negative clearance that its neighbours leave it, `max_j (clearance_j - angle_ij)`: how deep it lies
//! behind the edge. With a sign on both sides of the edge, the share of the sky that a cone sees is a smooth step, and all of
//! them together count a sky that any edge moves over evenly. (Cones as in Aaltonen 2018; the continuation is that of McShane
//! 1934.)
//!
//! Nothing here is a length: cones begin some pixels from the surface, or where the largest empty ball that touches it lets
//! them go, and end where the scene does.

use crate::sampling::basis;
use zeroset_number::{Real, Vec3, v3};

/// Up.
pub const UP: [f32; 3] = [0.0, 1.0, 0.0];

/// From one sample of `quilez` to the next, its weight becomes this share (Tomczak 2012, equation 3.31).
pub const QUILEZ_FALL: f32 = 0.5;
/// From one sample of `bent` to the next, its weight is divided by this (Tomczak 2012, algorithm 3.7).
pub const BENT_FALL: f32 = 1.1;
/// Weights of the samples of `evans` (Evans 2006, listing 1).
pub const EVANS: [f32; 4] = [1.0, 1.2, 1.4, 1.8];

/// The visibility of a weighted `sum` of how much nearer than its samples the surface is: `1 - clamp(scale sum, 0, 1)`.
#[inline(always)]
pub fn visibility<R: Real>(sum: R, scale: R::Scalar) -> R {
    (sum * scale).clamp01().one_minus()
}

/// The visibility of a weighted `sum` of how much farther than its samples the surface is, not above 1: `exp(scale sum)`
/// (Evans 2006, 9.6; Tomczak 2012, equation 3.26 with its sign mended).
#[inline(always)]
pub fn exponential_visibility<R: Real>(sum: R, scale: R::Scalar) -> R {
    (sum * scale).min(0.0).exp()
}

/// How far a normal is from upright, a sum for [`visibility`] (Tomczak 2012, algorithm 4.3).
#[inline(always)]
pub fn slant<R: Real>(normal: Vec3<R>) -> R {
    normal.dot(v3(UP[0], UP[1], UP[2])).one_minus()
}

/// What a ray of obscurance counts that was stopped at `t`: `1 - exp(-tau t)` (Tomczak 2012, equation 3.23; Iones et al. 2003).
#[inline(always)]
pub fn obscurance<R: Real>(t: R, tau: R::Scalar) -> R {
    (t * -tau).exp().one_minus()
}

/// Number of cones.
pub const CONES: usize = 11;
/// The first of them are the ring around the normal, the others that along the horizon.
pub const HIGH: usize = 4;
// The numbers of the two rings. They, `FULL` and `EXTENT` make the error least: against rays in double precision over 60
// random scenes of solids, floors, walls and lids, and against mathematics over two planes at random angles, balls and discs
// over a floor, three walls and thin rooms, with the roughness of the floor under the balls. The scenes of the papers are not
// among them.
/// Cosines to the normal.
pub const COSINES: [f32; 2] = [0.88, 0.49];
/// Shares of the sky, by the cosine law, of one cone.
const SHARES: [f32; 2] = [0.5426 / 4.0, 0.4574 / 7.0];
/// Sine of the clearance that counts as wholly open. The plane of the surface itself leaves a low cone not more than its
/// cosine.
pub const FULL: f32 = 0.465;
/// A cone counts as half hidden from this far on the one side of an edge to this far on the other.
pub const WIDTH: [f32; 2] = [1.075, 0.9];
/// How far, measured as the distances between directions are, wholly open is.
pub const EXTENT: f32 = 0.43;
/// Near an edge, up to this share of its width, an open cone counts on its neighbours as a blocked one does.
pub const CLOSENESS: f32 = 0.2;
/// From this share of wholly open on a clearance says all it can of the directions beside it.
const TELLING: f32 = 0.2;
/// Sine of the clearance that is none.
pub const BLOCKED: f32 = 0.05;
/// Steps are as short as an edge at this share of the clearance found so far asks for.
pub const CARE: f32 = 0.45;
/// A cone ends where the scene leaves it this share of what is wholly open.
pub const SURE: f32 = 0.75;
/// The first sample is this many offsets from the origin.
pub const START: f32 = 4.0;
/// Cones begin this share of the touching ball's radius times their cosine from the origin. Up to 2 there is nothing on the
/// axis; less is also clear beside it.
pub const FREE: f32 = 1.2;
/// From one touching ball to the next.
pub const GROWTH: f32 = 8.0;
/// The radius of the touching ball is known up to this factor.
pub const NARROW: f32 = 2.0;
/// A ball that has all but this share of its radius is empty: single precision has no more.
pub const EMPTY: f32 = 0.999_998;
/// With all cones open their sum is 1 up to rounding: this makes up for it.
pub const WHOLE: f32 = 1.000_002;
/// What a sum of cones lacks on average, over itself and what is left to 1: the coefficients of a square polynomial. See [`open`].
pub const LACK: [f32; 3] = [0.501, -2.591, 2.719];
/// How much the normal counts among the directions that the sky is seen in: it decides where nothing is open.
pub const NORMAL_SHARE: f32 = 1e-3;

/// The cones are made around this direction and turned from it to the normal the shortest way. It is the opposite of no
/// face that anybody builds, and only there the shortest way is not known.
const AXIS: [f32; 3] = [0.269_680_3, 0.898_934_4, 0.345_190_8];

/// Direction number `k` (whole) of the cones around their axis.
#[inline(always)]
pub fn direction<R: Real>(k: R) -> Vec3<R> {
    let axis = v3(k.lit(AXIS[0]), k.lit(AXIS[1]), k.lit(AXIS[2]));
    let [a, b] = basis(axis);
    let high = k.below(HIGH as f32);
    let low = (k - HIGH as f32 + 0.25) / (CONES - HIGH) as f32;
    let turns = R::choose(high, k / HIGH as f32, low);
    let (sin, cos) = (turns * std::f32::consts::TAU).sin_cos();
    let c = R::choose(high, k.lit(COSINES[0]), k.lit(COSINES[1]));
    let r = c.sq().one_minus().sqrt();
    a * (r * cos) + b * (r * sin) + axis * c
}

/// The directions around the axis.
pub fn directions() -> [[f32; 3]; CONES] {
    std::array::from_fn(|k| direction(k as f32).array())
}

/// The ring of a cone.
#[inline(always)]
pub const fn ring(k: usize) -> usize {
    (k >= HIGH) as usize
}

/// Distances between directions, as points of the unit sphere.
pub fn distances() -> [[f32; CONES]; CONES] {
    let to = directions();
    to.map(|a| to.map(|b| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f32>().sqrt()))
}

/// `w`, turned with the rotation that takes the cones' axis to `n` the shortest way.
#[inline(always)]
pub fn turn<R: Real>(n: Vec3<R>, w: Vec3<R::Scalar>) -> Vec3<R> {
    let a = v3(n.x.lit(AXIS[0]), n.x.lit(AXIS[1]), n.x.lit(AXIS[2]));
    let w = n.like(w);
    let (v, c) = (a.cross(n), a.dot(n));
    let once = v.cross(w);
    w + once + v.cross(once) / (c + 1.0).max(1e-4)
}

/// The share that is open of a cone whose axis is `depth` widths before an edge: 0 at -1, 1 at 1.
#[inline(always)]
pub fn seen<R: Real>(depth: R) -> R {
    let x = (depth * 0.5 + 0.5).clamp01();
    x.sq() * (x * -2.0 + 3.0)
}

/// How clear a cone is, measured as the distances between directions are, from the sine of its clearance.
#[inline(always)]
pub fn clear<R: Real>(sine: R) -> R {
    ((sine - BLOCKED) * (1.0 / (FULL - BLOCKED))).clamp01() * EXTENT
}

/// How far behind the edge a blocked direction is, negative, for what another leaves it that is `clear` and so far `apart`.
/// One that is hardly clear says as little as one that is blocked: else the picture would jump where it becomes so.
#[inline(always)]
pub fn left<R: Real>(clear: R, apart: R::Scalar) -> R {
    let none = clear.lit(-WIDTH[0]);
    none.mix(
        clear - apart,
        (clear * (1.0 / (TELLING * EXTENT))).clamp01(),
    )
}

/// What a cone adds to the visibility that is `clear`, and `behind` the edge at most so far as [`left`] by all others. Of its
/// ring: `per_width`, one over the width of an edge, and the weight, see [`weights`].
#[inline(always)]
pub fn share<R: Real>(clear: R, behind: R, per_width: R::Scalar, weight: R::Scalar) -> R {
    let behind = behind.min(0.0) * (1.0 / WIDTH[0]);
    let before = clear * per_width;
    let close = (before * (1.0 / CLOSENESS)).one_minus().max(0.0);
    seen(before + behind * close) * weight
}

/// The openness from the `sum` of what all cones see.
///
/// Wide cones blur the horizon: what is nearly closed looks darker than it is, what is half open lighter, and what is nearly open darker
/// again, by up to 0.06 and much alike everywhere. So a polynomial that leaves 0 and 1 as they are, and rises, gives back what the sum
/// lacks on average. It was fitted to rays ([`LACK`]; least squares, each scene counting the same) over 66 random scenes: 36 of solids
/// turned and joined in the air, with floors, walls or none, and 30 of solids that stand on floors. The scenes of the papers are not among
/// them; on these it takes a fifth of the error away (docs/occlusion.md).
#[inline(always)]
pub fn open<R: Real>(sum: R) -> R {
    let x = (sum * WHOLE).min(1.0);
    let lack = (x * LACK[2] + LACK[1]) * x + LACK[0];
    x + x * x.one_minus() * lack
}

/// What one cone of a ring adds where it is wholly open, so that all of them make 1.
pub fn weights() -> [f32; 2] {
    [0, 1].map(|r| SHARES[r] / seen(EXTENT / WIDTH[r]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is closed stays closed, what is open open, and more light is never less.
    #[test]
    fn openness_rises_from_nothing_to_all() {
        assert_eq!(open(0.0f32), 0.0);
        assert_eq!(open(1.0 / WHOLE + 1e-6), 1.0);
        let mut before = 0.0f32;
        for i in 1..=1000 {
            let now = open(i as f32 / 1000.0);
            assert!(now > before && now <= 1.0, "{i}: {before}, {now}");
            before = now;
        }
    }
}
