//! Light from all around: an image of all directions, how likely rays are to look for light in each, and what surfaces make of it.

use crate::light::luminance_of;
use crate::microfacet::{alpha, distribution};
use crate::{parameters, preetham};
use std::f32::consts::{PI, TAU};
use std::sync::Arc;
use zeroset_number::{Real, Vec3, v3};
use zeroset_scene::environment::{Environment, Surroundings};
use zeroset_scene::light::{Light, Source};
use zeroset_scene::material::Image;
use zeroset_scene::scene::Scene;

/// Cells across and down that directions are chosen by, at most.
const CELLS: [u32; 2] = [512, 256];
/// Pixels of the images that rough mirrors show, each for one of [`LEVELS`] roughnesses.
pub const GLOSSY: [u32; 2] = [32, 16];
/// Roughnesses that there are such images of: evenly, up to 1.
pub const LEVELS: u32 = 4;
/// Pixels of the image that those are made of.
const COARSE: [u32; 2] = [64, 32];
/// The decision of [`crate::sampling::decided`] where light from all around is looked for, of the surface met first.
pub const DECISION: u32 = 0x456e_7669;

/// An environment, ready to light a scene.
#[derive(Clone, Debug)]
pub struct EnvironmentMap {
    /// What is seen.
    pub image: Arc<Image>,
    /// For each cell, row by row: where its part of its row ends, 0 to 1, and the density over the image of choosing it. Behind each row
    /// where its part of all rows ends.
    pub table: Arc<Image>,
    /// What rough mirrors show, level below level.
    pub glossy: Arc<Image>,
    /// What arrives at open surfaces: the first nine spherical harmonics of the mean by the cosine law.
    pub harmonics: [Vec3<f32>; 9],
    /// What its light is multiplied by.
    pub strength: f32,
    /// Cosine and sine of how far it is turned.
    pub turn: [f32; 2],
    /// What it was made of, and where the sun stood.
    made_of: (Environment, Option<glam::Vec3>),
}

/// The place on the image, 0 to 1 across and down, of a direction.
#[inline(always)]
pub fn place_of<R: Real>(d: Vec3<R>) -> [R; 2] {
    let across = d.x.atan2(-d.z) * (1.0 / TAU) + 0.5;
    [across, d.y.clamp(-1.0, 1.0).acos() * (1.0 / PI)]
}

/// The direction of a place on the image, and the sine of its angle to the vertical.
#[inline(always)]
pub fn direction_of<R: Real>([across, down]: [R; 2]) -> (Vec3<R>, R) {
    let (sin, cos) = ((across - 0.5) * TAU).sin_cos();
    let (wide, high) = (down * PI).sin_cos();
    (v3(wide * sin, high, -(wide * cos)), wide)
}

/// A direction turned about the vertical by the angle with this cosine and sine: from z to x.
#[inline(always)]
pub fn turned<R: Real>(d: Vec3<R>, cosine: R::Scalar, sine: R::Scalar) -> Vec3<R> {
    v3(d.x * cosine + d.z * sine, d.y, d.z * cosine - d.x * sine)
}

/// The density over directions, from that over the image, 0 to 1 both ways.
#[inline(always)]
pub fn over_directions<R: Real>(density: R, sine: R) -> R {
    density / (sine.max(1e-6) * (TAU * PI))
}

/// What arrives at an open surface, by the factors of the harmonics; below 0 where they ring.
#[inline(always)]
pub fn arriving<R: Real>(normal: Vec3<R>, factors: [Vec3<R::Scalar>; 9]) -> Vec3<R> {
    let mut sum = Vec3::splat(normal.x.lit(0.0));
    let weights = harmonics(normal);
    for k in 0..9 {
        sum = sum + normal.like(factors[k]) * weights[k];
    }
    sum
}

