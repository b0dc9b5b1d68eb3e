//! The algorithms of the CPU renderer, one ray at a time, in plain code: the reference that the stream is tested against and the
//! baseline of its benchmark.
//!
//! It shares the formulas of cameras, filters, patterns and light with the stream (`zeroset_shade`), and the constants of what
//! marches. All that the stream does in its own way is written anew here: marching (without cones), hits, normals, occlusion,
//! shadows, samples and their filter.

mod advection;
mod ao;
pub mod dense;
mod light;
mod march;
mod probe;
mod skylight;
mod texture;

pub use probe::{Compiled, Formula, Mark, Probe};

use glam::Vec3;
use light::Surface;
use rayon::prelude::*;
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_field::program::Program;
use zeroset_number::v3;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::light::Sky;
use zeroset_scene::material::Material;
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, Filter, Integrator, Settings, Shading};
use zeroset_shade::air::{self, Air};
use zeroset_shade::environment::EnvironmentMap;
use zeroset_shade::march::MARKS_BEHIND;
use zeroset_shade::pattern::Place;
use zeroset_shade::sampling::{LENS, decided, hit_seed, point, radius, scramble, weight};
use zeroset_shade::skin::has_skins;
use zeroset_shade::sky::SkyColours;
use zeroset_shade::surface::{
    FAINTEST, Lighting, LocalMaterial, around, colour, followed_share, mirrored,
};
use zeroset_shade::view::{Region, View};

fn glam(v: zeroset_number::Vec3<f32>) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}

fn field(v: Vec3) -> zeroset_number::Vec3<f32> {
    v3(v.x, v.y, v.z)
}

/// A ray, see `WideRay` of the CPU renderer.
#[derive(Clone, Copy, Debug)]
struct Ray {
    o: Vec3,
    d: Vec3,
    narrow: f32,
    travelled: f32,
}

/// How a ray came to be.
#[derive(Clone, Copy, Debug)]
struct Way {
    /// The share of its light that comes to the eye.
    weight: Vec3,
    reflections: u32,
    refractions: u32,
    /// The clear body that it is in.
    medium: Option<f32>,
    /// Where its random numbers come from: the pixel, and which of its samples.
    pixel: [u32; 2],
    index: u32,
}

impl Default for Way {
    fn default() -> Way {
        Way {
            weight: Vec3::ONE,
            reflections: 0,
            refractions: 0,
            medium: None,
            pixel: [0; 2],
            index: 0,
        }
    }
}

/// A ray that goes on, and the share of its light that comes to where it begins.
struct Onward {
    ray: Ray,
    share: Vec3,
    way: Way,
}

/// What a ray found.
#[derive(Clone, Copy, Debug)]
struct Sample {
    colour: Vec3,
    hit: Option<Hit>,
    steps: u32,
}

/// What a ray hit.
#[derive(Clone, Copy, Debug)]
struct Hit {
    t: f32,
    residual: f32,
    normal: Vec3,
    albedo: Vec3,
    open: f32,
    shadow: f32,
    object: f32,
}

/// What is known of a field apart from its values.
#[derive(Clone, Copy, Debug)]
pub struct Quality {
    /// A box that holds the solid.
    pub bounds: Aabb,
    /// Whether what is under the footprint of a pixel is a hit.
    pub fractal: bool,
    /// Whether values can be shown as distances.
    pub close: bool,
    /// Whether there are skins that the scene's methods would see.
    pub skins: bool,
    /// Evaluations that a ray may take.
    pub max_steps: u32,
}

impl Quality {
    /// That of a scene's program.
    pub fn of(program: &Program, scene: &Scene) -> Quality {
        Quality {
            bounds: program.bounds(),
            fractal: program.is_fractal(),
            close: program.is_close(),
            skins: has_skins(scene, program),
            max_steps: program.patient(scene.settings().max_steps),
        }
    }

    /// That of a distance in this box.
    pub fn distance(bounds: Aabb, max_steps: u32) -> Quality {
        Quality {
            bounds,
            fractal: false,
            close: true,
            skins: false,
            max_steps,
        }
    }
}

