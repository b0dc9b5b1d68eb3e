//! Penumbrae: what one sample of the field says of the light that reaches the beginning of a ray.

use zeroset_number::Real;

/// Less light than this counts as dark: a picture of 8 bits can hardly show it.
pub const DARK: f32 = 1.0 / 256.0;

/// The light that a sample of distance `f` at `t` leaves: `sharpness * f / t` (Tomczak 2012, algorithm 3.3).
#[inline(always)]
pub fn soft<R: Real>(f: R, t: R, sharpness: R::Scalar) -> R {
    f * sharpness / t
}

/// As [`soft`], at the closest place between the sample and the one of radius `r` a step of `z` before it (Aaltonen 2018).
#[inline(always)]
pub fn soft_closest<R: Real>(f: R, z: R, r: R, t: R, sharpness: R::Scalar) -> R {
    let (y, d) = closest(f, z, r);
    // a sample within the solid is dark, however close the surface
    let d = R::select(f.below(0.0), f, d);
    d * sharpness / (t - y).max(1e-20)
}

/// How far before the sample `f` a ray came closest to the surface, and how close, if the surface is seen from both samples
/// at the same place: `y = (z^2 + f^2 - r^2) / (2 z)`, which for `z = r` is Aaltonen's `f^2 / (2 r)`. Steps beyond the
/// sphere of the last sample have no such place.
#[inline(always)]
pub fn closest<R: Real>(f: R, z: R, r: R) -> (R, R) {
    let y = (z.sq() + f.sq() - r.sq()) / (z * 2.0).max(1e-20);
    // none before the first sample, none where the ray moves away
    let none = !z.above(0.0) | z.above(r * 1.000_001) | !f.below(r);
    let y = R::select(none, f.lit(0.0), y.max(0.0));
    (y, (f.sq() - y.sq()).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two samples that see one point at height `h` over the ray's place `c`.
    #[test]
    fn the_closest_place_is_the_foot_of_the_perpendicular() {
        let close =
            |a: f32, b: f32| assert!((a - b).abs() < 2e-3 * b.max(1.0), "{a} instead of {b}");
        let mut beyond = 0;
        for (c, h) in [(2.0f32, 0.5f32), (3.0, 1.0), (1.0, 0.01), (8.0, 0.3)] {
            for share in [0.1f32, 0.4, 0.8] {
                let t = c * share;
                let r = (c - t).hypot(h);
                for z in [0.5 * r, 0.9 * r, r] {
                    let f = (t + z - c).hypot(h);
                    let (y, d) = closest(f, z, r);
                    if f < r && t + z > c {
                        // the sample is that far behind the foot
                        close(t + z - y, c);
                        close(d, h);
                        beyond += 1;
                    } else {
                        // nothing closer has been passed
                        close(y, 0.0);
                        close(d, f);
                    }
                }
            }
        }
        assert!(beyond >= 10, "{beyond}");
        // the first sample, and a step out of the sphere of the last one
        assert_eq!(closest(0.5, 0.0, 0.0), (0.0, 0.5));
        assert_eq!(closest(0.5, 1.1, 1.0), (0.0, 0.5));
    }
}
