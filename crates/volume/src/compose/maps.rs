//! Surfaces that are maps: heights over a plane, radii over all directions, each with a mean and a variance (Evans 2006, 9.8 and figure 9).
//!
//! A map is blurred, and its square with it, as variance shadow maps are (Donnelly and Lauritzen 2006). The mean says where the surface is on
//! average, and the variance how steep it is: a slope `g`, blurred by a Gaussian of deviation `b`, has the variance `(g b)^2`. The distance to
//! a surface so steep is what lies between along the vertical, or along the radius, over `sqrt(1 + g^2)`: it falls off more softly where the map varies.

use super::body::{BodyError, length};
use std::sync::Arc;
use zeroset_number::{Data, Grid, Real, Vec3, v3};

/// A surface over the plane of x and z: what is below it and above another one, or above a flat bottom.
#[derive(Clone, Debug)]
pub struct Heights {
    /// Mean and share of the upper map, then of the lower one: a layer each.
    data: Data,
    nodes: [u32; 2],
    half: [f32; 2],
    lowest: f32,
    highest: f32,
}

/// What is below a surface of heights.
#[derive(Clone, Debug)]
pub enum Bottom {
    /// A plane at this height.
    Flat(f32),
    /// Another surface, one height for each node.
    Heights(Vec<f32>),
}

impl Heights {
    /// Heights at the nodes of a rectangle, x fastest, that goes from `-half` to `half` along x and z, blurred by a Gaussian of this deviation.
    ///
    /// # Errors
    /// Maps with another number of samples than nodes, or with samples that are no numbers; lengths that are none.
    pub fn new(
        nodes: [u32; 2],
        half: [f32; 2],
        upper: &[f32],
        bottom: &Bottom,
        blur: f32,
    ) -> Result<Heights, BodyError> {
        for side in half {
            length("half a side of heights", side)?;
        }
        length("the blur of heights", blur)?;
        let step = [0, 1].map(|k| 2.0 * half[k] / (nodes[k].max(2) - 1) as f32);
        let flat;
        let lower = match bottom {
            Bottom::Flat(y) => {
                flat = vec![*y; upper.len()];
                &flat
            }
            Bottom::Heights(lower) => lower,
        };
        let mut layers = Vec::new();
        for map in [upper, lower] {
            check(nodes, map)?;
            let [mean, square] = [map.to_vec(), map.iter().map(|y| y * y).collect()]
                .map(|map| blurred(nodes, map, step.map(|s| blur / s)));
            let shares = mean.iter().zip(&square);
            let shares: Vec<f32> = shares.map(|(m, s)| share(s - m * m, blur)).collect();
            layers.extend(mean);
            layers.extend(shares);
        }
        let least = |a: f32, b: &f32| a.min(*b);
        let most = |a: f32, b: &f32| a.max(*b);
        Ok(Heights {
            nodes,
            half,
            lowest: lower.iter().fold(f32::INFINITY, least),
            highest: upper.iter().fold(f32::NEG_INFINITY, most),
            data: data([nodes[0], nodes[1], 4], layers)?,
        })
    }

    pub(super) fn bounds(&self) -> ([f32; 3], [f32; 3]) {
        let [x, z] = self.half;
        let high = self.highest.max(self.lowest);
        ([-x, self.lowest, -z], [x, high, z])
    }

    #[inline(always)]
    pub(super) fn distance<R: Real<Scalar = f32, Store = Data>>(&self, p: Vec3<R>) -> R {
        let [x, z] = self.half;
        let (nx, nz) = (self.nodes[0] as f32, self.nodes[1] as f32);
        let across = (p.x + x) * ((nx - 1.0) / (2.0 * x));
        let down = (p.z + z) * ((nz - 1.0) / (2.0 * z));
        let layer = |k: f32| {
            let at = v3(across, down, p.x.lit(k));
            R::sample(&self.data, 0.0, v3(nx, nz, 4.0), at)
        };
        let above = (p.y - layer(0.0)) * layer(1.0);
        let below = -(p.y - layer(2.0)) * layer(3.0);
        let beside = (p.x.abs() - x).max(p.z.abs() - z);
        above.max(below).max(beside)
    }
}