/// Renders a scene on the threads of the pool that it is called in. `probe` makes an evaluator of the field.
pub fn render<P: Probe>(scene: &Scene, quality: &Quality, probe: impl Fn() -> P + Sync) -> Film {
    let settings = scene.settings();
    let [width, height] = settings.size;
    let sky = skylight::Volume::of(scene, quality, &mut probe());
    let lit = advection::Volume::of(scene, quality, &mut probe());
    let plain = Plain {
        scene,
        settings,
        view: View::new(scene.camera(), settings.size, settings.footprint),
        region: Region::new(&quality.bounds),
        quality: *quality,
        fallback: Material::default(),
        around: EnvironmentMap::renewed(None, scene),
        sky,
        lit,
    };
    let samples = plain.samples();
    let rows: Vec<Vec<Sample>> = (0..height)
        .into_par_iter()
        .map_init(&probe, |probe, y| {
            let pixels = (0..width).flat_map(|x| (0..samples).map(move |i| (x, i)));
            pixels.map(|(x, i)| plain.sample(probe, x, y, i)).collect()
        })
        .collect();
    plain.film(&rows, samples)
}

struct Plain<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    view: View,
    region: Region,
    quality: Quality,
    fallback: Material,
    /// Light from all around, by an image.
    around: Option<Arc<EnvironmentMap>>,
    /// The volume that skylight is read from.
    sky: Option<skylight::Volume>,
    /// The volume that lights are advected through.
    lit: Option<advection::Volume>,
}

/// Rays along a side of a pixel of which the covered parts are wanted: that many squared are close to the area.
const COVERING: u32 = 8;

