//! Lamps: lights with an extent, that surfaces see parts of and rays may meet.
//!
//! A lamp shines from its front (a sphere from all of itself) and is no body: rays go on through it. A way of light may be found from both
//! ends, by a place chosen on the lamp or by a ray that a surface scatters there. Each counts as much as it was likely to find it (the
//! balance heuristic of Veach and Guibas 1995).

use crate::microfacet::{alpha, distribution};
use crate::parameters;
use crate::surface::{LocalMaterial, mirrored};
use crate::{bsdf, light::luminance_of, sampling::basis, view::on_disc};
use zeroset_number::{Real, Vec3};
use zeroset_scene::light::{Light, Source};

/// What surfaces are smoother than is as likely to reflect a direction as this (see [`alpha`]).
const SMOOTHEST: f32 = 1e-4;

/// The shape of a lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// All within -1 to 1 of two half sides at right angles.
    Rectangle,
    /// All within 1 of two half axes at right angles.
    Disc,
    /// All within a radius.
    Sphere,
}

/// A lamp.
#[derive(Clone, Copy, Debug)]
pub struct Lamp<C> {
    /// Its shape.
    pub shape: Shape,
    /// Its middle.
    pub place: Vec3<C>,
    /// From there to the right edge.
    pub right: Vec3<C>,
    /// From there to the upper edge; it shines to the side of `right x up`.
    pub up: Vec3<C>,
    /// Radius of a sphere.
    pub radius: C,
    /// What it shows to one side, scene units squared: of a sphere its disc.
    pub area: C,
    /// What a white surface shows that faces it at a distance of 1, where the lamp is small.
    pub strength: Vec3<C>,
    /// Whether rays meet it.
    pub visible: bool,
}

impl Lamp<f32> {
    /// That of a light which has an extent.
    pub fn of(light: &Light) -> Option<Lamp<f32>> {
        let zero = glam::Vec3::ZERO;
        let (shape, place, right, up, radius, visible) = match light.source {
            Source::Directional { .. } | Source::Point { .. } => return None,
            Source::Rectangle {
                position,
                right,
                up,
                visible,
            } => (Shape::Rectangle, position, right, up, 0.0, visible),
            Source::Disc {
                position,
                direction,
                radius,
                visible,
            } => {
                let [a, b] = basis(parameters(direction)).map(|v| glam::Vec3::from(v.array()));
                (
                    Shape::Disc,
                    position,
                    a * radius,
                    b * radius,
                    radius,
                    visible,
                )
            }
            Source::Sphere {
                position,
                radius,
                visible,
            } => (Shape::Sphere, position, zero, zero, radius, visible),
        };
        let area = match shape {
            Shape::Rectangle => 4.0 * right.cross(up).length(),
            Shape::Disc | Shape::Sphere => std::f32::consts::PI * radius * radius,
        };
        Some(Lamp {
            shape,
            place: parameters(place),
            right: parameters(right),
            up: parameters(up),
            radius,
            area,
            strength: parameters(light.radiance),
            visible,
        })
    }

    /// The light of a ray that meets it.
    pub fn radiance(&self) -> Vec3<f32> {
        self.strength * (std::f32::consts::PI / self.area)
    }

    /// Chooses a place on it, as it is seen from `p`, from a point of the unit square.
    pub fn choose(&self, p: Vec3<f32>, u: [f32; 2]) -> Aimed<f32> {
        match self.shape {
            Shape::Rectangle => sheet(self.place, self.right, self.up, p, on_square(u)),
            Shape::Disc => sheet(self.place, self.right, self.up, p, on_disc(u)),
            Shape::Sphere => sphere(self.place, self.radius, p, u),
        }
    }

    /// How a ray meets it, if it does: at which distance, and how much distance leaves.
    pub fn meet(&self, o: Vec3<f32>, d: Vec3<f32>) -> Option<[f32; 2]> {
        let met = match self.shape {
            Shape::Rectangle | Shape::Disc => {
                let [t, x, y] = meet_sheet(self.place, self.right, self.up, o, d);
                let within = match self.shape {
                    Shape::Rectangle => x.abs().max(y.abs()) <= 1.0,
                    Shape::Disc | Shape::Sphere => x * x + y * y <= 1.0,
                };
                let t = if within { t } else { -1.0 };
                [t, sheet_falloff(self.right, self.up, d, t)]
            }
            Shape::Sphere => meet_sphere(self.place, self.radius, o, d),
        };
        (met[0] > 0.0 && met[1] > 0.0).then_some(met)
    }
}

