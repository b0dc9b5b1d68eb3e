//! The formulas of [`zeroset_shade`] as WGSL functions: recorded, as the field is, so that both renderers have one of each.
//!
//! A scene's text holds those that its methods need, see `source.rs`.

use std::collections::HashMap;
use std::sync::LazyLock;
use zeroset_number::{Argument, Expr, Ops, Real, Recorder, Vec2, Vec3, v2, wgsl};
use zeroset_scene::settings::{Filter, Shading, Tone};
use zeroset_shade::pattern::{self, Place};
use zeroset_shade::sky::{self, SkyColours};
use zeroset_shade::surface::{self, Lighting, LocalMaterial};
use zeroset_shade::view::{self, Linear};
use zeroset_shade::{
    advection, air, bsdf, environment, lamp, light, march, normal, occlusion, sampling, secondary,
    shadow, skin, skylight, tone,
};

/// A formula that shaders call.
pub(crate) struct Formula {
    /// Its name in WGSL.
    name: &'static str,
    /// Which of several of one name it is; empty where there is one.
    variant: &'static str,
    arguments: &'static [(&'static str, Argument)],
    record: for<'r> fn(&'r Recorder) -> Vec<Expr<'r>>,
}

impl Formula {
    fn print(&self) -> String {
        let recorder = Recorder::new();
        let results = (self.record)(&recorder);
        let function = recorder.function(self.name, self.arguments, &results);
        let function = function.expect("formulas use their own arguments and few results");
        wgsl::print(&function)
    }
}

/// The text of a formula: `name`, or `name@variant` where there are several of one name.
///
/// # Panics
/// Where there is no such formula.
pub(crate) fn text(name: &'static str) -> &'static str {
    static TEXTS: LazyLock<HashMap<(&'static str, &'static str), String>> = LazyLock::new(|| {
        let all = FORMULAS.iter();
        all.map(|f| ((f.name, f.variant), f.print())).collect()
    });
    let key = name.split_once('@').unwrap_or((name, ""));
    match TEXTS.get(&key) {
        Some(text) => text,
        None => panic!("there is no formula `{name}`"),
    }
}

/// What a formula gives, number by number.
trait Results<'r> {
    fn list(self) -> Vec<Expr<'r>>;
}

impl<'r> Results<'r> for Expr<'r> {
    fn list(self) -> Vec<Expr<'r>> {
        vec![self]
    }
}

impl<'r> Results<'r> for Vec2<Expr<'r>> {
    fn list(self) -> Vec<Expr<'r>> {
        self.array().to_vec()
    }
}

impl<'r> Results<'r> for Vec3<Expr<'r>> {
    fn list(self) -> Vec<Expr<'r>> {
        self.array().to_vec()
    }
}

impl<'r, const N: usize> Results<'r> for [Expr<'r>; N] {
    fn list(self) -> Vec<Expr<'r>> {
        self.to_vec()
    }
}

/// A direction with a distance: a vector of four.
impl<'r> Results<'r> for (Vec3<Expr<'r>>, Expr<'r>) {
    fn list(self) -> Vec<Expr<'r>> {
        let (to, distance) = self;
        vec![to.x, to.y, to.z, distance]
    }
}

/// An argument, as a formula takes it.
macro_rules! input {
    ($r:ident, $name:expr, Number) => {
        $r.input($name)
    };
    ($r:ident, $name:expr, Vec2) => {{
        let at = |c: &str| $r.input(&format!("{}.{c}", $name));
        v2(at("x"), at("y"))
    }};
    ($r:ident, $name:expr, Vec3) => {
        $r.point($name)
    };
    ($r:ident, $name:expr, Vec4) => {
        ["x", "y", "z", "w"].map(|c| $r.input(&format!("{}.{c}", $name)))
    };
}

macro_rules! formulas {
    ($(fn $name:ident $(@ $variant:ident)? ($($argument:ident: $kind:ident),*) = $formula:expr;)*) => {
        const FORMULAS: &[Formula] = &[$(Formula {
            name: stringify!($name),
            variant: concat!($(stringify!($variant))?),
            arguments: &[$((stringify!($argument), Argument::$kind)),*],
            record: |r| {
                $(let $argument = input!(r, stringify!($argument), $kind);)*
                Results::list($formula)
            },
        }),*];
    };
}

