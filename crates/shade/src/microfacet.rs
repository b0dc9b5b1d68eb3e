//! How surfaces of small mirrors reflect: the distribution GGX, what the mirrors hide of each other, and Fresnel's laws.

use zeroset_number::{Real, Vec3};

/// The least `alpha` that a light is seen with in a highlight: lights are no points, but as wide as a disc of some four degrees. With less
/// their reflections would be smaller than a pixel.
pub const LIGHT_ALPHA: f32 = 0.03;

/// The width of the distribution, from the roughness that people state (Burley 2012).
#[inline(always)]
pub fn alpha<R: Real>(roughness: R) -> R {
    roughness.sq()
}

/// How many mirrors have the normal `h`, per solid angle (GGX: Walter et al. 2007, equation 33).
#[inline(always)]
pub fn distribution<R: Real>(n: Vec3<R>, h: Vec3<R>, alpha: R) -> R {
    // the sine keeps the digits that one minus a cosine near one loses
    let sine2 = n.cross(h).length_squared();
    let alpha2 = alpha.sq();
    let spread = sine2 + alpha2 * n.dot(h).sq();
    alpha2 / (spread.sq() * std::f32::consts::PI).max(1e-30)
}

#[inline(always)]
fn stretched<R: Real>(cosine: R, alpha2: R) -> R {
    (cosine.sq() * alpha2.one_minus() + alpha2).sqrt()
}

/// The share of mirrors that neither the eye nor the light is hidden from, over four times both cosines (Heitz 2014, equation 99,
/// correlated by height).
#[inline(always)]
pub fn visibility<R: Real>(to_light: R, to_eye: R, alpha: R) -> R {
    let alpha2 = alpha.sq();
    let sum = to_light * stretched(to_eye, alpha2) + to_eye * stretched(to_light, alpha2);
    (sum * 2.0).max(1e-20).recip()
}

/// How much of what is missing to a mirror a surface reflects at this cosine (Schlick 1994).
#[inline(always)]
pub fn schlick<R: Real>(cosine: R) -> R {
    cosine.clamp01().one_minus().powi(5)
}

/// The reflectance of the border of two clear bodies at this cosine; `ior` is the index of refraction behind it over that before it.
/// It is 1 where nothing gets through (Fresnel's equations, as in Cook and Torrance 1982).
#[inline(always)]
pub fn fresnel<R: Real>(cosine: R, ior: R) -> R {
    let c = cosine.clamp01();
    let square = ior.sq() - 1.0 + c.sq();
    let g = square.max(0.0).sqrt();
    let a = (g - c) / (g + c).max(1e-12);
    let b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    let partial = a.sq() * (b.sq() + 1.0) * 0.5;
    R::select(square.above(0.0), partial, c.lit(1.0)).min(1.0)
}

/// The share of light from everywhere that mirrors without loss send to an eye at this cosine in one reflection; the rest is reflected
/// again by other mirrors.
///
/// Fitted to the integral over the visible normals, with an error below 0.01 where the cosine is above 0.03.
#[inline(always)]
pub fn single<R: Real>(cosine: R, roughness: R) -> R {
    // the surface looks smooth where the cosine is large beside the width of the distribution
    let c = cosine.clamp(1e-4, 1.0);
    let s = c / (c + alpha(roughness) * 0.7);
    let mut sum = s.lit(0.0);
    // Horner's scheme, over the roughness and within over s
    for row in SINGLE.iter().rev() {
        let mut inner = s.lit(0.0);
        for k in row.iter().rev() {
            inner = inner * s + *k;
        }
        sum = sum * roughness + inner;
    }
    sum.clamp(0.25, 1.0)
}

/// A polynomial in s and the roughness, for each power of the roughness the factors of the powers of s.
const SINGLE: [&[f32]; 6] = [
    &[
        0.336_21, -0.921_5, 8.526_87, -18.204_47, 18.074_9, -6.811_57,
    ],
    &[6.364_06, -5.117_36, -9.973_5, 11.219, -2.530_19],
    &[-20.531_51, 19.514_15, 7.157_1, -6.698_52],
    &[30.893_28, -25.698_51, 0.387_85],
    &[-22.153_27, 9.882_08],
    &[6.069_5],
];

