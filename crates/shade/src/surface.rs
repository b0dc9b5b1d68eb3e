//! The colour of a surface, from what it is made of and the light that it gets.

use crate::microfacet::{mean_schlick, single};
use crate::sky::{SkyColours, ambient, glossy};
use zeroset_number::{Real, Vec3};
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
    /// 0 opaque, 1 glass.
    pub transmission: R,
    /// Exponent of the highlight of Phong's model.
    pub shininess: R,
}

/// The light that a place on a surface gets, and the ways to it.
#[derive(Clone, Copy, Debug)]
pub struct Lighting<R> {
    /// From the lights, by the cosine law.
    pub diffuse: Vec3<R>,
    /// In highlights, before the material's strength.
    pub gloss: Vec3<R>,
    /// The part of it that mirrors reflect that are seen from the side: what the rise of Fresnel's law weighs.
    pub grazing: Vec3<R>,
    /// Ambient visibility, which scales what comes from the sky and nothing else (Tomczak 2012, equation 3.32).
    pub open: R,
    /// What the light of the sky is multiplied by that comes to the body: the colours of things near by; 1 where they do not count.
    pub tint: Vec3<R>,
    /// Where most of the sky is seen.
    pub bent: Vec3<R>,
    /// The normal.
    pub normal: Vec3<R>,
    /// The direction of the ray that sees it.
    pub direction: Vec3<R>,
}

/// The highlight's strength that stands for the reflectance of the index of refraction itself.
pub const USUAL_SPECULAR: f32 = 0.25;

/// Reflectance along the normal of a body that is no metal, of usual glass, stone or plastic (an index of refraction of 1.5).
const DIELECTRIC: f32 = 0.04;

/// Up to this roughness reflections are followed...
pub const SHARP: f32 = 0.25;
/// ...and from this on they are blurred as a whole; between the two, both are mixed.
pub const BLURRED: f32 = 0.5;

/// What brings less than this share of its light to the eye is not followed.
pub const FAINTEST: f32 = 1.0 / 256.0;

/// The share of a surface's reflection that is followed as if it were a mirror. The rest is the sky's, blurred and dimmed where little of
/// the sky is seen.
#[inline(always)]
pub fn followed_share<R: Real>(roughness: R) -> R {
    roughness.smoothstep(SHARP, BLURRED).one_minus()
}

/// What reflects less than this along its normal reflects less from the side too: nothing in nature does, so this is how a material says
/// that it does not reflect at all (Lagarde and de Rousiers 2014, 3.1.3).
const LEAST_NATURAL: f32 = 0.02;

/// What mirrors reflect.
#[derive(Clone, Copy, Debug)]
pub struct Mirrored<R> {
    /// Reflectance along the normal: the colour of metals, and of all others that of glass, times the strength that the material states.
    pub straight: Vec3<R>,
    /// Reflectance from the side.
    pub edge: R,
    /// How much more than in one reflection comes from mirrors that mirror each other (Turquin 2019).
    pub again: Vec3<R>,
    /// How much of the light from everywhere is reflected in all.
    pub all: Vec3<R>,
    /// What comes to a matte body below the mirrors, all colours alike: what they would leave if none of it were metal, and nothing of the
    /// share that is metal.
    pub left: R,
}

/// What the mirrors of a surface reflect to an eye at this cosine.
#[inline(always)]
pub fn mirrored<R: Real>(what: &LocalMaterial<R>, cosine: R) -> Mirrored<R> {
    let clear = (what.specular * (DIELECTRIC / USUAL_SPECULAR)).min(1.0);
    let clear_edge = (clear * (1.0 / LEAST_NATURAL)).min(1.0);
    let dull = what.metallic.one_minus();
    let straight = what.albedo * what.metallic + Vec3::splat(clear * dull);
    let edge = clear_edge * dull + what.metallic;
    let rise = mean_schlick(cosine, what.roughness);
    let once = single(cosine, what.roughness);
    let more = once.recip() - 1.0;
    let again = straight * more + Vec3::splat(once.lit(1.0));
    let mean = straight * rise.one_minus() + Vec3::splat(rise * edge);
    let clear_all = (clear * rise.one_minus() + clear_edge * rise) * (clear * more + 1.0) * once;
    Mirrored {
        straight,
        edge,
        again,
        all: (mean.times(again) * once).map(
            #[inline(always)]
            |x| x.min(1.0),
        ),
        left: clear_all.min(1.0).one_minus() * dull,
    }
}

/// The share of the sky that a reflection sees where the ambient visibility is `open` (Lagarde and de Rousiers 2014, listing 26).
#[inline(always)]
pub fn reflected_visibility<R: Real>(open: R, cosine: R, roughness: R) -> R {
    let power = (roughness * -16.0 - 1.0).exp2();
    let base = (cosine.clamp01() + open).max(1e-6);
    ((base.ln() * power).exp() - 1.0 + open).clamp01()
}

