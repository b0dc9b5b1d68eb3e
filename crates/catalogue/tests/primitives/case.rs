//! An entry at one set of parameters, with the places where it is looked at.

use std::fmt;

use zeroset_catalogue::bounds::Aabb;

use crate::entry::{Entry, Point};

/// What a proof found, and where.
#[derive(Debug)]
pub struct Failure {
    pub entry: &'static str,
    pub proof: &'static str,
    pub params: Vec<f64>,
    pub what: String,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} {:?}: {}: {}",
            self.entry, self.params, self.proof, self.what
        )
    }
}

/// Xorshift, from a seed that depends on the entry alone.
pub struct Random(u64);

impl Random {
    pub fn new(name: &str, salt: u64) -> Self {
        let hash = name.bytes().fold(0xcbf2_9ce4_8422_2325 ^ salt, |h, b| {
            (h ^ u64::from(b)).wrapping_mul(0x100_0000_01b3)
        });
        Random(hash | 1)
    }

    /// Uniform in 0..1.
    pub fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in `lo..hi`.
    pub fn within(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// Uniform in the logarithm.
    pub fn scale(&mut self, lo: f64, hi: f64) -> f64 {
        self.within(lo.ln(), hi.ln()).exp()
    }

    pub fn index(&mut self, n: usize) -> usize {
        ((self.unit() * n as f64) as usize).min(n - 1)
    }

    /// A unit vector, uniform over the sphere.
    pub fn direction(&mut self) -> Point {
        loop {
            let v: Point = std::array::from_fn(|_| self.within(-1.0, 1.0));
            let r = length(v);
            if r > 0.1 && r <= 1.0 {
                return v.map(|x| x / r);
            }
        }
    }

    /// Uniform in a box.
    pub fn point(&mut self, b: &Aabb) -> Point {
        std::array::from_fn(|k| self.within(b.min[k], b.max[k]))
    }
}

pub fn length(v: Point) -> f64 {
    v[0].hypot(v[1]).hypot(v[2])
}

pub fn distance(p: Point, q: Point) -> f64 {
    length([p[0] - q[0], p[1] - q[1], p[2] - q[2]])
}

/// `p + t d`.
pub fn along(p: Point, d: Point, t: f64) -> Point {
    std::array::from_fn(|k| p[k] + t * d[k])
}

/// An entry at one set of parameters.
pub struct Case<'e> {
    pub entry: &'e Entry,
    /// Parameters as the evaluators read them.
    pub stored: Vec<f32>,
    /// The same numbers in `f64`.
    pub params: Vec<f64>,
    pub bounds: Aabb,
    pub lipschitz: f64,
    /// The bounds, cut to a finite part where they are infinite.
    pub core: Aabb,
    /// Half the longest side of [`Self::core`]: what tolerances are relative to.
    pub size: f64,
    /// Points of the surface, found with `contains`.
    pub surface: Vec<Point>,
    /// Points inside, some shallow, some deep.
    pub inside: Vec<Point>,
    /// Points outside, near the surface.
    pub outside: Vec<Point>,
}

/// Surface points looked for.
const SURFACE: usize = 1200;

impl<'e> Case<'e> {
    pub fn new(entry: &'e Entry, params: &[f64]) -> Result<Self, Failure> {
        let stored: Vec<f32> = params.iter().map(|&x| x as f32).collect();
        let params: Vec<f64> = stored.iter().map(|&x| f64::from(x)).collect();
        let bounds = (entry.bounds)(&params);
        let lipschitz = (entry.lipschitz)(&params);
        let (core, size) = core(&bounds);
        let (surface, inside, outside) = Default::default();
        let mut case = Case {
            entry,
            stored,
            params,
            bounds,
            lipschitz,
            core,
            size,
            surface,
            inside,
            outside,
        };
        if !(lipschitz > 0.0 && lipschitz.is_finite()) {
            return Err(case.fail("bounds", format!("Lipschitz constant {lipschitz}")));
        }
        if bounds.is_empty() || bounds.min.iter().chain(&bounds.max).any(|x| x.is_nan()) {
            return Err(case.fail(
                "bounds",
                format!("{bounds:?} at a set of parameters that must show something"),
            ));
        }
        case.find_surface()?;
        Ok(case)
    }

    pub fn fail(&self, proof: &'static str, what: String) -> Failure {
        Failure {
            entry: self.entry.info.name,
            proof,
            params: self.params.clone(),
            what,
        }
    }

    pub fn random(&self, salt: u64) -> Random {
        let salt = self
            .params
            .iter()
            .fold(salt, |s, p| s.rotate_left(9) ^ p.to_bits());
        Random::new(self.entry.info.name, salt)
    }

    pub fn value(&self, p: Point) -> f64 {
        (self.entry.value)(p, &self.stored)
    }

    pub fn contains(&self, p: Point) -> bool {
        (self.entry.contains)(&self.params, p)
    }

    /// Below this a value says nothing about the sign.
    pub fn band(&self) -> f64 {
        1e-9 * self.size
    }