/// What [`schlick`] is in the mean over the mirrors that an eye at this cosine sees (the form is Schüler's, fitted to the same integral
/// as [`single`], with an error below 0.03).
#[inline(always)]
pub fn mean_schlick<R: Real>(cosine: R, roughness: R) -> R {
    let alpha = alpha(roughness).max(1e-4);
    let power = (alpha * -2.8).exp() * 5.0;
    let smooth = (cosine.clamp(0.0, 0.9999).one_minus().ln() * power).exp();
    smooth / ((alpha.ln() * 1.4).exp() * 26.0 + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_number::v3;

    /// The share of light from everywhere that comes back at this cosine, and the part of it that [`schlick`] weighs: integrated over
    /// the directions of the light, in double precision.
    fn integral(cosine: f64, roughness: f64) -> [f64; 2] {
        let alpha = roughness * roughness;
        let eye = [(1.0 - cosine * cosine).sqrt(), 0.0, cosine];
        let lambda = |c: f64| ((1.0 + alpha * alpha * (1.0 / (c * c) - 1.0)).sqrt() - 1.0) / 2.0;
        let (mut all, mut risen) = (0.0, 0.0);
        // over the normals of mirrors, evenly in what the distribution counts of them: D cos = density
        let (rings, turns) = (600, 200);
        for i in 0..rings {
            let u = (f64::from(i) + 0.5) / f64::from(rings);
            // tangent of the angle to the normal
            let tan2 = alpha * alpha * u / (1.0 - u);
            let c = 1.0 / (1.0 + tan2).sqrt();
            let s = (1.0 - c * c).sqrt();
            for k in 0..turns {
                let phi = (f64::from(k) + 0.5) / f64::from(turns) * std::f64::consts::TAU;
                let h = [s * phi.cos(), s * phi.sin(), c];
                let eh: f64 = (0..3).map(|k| eye[k] * h[k]).sum();
                let light = 2.0 * eh * c - cosine;
                if eh <= 0.0 || light <= 0.0 {
                    continue;
                }
                let g = 1.0 / (1.0 + lambda(cosine) + lambda(light));
                let w = g * eh / (cosine * c);
                all += w;
                risen += w * (1.0 - eh).powi(5);
            }
        }
        let n = f64::from(rings * turns);
        [all / n, risen / n]
    }

    #[test]
    fn fits_follow_the_integrals() {
        for roughness in [0.15, 0.3, 0.5, 0.7, 0.85, 1.0] {
            for cosine in [0.05, 0.15, 0.3, 0.5, 0.7, 0.9, 1.0] {
                let [all, risen] = integral(cosine, roughness);
                let (c, r) = (cosine as f32, roughness as f32);
                let found = single(c, r);
                assert!(
                    (f64::from(found) - all).abs() < 0.012,
                    "{c} {r}: {found} instead of {all}"
                );
                let found = mean_schlick(c, r);
                let right = risen / all;
                assert!(
                    (f64::from(found) - right).abs() < 0.03,
                    "{c} {r}: {found} instead of {right}"
                );
            }
        }
    }

    #[test]
    fn the_distribution_covers_the_surface() {
        for roughness in [0.1f32, 0.3, 0.6, 1.0] {
            // the integral of D cos over the hemisphere is 1
            let n = v3(0.0, 0.0, 1.0f64);
            let (mut sum, steps) = (0.0, 20_000);
            for i in 0..steps {
                let theta = (f64::from(i) + 0.5) / f64::from(steps) * std::f64::consts::FRAC_PI_2;
                let h = v3(theta.sin(), 0.0, theta.cos());
                let d = distribution(
                    v3(n.x as f32, n.y as f32, n.z as f32),
                    v3(h.x as f32, h.y as f32, h.z as f32),
                    alpha(roughness),
                );
                sum += f64::from(d)
                    * theta.cos()
                    * theta.sin()
                    * std::f64::consts::PI
                    * std::f64::consts::PI
                    / f64::from(steps);
            }
            assert!((sum - 1.0).abs() < 2e-3, "{roughness}: {sum}");
        }
    }

    #[test]
    fn fresnel_has_its_known_values() {
        let close = |a: f32, b: f32| assert!((a - b).abs() < 1e-5, "{a} instead of {b}");
        close(fresnel(1.0, 1.5), 0.04);
        close(fresnel(1.0, 1.0 / 1.5), 0.04);
        close(fresnel(0.0, 1.5), 1.0);
        // beyond the critical angle, whose sine is 1 / 1.5, all is reflected
        let critical = (1.0f32 - 1.0 / 2.25).sqrt();
        close(fresnel(critical - 1e-3, 1.0 / 1.5), 1.0);
        assert!(fresnel(critical + 1e-2, 1.0 / 1.5) < 0.9);
        // at Brewster's angle only one of two polarizations is reflected: half of ((n^2 - 1) / (n^2 + 1))^2
        let brewster = (1.0f32 / (1.0 + 2.25)).sqrt();
        close(fresnel(brewster, 1.5), 0.5 * (1.25f32 / 3.25).powi(2));
        // the same seen from both sides
        let inside = (1.0 - (1.0 - 0.36) / 2.25f32).sqrt();
        close(fresnel(0.6, 1.5), fresnel(inside, 1.0 / 1.5));
        close(fresnel(0.3, 1.0), 0.0);
    }
}