formulas! {
    // view
    fn on_plane(at: Vec2, half: Vec2, scale: Number) = view::on_plane(at, half, scale);
    fn pinhole_ray(q: Vec2, right: Vec3, up: Vec3, back: Vec3) = view::pinhole_ray(q, right, up, back);
    fn across_plane(q: Vec2, right: Vec3, up: Vec3, origin: Vec3) = view::across(q, right, up, origin);
    fn cone_slope(q: Vec2, reach: Number) = view::cone_slope(q, reach);
    fn enter_box(least: Vec3, most: Vec3, origin: Vec3, direction: Vec3, slope: Number, constant: Number) =
        view::enter(least, most, origin, direction, slope, constant);
    fn leave_box(least: Vec3, most: Vec3, origin: Vec3, direction: Vec3, slope: Number, constant: Number) =
        view::leave(least, most, origin, direction, slope, constant);
    fn on_disc(u: Vec2) = view::on_disc(u.array());
    fn view_narrowness(direction: Vec3, back: Vec3) = view::narrowness(direction, back);
    fn width_of_pixel(t: Number, narrow: Number, pixel: Vec2) = view::pixel_width(t, narrow, linear(pixel));
    fn radius_of_footprint(t: Number, narrow: Number, share: Vec2, rounding: Vec2) =
        view::footprint(t, narrow, linear(share), linear(rounding));

    // marching
    fn behind_surface(p: Vec3) = march::behind(size(p));
    fn skin_touch(point: Vec3, offset: Number) = skin::touch(offset, size(point));
    fn false_position(above: Number, below: Number) = march::root(above, below);
    fn slope_between(before: Number, after: Number, stride: Number) = march::rise(before, after, stride);
    fn smoothed_slope(slope: Number, before: Number, after: Number, stride: Number, beta: Number) =
        march::smoothed(slope, before, after, stride, beta);
    fn slope_step(radius: Number, slope: Number) = march::slope_step(radius, slope);
    fn planar_step(radius: Number, before: Number, stride: Number, share: Number) =
        march::planar_step(radius, before, stride, share);
    fn secondary_step(radius: Number, t: Number, slope: Number, wide: Number) =
        secondary::reach(radius, t, slope, wide);
    fn sample_step(p: Vec3, pixel: Number) = normal::step(p, pixel);

    // sampling
    fn cosine_direction(normal: Vec3, u: Vec2) = sampling::cosine_direction(normal, u.x, u.y);
    fn filter_box(x: Number) = sampling::weight(Filter::Box, x);
    fn filter_tent(x: Number) = sampling::weight(Filter::Tent, x);
    fn filter_mitchell(x: Number) = sampling::weight(Filter::Mitchell, x);

    // patterns
    fn pixel_stretch(normal: Vec3, direction: Vec3, pixel: Number) = pattern::stretch(normal, direction, pixel);
    fn tame_row(row: Vec3) = pattern::tame(row);
    fn mapped_normal(normal: Vec3, x: Vec3, y: Vec3, z: Vec3) = pattern::mapped_normal(normal, [x, y, z]);
    fn mapped_scale(x: Vec3, y: Vec3, z: Vec3) = pattern::mapped_scale([x, y, z]);
    fn pattern_checker(point: Vec3, normal: Vec3, width: Number, stretch: Vec3, size: Number) =
        pattern::checker(&place(point, normal, width, stretch), size);
    fn pattern_stripes(point: Vec3, normal: Vec3, width: Number, stretch: Vec3, direction: Vec3, size: Number) =
        pattern::stripes(&place(point, normal, width, stretch), direction, size);
    fn pattern_noise(point: Vec3, normal: Vec3, width: Number, stretch: Vec3, size: Number, octaves: Number) =
        pattern::noise(&place(point, normal, width, stretch), size, octaves);
    fn pattern_gradient(point: Vec3, start: Vec3, end: Vec3) =
        pattern::gradient(&place(point, point, point.x, point), start, end);
    fn pattern_orbit(orbit: Vec4) = {
        let [x, ..] = orbit;
        let any = zeroset_number::v3(x, x, x);
        pattern::orbit(&place(any, any, x, any).with_orbit(orbit))
    };
    fn texture_number(colour: Vec3) = light::luminance_of(colour);
    fn bumped_normal(normal: Vec3, across: Vec3, along: Vec3, rise: Vec2, direction: Vec3) =
        pattern::bumped(normal, [across, along], [rise.x, rise.y], direction);
    fn basis_across(normal: Vec3) = sampling::basis(normal)[0];
    fn basis_along(normal: Vec3) = sampling::basis(normal)[1];
    fn kept_on(direction: Vec3, face: Vec3) = surface::kept_on(direction, face);
    fn projection_weights(normal: Vec3, sharpness: Number) = pattern::projection_weights(normal, sharpness);
    fn projection(point: Vec3, normal: Vec3, axis: Number, size: Number) =
        pattern::projection(point, normal, axis, size);

    // light
    fn sky_colour(horizon: Vec3, top: Vec3, bottom: Vec3, y: Number) =
        // the sky itself does not depend on how much of it arrives
        sky::colour(&SkyColours { top, horizon, bottom, ambient: y }, y);
    fn fog_share(density: Number, falloff: Number, y: Number, rise: Number, t: Number) =
        air::share(density, falloff, y, rise, t);
    fn fog_light(fog: Vec3, sun: Vec3, radiance: Vec3, glow: Number, direction: Vec3) =
        air::scattered(fog, sun, radiance, glow, direction);
    fn sun_disc(sun: Vec3, radiance: Vec3, cosine: Number, direction: Vec3) =
        air::disc(sun, radiance, cosine, direction);
    fn towards_point(place: Vec3, point: Vec3) = light::towards_point(place, point);
    fn towards_sheet(place: Vec3, right: Vec3, up: Vec3, point: Vec3, at: Vec2) = {
        let aimed = lamp::sheet(place, right, up, point, at.array());
        (aimed.to, aimed.distance)
    };
    fn sheet_falloff(right: Vec3, up: Vec3, to: Vec3, distance: Number) = lamp::sheet_falloff(right, up, to, distance);
    fn towards_sphere(place: Vec3, radius: Number, point: Vec3, u: Vec2) = {
        let aimed = lamp::sphere(place, radius, point, u.array());
        (aimed.to, aimed.distance)
    };
    fn seen_sphere(place: Vec3, radius: Number, point: Vec3) = {
        lamp::sphere_falloff(radius, (place - point).length_squared().max(1e-24))
    };
    fn meet_sheet(place: Vec3, right: Vec3, up: Vec3, origin: Vec3, direction: Vec3) =
        lamp::meet_sheet(place, right, up, origin, direction);
    fn meet_sphere(place: Vec3, radius: Number, origin: Vec3, direction: Vec3) =
        lamp::meet_sphere(place, radius, origin, direction);
    fn lamp_highlight(normal: Vec3, to: Vec3, direction: Vec3, roughness: Number) =
        lamp::highlight(normal, to, direction, roughness);
    fn lamp_density(falloff: Number, area: Number) = lamp::density(falloff, area);
    fn balance(density: Number, other: Number) = lamp::balance(density, other);
    fn scatter_density(albedo: Vec3, finish: Vec4, normal: Vec3, direction: Vec3, to: Vec3) =
        lamp::likelihood(&material(albedo, albedo, finish), normal, direction, to);
    fn place_of_direction(direction: Vec3) = environment::place_of(direction);
    fn direction_of_place(place: Vec2) = environment::direction_of(place.array());
    fn turned_around(direction: Vec3, cosine: Number, sine: Number) = environment::turned(direction, cosine, sine);
    fn density_of_direction(density: Number, sine: Number) = environment::over_directions(density, sine);
    fn arriving_around(
        normal: Vec3, a: Vec3, b: Vec3, c: Vec3, d: Vec3, e: Vec3, f: Vec3, g: Vec3, h: Vec3, i: Vec3
    ) = environment::arriving(normal, [a, b, c, d, e, f, g, h, i]);
    fn surface_around@Physical(
        albedo: Vec3, finish: Vec4, normal: Vec3, direction: Vec3, open: Number, arriving: Vec3, seen: Vec3, followed: Number
    ) = {
        let what = material(albedo, albedo, finish);
        surface::around(Shading::Physical, &what, [normal, direction], open, [arriving, seen], followed)
    };
    fn surface_around@Matte(
        albedo: Vec3, finish: Vec4, normal: Vec3, direction: Vec3, open: Number, arriving: Vec3, seen: Vec3, followed: Number
    ) = {
        let what = material(albedo, albedo, finish);
        surface::around(Shading::Phong, &what, [normal, direction], open, [arriving, seen], followed)
    };
    fn light_response@Physical(to: Vec3, distance: Number, kind: Number, normal: Vec3, direction: Vec3, finish: Number) =
        response(Shading::Physical, (to, distance), kind, normal, direction, finish);
    fn light_response@Phong(to: Vec3, distance: Number, kind: Number, normal: Vec3, direction: Vec3, finish: Number) =
        response(Shading::Phong, (to, distance), kind, normal, direction, finish);
    fn light_response@Lambert(to: Vec3, distance: Number, kind: Number, normal: Vec3, direction: Vec3, finish: Number) =
        response(Shading::Lambert, (to, distance), kind, normal, direction, finish);
    fn light_response@LambertLegacy(
        to: Vec3, distance: Number, kind: Number, normal: Vec3, direction: Vec3, finish: Number
    ) = response(Shading::LambertLegacy, (to, distance), kind, normal, direction, finish);
    fn surface_colour@Physical(
        albedo: Vec3, emission: Vec3, finish: Vec4, diffuse: Vec3, gloss: Vec3, grazing: Vec3, open: Number, tint: Vec3, bent: Vec3,
        normal: Vec3, direction: Vec3, horizon: Vec3, top: Vec3, bottom: Vec3, ambient: Number, followed: Number
    ) = surface::colour(
        Shading::Physical,
        &SkyColours { top, horizon, bottom, ambient },
        &material(albedo, emission, finish),
        &Lighting { diffuse, gloss, grazing, open, tint, bent, normal, direction },
        followed,
    );
    fn surface_colour@Phong(
        albedo: Vec3, emission: Vec3, finish: Vec4, diffuse: Vec3, gloss: Vec3, grazing: Vec3, open: Number, tint: Vec3, bent: Vec3,
        normal: Vec3, direction: Vec3, horizon: Vec3, top: Vec3, bottom: Vec3, ambient: Number, followed: Number
    ) = surface::colour(
        Shading::Phong,
        &SkyColours { top, horizon, bottom, ambient },
        &material(albedo, emission, finish),
        &Lighting { diffuse, gloss, grazing, open, tint, bent, normal, direction },
        followed,
    );
    fn surface_colour@Lambert(
        albedo: Vec3, emission: Vec3, finish: Vec4, diffuse: Vec3, gloss: Vec3, grazing: Vec3, open: Number, tint: Vec3, bent: Vec3,
        normal: Vec3, direction: Vec3, horizon: Vec3, top: Vec3, bottom: Vec3, ambient: Number, followed: Number
    ) = surface::colour(
        Shading::Lambert,
        &SkyColours { top, horizon, bottom, ambient },
        &material(albedo, emission, finish),
        &Lighting { diffuse, gloss, grazing, open, tint, bent, normal, direction },
        followed,
    );
    fn mirror_reflectance(albedo: Vec3, finish: Vec4, cosine: Number) =
        surface::mirrored(&material(albedo, albedo, finish), cosine).all;
    fn followed_share(roughness: Number) = surface::followed_share(roughness);
    fn border(direction: Vec3, normal: Vec3, ior: Number) = {
        let border = surface::refraction(direction, normal, ior);
        (border.direction, border.reflected)
    };
    fn scatter_way(albedo: Vec3, finish: Vec4, normal: Vec3, direction: Vec3, ior: Number, choice: Vec3) = {
        let what = material(albedo, albedo, finish);
        let way = bsdf::scatter(&what, normal, direction, ior, albedo, choice.array());
        (way.direction, way.lobe + way.through * 4.0)
    };
    fn scatter_weight(
        albedo: Vec3, finish: Vec4, normal: Vec3, direction: Vec3, ior: Number, tint: Vec3, choice: Vec3
    ) = {
        let what = material(albedo, albedo, finish);
        bsdf::scatter(&what, normal, direction, ior, tint, choice.array()).weight
    };
    fn light_width(sharpness: Number) = light::width_of(sharpness);
    fn disc_power(cosine: Number) = light::disc_power(cosine);
    fn cone_around(axis: Vec3, cosine: Number, u: Vec2) = sampling::cone_direction(axis, cosine, u.x, u.y);
    fn transmittance(attenuation: Vec3, t: Number) = surface::transmittance(attenuation, t);

    // shadows
    fn soft_shadow(f: Number, t: Number, sharpness: Number) = shadow::soft(f, t, sharpness);
    fn closest_shadow(f: Number, z: Number, r: Number, t: Number, sharpness: Number) =
        shadow::soft_closest(f, z, r, t, sharpness);
    fn advected_entry(place: Vec3, to: Vec3, cells: Vec3) = advection::entry(place, to, cells);

    // occlusion
    fn visibility(sum: Number, scale: Number) = occlusion::visibility(sum, scale);
    fn exponential_visibility(sum: Number, scale: Number) = occlusion::exponential_visibility(sum, scale);
    fn skylight_way(normal: Vec3, bend: Number) = skylight::way(normal, bend);
    fn skylight_bent(normal: Vec3, way: Vec3) = skylight::bent(normal, way);
    fn skylight_share(place: Vec3, cells: Vec3) = skylight::share(place, cells);
    fn skylight_curved(f: Number, per: Number) = skylight::curved(f, per);
    fn skylight_light(sums: Vec3, scale: Number) = skylight::light(sums, scale);
    fn skylight_split(light: Vec3) = {
        let (open, tint) = skylight::split(light);
        (tint, open)
    };
    fn slant(normal: Vec3) = occlusion::slant(normal);
    fn obscurance(t: Number, tau: Number) = occlusion::obscurance(t, tau);
    fn cone_direction(k: Number) = occlusion::direction(k);
    fn turn_cone(normal: Vec3, direction: Vec3) = occlusion::turn(normal, direction);
    fn cone_clear(sine: Number) = occlusion::clear(sine);
    fn cone_left(clear: Number, apart: Number) = occlusion::left(clear, apart);
    fn cone_share(clear: Number, behind: Number, per_width: Number, weight: Number) =
        occlusion::share(clear, behind, per_width, weight);
    fn cone_open(sum: Number) = occlusion::open(sum);

    // tone curves
    fn srgb@Soft(linear: Vec3) = tone::view(Tone::Soft, linear).map(tone::encode);
    fn srgb@Filmic(linear: Vec3) = tone::view(Tone::Filmic, linear).map(tone::encode);
    fn srgb@Agx(linear: Vec3) = tone::view(Tone::Agx, linear).map(tone::encode);
    fn srgb@Standard(linear: Vec3) = tone::view(Tone::Standard, linear).map(tone::encode);
}

