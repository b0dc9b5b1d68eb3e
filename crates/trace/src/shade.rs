//! How light becomes colour: each term one formula over any number type.

use crate::simd::each;
use zeroset_number::{Real, Vec3};
use zeroset_scene::light::{Light, Sky, Source};
use zeroset_scene::settings::Shading;

/// Light that a hit gets from one light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival<R> {
    /// By the cosine law.
    pub(crate) diffuse: Vec3<R>,
    /// In the highlight, before the material's strength.
    pub(crate) gloss: Vec3<R>,
    /// How much this light would be without its shadow: its share of the shadow plane.
    pub(crate) share: R,
}

/// Luminance of a linear colour (Rec. 709).
pub(crate) fn luminance(c: [f32; 3]) -> f32 {
    0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]
}

/// What arrives at a surface of normal `n` from a light in direction `to` at `distance`, of which `lit` is not in shadow; `d`
/// is the direction of the ray that sees it.
#[inline(always)]
pub(crate) fn arrival<R: Real<Scalar = f32>>(
    shading: Shading,
    light: &Light,
    (to, distance): (Vec3<R>, R),
    n: Vec3<R>,
    d: Vec3<R>,
    lit: R,
    shininess: R,
) -> Arrival<R> {
    let falloff = match (&light.source, shading) {
        (Source::Point { .. }, Shading::Phong | Shading::Lambert) => {
            distance.sq().max(1e-12).recip()
        }
        _ => distance.lit(1.0),
    };
    let cosine = n.dot(to).max(0.0);
    let scale = match shading {
        Shading::Phong => 1.0,
        Shading::Lambert => std::f32::consts::FRAC_1_PI,
        Shading::LambertLegacy => 0.25 * std::f32::consts::FRAC_1_PI,
    };
    let arriving = falloff * lit;
    let colour = light.radiance.to_array();
    let diffuse = cosine * scale;
    let gloss = match shading {
        Shading::Phong => {
            // Blinn's half vector; `facing` is zero where the light is behind the surface (Tomczak 2012, equation 3.5)
            let half = to - d;
            let aligned = (n.dot(half) / half.length().max(1e-12)).clamp(1e-8, 1.0);
            let peak = (aligned.ln() * shininess).exp();
            R::select(cosine.above(0.0), peak, cosine.lit(0.0))
        }
        Shading::Lambert | Shading::LambertLegacy => cosine.lit(0.0),
    };
    let (diffuse, gloss) = (diffuse * arriving, gloss * arriving);
    Arrival {
        diffuse: each(
            #[inline(always)]
            |k| diffuse * colour[k],
        ),
        gloss: each(
            #[inline(always)]
            |k| gloss * colour[k],
        ),
        share: falloff * luminance(colour),
    }
}

/// The sky along a direction whose height is `y`: smooth from the bottom over the horizon to the top.
#[inline(always)]
pub(crate) fn sky<R: Real<Scalar = f32>>(sky: &Sky, y: R) -> Vec3<R> {
    let t = y.abs().min(1.0).sqrt();
    let down = y.negative();
    let (horizon, top, bottom) = (sky.horizon, sky.top - sky.horizon, sky.bottom - sky.horizon);
    each(
        #[inline(always)]
        |k| t * R::select(down, t.lit(bottom[k]), t.lit(top[k])) + horizon[k],
    )
}

/// What arrives of the sky at an open surface whose normal (or bent normal) has the height `y`: nearly the mean of the sky
/// over the hemisphere around it.
#[inline(always)]
pub(crate) fn ambient<R: Real<Scalar = f32>>(sky: &Sky, y: R) -> Vec3<R> {
    let t = y * 0.5 + 0.5;
    let low = (sky.bottom + sky.horizon) * (0.5 * sky.ambient);
    let rise = (sky.top - sky.bottom) * (0.5 * sky.ambient);
    each(
        #[inline(always)]
        |k| t * rise[k] + low[k],
    )
}

/// What a surface is made of, where materials meet a mixture of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Substance<R> {
    pub(crate) albedo: Vec3<R>,
    pub(crate) emission: Vec3<R>,
    pub(crate) specular: R,
    pub(crate) metallic: R,
    pub(crate) roughness: R,
}

/// Reflectance of a non-metal looked at along its normal.
const DIELECTRIC: f32 = 0.04;

