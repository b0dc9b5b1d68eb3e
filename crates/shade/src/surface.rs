//! The colour of a surface, from what it is made of and the light that it gets.

use crate::sky::{SkyColours, ambient, colour as sky};
use zeroset_number::{Ops, Real, Vec3};
use zeroset_scene::settings::Shading;

/// What a surface is made of at one place: where materials meet, a mixture of them.
#[derive(Clone, Copy, Debug)]
pub struct LocalMaterial<R> {
    /// Linear colour.
    pub albedo: Vec3<R>,
    /// Light of its own.
    pub emission: Vec3<R>,
    /// Strength of the highlight.
    pub specular: R,
    /// 0 plastic or stone, 1 metal.
    pub metallic: R,
    /// 0 mirror, 1 chalk.
    pub roughness: R,
}

/// The light that a place on a surface gets, and the ways to it.
#[derive(Clone, Copy, Debug)]
pub struct Lighting<R> {
    /// From the lights, by the cosine law.
    pub diffuse: Vec3<R>,
    /// In highlights, before the material's strength.
    pub gloss: Vec3<R>,
    /// Ambient visibility, which scales what comes from the sky and nothing else (Tomczak 2012, equation 3.32).
    pub open: R,
    /// Where most of the sky is seen.
    pub bent: Vec3<R>,
    /// The normal.
    pub normal: Vec3<R>,
    /// The direction of the ray that sees it.
    pub direction: Vec3<R>,
}

/// Reflectance of a non-metal looked at along its normal.
const DIELECTRIC: f32 = 0.04;

/// The colour of a surface: light by the cosine law and the ambient term, highlights, the sky's reflection, its own light.
///
/// The reflection is the sky's colour along the mirror direction, dimmed to its ambient colour by roughness and weighted by
/// Schlick's (1994) approximation of Fresnel's law; wholly rough surfaces and Lambert's models have none.
#[inline(always)]
pub fn colour<R: Real>(
    shading: Shading,
    sky: &SkyColours<R::Scalar>,
    what: &LocalMaterial<R>,
    light: &Lighting<R>,
) -> Vec3<R> {
    match shading {
        Shading::Phong => phong(sky, what, light),
        Shading::Lambert | Shading::LambertLegacy => matte(sky, what, light) + what.emission,
    }
}

/// What a surface scatters in its own colour.
#[inline(always)]
fn matte<R: Real>(
    sky: &SkyColours<R::Scalar>,
    what: &LocalMaterial<R>,
    light: &Lighting<R>,
) -> Vec3<R> {
    let around = ambient(sky, light.bent.y);
    what.albedo.times(light.diffuse + around * light.open)
}

#[inline(always)]
fn phong<R: Real>(
    sky_colours: &SkyColours<R::Scalar>,
    what: &LocalMaterial<R>,
    light: &Lighting<R>,
) -> Vec3<R> {
    let (n, d) = (light.normal, light.direction);
    let dull = what.metallic.one_minus();
    let incoming = matte(sky_colours, what, light);
    // highlights and reflections of metals take their colour
    let tinted = what.albedo * what.metallic + Vec3::splat(dull);
    let cosine = -n.dot(d);
    let mirror = d + n * (cosine * 2.0);
    let (sharp, wide) = (
        sky(sky_colours, mirror.y),
        ambient(sky_colours, n.y) / sky_colours.ambient.max(1e-3),
    );
    let rough = what.roughness;
    let seen = sharp * rough.one_minus() + wide * rough;
    let grazing = cosine.clamp01().one_minus().powi(5);
    let smooth = rough.one_minus();
    let straight = what.albedo * what.metallic + Vec3::splat(dull * DIELECTRIC);
    let (rise, share) = (grazing * smooth, smooth * light.open);
    let mirrored = (straight * rise.one_minus() + Vec3::splat(rise)) * share;
    // what a rough metal does not mirror it scatters: the ambient light in its own colour
    let scattered = incoming * (what.metallic * rough);
    incoming * dull
        + scattered
        + tinted.times(light.gloss) * what.specular
        + mirrored.times(seen)
        + what.emission
}