    /// Unit vector along which the value grows, by differences; zero where there is none.
    pub fn upwards(&self, p: Point) -> Point {
        let h = 1e-6 * self.size;
        let g: Point = std::array::from_fn(|k| {
            let (mut a, mut b) = (p, p);
            a[k] += h;
            b[k] -= h;
            self.value(a) - self.value(b)
        });
        let r = length(g);
        if r > 0.0 && r.is_finite() {
            g.map(|x| x / r)
        } else {
            [0.0; 3]
        }
    }

    /// Places all over: in the box, around it, far away, near the surface at every scale, and where formulas tend to
    /// break (the origin, axes, planes of symmetry, corners).
    pub fn places(&self, n: usize, salt: u64) -> Vec<Point> {
        let mut random = self.random(salt);
        let mut out = self.special();
        let (near, far) = (
            self.core.grow(0.2 * self.size),
            self.core.grow(1.5 * self.size),
        );
        for i in 0..n {
            out.push(match i % 4 {
                0 => random.point(&near),
                1 => random.point(&far),
                _ => {
                    let s = self.surface[random.index(self.surface.len())];
                    let (d, t) = (random.direction(), random.scale(1e-4, 0.5));
                    along(s, d, t * self.size)
                }
            });
        }
        out
    }

    /// The origin, points of axes, symmetry planes and edges of the box.
    pub fn special(&self) -> Vec<Point> {
        let steps = [-2.0, -1.0, -0.5, 0.0, 0.5, 1.0];
        let (centre, half) = (self.core.centre(), self.core.half());
        let mut out = Vec::new();
        for x in steps {
            for y in steps {
                for z in steps {
                    let s = [x, y, z];
                    out.push(std::array::from_fn(|k| centre[k] + s[k] * half[k]));
                    out.push(std::array::from_fn(|k| s[k] * half[k]));
                }
            }
        }
        out
    }

    /// The crossing between `a` and `b`, of which one is inside and one outside.
    fn bisect(&self, a: Point, b: Point) -> Point {
        let (mut a, mut b) = (a, b);
        let side = self.contains(a);
        for _ in 0..44 {
            let m = std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
            if self.contains(m) == side {
                a = m
            } else {
                b = m
            }
        }
        a
    }

    /// Points of the surface. Where to look is hinted by the value for half of them and by nothing for the other half;
    /// what is found is decided by `contains` alone.
    fn find_surface(&mut self) -> Result<(), Failure> {
        let mut random = self.random(1);
        let window = self.core.grow(0.1 * self.size);
        let mut found = Vec::new();
        for _ in 0..SURFACE / 2 {
            let (a, b) = (random.point(&window), random.point(&window));
            let at = |i: usize| std::array::from_fn(|k| a[k] + (b[k] - a[k]) * i as f64 / 12.0);
            let sides: Vec<bool> = (0..=12).map(|i| self.contains(at(i))).collect();
            if let Some(i) = (0..12).find(|&i| sides[i] != sides[i + 1]) {
                found.push(self.bisect(at(i), at(i + 1)));
            }
        }
        for _ in 0..2 * SURFACE {
            if found.len() >= SURFACE {
                break;
            }
            let mut p = random.point(&window);
            for _ in 0..6 {
                p = along(p, self.upwards(p), -self.value(p) / self.lipschitz);
            }
            let n = self.upwards(p);
            let crossing = (0..9).find_map(|i| {
                let t = self.size * 1e-8 * 8_f64.powi(i);
                let (a, b) = (along(p, n, -t), along(p, n, t));
                (self.contains(a) != self.contains(b)).then_some((a, b))
            });
            if let Some((a, b)) = crossing {
                found.push(self.bisect(a, b));
            }
        }
        if found.len() < SURFACE / 10 {
            return Err(self.fail(
                "sign",
                format!(
                    "only {} points where value and membership meet",
                    found.len()
                ),
            ));
        }
        for &s in &found {
            let n = self.upwards(s);
            for (way, side) in [(-1.0, true), (1.0, false)] {
                let deep = [1e-1, 1e-2, 1e-3, 1e-4].into_iter().find_map(|t| {
                    let p = along(s, n, way * t * self.size);
                    (self.contains(p) == side).then_some(p)
                });
                if let Some(p) = deep {
                    if side {
                        self.inside.push(p)
                    } else {
                        self.outside.push(p)
                    }
                }
            }
        }
        self.surface = found;
        Ok(())
    }
}

/// A finite part of the bounds, and half its longest side.
fn core(bounds: &Aabb) -> (Aabb, f64) {
    let size = (0..3)
        .map(|k| 0.5 * (bounds.max[k] - bounds.min[k]))
        .filter(|h| h.is_finite())
        .fold(0.0, f64::max);
    let size = if size > 0.0 { size } else { 1.5 };
    let mut core = *bounds;
    for k in 0..3 {
        match (bounds.min[k].is_finite(), bounds.max[k].is_finite()) {
            (true, true) => {}
            (true, false) => core.max[k] = core.min[k] + 2.0 * size,
            (false, true) => core.min[k] = core.max[k] - 2.0 * size,
            (false, false) => (core.min[k], core.max[k]) = (-size, size),
        }
    }
    (core, size)
}