impl Plain<'_> {
    /// Rays a pixel.
    fn samples(&self) -> u32 {
        match self.settings.antialias {
            Antialias::Coverage { .. } => COVERING * COVERING,
            Antialias::None | Antialias::Supersample { .. } => self.settings.antialias.samples(),
        }
    }

    /// See [`View::narrow`].
    fn narrow(&self, o: Vec3, d: Vec3) -> f32 {
        self.view
            .narrow(field(if self.view.pinhole { d } else { o }))
    }

    /// What is shown as the distance to the surface.
    fn distance(&self, probe: &mut impl Probe, p: Vec3) -> f32 {
        let f = probe.value(p);
        if self.quality.close {
            f
        } else {
            f / probe.gradient(p).length().max(1e-12)
        }
    }

    /// Where sample number `index` of a pixel is.
    fn jitter(&self, x: u32, y: u32, index: u32) -> [f32; 2] {
        match self.settings.antialias {
            Antialias::None => [0.5; 2],
            // what the areas of parts are found to be: a grid over the pixel, turned a little
            Antialias::Coverage { .. } => {
                let (column, row) = (index % COVERING, index / COVERING);
                let at = |n: u32, by: u32| {
                    let within = (by as f32 + 0.5) / COVERING as f32;
                    (n as f32 + within) / COVERING as f32
                };
                [at(column, row), at(row, column)]
            }
            Antialias::Supersample { .. } => point(index, scramble(x, y, self.settings.seed)),
        }
    }

    fn sample(&self, probe: &mut impl Probe, x: u32, y: u32, index: u32) -> Sample {
        let [u, v] = self.jitter(x, y, index);
        let ray = self.view.ray(x as f32 + u, y as f32 + v);
        let (o, d) = self.view.split(ray);
        let (o, d) = (glam(o), glam(d));
        let narrow = self.narrow(o, d);
        let ray = match self.through_lens(o, d, [x, y], index) {
            Some((o, d)) => Ray {
                o,
                d,
                narrow: if self.view.pinhole {
                    self.narrow(o, d)
                } else {
                    narrow
                },
                travelled: 0.0,
            },
            None => Ray {
                o,
                d,
                narrow,
                travelled: 0.0,
            },
        };
        let key = scramble(x, y, hit_seed(self.settings.seed, index));
        let way = Way {
            pixel: [x, y],
            index,
            ..Way::default()
        };
        self.follow(probe, &ray, key, &way)
    }

    /// The ray of a sample from its place on the lens, where that has an extent: to where the ray through its middle, from `o` along `d`,
    /// comes to the plane that is in focus.
    fn through_lens(&self, o: Vec3, d: Vec3, [x, y]: [u32; 2], index: u32) -> Option<(Vec3, Vec3)> {
        let camera = self.scene.camera();
        if camera.aperture == 0.0 || self.settings.antialias.filter().is_none() {
            return None;
        }
        let key = scramble(x, y, hit_seed(self.settings.seed, 0));
        let [a, b] = decided(index, key, LENS).map(|u| 2.0 * u - 1.0);
        // the square is a square of rings, and each becomes a circle
        let ring = a.abs().max(b.abs());
        let (sin, cos) = if ring == 0.0 {
            (0.0, 1.0)
        } else if a.abs() > b.abs() {
            let (sin, cos) = (std::f32::consts::FRAC_PI_4 * b / a).sin_cos();
            (sin * a.signum(), cos * a.signum())
        } else {
            let (sin, cos) = (std::f32::consts::FRAC_PI_4 * a / b).sin_cos();
            (cos * b.signum(), sin * b.signum())
        };
        let aside = camera.axes.x_axis * cos + camera.axes.y_axis * sin;
        let from = o + aside * (camera.aperture * ring);
        let sharp = o + d * (camera.focus / -d.dot(camera.axes.z_axis));
        Some((from, (sharp - from).normalize()))
    }

    /// What a ray sees.
    fn follow(&self, probe: &mut impl Probe, ray: &Ray, key: [u32; 2], way: &Way) -> Sample {
        let Ray { o, d, .. } = *ray;
        probe.enter(way.medium.is_some());
        let found = self.march(probe, ray);
        let Some(end) = found.hit else {
            let looks = way.reflections + way.refractions == 0 && way.medium.is_none();
            let sky = self.haze(ray, air::ENDLESS, self.sky(d, looks));
            return Sample {
                colour: sky + self.glow(probe, ray, way, f32::INFINITY),
                hit: None,
                steps: found.steps,
            };
        };
        let near = |t: f32| self.view.near(t + ray.travelled, ray.narrow);
        let (mut t, side) = (end.t, end.side);
        for _ in 0..self.settings.discontinuity_reduction {
            let wanted = near(t);
            let by = side * probe.value(o + d * t) - wanted;
            t = (t + by.clamp(-2.0 * wanted, 2.0 * wanted)).max(0.0);
        }
        let p = o + d * t;
        let offset = 2.0 * end.f.abs().max(near(t));
        let normal = self.normal(probe, p, ray, t, side);
        let residual = probe.value(p).abs();
        let travelled = t + ray.travelled;
        let mark = probe.marks(p - normal * (MARKS_BEHIND * self.view.rounding.at(travelled)));
        probe.enter(false);
        let mut surface = Surface {
            p,
            normal,
            shown: normal,
            side,
            offset,
            d,
        };
        // inside a solid there is no sky: it is shown as if there were no solid
        let (open, bent, tint) = if side < 0.0 {
            (1.0, normal, Vec3::ONE)
        } else {
            self.occlusion(probe, &surface, mark.object, key)
        };
        let pixel = self.view.width(travelled, ray.narrow) / (self.samples() as f32).sqrt();
        let mut what = {
            let place = Place::new(field(p), field(normal), field(d), pixel);
            let place = place.with_orbit(mark.orbit);
            let (what, shown) = self.local_material(probe, &mark, &place, d);
            surface.shown = shown;
            what
        };
        let bounces = match (self.settings.shading, self.settings.integrator) {
            (
                Shading::Physical,
                Integrator::Whitted {
                    reflections,
                    refractions,
                },
            ) => Some([reflections, refractions]),
            _ => {
                what.transmission = 0.0;
                None
            }
        };
        let finish = match self.settings.shading {
            Shading::Phong => what.shininess,
            _ => what.roughness,
        };
        let bent_rays =
            bounces.map(|limits| self.onward(probe, ray, &surface, t, &what, &mark, way, limits));
        let (onward, followed) = bent_rays.unwrap_or_default();
        let light = self.light(probe, &surface, finish, way, followed);
        let shone = if side < 0.0 {
            1.0 - what.transmission
        } else {
            1.0
        };
        let lighting = Lighting {
            diffuse: field(light.diffuse),
            gloss: field(light.gloss * shone),
            grazing: field(light.grazing * shone),
            open,
            tint: field(tint),
            bent: field(bent),
            normal: field(surface.shown),
            direction: field(d),
        };
        let black = Sky {
            top: Vec3::ZERO,
            horizon: Vec3::ZERO,
            bottom: Vec3::ZERO,
            ..*self.scene.sky()
        };
        let sky_colours = SkyColours::of(match self.around {
            Some(_) => &black,
            None => self.scene.sky(),
        });
        let mut c = glam(colour(
            self.settings.shading,
            &sky_colours,
            &what,
            &lighting,
            followed,
        ));
        if let Some(map) = &self.around {
            let mirror = d - surface.shown * (2.0 * surface.shown.dot(d));
            let seen = map.reflected(field(mirror), what.roughness);
            let arriving = map.arriving(field(bent)) * self.scene.sky().ambient;
            let arriving = field(glam(arriving) * tint);
            c += glam(around(
                self.settings.shading,
                &what,
                [field(surface.shown), field(d)],
                open,
                [arriving, seen],
                followed,
            ));
        }
        for next in onward {
            let seen = self.follow(probe, &next.ray, key, &next.way);
            c += next.share * seen.colour;
        }
        if side > 0.0 {
            // the rays that go on are part of what fog is before
            c = self.haze(ray, t, c);
        } else if way.medium.is_some() || what.transmission > 0.0 {
            let body = self.material(probe, way.medium.unwrap_or(mark.first));
            c *= (-body.attenuation * t).exp();
        }
        c += self.glow(probe, ray, way, t);
        let hit = Hit {
            t,
            residual,
            normal,
            albedo: glam(what.albedo),
            open,
            shadow: light.shadow,
            object: mark.object + 1.0,
        };
        Sample {
            colour: c,
            hit: Some(hit),
            steps: found.steps,
        }
    }

    /// The sky along a ray, with the disc of the sun where it is looked at.
    fn sky(&self, d: Vec3, looks: bool) -> Vec3 {
        let (sky, lights) = (self.scene.sky(), self.scene.lights());
        let air = Air::of(sky, lights);
        let mut seen = match &self.around {
            Some(map) => glam(map.radiance(field(d))),
            None => sky.colour(d),
        };
        if looks && air.cosine <= 1.0 {
            seen += glam(air::disc(air.sun, air.radiance, air.cosine, field(d)));
        }
        seen
    }

    /// A colour behind the air along a ray.
    fn haze(&self, ray: &Ray, t: f32, c: Vec3) -> Vec3 {
        let air = Air::of(self.scene.sky(), self.scene.lights());
        if !air.is_foggy() {
            return c;
        }
        let share = air::share(air.density, air.falloff, ray.o.y, ray.d.y, t);
        let fog = air::scattered(air.fog, air.sun, air.radiance, air.glow, field(ray.d));
        c.lerp(glam(fog), share)
    }

    /// The rays that go on from a surface, and the share of its reflection that they follow.
    #[allow(clippy::too_many_arguments, reason = "all that is known of a hit")]
    fn onward(
        &self,
        probe: &mut impl Probe,
        ray: &Ray,
        at: &Surface,
        t: f32,
        what: &LocalMaterial<f32>,
        mark: &Mark,
        way: &Way,
        limits: [u32; 2],
    ) -> (Vec<Onward>, f32) {
        let inside = at.side < 0.0;
        let (d, n) = (at.d, at.shown);
        let clear = what.transmission * (1.0 - what.metallic);
        let smooth = followed_share(what.roughness);
        let mut onward = Vec::new();
        if clear <= 0.0 && (inside || smooth <= 0.0) {
            return (onward, 0.0);
        }
        let medium = way.medium.unwrap_or(mark.first);
        let body = self.material(probe, medium);
        let lost = if inside {
            (-body.attenuation * t).exp()
        } else {
            // what is left of white where fog is black
            let air = Air::of(self.scene.sky(), self.scene.lights());
            Vec3::ONE - air::share(air.density, air.falloff, ray.o.y, ray.d.y, t)
        };
        let mut send = |direction: Vec3, side: f32, share: Vec3, next: Way| {
            let weight = way.weight * lost * share;
            let bright = weight.max_element() >= FAINTEST;
            if bright {
                let ray = Ray {
                    o: at.p + at.normal * (side * at.offset),
                    d: texture::on_side(direction, at.normal * side),
                    narrow: ray.narrow,
                    travelled: ray.travelled + t,
                };
                let way = Way { weight, ..next };
                onward.push(Onward { ray, share, way });
            }
            bright
        };
        let cosine = (-n.dot(d)).clamp(0.0, 1.0);
        let mut reflected = match inside {
            true => Vec3::ZERO,
            false => glam(mirrored(what, cosine).all) * (smooth * (1.0 - clear)),
        };
        if clear > 0.0 {
            // Snell's law and Fresnel's equations, as textbooks have them
            let (n1, n2) = if inside {
                (body.ior, 1.0)
            } else {
                (1.0, body.ior)
            };
            let sine = (1.0 - cosine * cosine).sqrt() * n1 / n2;
            let passes = sine < 1.0;
            let inner = (1.0 - sine * sine).max(0.0).sqrt();
            let across = (n1 * cosine - n2 * inner) / (n1 * cosine + n2 * inner);
            let along = (n1 * inner - n2 * cosine) / (n1 * inner + n2 * cosine);
            let back = match passes {
                true => 0.5 * (across * across + along * along),
                false => 1.0,
            };
            reflected += Vec3::splat(clear * back);
            let tint = if inside { Vec3::ONE } else { glam(what.albedo) };
            if passes && way.refractions < limits[1] {
                let tangent = (d + n * cosine).normalize_or_zero();
                let direction = (tangent * sine - n * inner).normalize();
                let next = Way {
                    refractions: way.refractions + 1,
                    medium: (!inside).then_some(mark.first),
                    ..*way
                };
                send(direction, -1.0, tint * (clear * (1.0 - back)), next);
            }
        }
        let next = Way {
            reflections: way.reflections + u32::from(!inside),
            refractions: way.refractions + u32::from(inside),
            medium: inside.then_some(medium),
            ..*way
        };
        let allowed = next.reflections <= limits[0] && next.refractions <= limits[1];
        let mirror = d + n * (2.0 * cosine);
        if allowed && send(mirror, 1.0, reflected, next) {
            (onward, smooth + (1.0 - smooth) * clear)
        } else {
            (onward, clear)
        }
    }

    fn material(&self, probe: &mut impl Probe, number: f32) -> &Material {
        let materials = self.scene.materials();
        let at = match probe.placed(number, materials.len(), Vec3::ZERO) {
            Some((material, ..)) => material,
            None if number >= 0.0 => number as usize,
            None => usize::MAX,
        };
        materials.get(at).unwrap_or(&self.fallback)
    }

    /// What the surface is made of, and its normal with the heights of bumps.
    fn local_material(
        &self,
        probe: &mut impl Probe,
        mark: &Mark,
        at: &Place<f32>,
        d: Vec3,
    ) -> (LocalMaterial<f32>, Vec3) {
        let mut of = |number: f32, weight: f32| {
            let placed = probe.placed(number, self.scene.materials().len(), glam(at.point));
            let rows = placed.map_or([Vec3::X, Vec3::Y, Vec3::Z], |(_, _, rows)| rows);
            let here = placed.map_or(*at, |(_, point, _)| texture::seen_from(at, point, rows));
            let m = self.material(probe, number);
            let number = |map: &Option<_>, own: f32| {
                map.as_ref().map_or(own, |map| texture::number(map, &here))
            };
            let what = LocalMaterial {
                albedo: field(texture::shown(&m.pattern, &here) * weight),
                emission: field(m.emission * weight),
                specular: m.specular * weight,
                metallic: number(&m.metallic_map, m.metallic) * weight,
                roughness: number(&m.roughness_map, m.roughness) * weight,
                transmission: m.transmission * weight,
                shininess: m.shininess * weight,
            };
            let normal = match &m.bump {
                Some(bump) => texture::bumped(bump, at, &here, rows, d),
                None => glam(at.normal),
            };
            (what, normal * weight)
        };
        let (a, normal) = of(mark.first, 1.0 - mark.share);
        if mark.share <= 0.0 {
            return (a, normal);
        }
        let (b, other) = of(mark.second, mark.share);
        let both = LocalMaterial {
            albedo: a.albedo + b.albedo,
            emission: a.emission + b.emission,
            specular: a.specular + b.specular,
            metallic: a.metallic + b.metallic,
            roughness: a.roughness + b.roughness,
            transmission: a.transmission + b.transmission,
            shininess: a.shininess + b.shininess,
        };
        (both, (normal + other).normalize_or_zero())
    }

    /// Filters the samples, row by row, pixel by pixel.
    fn film(&self, rows: &[Vec<Sample>], samples: u32) -> Film {
        let [width, height] = self.settings.size;
        let mut film = Film::new(width, height);
        let filter = self.settings.antialias.filter().unwrap_or(Filter::Box);
        let reach = radius(filter) as i32;
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let at = (y * width + x) as usize;
            let (mut sum, mut cover, mut weights) = (Vec3::ZERO, 0.0, 0.0);
            for (dy, dx) in (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dy, dx)))
            {
                let (sx, sy) = (x as i32 + dx, y as i32 + dy);
                if sx < 0 || sy < 0 || sx >= width as i32 || sy >= height as i32 {
                    continue;
                }
                for i in 0..samples {
                    let [u, v] = self.jitter(sx as u32, sy as u32, i);
                    let sample = &rows[sy as usize][(sx as u32 * samples + i) as usize];
                    let w =
                        weight(filter, u - 0.5 + dx as f32) * weight(filter, v - 0.5 + dy as f32);
                    sum += sample.colour * w;
                    cover += if sample.hit.is_some() { w } else { 0.0 };
                    weights += w;
                }
            }
            let own = &rows[y as usize][(x * samples) as usize..][..samples as usize];
            let colour = (sum / weights.max(1e-6)).max(Vec3::ZERO);
            write(
                &mut film,
                at,
                colour,
                (cover / weights.max(1e-6)).clamp(0.0, 1.0),
                own,
            );
        }
        film
    }
}

