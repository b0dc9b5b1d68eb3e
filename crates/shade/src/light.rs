//! What arrives at a surface from a light.

use crate::microfacet::{LIGHT_ALPHA, alpha, distribution, schlick, visibility};
use crate::{each, parameters};
use zeroset_number::{Real, Vec3, v3};
use zeroset_scene::light::{Light, Source};
use zeroset_scene::settings::{Shading, Shadow};

/// Luminance of a linear colour (Rec. 709).
#[inline(always)]
pub fn luminance(c: [f32; 3]) -> f32 {
    luminance_of(v3(c[0], c[1], c[2]))
}

/// As [`luminance`], of numbers of any type.
#[inline(always)]
pub fn luminance_of<R: Real>(c: Vec3<R>) -> R {
    c.x * 0.2126 + c.y * 0.7152 + c.z * 0.0722
}

/// How a surface answers a light of radiance 1 that is not in shadow.
#[derive(Clone, Copy, Debug)]
pub struct Response<R> {
    /// By the cosine law, before `falloff`.
    pub diffuse: R,
    /// In the highlight, before `falloff` and the material's strength.
    pub gloss: R,
    /// The part of it that the rise of Fresnel's law weighs.
    pub grazing: R,
    /// What distance leaves of the light.
    pub falloff: R,
}

/// The direction from `p` to a place, and the distance to it.
#[inline(always)]
pub fn towards_point<R: Real>(place: Vec3<R::Scalar>, p: Vec3<R>) -> (Vec3<R>, R) {
    let to = -(p - place);
    let distance = to.length().max(1e-18);
    (to / distance, distance)
}

/// The direction from `p` to a light, and the distance to it.
#[inline(always)]
pub fn towards<R: Real<Scalar = f32>>(source: &Source, p: Vec3<R>) -> (Vec3<R>, R) {
    match source {
        Source::Directional { direction } => {
            (p.like(parameters(-*direction)), p.x.lit(f32::INFINITY))
        }
        Source::Point { position }
        | Source::Rectangle { position, .. }
        | Source::Disc { position, .. }
        | Source::Sphere { position, .. } => towards_point(parameters(*position), p),
    }
}

/// The cosine of the angle under which half a light is seen whose shadow is so sharp: as wide as its penumbra.
#[inline(always)]
pub fn width_of<R: Real>(sharpness: R) -> R {
    (sharpness.sq().recip() + 1.0).sqrt().recip()
}

/// How many times as bright a disc is as a white surface that faces it: pi over its solid angle. `cosine` is that of the angle under which
/// half of it is seen.
#[inline(always)]
pub fn disc_power<R: Real>(cosine: R) -> R {
    (cosine.one_minus() * 2.0).max(1e-9).recip()
}

/// See [`width_of`]; 1 where the shadow is hard.
pub fn width(light: &Light) -> f32 {
    match light.shadow {
        Shadow::Soft { sharpness } | Shadow::SoftClosest { sharpness } => width_of(sharpness),
        Shadow::Hard | Shadow::Advected { .. } | Shadow::None => 1.0,
    }
}

/// The light of all suns that are seen in a direction: discs as wide as the penumbrae of their shadows, so bright that a white surface that
/// faces one is as bright as the light says. Those without a width are not seen.
pub fn discs(lights: &[Light], direction: Vec3<f32>) -> Vec3<f32> {
    let mut sum = Vec3::splat(0.0);
    for light in lights {
        let Source::Directional { direction: way } = light.source else {
            continue;
        };
        let cosine = width(light);
        if cosine < 1.0 && -parameters(way).dot(direction) > cosine {
            sum = sum + parameters(light.radiance) * disc_power(cosine);
        }
    }
    sum
}

/// Inverse squares, relative to a distance of 1.
#[inline(always)]
pub fn falloff<R: Real>(distance: R) -> R {
    distance.sq().max(1e-12).recip()
}

/// Blinn's (1977) highlight by the half vector between the direction `to` the light and that to the eye; `d` is the direction
/// of the ray that sees the surface. Zero where the light is behind the surface: `facing` of Tomczak 2012, equation 3.5.
#[inline(always)]
pub fn highlight<R: Real>(n: Vec3<R>, to: Vec3<R>, d: Vec3<R>, cosine: R, shininess: R) -> R {
    let half = to - d;
    let aligned = (n.dot(half) / half.length().max(1e-12)).clamp(1e-8, 1.0);
    let peak = (aligned.ln() * shininess).exp();
    R::choose(cosine.above(0.0), peak, cosine.lit(0.0))
}