/// The first nine spherical harmonics of a direction (Ramamoorthi and Hanrahan 2001, equation 3).
#[inline(always)]
pub fn harmonics<R: Real>(n: Vec3<R>) -> [R; 9] {
    [
        n.x.lit(0.282_095),
        n.y * 0.488_603,
        n.z * 0.488_603,
        n.x * 0.488_603,
        n.x * n.y * 1.092_548,
        n.y * n.z * 1.092_548,
        (n.z.sq() * 3.0 - 1.0) * 0.315_392,
        n.x * n.z * 1.092_548,
        (n.x.sq() - n.y.sq()) * 0.546_274,
    ]
}

impl EnvironmentMap {
    /// That of a scene's environment; its sun is the first directional one of these lights.
    pub fn new(environment: &Environment, lights: &[Light]) -> EnvironmentMap {
        let sun = sun(lights);
        let image = match &environment.source {
            Surroundings::Image { image } => Arc::clone(image),
            Surroundings::Clear { turbidity, ground } => {
                let sun = sun.unwrap_or(glam::Vec3::Y);
                Arc::new(preetham::image(*turbidity, *ground, sun))
            }
        };
        let coarse = shrunk(&image, COARSE);
        let (sine, cosine) = environment.turn.sin_cos();
        EnvironmentMap {
            table: Arc::new(table(&image)),
            glossy: Arc::new(glossy(&coarse)),
            harmonics: projected(&coarse),
            strength: environment.strength,
            turn: [cosine, sine],
            made_of: (environment.clone(), sun),
            image,
        }
    }

    /// That of a scene, if it has one: the one before, if it was made of the same.
    pub fn renewed(
        before: Option<&Arc<EnvironmentMap>>,
        scene: &Scene,
    ) -> Option<Arc<EnvironmentMap>> {
        let environment = scene.environment()?;
        let same = |map: &&Arc<EnvironmentMap>| {
            let (of, stood) = &map.made_of;
            let alike = match (&of.source, &environment.source) {
                (Surroundings::Image { image: a }, Surroundings::Image { image: b }) => {
                    Arc::ptr_eq(a, b)
                }
                (a @ Surroundings::Clear { .. }, b @ Surroundings::Clear { .. }) => {
                    a == b && *stood == sun(scene.lights())
                }
                _ => false,
            };
            alike && (of.strength, of.turn) == (environment.strength, environment.turn)
        };
        Some(match before.filter(same) {
            Some(map) => Arc::clone(map),
            None => Arc::new(EnvironmentMap::new(environment, scene.lights())),
        })
    }

    /// The light along a direction.
    pub fn radiance(&self, d: Vec3<f32>) -> Vec3<f32> {
        let [across, down] = place_of(self.local(d));
        smooth(&self.image, [0, self.image.height], across, down) * self.strength
    }

    /// The direction as the image has it.
    fn local(&self, d: Vec3<f32>) -> Vec3<f32> {
        turned(d, self.turn[0], -self.turn[1])
    }

    /// What a mirror so rough shows that looks along a direction.
    pub fn reflected(&self, d: Vec3<f32>, roughness: f32) -> Vec3<f32> {
        let [across, down] = place_of(self.local(d));
        let at = (roughness * LEVELS as f32 - 1.0).clamp(0.0, LEVELS as f32 - 1.0);
        let level = (at as u32).min(LEVELS - 2);
        let of = |level: u32| smooth(&self.glossy, [level * GLOSSY[1], GLOSSY[1]], across, down);
        let share = at - level as f32;
        (of(level) * (1.0 - share) + of(level + 1) * share) * self.strength
    }

    /// What arrives at an open surface of this normal: the mean by the cosine law.
    pub fn arriving(&self, normal: Vec3<f32>) -> Vec3<f32> {
        let sum = arriving(self.local(normal), self.harmonics);
        sum.map(|x| x.max(0.0)) * self.strength
    }

    /// Cells across and down.
    pub fn cells(&self) -> [u32; 2] {
        [self.table.width - 1, self.table.height]
    }

