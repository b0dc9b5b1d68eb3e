//! How light scatters at a surface, for integrators that follow one way of many: a direction out of all, and what the light from there is
//! worth.
//!
//! The surface is that of [`crate::surface`]: small mirrors over a body that scatters by the cosine law, or over a clear one.

use crate::light::luminance_of;
use crate::microfacet::{alpha, schlick};
use crate::sampling::{basis, cosine_direction};
use crate::surface::{LocalMaterial, Mirrored, mirrored, refraction};
use zeroset_number::{Real, Vec3, v3};

/// Decisions that a way takes at each surface: what scatters it and whether it ends; where to; and where each of so many lights is looked
/// for.
pub const DECISIONS: u32 = 2 + zeroset_scene::valid::LIGHTS as u32;
/// Ways end at random from this number of surfaces on...
pub const SURE: u32 = 3;
/// ...and go on with a chance of at most this.
pub const LIKELIEST: f32 = 0.95;

/// Where a ray goes on.
#[derive(Clone, Copy, Debug)]
pub struct Scattered<R> {
    /// The direction, of length 1.
    pub direction: Vec3<R>,
    /// The reflectance times the cosine over the density with which the direction is chosen: the share of the light from there that
    /// goes to the eye. Zero where the way ends.
    pub weight: Vec3<R>,
    /// 0 where the body scattered it, 1 where a mirror reflected it, 2 where a clear body did or let it through.
    pub lobe: R,
    /// 1 where it goes on behind the surface, else 0.
    pub through: R,
}

/// The normal of a mirror out of those that are seen from the direction `v` (Dupuy and Benyoub 2023), from a point of the unit square. `n`
/// is the normal of the surface.
#[inline(always)]
pub fn visible_normal<R: Real>(n: Vec3<R>, v: Vec3<R>, alpha: R, u: [R; 2]) -> Vec3<R> {
    let [a, b] = basis(n);
    // in a space where the distribution is a hemisphere
    let stretched = v3(v.dot(a) * alpha, v.dot(b) * alpha, v.dot(n).max(1e-6));
    let w = stretched / stretched.length().max(1e-12);
    let (sin, cos) = (u[0] * std::f32::consts::TAU).sin_cos();
    let z = u[1].one_minus() * (w.z + 1.0) - w.z;
    let r = z.sq().one_minus().max(0.0).sqrt();
    let cap = v3(r * cos, r * sin, z);
    let h = cap + w;
    let h = v3(h.x * alpha, h.y * alpha, h.z.max(1e-6));
    let h = h / h.length().max(1e-12);
    a * h.x + b * h.y + n * h.z
}

/// Smith's function of what mirrors hide, over what they show (Walter et al. 2007; Heitz 2014, equation 72).
#[inline(always)]
pub fn hidden<R: Real>(cosine: R, alpha: R) -> R {
    let c2 = cosine.sq().max(1e-8);
    ((alpha.sq() * (c2.recip() - 1.0) + 1.0).max(1.0).sqrt() - 1.0) * 0.5
}

/// The share of the mirrors that the eye sees that is not hidden from the light: both by height (Heitz 2014).
#[inline(always)]
fn seen_share<R: Real>(to_eye: R, to_light: R, alpha: R) -> R {
    let (eye, light) = (hidden(to_eye, alpha), hidden(to_light, alpha));
    (eye + 1.0) / (eye + light + 1.0)
}

/// How often a surface scatters with its matte body and with its mirrors; what is left is for a clear body.
#[derive(Clone, Copy, Debug)]
pub struct Shares<R> {
    /// The matte body.
    pub body: R,
    /// The mirrors.
    pub mirror: R,
    /// A clear body.
    pub clear: R,
}

/// See [`scatter`].
#[inline(always)]
pub fn shares<R: Real>(what: &LocalMaterial<R>, mirrors: &Mirrored<R>) -> Shares<R> {
    let clear = what.transmission * what.metallic.one_minus();
    let body = what.albedo * (mirrors.left * what.transmission.one_minus());
    let opaque = clear.one_minus();
    let (w_body, w_mirror) = (luminance_of(body), luminance_of(mirrors.all) * opaque);
    let all = (w_body + w_mirror + clear).max(1e-12);
    Shares {
        body: w_body / all,
        mirror: w_mirror / all,
        clear: (clear / all).max(1e-12),
    }
}