/// Writes a pixel of all planes.
fn write(film: &mut Film, at: usize, colour: Vec3, coverage: f32, samples: &[Sample]) {
    let hits: Vec<&Hit> = samples.iter().filter_map(|s| s.hit.as_ref()).collect();
    let nearest = hits.iter().copied().min_by(|a, b| a.t.total_cmp(&b.t));
    let mean = |f: fn(&Hit) -> f32| {
        if hits.is_empty() {
            1.0
        } else {
            hits.iter().map(|h| f(h)).sum::<f32>() / hits.len() as f32
        }
    };
    let normal: Vec3 = hits.iter().map(|h| h.normal).sum();
    let albedo: Vec3 = hits.iter().map(|h| h.albedo).sum();
    let steps = samples.iter().map(|s| s.steps as f32).sum::<f32>() / samples.len() as f32;
    let mut put = |plane: Plane, values: &[f32]| {
        film.plane_mut(plane)[at * values.len()..][..values.len()].copy_from_slice(values);
    };
    put(Plane::Colour, &colour.to_array());
    put(Plane::Coverage, &[coverage]);
    put(Plane::Depth, &[nearest.map_or(f32::INFINITY, |h| h.t)]);
    put(Plane::Normal, &normal.normalize_or_zero().to_array());
    put(
        Plane::Albedo,
        &(albedo / hits.len().max(1) as f32).to_array(),
    );
    put(Plane::Occlusion, &[mean(|h| h.open)]);
    put(Plane::Shadow, &[mean(|h| h.shadow)]);
    put(Plane::Steps, &[steps]);
    put(Plane::Residual, &[nearest.map_or(0.0, |h| h.residual)]);
    put(Plane::Object, &[nearest.map_or(0.0, |h| h.object)]);
}
