//! Fractals by folds: proven bounds.

use super::*;
use zeroset_number::inlined;

/// Menger's sponge.
pub struct Menger;

impl Fractal for Menger {
    const INFO: Info = Info {
        name: "menger",
        doc: "Menger's sponge: a cube of side 2 with square holes in every third of a third.",
        source: "Menger 1926; distance bound after Quilez 2011",
        group: "Fractals",
        dimension: Dimension::Three,
        params: &[number(
            "iterations",
            Unit::Count,
            &[4.0],
            1.0,
            10.0,
            "Generations of holes.",
        )],
    };
    const EXACTNESS: Exactness = Exactness::Bound;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0], &[2.0]];

    #[inline(always)]
    fn limit<R: Real>(a: Args<'_, R>) -> R::Scalar {
        a.get(0)
    }
    /// The point, the distance so far, the size of the holes' grid.
    #[inline(always)]
    fn start<R: Real>(p: Vec3<R>, _a: Args<'_, R>) -> Orbit<R> {
        let q = v3(p.x.abs() - 1.0, p.y.abs() - 1.0, p.z.abs() - 1.0);
        let deepest = q.max_component();
        let cube = R::select(deepest.above(0.0), q.max0().length(), deepest);
        (p, cube, p.x.lit(1.0), p.x.lit(0.0))
    }
    #[inline(always)]
    fn live<R: Real>(orbit: Orbit<R>, _a: Args<'_, R>) -> R::Mask {
        orbit.2.above(0.0)
    }
    #[inline(always)]
    fn step<R: Real>(p: Vec3<R>, (_, d, scale, _): Orbit<R>, _a: Args<'_, R>) -> Orbit<R> {
        // |a| is the distance from the nearest centre of a cell of side 2 / scale, in half cells: a continuous wave
        let wave = inlined(
            #[inline(always)]
            |x: R| {
                let u = (x * scale + 1.0) * 0.5;
                ((u - u.floor()) * 2.0 - 1.0).abs()
            },
        );
        let w = v3(wave(p.x), wave(p.y), wave(p.z));
        let r = v3(
            (w.x * -3.0 + 1.0).abs(),
            (w.y * -3.0 + 1.0).abs(),
            (w.z * -3.0 + 1.0).abs(),
        );
        let next = scale * 3.0;
        // inside the three bars of a cell, two of the three waves are below a third
        let inside = v3(-(w.x * 3.0) + 1.0, -(w.y * 3.0) + 1.0, -(w.z * 3.0) + 1.0);
        let bars = (inside.x.min(inside.y))
            .max(inside.y.min(inside.z))
            .max(inside.z.min(inside.x));
        (r, d.max(bars / next), next, r.length())
    }
    #[inline(always)]
    fn end<R: Real>(_p: Vec3<R>, orbit: Orbit<R>, _a: Args<'_, R>) -> R {
        orbit.1
    }
    fn bounds(_a: &[f64]) -> Aabb {
        ball(1.0)
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        if p.iter().any(|x| x.abs() > 1.0) {
            return false;
        }
        // the thirds of a coordinate are its digits to base 3
        let mut digits = p.map(|x| 0.5 * (x + 1.0));
        for _ in 0..a[0] as u32 {
            digits = digits.map(|x| 3.0 * x);
            if digits.iter().filter(|x| x.floor() == 1.0).count() >= 2 {
                return false;
            }
            digits = digits.map(|x| x - x.floor().min(2.0));
        }
        true
    }
}

/// Sierpinski's tetrahedron.
pub struct Sierpinski;

const CORNERS: [[f64; 3]; 4] = [
    [1.0, 1.0, 1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, -1.0],
    [-1.0, 1.0, -1.0],
];

impl Fractal for Sierpinski {
    const INFO: Info = Info {
        name: "sierpinski",
        doc: "Sierpinski's tetrahedron: four copies of half its size, again and again, in a cube of side 2.",
        source: "Sierpinski 1915; by reflections",
        group: "Fractals",
        dimension: Dimension::Three,
        params: &[number(
            "iterations",
            Unit::Count,
            &[6.0],
            1.0,
            14.0,
            "Generations of copies.",
        )],
    };
    const EXACTNESS: Exactness = Exactness::Bound;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0], &[3.0]];

    #[inline(always)]
    fn limit<R: Real>(a: Args<'_, R>) -> R::Scalar {
        a.get(0)
    }
    #[inline(always)]
    fn start<R: Real>(p: Vec3<R>, _a: Args<'_, R>) -> Orbit<R> {
        (p, p.x.lit(0.0), p.x.lit(1.0), p.x.lit(0.0))
    }
    #[inline(always)]
    fn live<R: Real>(orbit: Orbit<R>, _a: Args<'_, R>) -> R::Mask {
        orbit.2.above(0.0)
    }
    #[inline(always)]
    fn step<R: Real>(_p: Vec3<R>, (z, _, scale, _): Orbit<R>, _a: Args<'_, R>) -> Orbit<R> {
        // reflections that bring the nearest corner to (1, 1, 1)
        let fold = inlined(
            #[inline(always)]
            |u: R, v: R| {
                let m = (u + v).min(0.0);
                (u - m, v - m)
            },
        );
        let (x, y) = fold(z.x, z.y);
        let (x, w) = fold(x, z.z);
        let (y, w) = fold(y, w);
        let next = v3(x * 2.0 - 1.0, y * 2.0 - 1.0, w * 2.0 - 1.0);
        (next, z.x.lit(0.0), scale * 2.0, z.x.lit(0.0))
    }
    #[inline(always)]
    fn end<R: Real>(_p: Vec3<R>, (z, _, scale, _): Orbit<R>, _a: Args<'_, R>) -> R {
        let faces = (-z.x - z.y - z.z)
            .max(z.x + z.y - z.z)
            .max(z.y + z.z - z.x)
            .max(z.x + z.z - z.y);
        (faces - 1.0) * R::constant(0.577_350_269_189_625_8) / scale
    }
    fn bounds(_a: &[f64]) -> Aabb {
        ball(1.0)
    }
    /// Beyond a corner the nearest face is sqrt(3) times nearer than the corner is along an axis.
    fn level_bounds(_a: &[f64], level: f64) -> Aabb {
        ball(1.0 + 1.733 * level)
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        let [x, y, z] = p;
        let inside = [-x - y - z, x + y - z, y + z - x, x + z - y]
            .iter()
            .all(|f| *f <= 1.0);
        if !inside || a[0] < 1.0 {
            return inside;
        }
        let copies = CORNERS
            .iter()
            .map(|c| std::array::from_fn(|k| 2.0 * p[k] - c[k]));
        copies
            .into_iter()
            .any(|q| <Self as Fractal>::contains(&[a[0] - 1.0], q))
    }
}