/// Chooses where a ray of direction `d` goes on that meets a surface of normal `n` on its side. `ior` is the index of refraction behind a
/// clear surface over that before it, `tint` what a clear body colours light with that goes in. Of the three numbers in [0, 1) the
/// first chooses what scatters the ray, the others where to.
#[inline(always)]
pub fn scatter<R: Real>(
    what: &LocalMaterial<R>,
    n: Vec3<R>,
    d: Vec3<R>,
    ior: R,
    tint: Vec3<R>,
    [choice, u, v]: [R; 3],
) -> Scattered<R> {
    let eye = -d;
    let cosine = n.dot(eye).clamp(1e-4, 1.0);
    let zero = cosine.lit(0.0);
    let clear = what.transmission * what.metallic.one_minus();
    let mirrors = mirrored(what, cosine);
    let body = what.albedo * (mirrors.left * what.transmission.one_minus());
    // how often each is chosen
    let opaque = clear.one_minus();
    let Shares {
        body: p_body,
        mirror: p_mirror,
        clear: p_clear,
    } = shares(what, &mirrors);
    let is_body = choice.below(p_body);
    let is_clear = (choice - p_body).above(p_mirror);

    let scattered = cosine_direction(n, u, v);
    let alpha = alpha(what.roughness);
    let h = visible_normal(n, eye, alpha, [u, v]);
    let aligned = h.dot(eye).max(0.0);
    let reflected = d + h * (aligned * 2.0);
    let up = n.dot(reflected);
    let share = seen_share(cosine, up.max(0.0), alpha);
    let share = R::choose(up.above(0.0), share, zero);
    let rise = schlick(aligned);
    let f = mirrors.straight * rise.one_minus() + Vec3::splat(mirrors.edge * rise);
    let mirror_weight = f.times(mirrors.again) * (share * opaque / p_mirror.max(1e-12));

    // the border of a clear body
    let border = refraction(d, h, ior);
    let rest = ((choice - p_body - p_mirror) / p_clear).clamp(0.0, 1.0);
    let passes = rest.above(border.reflected);
    let down = -n.dot(border.direction);
    let shone = seen_share(cosine, down.max(0.0), alpha);
    let shone = R::choose(down.above(0.0), shone, zero);
    let through_weight = tint * (shone * clear / p_clear);
    let back_weight = Vec3::splat(share * clear / p_clear);
    let one = cosine.lit(1.0);
    let clear_weight = Vec3::select(passes, through_weight, back_weight);
    let clear_way = Vec3::select(passes, border.direction, reflected);

    let mirror = Scattered {
        direction: Vec3::select(is_clear, clear_way, reflected),
        weight: Vec3::select(is_clear, clear_weight, mirror_weight),
        lobe: R::choose(is_clear, cosine.lit(2.0), one),
        through: R::choose(is_clear, R::choose(passes, one, zero), zero),
    };
    Scattered {
        direction: Vec3::select(is_body, scattered, mirror.direction),
        weight: Vec3::select(is_body, body / p_body.max(1e-12), mirror.weight),
        lobe: R::choose(is_body, zero, mirror.lobe),
        through: R::choose(is_body, zero, mirror.through),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::microfacet::single;
    use crate::sampling::point;

    fn material(roughness: f32) -> LocalMaterial<f32> {
        LocalMaterial {
            albedo: v3(1.0, 1.0, 1.0),
            emission: v3(0.0, 0.0, 0.0),
            specular: 0.25,
            metallic: 0.0,
            roughness,
            transmission: 0.0,
            shininess: 40.0,
        }
    }

    /// The mean weight over all directions: what comes back of a white world.
    fn furnace(what: &LocalMaterial<f32>, cosine: f32, ior: f32) -> f32 {
        let n = v3(0.36, 0.48, 0.8f32);
        let [a, _] = basis(n);
        let eye = n * cosine + a * (1.0 - cosine * cosine).sqrt();
        let count = 1 << 14;
        let mut sum = 0.0;
        for i in 0..count {
            let [u, v] = point(i, [0, 0]);
            let choice = (i.wrapping_mul(2_654_435_769) >> 8) as f32 / 16_777_216.0;
            let way = scatter(what, n, -eye, ior, v3(1.0, 1.0, 1.0), [choice, u, v]);
            assert!((way.direction.length() - 1.0).abs() < 1e-3);
            assert!(way.weight.x >= 0.0 && way.weight.x.is_finite());
            sum += f64::from(way.weight.x);
        }
        (sum / f64::from(count)) as f32
    }

    #[test]
    fn a_white_world_stays_white() {
        for roughness in [0.05, 0.2, 0.4, 0.7, 1.0] {
            for cosine in [0.15, 0.4, 0.7, 0.98] {
                let plastic = material(roughness);
                let metal = LocalMaterial {
                    metallic: 1.0,
                    ..plastic
                };
                let half = LocalMaterial {
                    metallic: 0.5,
                    ..plastic
                };
                for (what, name) in [(plastic, "plastic"), (metal, "metal")] {
                    let found = furnace(&what, cosine, 1.5);
                    assert!(
                        (found - 1.0).abs() < 0.03,
                        "{name} {roughness} {cosine}: {found}"
                    );
                }
                // mirrors that are half metal lose a little to each other
                let found = furnace(&half, cosine, 1.5);
                assert!(
                    (0.8..1.02).contains(&found),
                    "{roughness} {cosine}: {found}"
                );
                // a clear body loses what its mirrors hide: nothing where it is smooth
                let clear = LocalMaterial {
                    transmission: 1.0,
                    ..plastic
                };
                for ior in [1.5, 1.0 / 1.5] {
                    let found = furnace(&clear, cosine, ior);
                    let lost = 1.0 - single(cosine, roughness);
                    assert!(
                        found < 1.001 && found > 0.99 - 2.0 * lost,
                        "glass {roughness} {cosine} {ior}: {found}"
                    );
                }
            }
        }
    }

    /// The density of visible normals by its formula, against the histogram of those that are chosen (chi-square).
    #[test]
    fn visible_normals_have_their_density() {
        for (roughness, cosine) in [(0.6f32, 0.9f32), (0.7, 0.4), (1.0, 0.2)] {
            let a = alpha(roughness);
            let n = v3(0.0, 0.0, 1.0f32);
            let eye = v3((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
            let (rings, turns, count) = (8, 8, 1 << 18);
            let mut bins = vec![0.0f64; rings * turns];
            let cell = |h: Vec3<f32>| {
                let ring = (h.z * rings as f32) as usize;
                let turn = (h.y.atan2(h.x) / std::f32::consts::TAU + 0.5) * turns as f32;
                ring.min(rings - 1) * turns + (turn as usize).min(turns - 1)
            };
            let [x, y] = basis(n);
            for i in 0..count {
                // not one sequence for both: chi-square wants random numbers
                let mut k = i as u32;
                let mut next = || {
                    k = k.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
                    let w = ((k >> ((k >> 28) + 4)) ^ k).wrapping_mul(277_803_737);
                    ((w >> 22) ^ w) as f32 / 4_294_967_296.0
                };
                let h = visible_normal(n, eye, a, [next(), next()]);
                bins[cell(v3(h.dot(x), h.dot(y), h.dot(n)))] += 1.0;
            }
            let eye = v3(eye.dot(x), eye.dot(y), eye.dot(n));
            // the expected counts, by quadrature over each cell
            let fine = 40;
            let mut statistic = 0.0;
            let mut degrees = 0;
            for ring in 0..rings {
                for turn in 0..turns {
                    let mut density = 0.0f64;
                    for i in 0..fine {
                        for k in 0..fine {
                            let c = (ring as f64 + (f64::from(i) + 0.5) / f64::from(fine))
                                / rings as f64;
                            let phi = (turn as f64 + (f64::from(k) + 0.5) / f64::from(fine))
                                / turns as f64;
                            let phi = (phi - 0.5) * std::f64::consts::TAU;
                            let s = (1.0 - c * c).sqrt();
                            let h = [s * phi.cos(), s * phi.sin(), c];
                            let eh = h[0] * f64::from(eye.x)
                                + h[1] * f64::from(eye.y)
                                + h[2] * f64::from(eye.z);
                            let a2 = f64::from(a).powi(2);
                            let d =
                                a2 / (std::f64::consts::PI * (c * c * (a2 - 1.0) + 1.0).powi(2));
                            let ce = f64::from(eye.z);
                            let g = 2.0 / (1.0 + (1.0 + a2 * (1.0 / (ce * ce) - 1.0)).sqrt());
                            density += g * eh.max(0.0) * d / ce;
                        }
                    }
                    let area =
                        std::f64::consts::TAU / (rings * turns) as f64 / f64::from(fine * fine);
                    let expected = density * area * f64::from(count);
                    if expected > 20.0 {
                        statistic += (bins[ring * turns + turn] - expected).powi(2) / expected;
                        degrees += 1;
                    }
                }
            }
            // four standard deviations over the mean of the distribution
            let limit = f64::from(degrees) + 4.0 * (2.0 * f64::from(degrees)).sqrt() + 10.0;
            assert!(
                degrees > 20 && statistic < limit,
                "{roughness} {cosine}: {statistic} of {degrees}"
            );
        }
    }
}