fn linear(v: Vec2<Expr<'_>>) -> Linear<Expr<'_>> {
    Linear {
        slope: v.x,
        constant: v.y,
    }
}

/// The sum of the coordinates' sizes, which rounding grows with.
fn size(p: Vec3<Expr<'_>>) -> Expr<'_> {
    p.x.abs() + p.y.abs() + p.z.abs()
}

fn place<'r>(
    point: Vec3<Expr<'r>>,
    normal: Vec3<Expr<'r>>,
    width: Expr<'r>,
    stretch: Vec3<Expr<'r>>,
) -> Place<Expr<'r>> {
    Place {
        point,
        normal,
        width,
        stretch,
        orbit: [point.x.lit(0.0); 4],
    }
}

/// A material from its numbers: specular, metallic, roughness, transmission.
fn material<'r>(
    albedo: Vec3<Expr<'r>>,
    emission: Vec3<Expr<'r>>,
    [specular, metallic, roughness, transmission]: [Expr<'r>; 4],
) -> LocalMaterial<Expr<'r>> {
    LocalMaterial {
        albedo,
        emission,
        specular,
        metallic,
        roughness,
        transmission,
        // the answer to lights has it already
        shininess: roughness,
    }
}

/// A light's share by the cosine law, that in the highlight, the part of it that the rise of Fresnel's law weighs, and what distance
/// leaves of it. `kind` is 0 where the light has no place.
fn response<'r>(
    shading: Shading,
    to: (Vec3<Expr<'r>>, Expr<'r>),
    kind: Expr<'r>,
    normal: Vec3<Expr<'r>>,
    direction: Vec3<Expr<'r>>,
    finish: Expr<'r>,
) -> [Expr<'r>; 4] {
    let [near, far] =
        [true, false].map(|point| light::response(shading, point, to, normal, direction, finish));
    let falloff = Expr::choose(kind.above(0.5), near.falloff, far.falloff);
    [near.diffuse, near.gloss, near.grazing, falloff]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;
    use zeroset_number::v3;
    use zeroset_testkit::wgsl::{Shader, Value};

    /// All formulas, of several of one name the last.
    fn shader() -> Shader {
        let texts: HashMap<&str, String> = FORMULAS.iter().map(|f| (f.name, f.print())).collect();
        Shader::new(&texts.into_values().collect::<String>())
    }

    #[test]
    fn every_formula_is_valid_and_has_the_name_that_stages_call() {
        let mut seen = HashSet::new();
        for formula in FORMULAS {
            assert!(seen.insert((formula.name, formula.variant)));
            assert_eq!(wgsl::identifier(formula.name), formula.name);
            Shader::new(&formula.print());
        }
        shader();
    }

    /// Numbers between -1 and 1.
    fn random(seed: u32) -> impl FnMut() -> f32 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 8_388_608.0 - 1.0
        }
    }

    #[test]
    fn shaders_compute_what_the_cpu_does() {
        let shader = shader();
        let flat = |v: Vec3<f32>| Value::Vector(v.array().to_vec());
        let same = |name: &str, arguments: Vec<Value>, right: &[f32]| {
            let found = shader.call_with(name, arguments.clone(), &[]);
            assert_eq!(found.len(), right.len(), "{name}");
            for (a, b) in found.iter().zip(right) {
                let near = (a - b).abs() <= 2e-5 * b.abs().max(1.0);
                assert!(
                    near,
                    "{name} of {arguments:?}: {found:?} instead of {right:?}"
                );
            }
        };
        for seed in 0..200 {
            let mut any = random(seed);
            let mut vector = || v3(any(), any(), any());
            let (p, n, d) = (vector() * 3.0, vector().normalize(), vector().normalize());
            let (a, b, c) = (vector(), vector(), vector().normalize());
            let stretch = vector() * 0.3;
            let [x, y, z] = vector().array().map(f32::abs);
            let place = Place {
                stretch,
                ..Place::new(p, n, d, 0.3 * z)
            };
            let (size, few) = (0.1 + x, 1.0 + (y * 5.0).floor());
            let at = [flat(p), flat(n), Value::Float(0.3 * z), flat(stretch)];
            let with = |more: &[Value]| [&at[..], more].concat();
            same(
                "pattern_noise",
                with(&[Value::Float(size), Value::Float(few)]),
                &[pattern::noise(&place, size, few)],
            );
            same(
                "pattern_stripes",
                with(&[flat(c), Value::Float(size)]),
                &[pattern::stripes(&place, c, size)],
            );
            same(
                "mapped_normal",
                vec![flat(n), flat(a), flat(b), flat(c)],
                &pattern::mapped_normal(n, [a, b, c]).array(),
            );
            let across = sampling::basis(n);
            same(
                "bumped_normal",
                vec![
                    flat(n),
                    flat(across[0]),
                    flat(across[1]),
                    Value::Vector(vec![x, y]),
                    flat(d),
                ],
                &pattern::bumped(n, across, [x, y], d).array(),
            );
            same(
                "leave_box",
                vec![
                    flat(a - v3(1.0, 1.0, 1.0)),
                    flat(b + v3(1.0, 1.0, 1.0)),
                    flat(p),
                    flat(d),
                    Value::Float(0.05 * x),
                    Value::Float(y),
                ],
                &[view::leave(
                    a - v3(1.0, 1.0, 1.0),
                    b + v3(1.0, 1.0, 1.0),
                    p,
                    d,
                    0.05 * x,
                    y,
                )
                .min(f32::MAX)],
            );
            let (closest, numbers) = (
                shadow::soft_closest(x, y, z, 2.0 + x, 8.0),
                [x, y, z, 2.0 + x, 8.0],
            );
            same(
                "closest_shadow",
                numbers.map(Value::Float).to_vec(),
                &[closest],
            );
            let k = (seed % 11) as f32;
            same(
                "cone_direction",
                vec![Value::Float(k)],
                &occlusion::direction(k).array(),
            );
            let (to, distance) = light::towards_point(a * 4.0, p);
            same(
                "towards_point",
                vec![flat(a * 4.0), flat(p)],
                &[to.x, to.y, to.z, distance],
            );
            same("srgb", vec![flat(a)], &a.map(tone::encode).array());
        }
    }
}