/// The colour of a surface: light by the cosine law and the ambient term, highlights, the sky's reflection but for the share of it that
/// is `followed`, its own light.
#[inline(always)]
pub fn colour<R: Real>(
    shading: Shading,
    sky: &SkyColours<R::Scalar>,
    what: &LocalMaterial<R>,
    light: &Lighting<R>,
    followed: R,
) -> Vec3<R> {
    match shading {
        Shading::Physical => physical(sky, what, light, followed),
        Shading::Phong => matte(sky, what, light) + light.gloss * what.specular + what.emission,
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
    let around = ambient(sky, light.bent.y).times(light.tint);
    what.albedo.times(light.diffuse + around * light.open)
}

/// Small mirrors over a body that scatters what they let through; metals let nothing through.
#[inline(always)]
fn physical<R: Real>(
    sky: &SkyColours<R::Scalar>,
    what: &LocalMaterial<R>,
    light: &Lighting<R>,
    followed: R,
) -> Vec3<R> {
    let (n, d) = (light.normal, light.direction);
    let facing = -n.dot(d);
    let cosine = facing.clamp01();
    let mirrors = mirrored(what, cosine);
    let highlight =
        mirrors.straight.times(light.gloss - light.grazing) + light.grazing * mirrors.edge;
    let body = matte(sky, what, light) * (mirrors.left * what.transmission.one_minus());
    let mirror = d + n * (facing * 2.0);
    let seen = reflected_visibility(light.open, cosine, what.roughness) * followed.one_minus();
    let around = glossy(sky, mirror.y, what.roughness) * seen;
    body + mirrors.again.times(highlight) + mirrors.all.times(around) + what.emission
}

/// What a surface makes of light from all around, beside [`colour`]: `arriving` is what arrives at an open surface that faces where most of it
/// is seen, `seen` what a mirror as rough shows, of which small mirrors reflect all but the share `followed`.
#[inline(always)]
pub fn around<R: Real>(
    shading: Shading,
    what: &LocalMaterial<R>,
    [n, d]: [Vec3<R>; 2],
    open: R,
    [arriving, seen]: [Vec3<R>; 2],
    followed: R,
) -> Vec3<R> {
    let matte = what.albedo.times(arriving) * open;
    match shading {
        Shading::Physical => {
            let cosine = (-n.dot(d)).clamp01();
            let mirrors = mirrored(what, cosine);
            let body = matte * (mirrors.left * what.transmission.one_minus());
            let share = reflected_visibility(open, cosine, what.roughness);
            body + mirrors.all.times(seen) * (share * followed.one_minus())
        }
        Shading::Phong | Shading::Lambert | Shading::LambertLegacy => matte,
    }
}

/// How a clear body takes a ray: the shares that are reflected and let through, and the direction of the latter.
#[derive(Clone, Copy, Debug)]
pub struct Refraction<R> {
    /// The share that is reflected; 1 where nothing gets through.
    pub reflected: R,
    /// Where the rest goes (Snell's law), of length 1.
    pub direction: Vec3<R>,
}

/// What becomes of a ray of direction `d` at a border with the normal `n` on its side; `ior` is the index of refraction behind it over that
/// before it.
#[inline(always)]
pub fn refraction<R: Real>(d: Vec3<R>, n: Vec3<R>, ior: R) -> Refraction<R> {
    let cosine = (-n.dot(d)).clamp01();
    let over = ior.recip();
    let square = (cosine.sq().one_minus() * over.sq()).one_minus();
    let behind = square.max(0.0).sqrt();
    let direction = d * over + n * (over * cosine - behind);
    Refraction {
        reflected: crate::microfacet::fresnel(cosine, ior),
        direction: direction / direction.length().max(1e-12),
    }
}

/// The direction of a ray that goes on from a surface on the side of its normal `face`: one that bumps would send to the other side goes
/// along it.
#[inline(always)]
pub fn kept_on<R: Real>(direction: Vec3<R>, face: Vec3<R>) -> Vec3<R> {
    let facing = face.dot(direction);
    let lift = R::choose(facing.negative(), -facing + ALONG, facing.lit(0.0));
    let kept = direction + face * lift;
    kept / kept.length().max(1e-12)
}

/// Cosine between such a ray and the normal.
const ALONG: f32 = 0.02;

/// What remains of light after the way `t` through a body that takes `attenuation` of it per length (Beer's law).
#[inline(always)]
pub fn transmittance<R: Real>(attenuation: Vec3<R>, t: R) -> Vec3<R> {
    attenuation.map(
        #[inline(always)]
        |a| (-(a * t)).exp(),
    )
}