    /// Chooses a direction by how much light comes from there, from a point of the unit square: the direction, and the density over
    /// directions.
    pub fn choose(&self, [u, v]: [f32; 2]) -> (Vec3<f32>, f32) {
        let [columns, rows] = self.cells();
        let row_end = |row: u32| self.cell(columns, row).x;
        let (row, down) = find(rows, v, row_end);
        let (column, across) = find(columns, u, |column| self.cell(column, row).x);
        let place = [
            (column as f32 + across) / columns as f32,
            (row as f32 + down) / rows as f32,
        ];
        let (d, sine) = direction_of(place);
        let density = over_directions(self.cell(column, row).y, sine);
        (turned(d, self.turn[0], self.turn[1]), density)
    }

    /// The density over directions with which [`EnvironmentMap::choose`] finds this one.
    pub fn density(&self, d: Vec3<f32>) -> f32 {
        let local = self.local(d);
        let ([across, down], [columns, rows]) = (place_of(local), self.cells());
        let cell = |x: f32, count: u32| ((x * count as f32).max(0.0) as u32).min(count - 1);
        let sine = (local.x * local.x + local.z * local.z).sqrt();
        over_directions(self.cell(cell(across, columns), cell(down, rows)).y, sine)
    }

    fn cell(&self, column: u32, row: u32) -> glam::Vec3 {
        self.table.pixels[(row * self.table.width + column) as usize]
    }
}

/// Where the sun stands: against the way of the first light from far away.
fn sun(lights: &[Light]) -> Option<glam::Vec3> {
    lights.iter().find_map(|light| match light.source {
        Source::Directional { direction } => Some(-direction),
        _ => None,
    })
}