/// A place on a lamp, as a surface sees it.
#[derive(Clone, Copy, Debug)]
pub struct Aimed<R> {
    /// The direction, of length 1.
    pub to: Vec3<R>,
    /// How far it is.
    pub distance: R,
    /// What distance leaves of the lamp's strength, if all of it were like this place; 0 behind the lamp. One over this and the area is
    /// the density, over directions, with which the place is chosen.
    pub falloff: R,
}

/// A point of the square from -1 to 1, from one of the unit square.
#[inline(always)]
pub fn on_square<R: Real>([u, v]: [R; 2]) -> [R; 2] {
    [u * 2.0 - 1.0, v * 2.0 - 1.0]
}

/// The place `(x, y)` of a rectangle or a disc.
#[inline(always)]
pub fn sheet<R: Real>(
    place: Vec3<R::Scalar>,
    right: Vec3<R::Scalar>,
    up: Vec3<R::Scalar>,
    p: Vec3<R>,
    [x, y]: [R; 2],
) -> Aimed<R> {
    let at = p.like(right) * x + p.like(up) * y + p.like(place);
    let way = at - p;
    let distance = way.length().max(1e-18);
    let to = way / distance;
    Aimed {
        to,
        distance,
        falloff: sheet_falloff(right, up, to, distance),
    }
}

/// What the distance leaves of a rectangle or a disc along `to`: the cosine at the lamp over the square.
#[inline(always)]
pub fn sheet_falloff<R: Real>(
    right: Vec3<R::Scalar>,
    up: Vec3<R::Scalar>,
    to: Vec3<R>,
    distance: R,
) -> R {
    let front = to.like(right).cross(to.like(up)).normalize();
    (-front.dot(to)).max(0.0) / distance.sq().max(1e-12)
}

/// Twice one minus the cosine of the angle under which half a sphere is seen, over the square of its radius; 0 from within.
#[inline(always)]
pub fn sphere_falloff<R: Real>(radius: R, square: R) -> R {
    // one minus a cosine near 1 would lose its digits
    let sine2 = radius.sq() / square;
    let cosine = sine2.one_minus().max(0.0).sqrt();
    let falloff = (square * (cosine + 1.0)).recip() * 2.0;
    R::choose(sine2.below(1.0), falloff, radius.lit(0.0))
}

/// A place of a sphere, evenly over the directions in which it is seen (Shirley, Wang and Zimmerman 1996, 3.2).
#[inline(always)]
pub fn sphere<R: Real>(
    place: Vec3<R::Scalar>,
    radius: R::Scalar,
    p: Vec3<R>,
    [u, v]: [R; 2],
) -> Aimed<R> {
    let way = p.like(place) - p;
    let square = way.length_squared().max(1e-24);
    let (far, radius) = (square.sqrt(), u.like(radius));
    let axis = way / far;
    let falloff = sphere_falloff(radius, square);
    // one minus the cosine of the angle to the middle
    let less = falloff * radius.sq() * 0.5 * u;
    let across2 = less * (-less + 2.0);
    let across = across2.max(0.0).sqrt();
    let (sin, cos) = (v * std::f32::consts::TAU).sin_cos();
    let [a, b] = basis(axis);
    let along = less.one_minus();
    let to = a * (across * cos) + b * (across * sin) + axis * along;
    let within = (radius.sq() - square * across2).max(0.0).sqrt();
    Aimed {
        to,
        distance: (far * along - within).max(0.0),
        falloff,
    }
}

