//! Randomness, and the exact shapes that operators are tried on: alone, touching, parallel, opposed and coincident.

use zeroset_catalogue::bounds::{Aabb, Exactness};

pub type Point = [f64; 3];

/// Xorshift.
pub struct Random(u64);

impl Random {
    /// From a name and some numbers alone.
    pub fn new(name: &str, numbers: &[f64], salt: u64) -> Self {
        let bytes = name
            .bytes()
            .map(u64::from)
            .chain(numbers.iter().map(|x| x.to_bits()));
        let hash = bytes.fold(0xcbf2_9ce4_8422_2325 ^ salt, |h, b| {
            (h ^ b).wrapping_mul(0x100_0000_01b3)
        });
        let mut random = Random(hash | 1);
        (0..8).for_each(|_| {
            random.unit();
        });
        random
    }

    /// Uniform in 0..1.
    pub fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn within(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// Uniform in the logarithm.
    pub fn scale(&mut self, lo: f64, hi: f64) -> f64 {
        self.within(lo.ln(), hi.ln()).exp()
    }

    pub fn sign(&mut self) -> f64 {
        if self.unit() < 0.5 { -1.0 } else { 1.0 }
    }

    /// Any sign, any size between tiny and `hi`.
    pub fn signed(&mut self, hi: f64) -> f64 {
        self.sign()
            * if self.unit() < 0.5 {
                self.within(0.0, hi)
            } else {
                self.scale(1e-4 * hi, hi)
            }
    }

    /// A unit vector, uniform over the sphere; every fourth along an axis.
    pub fn direction(&mut self) -> Point {
        if self.unit() < 0.25 {
            let (k, s) = ((self.unit() * 3.0) as usize, self.sign());
            return std::array::from_fn(|i| if i == k { s } else { 0.0 });
        }
        loop {
            let v: Point = std::array::from_fn(|_| self.within(-1.0, 1.0));
            let r = length(v);
            if r > 0.1 && r <= 1.0 {
                return v.map(|x| x / r);
            }
        }
    }

    pub fn point(&mut self, b: &Aabb) -> Point {
        std::array::from_fn(|k| self.within(b.min[k], b.max[k]))
    }
}

pub fn length(v: Point) -> f64 {
    v[0].hypot(v[1]).hypot(v[2])
}

pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `p + t d`.
pub fn along(p: Point, d: Point, t: f64) -> Point {
    std::array::from_fn(|k| p[k] + t * d[k])
}

/// The part of a box that lies in the window where shapes are tried.
pub fn window(b: &Aabb, half: f64) -> Aabb {
    b.intersect(&Aabb::centred([half; 3]))
}

/// Gradient by central differences.
pub fn gradient(f: &dyn Fn(Point) -> f64, p: Point) -> Point {
    let h = 1e-6;
    std::array::from_fn(|k| {
        let (mut a, mut b) = (p, p);
        a[k] += h;
        b[k] -= h;
        (f(a) - f(b)) / (2.0 * h)
    })
}

/// A shape whose distance is exact, or is exact outside.
#[derive(Clone, Debug)]
pub enum Shape {
    Ball {
        c: Point,
        r: f64,
    },
    /// All with `n . p <= d`.
    Half {
        n: Point,
        d: f64,
    },
    /// A box whose rows are turned.
    Brick {
        c: Point,
        rows: [Point; 3],
        half: Point,
    },
    /// A 2D disc.
    Disc {
        c: [f64; 2],
        r: f64,
    },
    /// A 2D rectangle.
    Rectangle {
        c: [f64; 2],
        half: [f64; 2],
    },
    /// A union, which is exact outside only.
    Two(Box<Shape>, Box<Shape>),
}
use Shape::*;

fn box_distance<const N: usize>(q: [f64; N]) -> f64 {
    let outside = q.iter().map(|x| x.max(0.0).powi(2)).sum::<f64>().sqrt();
    outside + q.iter().copied().fold(f64::NEG_INFINITY, f64::max).min(0.0)
}

impl Shape {
    pub fn value(&self, p: Point) -> f64 {
        match self {
            Ball { c, r } => length([p[0] - c[0], p[1] - c[1], p[2] - c[2]]) - r,
            Half { n, d } => dot(*n, p) - d,
            Brick { c, rows, half } => {
                let q = along(p, *c, -1.0);
                box_distance::<3>(std::array::from_fn(|i| dot(rows[i], q).abs() - half[i]))
            }
            Disc { c, r } => (p[0] - c[0]).hypot(p[1] - c[1]) - r,
            Rectangle { c, half } => {
                box_distance::<2>(std::array::from_fn(|k| (p[k] - c[k]).abs() - half[k]))
            }
            Two(x, y) => x.value(p).min(y.value(p)),
        }
    }