/// The first of `count` parts that ends behind `x`, by bisection, and how far into it that is, 0 to 1. `end` is where each ends.
fn find(count: u32, x: f32, end: impl Fn(u32) -> f32) -> (u32, f32) {
    let (mut low, mut high) = (0, count - 1);
    while low < high {
        let middle = (low + high) / 2;
        if end(middle) > x {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    let start = if low > 0 { end(low - 1) } else { 0.0 };
    let width = (end(low) - start).max(1e-12);
    (low, ((x - start) / width).clamp(0.0, 0.999_999))
}

/// The colour of an image between its four nearest pixels, of its rows from `first` on, as many as `count`: around it from left to right.
fn smooth(image: &Image, [first, count]: [u32; 2], across: f32, down: f32) -> Vec3<f32> {
    let width = image.width as f32;
    let (x, y) = (across * width - 0.5, down * count as f32 - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let (s, t) = (x - left, y - top);
    let at = |dx: f32, dy: f32| {
        let column = left + dx - width * ((left + dx) / width).floor();
        let row = (top + dy).clamp(0.0, count as f32 - 1.0);
        let row = row as u32 + first;
        let column = (column as u32).min(image.width - 1);
        parameters(image.pixels[(row * image.width + column) as usize])
    };
    let upper = at(0.0, 0.0) * (1.0 - s) + at(1.0, 0.0) * s;
    let lower = at(0.0, 1.0) * (1.0 - s) + at(1.0, 1.0) * s;
    upper * (1.0 - t) + lower * t
}

fn image([width, height]: [u32; 2], pixels: Vec<glam::Vec3>) -> Image {
    Image {
        path: String::new(),
        width,
        height,
        pixels,
    }
}

/// The mean colours of the cells of a coarser image, rows weighted by how much of all directions they show.
fn shrunk(from: &Image, most: [u32; 2]) -> Image {
    let (width, height) = (from.width.min(most[0]), from.height.min(most[1]));
    let count = (width * height) as usize;
    let (mut sums, mut weights) = (vec![glam::Vec3::ZERO; count], vec![0.0f32; count]);
    for y in 0..from.height {
        let sine = ((y as f32 + 0.5) / from.height as f32 * PI).sin();
        let row = (u64::from(y) * u64::from(height) / u64::from(from.height)) as u32;
        for x in 0..from.width {
            let column = (u64::from(x) * u64::from(width) / u64::from(from.width)) as u32;
            let cell = (row * width + column) as usize;
            sums[cell] += from.pixels[(y * from.width + x) as usize] * sine;
            weights[cell] += sine;
        }
    }
    let means = sums.iter().zip(weights).map(|(sum, weight)| *sum / weight);
    image([width, height], means.collect())
}

/// See [`EnvironmentMap::table`]. A cell counts as much as it and its neighbours are bright, since what is seen is mixed of both.
fn table(of: &Image) -> Image {
    let cells = shrunk(of, CELLS);
    let (width, height) = (cells.width, cells.height);
    let bright = |x: u32, y: u32| luminance_of(parameters(cells.pixels[(y * width + x) as usize]));
    let weight = |x: u32, y: u32| {
        let mut sum = 0.0;
        for dy in [y.saturating_sub(1), y, (y + 1).min(height - 1)] {
            for dx in [(x + width - 1) % width, x, (x + 1) % width] {
                sum += bright(dx, dy);
            }
        }
        let sine = ((y as f32 + 0.5) / height as f32 * PI).sin();
        f64::from(sum) * f64::from(sine)
    };
    let mut weights: Vec<f64> = (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| weight(x, y))
        .collect();
    let all: f64 = weights.iter().sum();
    if all <= 0.0 {
        // nothing is bright: all directions are alike
        weights.fill(1.0);
    }
    let all: f64 = weights.iter().sum();
    let count = f64::from(width) * f64::from(height);
    let mut pixels = Vec::new();
    let mut down = 0.0;
    for row in weights.chunks(width as usize) {
        let sum: f64 = row.iter().sum();
        let mut across = 0.0;
        for weight in row {
            across += weight;
            let end = if sum > 0.0 { across / sum } else { 1.0 };
            pixels.push(glam::Vec3::new(
                end as f32,
                (weight / all * count) as f32,
                0.0,
            ));
        }
        down += sum;
        pixels.push(glam::Vec3::new((down / all) as f32, 0.0, 0.0));
    }
    image([width + 1, height], pixels)
}

/// The directions of an image's pixels with their colours, and how much of all directions they show.
fn directions(of: &Image) -> Vec<(Vec3<f32>, Vec3<f32>, f32)> {
    let (width, height) = (of.width, of.height);
    let angle = TAU * PI / (width * height) as f32;
    let pixel = |x: u32, y: u32| {
        let place = [
            (x as f32 + 0.5) / width as f32,
            (y as f32 + 0.5) / height as f32,
        ];
        let (d, sine) = direction_of(place);
        let colour = parameters(of.pixels[(y * width + x) as usize]);
        (d, colour, sine * angle)
    };
    (0..height)
        .flat_map(|y| (0..width).map(move |x| pixel(x, y)))
        .collect()
}

/// See [`EnvironmentMap::harmonics`].
fn projected(of: &Image) -> [Vec3<f32>; 9] {
    let mut sums = [v3(0.0, 0.0, 0.0); 9];
    for (d, colour, angle) in directions(of) {
        for (sum, weight) in sums.iter_mut().zip(harmonics(d)) {
            *sum = *sum + colour * (weight * angle);
        }
    }
    // the factors of the cosine law over pi
    let factor = |k: usize| match k {
        0 => 1.0,
        1..=3 => 2.0 / 3.0,
        _ => 0.25,
    };
    std::array::from_fn(|k| sums[k] * factor(k))
}

/// See [`EnvironmentMap::glossy`]: what mirrors show that are looked at straight (Karis 2013).
fn glossy(of: &Image) -> Image {
    let all = directions(of);
    let mut pixels = Vec::new();
    for level in 1..=LEVELS {
        let alpha = alpha(level as f32 / LEVELS as f32);
        for y in 0..GLOSSY[1] {
            for x in 0..GLOSSY[0] {
                let place = [
                    (x as f32 + 0.5) / GLOSSY[0] as f32,
                    (y as f32 + 0.5) / GLOSSY[1] as f32,
                ];
                let (n, _) = direction_of(place);
                let (mut sum, mut weights) = (v3(0.0, 0.0, 0.0), 0.0f32);
                for (d, colour, angle) in &all {
                    let cosine = n.dot(*d);
                    if cosine <= 0.0 {
                        continue;
                    }
                    let weight = distribution(n, (n + *d).normalize(), alpha) * cosine * angle;
                    sum = sum + *colour * weight;
                    weights += weight;
                }
                pixels.push(glam::Vec3::from((sum / weights.max(1e-12)).array()));
            }
        }
    }
    image([GLOSSY[0], GLOSSY[1] * LEVELS], pixels)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{cosine_direction, point};

    /// Something with a lamp in it, a horizon, and colours.
    fn room() -> Arc<Image> {
        let (width, height) = (96, 48);
        let pixel = |x: u32, y: u32| {
            let lamp = (20..24).contains(&x) && (10..13).contains(&y);
            let base = if y > 24 { 0.1 } else { 0.6 };
            let bright = if lamp { 60.0 } else { base };
            glam::Vec3::new(
                bright,
                0.8 * bright,
                base + 0.3 * (x as f32 / 15.0).sin().abs(),
            )
        };
        let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Arc::new(image(
            [width, height],
            all.map(|(x, y)| pixel(x, y)).collect(),
        ))
    }

    fn map(turn: f32) -> EnvironmentMap {
        let image = room();
        let environment = Environment {
            source: Surroundings::Image { image },
            strength: 1.5,
            turn,
        };
        EnvironmentMap::new(&environment, &[])
    }

    #[test]
    fn places_and_directions_are_each_others() {
        for i in 0..200 {
            let [u, v] = point(i, [3, 4]);
            let (d, sine) = direction_of([u, v]);
            assert!((d.length() - 1.0).abs() < 1e-5);
            assert!((sine - (1.0 - d.y * d.y).sqrt()).abs() < 1e-4);
            let back = place_of(d);
            // at a pole all directions of a row are one, and an image ends where it begins
            let around = (back[0] - u).abs();
            let around = around.min(1.0 - around) * sine;
            assert!(
                around < 1e-4 && (back[1] - v).abs() < 1e-3,
                "{back:?} for {u}, {v}"
            );
        }
        // the middle is what a camera sees that is not turned
        let (d, _) = direction_of([0.5f32, 0.5]);
        assert!((d - v3(0.0, 0.0, -1.0)).length() < 1e-6);
        let (d, _) = direction_of([0.75f32, 0.5]);
        assert!((d - v3(1.0, 0.0, 0.0)).length() < 1e-6);
        assert!((turned(v3(0.0f32, 0.0, 1.0), 0.0, 1.0) - v3(1.0, 0.0, 0.0)).length() < 1e-6);
    }

    /// Directions are chosen with the density that is said (chi-square), which covers all of them.
    #[test]
    fn directions_have_their_density() {
        let map = map(0.7);
        let (across, down, count) = (16usize, 8usize, 1 << 17);
        let mut found = vec![0.0f64; across * down];
        let mut state = 7u32;
        let mut next = || {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            let w = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
            (((w >> 22) ^ w) >> 8) as f32 / 16_777_216.0
        };
        let cell = |d: Vec3<f32>| {
            let [x, y] = place_of(d);
            let x = ((x * across as f32) as usize).min(across - 1);
            ((y * down as f32) as usize).min(down - 1) * across + x
        };
        for _ in 0..count {
            let (d, density) = map.choose([next(), next()]);
            assert!((d.length() - 1.0).abs() < 1e-4 && density > 0.0);
            // beside the edge of a cell rounding may find the next one
            found[cell(d)] += 1.0;
        }
        let fine = 48;
        let mut expected = vec![0.0f64; across * down];
        let (mut all, wide, high) = (0.0, across * fine, down * fine);
        for y in 0..high {
            for x in 0..wide {
                let place = [
                    (x as f32 + 0.5) / wide as f32,
                    (y as f32 + 0.5) / high as f32,
                ];
                let (d, sine) = direction_of(place);
                let angle = f64::from(sine) * f64::from(TAU * PI) / (wide * high) as f64;
                let share = f64::from(map.density(d)) * angle;
                expected[cell(d)] += share * f64::from(count);
                all += share;
            }
        }
        assert!((all - 1.0).abs() < 0.01, "{all}");
        let (mut statistic, mut degrees) = (0.0, 0.0f64);
        for (found, expected) in found.iter().zip(&expected) {
            if *expected > 20.0 {
                statistic += (found - expected).powi(2) / expected;
                degrees += 1.0;
            }
        }
        let limit = degrees + 5.0 * (2.0 * degrees).sqrt() + 20.0;
        assert!(
            degrees > 60.0 && statistic < limit,
            "{statistic} of {degrees}"
        );
    }

    /// What is chosen by its light has the mean of what is chosen evenly.
    #[test]
    fn chosen_light_is_all_light() {
        let map = map(0.3);
        let (mut chosen, mut even, count) = (0.0f64, 0.0, 1 << 16);
        for i in 0..count {
            let u = point(i, [1, 2]);
            let (d, density) = map.choose(u);
            chosen += f64::from(map.radiance(d).x / density) / f64::from(count);
            let z = 1.0 - 2.0 * u[0];
            let r = (1.0 - z * z).sqrt();
            let (sin, cos) = (u[1] * TAU).sin_cos();
            let d = v3(r * cos, z, r * sin);
            even += f64::from(map.radiance(d).x * 4.0 * PI) / f64::from(count);
        }
        assert!((chosen / even - 1.0).abs() < 0.01, "{chosen} and {even}");
    }

    #[test]
    fn what_arrives_is_the_mean_by_the_cosine_law() {
        let map = map(-1.1);
        for n in [
            v3(0.0, 1.0, 0.0),
            v3(0.6, 0.0, 0.8),
            v3(-0.36, -0.48, 0.8f32),
        ] {
            let (mut mean, count) = (v3(0.0, 0.0, 0.0), 1 << 14);
            for i in 0..count {
                let [u, v] = point(i, [5, 6]);
                mean = mean + map.radiance(cosine_direction(n, u, v)) / count as f32;
            }
            // the harmonics leave out a few hundredths (Ramamoorthi and Hanrahan 2001)
            let off = (map.arriving(n) - mean).abs().max_component();
            assert!(off < 0.09 * mean.max_component(), "{off} of {mean:?}");
        }
    }

    #[test]
    fn one_colour_stays_one_colour() {
        let colour = glam::Vec3::new(0.5, 0.25, 1.0);
        let image = Arc::new(image([40, 20], vec![colour; 800]));
        let source = Surroundings::Image { image };
        let environment = Environment {
            source,
            strength: 2.0,
            turn: 0.4,
        };
        let map = EnvironmentMap::new(&environment, &[]);
        for i in 0..50 {
            let (d, sine) = direction_of(point(i, [0, 0]));
            for found in [map.radiance(d), map.arriving(d), map.reflected(d, 0.6)] {
                assert!(
                    (found - parameters(colour * 2.0)).length() < 0.01,
                    "{found:?}"
                );
            }
            // a row is chosen by its middle, though it is wider at the one edge than at the other
            let density = map.density(d) * 4.0 * PI;
            let half_row = 0.5 * PI / 20.0;
            let within = 0.02 + half_row / sine;
            assert!(
                (density - 1.0).abs() < within,
                "{density}, not within {within} of 1"
            );
        }
    }
}