/// A kaleidoscopic iterated function system.
pub struct Kaleidoscope;

impl Kaleidoscope {
    fn turn([x, y, z]: [f64; 3], a: &[f64]) -> [f64; 3] {
        let ((s, c), (t, d)) = (a[2].sin_cos(), a[3].sin_cos());
        let (x, y) = (c * x - s * y, s * x + c * y);
        let (y, z) = (d * y - t * z, t * y + d * z);
        [x, y, z]
    }
}

impl Fractal for Kaleidoscope {
    const INFO: Info = Info {
        name: "kaleidoscope",
        doc: "A kaleidoscopic iterated function system: fold into an eighth and a sixth of space, turn, scale, again.",
        source: "Knighty 2010",
        group: "Fractals",
        dimension: Dimension::Three,
        params: &[
            number(
                "iterations",
                Unit::Count,
                &[8.0],
                1.0,
                24.0,
                "Steps of folding, turning and scaling.",
            ),
            number(
                "factor",
                Unit::Ratio,
                &[2.0],
                1.1,
                4.0,
                "How much every step scales.",
            ),
            number(
                "twist",
                Unit::Angle,
                &[0.3],
                -7.0,
                7.0,
                "Turn about z before every step's scaling.",
            ),
            number(
                "tilt",
                Unit::Angle,
                &[0.2],
                -7.0,
                7.0,
                "Turn about x before every step's scaling.",
            ),
            vec3(
                "offset",
                Unit::Length,
                &[1.0, 0.6, 0.3],
                -4.0,
                4.0,
                "The corner that every step scales about.",
            ),
        ],
    };
    const EXACTNESS: Exactness = Exactness::Bound;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[3.0, 1.6, 0.0, 0.0, 1.0, 1.0, 1.0],
        &[4.0, 1.7, -0.4, 0.5, 1.0, 0.4, 0.5],
    ];

    #[inline(always)]
    fn limit<R: Real>(a: Args<'_, R>) -> R::Scalar {
        a.get(0)
    }
    #[inline(always)]
    fn start<R: Real>(p: Vec3<R>, _a: Args<'_, R>) -> Orbit<R> {
        (p, p.x.lit(0.0), p.x.lit(1.0), p.x.lit(0.0))
    }
    #[inline(always)]
    fn live<R: Real>(orbit: Orbit<R>, _a: Args<'_, R>) -> R::Mask {
        orbit.2.above(0.0)
    }
    #[inline(always)]
    fn step<R: Real>(_p: Vec3<R>, (z, _, scale, _): Orbit<R>, a: Args<'_, R>) -> Orbit<R> {
        let q = z.abs();
        // largest first: reflections at the planes between the axes
        let sort = inlined(
            #[inline(always)]
            |u: R, v: R| {
                let swap = u.below(v);
                (R::select(swap, v, u), R::select(swap, u, v))
            },
        );
        let (x, y) = sort(q.x, q.y);
        let (x, w) = sort(x, q.z);
        let (y, w) = sort(y, w);
        let ((s, c), (t, d)) = (a.get(2).sin_cos(), a.get(3).sin_cos());
        let (x, y) = (x * c - y * s, x * s + y * c);
        let (y, w) = (y * d - w * t, y * t + w * d);
        let k = a.get(1) - 1.0;
        let next = v3(
            x * a.get(1) - a.get(4) * k,
            y * a.get(1) - a.get(5) * k,
            w * a.get(1) - a.get(6) * k,
        );
        (next, z.x.lit(0.0), scale * a.get(1), z.x.lit(0.0))
    }
    #[inline(always)]
    fn end<R: Real>(_p: Vec3<R>, (z, _, scale, _): Orbit<R>, _a: Args<'_, R>) -> R {
        (z.length() - 1.0) / scale
    }
    /// Folds and turns keep the length and a step maps |z| to at least `s |z| - (s - 1) |offset|`: an orbit that ends in
    /// the unit ball began within `|offset| + s^-n`.
    fn bounds(a: &[f64]) -> Aabb {
        let offset = (a[4] * a[4] + a[5] * a[5] + a[6] * a[6]).sqrt();
        ball(offset + a[1].powf(-a[0]))
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        let mut z = p;
        for _ in 0..a[0] as u32 {
            z = z.map(f64::abs);
            z.sort_by(|x, y| y.total_cmp(x));
            let q = Self::turn(z, a);
            z = std::array::from_fn(|k| a[1] * q[k] - a[4 + k] * (a[1] - 1.0));
        }
        z.iter().map(|x| x * x).sum::<f64>() <= 1.0
    }
}