    pub fn bounds(&self) -> Aabb {
        let flat = |c: &[f64; 2], h: [f64; 2]| {
            let far = f64::INFINITY;
            Aabb::new(
                [c[0] - h[0], c[1] - h[1], -far],
                [c[0] + h[0], c[1] + h[1], far],
            )
        };
        let solid = |c: &Point, h: Point| Aabb::new(along(*c, h, -1.0), along(*c, h, 1.0));
        match self {
            Ball { c, r } => solid(c, [*r; 3]),
            Half { n, d } => {
                let mut b = Aabb::WHOLE;
                for (k, n) in n.iter().enumerate() {
                    if *n == 1.0 {
                        b.max[k] = *d;
                    } else if *n == -1.0 {
                        b.min[k] = -d;
                    }
                }
                b
            }
            Brick { c, rows, half } => solid(
                c,
                std::array::from_fn(|k| (0..3).map(|i| rows[i][k].abs() * half[i]).sum()),
            ),
            Disc { c, r } => flat(c, [*r; 2]),
            Rectangle { c, half } => flat(c, *half),
            Two(x, y) => x.bounds().hull(&y.bounds()),
        }
    }

    pub fn exactness(&self) -> Exactness {
        if matches!(self, Two(..)) {
            Exactness::Outside
        } else {
            Exactness::Exact
        }
    }

    pub fn centre(&self) -> Point {
        match self {
            Ball { c, .. } | Brick { c, .. } => *c,
            Half { n, d } => n.map(|x| x * d),
            Disc { c, .. } | Rectangle { c, .. } => [c[0], c[1], 0.0],
            Two(x, _) => x.centre(),
        }
    }

    pub fn ball(random: &mut Random, spread: f64) -> Shape {
        Ball {
            c: std::array::from_fn(|_| random.within(-spread, spread)),
            r: random.within(0.2, 0.8),
        }
    }

    pub fn brick(random: &mut Random, spread: f64) -> Shape {
        let n = random.direction();
        let side = along(random.direction(), [0.3, 0.5, 0.7], 1.0);
        let t = along(side, n, -dot(side, n));
        let u = t.map(|x| x / length(t));
        let v = [
            n[1] * u[2] - n[2] * u[1],
            n[2] * u[0] - n[0] * u[2],
            n[0] * u[1] - n[1] * u[0],
        ];
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Brick {
            c: std::array::from_fn(|_| random.within(-spread, spread)),
            rows: if random.unit() < 0.5 {
                identity
            } else {
                [n, u, v]
            },
            half: std::array::from_fn(|_| random.within(0.15, 0.7)),
        }
    }

    pub fn half(random: &mut Random) -> Shape {
        Half {
            n: random.direction(),
            d: random.within(-0.5, 0.5),
        }
    }

    /// A bounded solid.
    pub fn solid(random: &mut Random, spread: f64) -> Shape {
        if random.unit() < 0.5 {
            Shape::ball(random, spread)
        } else {
            Shape::brick(random, spread)
        }
    }