/// A surface with one radius for each direction from its origin: a cube map.
#[derive(Clone, Debug)]
pub struct Star {
    /// Mean radii of the six faces, then shares: a layer each.
    data: Data,
    side: u32,
    farthest: f32,
}

impl Star {
    /// The radii of all directions, at `side` nodes along each edge of a cube, blurred by a Gaussian of this deviation, an angle in radians.
    ///
    /// # Errors
    /// A blur that is none, too few or too many nodes, radii that are no lengths.
    pub fn new(side: u32, blur: f32, radius: impl Fn([f32; 3]) -> f32) -> Result<Star, BodyError> {
        length("the blur of a star", blur)?;
        if !(2..=2048).contains(&side) {
            return Err(BodyError::Map {
                nodes: [side; 2],
                values: 0,
            });
        }
        let nodes: Vec<Vec3<f32>> = (0..6 * side * side)
            .map(|n| direction(side, [n % side, n / side % side, n / side / side]))
            .collect();
        let mut radii = Vec::new();
        for way in &nodes {
            radii.push(length("a radius of a star", radius(way.array()))?);
        }
        let farthest = radii.iter().fold(0.0, |a: f32, b| a.max(*b));
        let sharp = Star {
            data: data([side, side, 6], radii)?,
            side,
            farthest,
        };
        let taps = taps(blur);
        let (mut means, mut shares) = (Vec::new(), Vec::new());
        for way in &nodes {
            let [a, b] = across(*way);
            let (mut mean, mut square) = (0.0, 0.0);
            for [x, y, weight] in &taps {
                let r = sharp.layer(*way + a * *x + b * *y, 0.0, 6.0);
                (mean, square) = (mean + weight * r, square + weight * r * r);
            }
            means.push(mean);
            shares.push(share(square - mean * mean, blur * mean));
        }
        means.extend(shares);
        Ok(Star {
            data: data([side, side, 12], means)?,
            side,
            farthest,
        })
    }

    pub(super) fn farthest(&self) -> f32 {
        self.farthest
    }

    /// A map in a direction, whose layers begin with number `first` of `all`.
    #[inline(always)]
    fn layer<R: Real<Scalar = f32, Store = Data>>(&self, way: Vec3<R>, first: f32, all: f32) -> R {
        let far = way.abs();
        let by_x = !(far.x.below(far.y) | far.x.below(far.z));
        let by_y = !far.y.below(far.z);
        let pick = |x: R, y: R, z: R| R::choose(by_x, x, R::choose(by_y, y, z));
        let major = pick(way.x, way.y, way.z);
        let size = major.abs().max(1e-20);
        let (u, v) = (pick(way.y, way.x, way.x), pick(way.z, way.z, way.y));
        let zero = way.x.lit(0.0);
        let face =
            pick(zero, zero + 2.0, zero + 4.0) + R::choose(major.negative(), zero + 1.0, zero);
        let nodes = self.side as f32;
        let half = 0.5 * (nodes - 1.0);
        let at = v3(
            (u / size + 1.0) * half,
            (v / size + 1.0) * half,
            face + first,
        );
        R::sample(&self.data, 0.0, v3(nodes, nodes, all), at)
    }

    #[inline(always)]
    pub(super) fn distance<R: Real<Scalar = f32, Store = Data>>(&self, p: Vec3<R>) -> R {
        (p.length() - self.layer(p, 0.0, 12.0)) * self.layer(p, 6.0, 12.0)
    }
}

/// The direction of a node of a cube map.
fn direction(side: u32, [i, j, face]: [u32; 3]) -> Vec3<f32> {
    let on = |k: u32| 2.0 * k as f32 / (side - 1) as f32 - 1.0;
    let (u, v) = (on(i), on(j));
    let major = if face % 2 == 0 { 1.0 } else { -1.0 };
    let way = match face / 2 {
        0 => v3(major, u, v),
        1 => v3(u, major, v),
        _ => v3(u, v, major),
    };
    way.normalize()
}