/// The colour of a surface: light by the cosine law and the ambient term, highlights, the sky's reflection, its own light.
///
/// `open` is the ambient visibility, which scales what comes from the sky and nothing else (Tomczak 2012, equation 3.32). The
/// reflection is the sky's colour along the mirror direction, dimmed to its ambient colour by roughness and weighted by
/// Schlick's (1994) approximation of Fresnel's law; wholly rough surfaces and Lambert's models have none.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "all that a colour depends on")]
pub(crate) fn colour<R: Real<Scalar = f32>>(
    shading: Shading,
    heavens: &Sky,
    what: &Substance<R>,
    diffuse: Vec3<R>,
    gloss: Vec3<R>,
    n: Vec3<R>,
    bent: Vec3<R>,
    d: Vec3<R>,
    open: R,
) -> Vec3<R> {
    let around = ambient(heavens, bent.y);
    if !matches!(shading, Shading::Phong) {
        return what.albedo.times(diffuse + around * open) + what.emission;
    }
    let dull = what.metallic.one_minus();
    let matte = what.albedo.times(diffuse + around * open) * dull;
    // highlights and reflections of metals take their colour
    let tinted = what.albedo * what.metallic + Vec3::splat(dull);
    let cosine = -n.dot(d);
    let mirror = d + n * (cosine * 2.0);
    let (sharp, wide) = (
        sky(heavens, mirror.y),
        ambient(heavens, n.y) / heavens.ambient.max(1e-3),
    );
    let rough = what.roughness;
    let seen = sharp * rough.one_minus() + wide * rough;
    let grazing = cosine.clamp01().one_minus().powi(5);
    let smooth = rough.one_minus();
    let straight = what.albedo * what.metallic + Vec3::splat(dull * DIELECTRIC);
    let (rise, share) = (grazing * smooth, smooth * open);
    let mirrored = (straight * rise.one_minus() + Vec3::splat(rise)) * share;
    // what a rough metal does not mirror it scatters: the ambient light in its own colour
    let scattered = what.albedo.times(diffuse + around * open) * (what.metallic * rough);
    matte + scattered + tinted.times(gloss) * what.specular + mirrored.times(seen) + what.emission
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3 as G;
    use zeroset_number::v3;
    use zeroset_scene::settings::Shadow;

    #[test]
    fn the_sky_is_the_scenes() {
        let s = Sky::default();
        for y in [-1.0, -0.3, 0.0, 0.01, 0.5, 1.0f32] {
            let d = G::new((1.0 - y * y).sqrt(), y, 0.0);
            assert!((G::from(sky(&s, y).array()) - s.colour(d)).length() < 1e-6);
        }
    }

    #[test]
    fn lights_follow_their_laws() {
        let light = |source| Light {
            source,
            radiance: G::new(2.0, 1.0, 0.5),
            shadow: Shadow::None,
        };
        let point = light(Source::Point { position: G::ZERO });
        let sun = light(Source::Directional {
            direction: G::NEG_Y,
        });
        let n = v3(0.0, 1.0, 0.0f32);
        let to = v3(0.6, 0.8, 0.0f32);
        let d = v3(0.6, -0.8, 0.0f32);
        let of = |shading, light: &Light, distance| {
            arrival(shading, light, (to, distance), n, d, 1.0, 10.0)
        };
        let close = |a: f32, b: f32| assert!((a - b).abs() < 1e-5, "{a} instead of {b}");
        close(of(Shading::Phong, &sun, f32::INFINITY).diffuse.x, 2.0 * 0.8);
        close(of(Shading::Phong, &point, 2.0).diffuse.x, 2.0 * 0.8 / 4.0);
        close(
            of(Shading::Lambert, &point, 2.0).diffuse.y,
            0.8 / 4.0 / std::f32::consts::PI,
        );
        close(
            of(Shading::LambertLegacy, &point, 2.0).diffuse.y,
            0.8 / (4.0 * std::f32::consts::PI),
        );
        // the mirror direction: half vector and normal agree
        close(of(Shading::Phong, &sun, f32::INFINITY).gloss.z, 0.5);
        close(of(Shading::Lambert, &sun, f32::INFINITY).gloss.z, 0.0);
        let behind = arrival(
            Shading::Phong,
            &sun,
            (v3(0.0, -1.0, 0.0), f32::INFINITY),
            n,
            d,
            1.0,
            10.0,
        );
        close(behind.gloss.x + behind.diffuse.x, 0.0);
    }
}