    /// A bounded 2D shape.
    pub fn flat(random: &mut Random, spread: f64) -> Shape {
        let c = std::array::from_fn(|_| random.within(-spread, spread));
        if random.unit() < 0.5 {
            Disc {
                c,
                r: random.within(0.2, 0.8),
            }
        } else {
            Rectangle {
                c,
                half: std::array::from_fn(|_| random.within(0.15, 0.7)),
            }
        }
    }
}

/// Pairs in general position and in all the special ones.
pub fn pairs(random: &mut Random) -> Vec<(Shape, Shape)> {
    let mut out = Vec::new();
    for _ in 0..3 {
        out.push((Shape::solid(random, 0.5), Shape::solid(random, 0.5)));
        out.push((Shape::solid(random, 0.5), Shape::half(random)));
        out.push((Shape::half(random), Shape::solid(random, 0.5)));
        out.push((Shape::half(random), Shape::half(random)));
    }
    let n = random.direction();
    let half = |s: f64, d: f64| Half {
        n: n.map(|x| x * s),
        d,
    };
    // parallel, a step, a slab, a gap
    out.extend([
        (half(1.0, 0.2), half(1.0, 0.1)),
        (half(1.0, 0.2), half(-1.0, 0.1)),
        (half(1.0, -0.2), half(-1.0, -0.1)),
    ]);
    out.push((half(1.0, 0.0), half(-1.0, 0.0)));
    out.push((
        Half {
            n: [1.0, 0.0, 0.0],
            d: 0.0,
        },
        Half {
            n: [0.0, 1.0, 0.0],
            d: 0.0,
        },
    ));
    let ball = |x: f64, r: f64| Ball {
        c: n.map(|c| c * x),
        r,
    };
    // touching from outside, from inside, concentric, apart, a ball on a plane
    out.extend([
        (ball(-0.5, 0.5), ball(0.3, 0.3)),
        (ball(0.0, 0.8), ball(0.5, 0.3)),
        (ball(0.0, 0.8), ball(0.0, 0.5)),
    ]);
    out.extend([
        (ball(-0.9, 0.5), ball(0.9, 0.4)),
        (ball(0.5, 0.5), half(1.0, 0.0)),
        (half(-1.0, 0.0), ball(0.5, 0.5)),
    ]);
    let same = Shape::solid(random, 0.3);
    out.extend([(ball(0.1, 0.7), ball(0.1, 0.7)), (same.clone(), same)]);
    // inside these the value is a bound
    let two = Two(Box::new(ball(-0.4, 0.6)), Box::new(ball(0.3, 0.7)));
    out.push((two.clone(), Shape::solid(random, 0.5)));
    out.extend([(two.clone(), ball(0.0, 1.2)), (half(1.0, 1.0), two)]);
    out
}

/// Places where a field is small or its shape reaches farthest: found by descending to the surface from random starts,
/// and by going along the axes as long as the value stays below `level`.
pub fn reached(f: &dyn Fn(Point) -> f64, level: f64, starts: &[Point], half: f64) -> Vec<Point> {
    let mut inside = Vec::new();
    for &start in starts {
        let mut p = start;
        for _ in 0..6 {
            let g = gradient(f, p);
            let steep = dot(g, g);
            if f(p) <= level || steep < 1e-3 {
                break;
            }
            p = along(p, g, -(f(p) - level) / steep - 1e-9);
        }
        if f(p) <= level && p.iter().all(|x| x.abs() <= half) {
            inside.push(p);
        }
    }
    let mut out = inside.clone();
    for (i, &p) in inside.iter().enumerate() {
        let mut d = [0.0; 3];
        d[i % 3] = if i / 3 % 2 == 0 { 1.0 } else { -1.0 };
        let (mut a, mut b) = (0.0, half);
        for _ in 0..20 {
            let t = 0.5 * (a + b);
            if f(along(p, d, t)) <= level {
                a = t
            } else {
                b = t
            }
        }
        out.push(along(p, d, a));
    }
    out
}

/// A place a hair from `p`, which may be one of no gradient.
pub fn beside(p: Point) -> Point {
    along(p, [1e-3, 2e-3, -1e-3], 1.0)
}

/// Whether a box is made of numbers.
pub fn is_sound(b: &Aabb) -> bool {
    b.min.iter().chain(&b.max).all(|x| !x.is_nan())
}