/// Where a ray meets the plane of a rectangle or a disc from its front: the distance, which is below 0 where it does not, and the place in
/// half sides.
#[inline(always)]
pub fn meet_sheet<R: Real>(
    place: Vec3<R::Scalar>,
    right: Vec3<R::Scalar>,
    up: Vec3<R::Scalar>,
    o: Vec3<R>,
    d: Vec3<R>,
) -> [R; 3] {
    let (right, up) = (o.like(right), o.like(up));
    let front = right.cross(up);
    let way = o.like(place) - o;
    let fall = front.dot(d);
    let faces = fall.below(0.0);
    let t = front.dot(way) / R::choose(faces, fall, fall.lit(1.0));
    let at = d * t - way;
    let x = at.dot(right) / right.length_squared();
    let y = at.dot(up) / up.length_squared();
    [R::choose(faces, t, t.lit(-1.0)), x, y]
}

/// Where a ray from outside meets a sphere: the distance, which is below 0 where it does not, and what distance leaves.
#[inline(always)]
pub fn meet_sphere<R: Real>(
    place: Vec3<R::Scalar>,
    radius: R::Scalar,
    o: Vec3<R>,
    d: Vec3<R>,
) -> [R; 2] {
    let way = o.like(place) - o;
    let along = way.dot(d);
    let aside = way - d * along;
    let radius = along.like(radius);
    let within = radius.sq() - aside.length_squared();
    let t = along - within.max(0.0).sqrt();
    let met = within.above(0.0);
    [
        R::choose(met, t, t.lit(-1.0)),
        sphere_falloff(radius, way.length_squared().max(1e-24)),
    ]
}

/// How likely a surface of normal `n`, seen along `d`, scatters to `to`: by its matte body, and by its mirrors, over directions. See
/// [`bsdf::scatter`].
#[inline(always)]
pub fn likelihood<R: Real>(what: &LocalMaterial<R>, n: Vec3<R>, d: Vec3<R>, to: Vec3<R>) -> [R; 2] {
    let cosine = (-n.dot(d)).clamp(1e-4, 1.0);
    let shares = bsdf::shares(what, &mirrored(what, cosine));
    let down = n.dot(to).max(0.0);
    let half = to - d;
    let half = half / half.length().max(1e-12);
    let alpha = alpha(what.roughness).max(SMOOTHEST);
    // the density of visible normals over that of directions (Heitz 2018, equations 3 and 17)
    let seen = (bsdf::hidden(cosine, alpha) + 1.0) * cosine * 4.0;
    [
        down * shares.body * std::f32::consts::FRAC_1_PI,
        distribution(n, half, alpha) / seen * shares.mirror,
    ]
}

/// The share that a way counts which was found with a density where the other end finds it with the density `other`.
#[inline(always)]
pub fn balance<R: Real>(density: R, other: R) -> R {
    density / (density + other).max(1e-30)
}

/// The density over directions with which a place is chosen that so much of the strength arrives from.
#[inline(always)]
pub fn density<R: Real>(falloff: R, area: R) -> R {
    (falloff * area).max(1e-30).recip()
}

/// What the mirrors of a surface reflect of a place of a lamp, and the part of it that the rise of Fresnel's law weighs: as
/// [`crate::light::mirror_highlight`], with mirrors as smooth as they are, since ways that the surface scatters find the rest.
#[inline(always)]
pub fn highlight<R: Real>(n: Vec3<R>, to: Vec3<R>, d: Vec3<R>, roughness: R) -> [R; 2] {
    crate::light::highlight_of(
        n,
        to,
        d,
        n.dot(to).max(0.0),
        alpha(roughness).max(SMOOTHEST),
    )
}