/// Two directions at right angles to one and to each other: the same for it wherever it lies on a map.
fn across(way: Vec3<f32>) -> [Vec3<f32>; 2] {
    let far = way.abs();
    let aside = if far.x <= far.y && far.x <= far.z {
        v3(1.0, 0.0, 0.0)
    } else if far.y <= far.z {
        v3(0.0, 1.0, 0.0)
    } else {
        v3(0.0, 0.0, 1.0)
    };
    let a = way.cross(aside).normalize();
    [a, way.cross(a)]
}

/// Places of a disc, and weights whose sum is 1, which have the deviation of a Gaussian along each axis.
fn taps(blur: f32) -> Vec<[f32; 3]> {
    const RINGS: [f32; 3] = [0.7, 1.4, 2.1];
    const TURNS: u32 = 8;
    let mut taps = vec![[0.0, 0.0, 0.5]];
    for (number, ring) in RINGS.into_iter().enumerate() {
        for k in 0..TURNS {
            let turn = (k as f32 + 0.5 * (number % 2) as f32) / TURNS as f32;
            let (sin, cos) = (turn * std::f32::consts::TAU).sin_cos();
            let weight = ring / TURNS as f32 * (-0.5 * ring * ring).exp() / RINGS[0];
            taps.push([ring * cos, ring * sin, weight]);
        }
    }
    let all: f32 = taps.iter().map(|[.., w]| w).sum();
    let spread: f32 = taps.iter().map(|[x, _, w]| w / all * x * x).sum();
    let times = blur / spread.sqrt();
    taps.iter()
        .map(|[x, y, w]| [x * times, y * times, w / all])
        .collect()
}

/// What a way along the vertical is multiplied by where heights have this variance after a blur of this deviation.
fn share(variance: f32, blur: f32) -> f32 {
    (1.0 + variance.max(0.0) / (blur * blur)).sqrt().recip()
}

fn check(nodes: [u32; 2], values: &[f32]) -> Result<(), BodyError> {
    let count = nodes.iter().map(|n| *n as usize).product::<usize>();
    if values.len() != count || !nodes.iter().all(|n| (2..=2048).contains(n)) {
        let values = values.len();
        return Err(BodyError::Map { nodes, values });
    }
    let is_height = |y: &f32| y.abs() <= 1e9;
    match values.iter().position(|y| !is_height(y)) {
        Some(at) => Err(BodyError::Sample {
            at,
            value: values[at],
        }),
        None => Ok(()),
    }
}

fn data(nodes: [u32; 3], values: Vec<f32>) -> Result<Data, BodyError> {
    let count = values.len();
    let grid = Grid::of_points(nodes, values).map_err(|_| BodyError::Map {
        nodes: [nodes[0], nodes[1]],
        values: count,
    })?;
    Ok(Data {
        params: Vec::new(),
        grids: vec![Arc::new(grid)],
    })
}

/// A map blurred by a Gaussian of these deviations in nodes, one axis after the other; beyond its edges the nodes there go on.
fn blurred([nx, nz]: [u32; 2], map: Vec<f32>, deviation: [f32; 2]) -> Vec<f32> {
    let [nx, nz] = [nx as i64, nz as i64];
    let along = |map: &[f32], deviation: f32, axis: usize| {
        let reach = (3.0 * deviation).ceil().min(nx.max(nz) as f32) as i64;
        let weight = |k: i64| (-0.5 * (k as f32 / deviation.max(1e-6)).powi(2)).exp();
        let weights: Vec<f32> = (-reach..=reach).map(weight).collect();
        let all: f32 = weights.iter().sum();
        let mut out = Vec::with_capacity(map.len());
        for (j, i) in (0..nz).flat_map(|j| (0..nx).map(move |i| (j, i))) {
            let mut sum = 0.0;
            for (k, w) in (-reach..=reach).zip(&weights) {
                let (x, z) = match axis {
                    0 => ((i + k).clamp(0, nx - 1), j),
                    _ => (i, (j + k).clamp(0, nz - 1)),
                };
                sum += w * map[(x + nx * z) as usize];
            }
            out.push(sum / all);
        }
        out
    };
    along(&along(&map, deviation[0], 0), deviation[1], 1)
}