/// The highlight of small mirrors (Cook and Torrance 1982; Walter et al. 2007) by the cosine law, for lights whose radiance a white
/// surface shows that faces them: pi times the reflectance. Then the part of it that Schlick's term weighs.
#[inline(always)]
pub fn mirror_highlight<R: Real>(
    n: Vec3<R>,
    to: Vec3<R>,
    d: Vec3<R>,
    cosine: R,
    roughness: R,
) -> [R; 2] {
    highlight_of(n, to, d, cosine, alpha(roughness).max(LIGHT_ALPHA))
}

/// See [`mirror_highlight`]: of mirrors with a distribution of this width.
#[inline(always)]
pub fn highlight_of<R: Real>(n: Vec3<R>, to: Vec3<R>, d: Vec3<R>, cosine: R, alpha: R) -> [R; 2] {
    let half = to - d;
    let half = half / half.length().max(1e-12);
    let to_eye = (-n.dot(d)).max(1e-4);
    let mirrors = distribution(n, half, alpha) * visibility(cosine, to_eye, alpha);
    let all = mirrors * cosine * std::f32::consts::PI;
    [all, all * schlick(half.dot(to))]
}

/// What a surface of normal `n` makes of a light in direction `to` at `distance`; `point` is whether that is at a place. `d` is
/// the direction of the ray that sees it, `finish` how smooth it is: its roughness, or for Phong's model its shininess.
///
/// Mirrors over a matte body; Phong's model as Tomczak 2012 has it, equations 3.1 to 3.5; Lambert's law, albedo / pi, with inverse
/// squares for point lights (Munini 2021, 3.3); the same as printed there, `(n . l) colour / (4 pi)` without falloff.
#[inline(always)]
pub fn response<R: Real>(
    shading: Shading,
    point: bool,
    (to, distance): (Vec3<R>, R),
    n: Vec3<R>,
    d: Vec3<R>,
    finish: R,
) -> Response<R> {
    let cosine = n.dot(to).max(0.0);
    let scale = match shading {
        Shading::Physical | Shading::Phong => 1.0,
        Shading::Lambert => std::f32::consts::FRAC_1_PI,
        Shading::LambertLegacy => 0.25 * std::f32::consts::FRAC_1_PI,
    };
    let falls = point && !matches!(shading, Shading::LambertLegacy);
    let none = cosine.lit(0.0);
    let [gloss, grazing] = match shading {
        Shading::Physical => mirror_highlight(n, to, d, cosine, finish),
        Shading::Phong => [highlight(n, to, d, cosine, finish), none],
        Shading::Lambert | Shading::LambertLegacy => [none, none],
    };
    Response {
        diffuse: cosine * scale,
        gloss,
        grazing,
        falloff: if falls {
            falloff(distance)
        } else {
            distance.lit(1.0)
        },
    }
}

/// Light that a hit gets from one light.
#[derive(Clone, Copy, Debug)]
pub struct Arrival<R> {
    /// By the cosine law.
    pub diffuse: Vec3<R>,
    /// In the highlight, before the material's strength.
    pub gloss: Vec3<R>,
    /// The part of it that the rise of Fresnel's law weighs.
    pub grazing: Vec3<R>,
    /// How much this light would be without its shadow: its share of the shadow plane.
    pub share: R,
}

/// What arrives at a surface of normal `n` from a light in direction `to` at `distance`, of which `lit` is not in shadow; `d`
/// is the direction of the ray that sees it. See [`response`].
#[inline(always)]
pub fn arrival<R: Real<Scalar = f32>>(
    shading: Shading,
    light: &Light,
    to: (Vec3<R>, R),
    n: Vec3<R>,
    d: Vec3<R>,
    lit: R,
    finish: R,
) -> Arrival<R> {
    let point = light.source.is_near();
    let response = response(shading, point, to, n, d, finish);
    let arriving = response.falloff * lit;
    let colour = light.radiance.to_array();
    let (diffuse, gloss) = (response.diffuse * arriving, response.gloss * arriving);
    let grazing = response.grazing * arriving;
    Arrival {
        diffuse: each(
            #[inline(always)]
            |k| diffuse * colour[k],
        ),
        gloss: each(
            #[inline(always)]
            |k| gloss * colour[k],
        ),
        grazing: each(
            #[inline(always)]
            |k| grazing * colour[k],
        ),
        share: response.falloff * luminance(colour),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3 as G;

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