/// All lamps of a scene that rays may meet.
pub fn visible(lights: &[Light]) -> Vec<Lamp<f32>> {
    let lamps = lights.iter().filter_map(Lamp::of);
    lamps
        .filter(|lamp| lamp.visible && luminance_of(lamp.strength) > 0.0)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3 as G;
    use zeroset_number::v3;
    use zeroset_scene::settings::Shadow;

    fn lamps() -> [Lamp<f32>; 3] {
        let sources = [
            Source::Rectangle {
                position: G::new(0.4, 1.1, -0.3),
                right: G::new(0.8, 0.0, 0.0),
                up: G::new(0.0, 0.3, 0.4),
                visible: true,
            },
            Source::Disc {
                position: G::new(-0.2, 0.9, 0.5),
                direction: G::new(0.2, -0.9, -0.4).normalize(),
                radius: 0.7,
                visible: true,
            },
            Source::Sphere {
                position: G::new(0.3, 1.0, 0.2),
                radius: 0.6,
                visible: true,
            },
        ];
        sources.map(|source| {
            let light = Light {
                source,
                radiance: G::ONE,
                shadow: Shadow::Hard,
            };
            Lamp::of(&light).expect("a lamp")
        })
    }

    fn numbers() -> impl FnMut() -> f32 {
        let mut state = 11u32;
        move || {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            let w = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
            (((w >> 22) ^ w) >> 8) as f32 / 16_777_216.0
        }
    }

    /// How far counts are from what is expected of them, in standard deviations of chi-square over its mean.
    fn surprise(found: &[f64], expected: &[f64]) -> f64 {
        let (mut statistic, mut degrees) = (0.0, 0.0f64);
        for (found, expected) in found.iter().zip(expected) {
            if *expected > 25.0 {
                statistic += (found - expected).powi(2) / expected;
                degrees += 1.0;
            }
        }
        assert!(degrees > 8.0, "{degrees} cells");
        (statistic - degrees) / (2.0 * degrees).sqrt()
    }

    /// Directions are chosen with the density that is said, which covers the lamp as rays meet it.
    #[test]
    fn places_have_their_density() {
        let p = v3(0.1, 0.05, -0.1);
        let (rows, columns, count, fine) = (24, 32, 1 << 17, 24);
        let cell = |d: Vec3<f32>| {
            let row = ((d.y * 0.5 + 0.5) * rows as f32) as usize;
            let turn = d.x.atan2(d.z) / std::f32::consts::TAU + 0.5;
            row.min(rows - 1) * columns + ((turn * columns as f32) as usize).min(columns - 1)
        };
        for lamp in lamps() {
            let mut next = numbers();
            let mut found = vec![0.0; rows * columns];
            for _ in 0..count {
                let aimed = lamp.choose(p, [next(), next()]);
                assert!((aimed.to.length() - 1.0).abs() < 1e-4);
                if aimed.falloff > 0.0 {
                    found[cell(aimed.to)] += 1.0;
                }
            }
            let mut expected = vec![0.0; rows * columns];
            let (high, wide) = (rows * fine, columns * fine);
            let angle = 4.0 * std::f64::consts::PI / (high * wide) as f64;
            let mut all = 0.0;
            for i in 0..high {
                let y = (i as f32 + 0.5) / high as f32 * 2.0 - 1.0;
                for k in 0..wide {
                    let turn = ((k as f32 + 0.5) / wide as f32 - 0.5) * std::f32::consts::TAU;
                    let r = (1.0 - y * y).sqrt();
                    let d = v3(r * turn.sin(), y, r * turn.cos());
                    let Some([_, falloff]) = lamp.meet(p, d) else {
                        continue;
                    };
                    let share = f64::from(density(falloff, lamp.area)) * angle;
                    all += share;
                    expected[cell(d)] += share * f64::from(count);
                }
            }
            assert!((all - 1.0).abs() < 0.01, "{:?}: {all}", lamp.shape);
            let surprise = surprise(&found, &expected);
            // cells at the rim are cut coarsely
            assert!(surprise < 8.0, "{:?}: {surprise}", lamp.shape);
        }
    }

    /// What is chosen is where a ray meets it.
    #[test]
    fn places_are_where_rays_meet() {
        let (p, mut next) = (v3(0.1, 0.05, -0.1), numbers());
        for lamp in lamps() {
            for _ in 0..500 {
                let aimed = lamp.choose(p, [next(), next()]);
                let Some([t, falloff]) = lamp.meet(p, aimed.to) else {
                    // beside the rim by rounding, or from behind
                    continue;
                };
                assert!((t - aimed.distance).abs() < 2e-3 * t, "{:?}", lamp.shape);
                assert!(
                    (falloff / aimed.falloff - 1.0).abs() < 1e-2,
                    "{:?}",
                    lamp.shape
                );
            }
        }
    }

    /// A sphere that is all above the horizon lights as its middle would: pi r^2 / d^2 of its radiance, by the cosine.
    #[test]
    fn spheres_light_by_their_closed_form() {
        let [_, _, sphere] = lamps();
        let (p, n, count) = (v3(0.0, -0.3, 0.4), v3(0.0, 1.0, 0.0), 1 << 14);
        let mut sum = 0.0;
        for i in 0..count {
            let aimed = sphere.choose(p, crate::sampling::point(i, [0, 0]));
            sum += f64::from(aimed.falloff * aimed.to.dot(n).max(0.0)) / f64::from(count);
        }
        let way = sphere.place - p;
        let right = way.normalize().y / way.length_squared();
        assert!((sum / f64::from(right) - 1.0).abs() < 2e-3, "{sum} {right}");
    }

    /// Points of the lens are spread evenly over it.
    #[test]
    fn discs_are_covered_evenly() {
        let (mut next, count, rings, turns) = (numbers(), 1 << 16, 6, 10);
        let mut found = vec![0.0; rings * turns];
        for _ in 0..count {
            let [x, y] = on_disc([next(), next()]);
            let square = x * x + y * y;
            assert!(square <= 1.000_01);
            let ring = ((square * rings as f32) as usize).min(rings - 1);
            let turn = (y.atan2(x) / std::f32::consts::TAU + 0.5) * turns as f32;
            found[ring * turns + (turn as usize).min(turns - 1)] += 1.0;
        }
        let even = vec![f64::from(count) / (rings * turns) as f64; rings * turns];
        let surprise = surprise(&found, &even);
        assert!(surprise < 5.0, "{surprise}");
    }

    /// What both ends find together counts as one: the weights of each direction sum to it.
    #[test]
    fn both_ends_together_count_once() {
        for (a, b) in [(0.1f32, 3.0), (2.0, 2.0), (1e-20, 1.0), (50.0, 0.0)] {
            let sum: f32 = balance(a, b) + balance(b, a);
            assert!((sum - 1.0).abs() < 1e-6, "{a} {b}: {sum}");
        }
    }

    /// The density of what a surface scatters is that of [`bsdf::scatter`], lobe by lobe.
    #[test]
    fn likelihoods_are_those_of_scattered_rays() {
        let what = LocalMaterial {
            albedo: v3(0.7f32, 0.5, 0.3),
            emission: v3(0.0, 0.0, 0.0),
            specular: 0.5,
            metallic: 0.4,
            roughness: 0.6,
            transmission: 0.0,
            shininess: 40.0,
        };
        let n = v3(0.0, 0.0, 1.0);
        let d = v3(0.6, 0.0, -0.8);
        let (rows, columns, count, fine) = (12, 16, 1 << 17, 40);
        let cell = |to: Vec3<f32>| {
            let row = ((to.z * rows as f32) as usize).min(rows - 1);
            let turn = to.y.atan2(to.x) / std::f32::consts::TAU + 0.5;
            row * columns + ((turn * columns as f32) as usize).min(columns - 1)
        };
        let mut next = numbers();
        let mut found = [vec![0.0; rows * columns], vec![0.0; rows * columns]];
        for _ in 0..count {
            let choice = [next(), next(), next()];
            let way = bsdf::scatter(&what, n, d, 1.5, v3(1.0, 1.0, 1.0), choice);
            if way.direction.z > 0.0 {
                found[usize::from(way.lobe > 0.5)][cell(way.direction)] += 1.0;
            }
        }
        let mut expected = [vec![0.0; rows * columns], vec![0.0; rows * columns]];
        let (high, wide) = (rows * fine, columns * fine);
        let angle = std::f64::consts::TAU / (high * wide) as f64;
        for i in 0..high {
            let z = (i as f32 + 0.5) / high as f32;
            for k in 0..wide {
                let turn = ((k as f32 + 0.5) / wide as f32 - 0.5) * std::f32::consts::TAU;
                let r = (1.0 - z * z).sqrt();
                let to = v3(r * turn.cos(), r * turn.sin(), z);
                let densities = likelihood(&what, n, d, to);
                for (sum, density) in expected.iter_mut().zip(densities) {
                    sum[cell(to)] += f64::from(density) * angle * f64::from(count);
                }
            }
        }
        for (found, expected) in found.iter().zip(&expected) {
            let surprise = surprise(found, expected);
            assert!(surprise < 6.0, "{surprise}");
        }
    }
}
