use super::*;
use fearless_simd::{Level, Simd, dispatch, prelude::*};
use zeroset_number::{Args, Argument, Dual, Expr, F64, Interval, Lanes, Recorder, wgsl};

struct Random(u64);

impl Random {
    fn within(&mut self, lo: f64, hi: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        lo + (hi - lo) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn point(&mut self, reach: f64) -> [f64; 3] {
        std::array::from_fn(|_| self.within(-reach, reach))
    }
}

fn number(p: [f64; 3]) -> Vec3<F64> {
    v3(F64(p[0]), F64(p[1]), F64(p[2]))
}

fn gradient(f: impl Fn(Vec3<Dual<F64>>) -> Dual<F64>, p: [f64; 3]) -> (f64, f64) {
    let d = f(Dual::point(number(p)));
    let [x, y, z] = d.d.map(|x| x.0);
    (d.v.0, (x * x + y * y + z * z).sqrt())
}

/// Smallest and largest value and largest slope over many points; none outside what is stated.
fn survey(
    f: impl Fn(Vec3<Dual<F64>>) -> Dual<F64>,
    range: (f64, f64),
    slope: f64,
    n: usize,
) -> (f64, f64, f64) {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let (mut lo, mut hi, mut steepest) = (f64::INFINITY, f64::NEG_INFINITY, 0f64);
    for _ in 0..n {
        let p = random.point(150.0);
        let (v, s) = gradient(&f, p);
        assert!(range.0 <= v && v <= range.1, "{v} at {p:?}");
        assert!(s <= slope * (1.0 + 1e-9), "slope {s} at {p:?}");
        (lo, hi, steepest) = (lo.min(v), hi.max(v), steepest.max(s));
    }
    (lo, hi, steepest)
}

#[test]
fn value_noise_keeps_its_range_and_slope() {
    let (lo, hi, slope) = survey(value_noise, ValueNoise::RANGE, ValueNoise::SLOPE, 1_000_000);
    assert!(
        lo < -0.95 && hi > 0.95 && slope > 0.85 * ValueNoise::SLOPE,
        "{lo} {hi} {slope}"
    );
}

#[test]
fn gradient_noise_keeps_its_range_and_slope() {
    let (lo, hi, slope) = survey(
        gradient_noise,
        GradientNoise::RANGE,
        GradientNoise::SLOPE,
        1_000_000,
    );
    assert!(
        lo < -0.7 && hi > 0.7 && slope > 0.6 * GradientNoise::SLOPE,
        "{lo} {hi} {slope}"
    );
}

#[test]
fn cellular_noise_keeps_its_range_and_slope() {
    let (lo, hi, slope) = survey(
        cellular_noise,
        CellularNoise::RANGE,
        CellularNoise::SLOPE,
        300_000,
    );
    assert!(lo < 0.05 && hi == 1.0 && slope > 0.999, "{lo} {hi} {slope}");
}

#[test]
fn fractal_sums_keep_their_range_and_slope() {
    let sum = |octaves: f64, lacunarity: f64, gain: f64| {
        let f = move |p: Vec3<Dual<F64>>| {
            fbm::<GradientNoise, _>(p, F64(octaves), F64(lacunarity), F64(gain))
        };
        let slope = fbm_slope::<GradientNoise>(octaves, lacunarity, gain);
        let (_, _, steepest) = survey(f, GradientNoise::RANGE, slope, 60_000);
        assert!(steepest > 0.25 * slope, "{steepest} of {slope}");
    };
    sum(1.0, 2.0, 0.5);
    sum(4.0, 2.0, 0.5);
    sum(5.0, 2.3, 0.4);
    assert_eq!(fbm_slope::<ValueNoise>(4.0, 2.0, 0.5), 3.75 * 4.0 / 1.875);
}

/// Near pairs, mostly across the faces of cells: the noises are continuous and the gradients tell the truth.
#[test]
fn no_jump_at_the_faces_of_cells() {
    fn pairs<N: Noise>() {
        let mut random = Random(77);
        for i in 0..40_000 {
            let mut p = random.point(20.0);
            p[i % 3] = p[i % 3].round();
            let h = 10f64.powf(random.within(-9.0, -1.0));
            let q: [f64; 3] = std::array::from_fn(|k| p[k] + random.within(-h, h));
            let p: [f64; 3] = std::array::from_fn(|k| p[k] + random.within(-h, h));
            let apart = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
            let (a, b) = (N::noise(number(p)).0, N::noise(number(q)).0);
            assert!(
                (a - b).abs() <= N::SLOPE * apart + 1e-13,
                "{}: {a} at {p:?}, {b} at {q:?}",
                N::NAME
            );
        }
    }
    pairs::<ValueNoise>();
    pairs::<GradientNoise>();
    pairs::<CellularNoise>();
}

/// The slope of value noise is the least that can be stated: corners of -1 and 1 reach it and nothing passes it.
#[test]
fn value_slope_is_the_least() {
    let mut steepest = 0f64;
    for signs in 0..256u32 {
        for i in 0..1000 {
            let x = [i % 10, i / 10 % 10, i / 100].map(|k| f64::from(k) / 18.0);
            let x = Dual::point(number(x));
            let h = std::array::from_fn(|c| x.x.lit(if signs >> c & 1 == 1 { 1.0 } else { -1.0 }));
            let d = interpolate(x, h).d.map(|x| x.0);
            steepest = steepest.max(d.iter().map(|d| d * d).sum::<f64>().sqrt());
        }
    }
    assert!((steepest - ValueNoise::SLOPE).abs() < 1e-12, "{steepest}");
}

/// The maxima that the derivation takes from the fade.
#[test]
fn constants_of_the_derivation() {
    let (mut b_most, mut c_most, mut slope) = (0f64, 0f64, 0f64);
    for i in 1..50_000 {
        // all three are symmetric about 1/2, and 1 - f would cancel near 1
        let x = f64::from(i) / 100_000.0;
        let f = x * x * x * ((x * 6.0 - 15.0) * x + 10.0);
        let df = 30.0 * x * x * (1.0 - x) * (1.0 - x);
        let g = 1.0 - f;
        let b = df * df / (f * g);
        let c = g * x * x + f * (1.0 - x) * (1.0 - x);
        let a = f * (1.0 - df / f * (1.0 - x)).powi(2) + g * (1.0 - df / g * x).powi(2);
        (b_most, c_most, slope) = (b_most.max(b), c_most.max(c), slope.max(a + b / 2.0));
    }
    assert!((14.06..=14.0625).contains(&b_most) && (0.2499..=0.25).contains(&c_most));
    let slope = slope.sqrt() * 2.0 / 3f64.sqrt();
    assert!(
        (slope - GradientNoise::SLOPE).abs() < 2e-5 && slope <= GradientNoise::SLOPE,
        "{slope}"
    );
}

/// All noises at a point, for comparing number types.
#[inline(always)]
fn all<R: Real>(p: Vec3<R>) -> [R; 4] {
    let sum = fbm::<ValueNoise, R>(p, R::constant(4.0), R::constant(2.0), R::constant(0.5));
    [value_noise(p), gradient_noise(p), cellular_noise(p), sum]
}

#[test]
fn number_types_agree() {
    #[inline(always)]
    fn lanes<S: Simd>(s: S, points: &[[f32; 3]]) -> Vec<[f32; 4]> {
        let mut out = Vec::new();
        for chunk in points.chunks(S::f32s::LEN) {
            let axis =
                |k: usize| Lanes::<S>(S::f32s::from_fn(s, |i| chunk[i.min(chunk.len() - 1)][k]));
            let v = all(v3(axis(0), axis(1), axis(2)));
            out.extend((0..chunk.len()).map(|i| v.map(|v| v.0.as_slice()[i])));
        }
        out
    }
    let mut random = Random(5);
    let points: Vec<[f32; 3]> = (0..20_000)
        .map(|i| {
            let p = random.point(10.0).map(|x| x as f32);
            if i % 7 == 0 { p.map(f32::round) } else { p }
        })
        .collect();
    let level = Level::new();
    let wide = dispatch!(level, s => lanes(s, &points));
    for (p, wide) in points.iter().zip(wide) {
        let exact = all(number(p.map(f64::from)));
        let single = all(v3(p[0], p[1], p[2]));
        for k in 0..4 {
            for v in [wide[k], single[k]] {
                // the fractal sum reads the noise at 8 times the coordinates
                assert!(
                    (f64::from(v) - exact[k].0).abs() < 3e-5,
                    "noise {k} at {p:?}: {v}, {:?}",
                    exact[k]
                );
            }
        }
    }
}

#[test]
fn ranges_over_boxes_hold_all_values() {
    let mut random = Random(11);
    let (mut small, mut narrow) = (0, 0);
    for _ in 0..2000 {
        let (p, half) = (random.point(10.0), 10f64.powf(random.within(-4.0, 0.5)));
        let side = |k: usize| Interval::new(p[k] - half, p[k] + half);
        let range = all(v3(side(0), side(1), side(2)));
        for _ in 0..8 {
            let q = p.map(|x| x + random.within(-half, half));
            for (v, r) in all(number(q)).into_iter().zip(range) {
                assert!(
                    r.lo - 1e-12 <= v.0 && v.0 <= r.hi + 1e-12,
                    "{v:?} at {q:?}, {r:?}"
                );
            }
        }
        let widest = range[..3].iter().map(|r| r.hi - r.lo).fold(0.0, f64::max);
        small += usize::from(half < 1e-2);
        narrow += usize::from(half < 1e-2 && widest <= 14.0 * half);
    }
    assert!(
        narrow == small && small > 500,
        "{narrow} narrow ranges over {small} small boxes"
    );
}

fn sum<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
    fbm::<GradientNoise, _>(p, a.get(0), a.get(1), a.get(2))
}

#[test]
fn shaders_are_valid() {
    let signature = [("p", Argument::Vec3), ("at", Argument::Offset)];
    let print = |name: &str, recorder: &Recorder, results: &[Expr<'_>]| {
        let function = recorder.function(name, &signature, results);
        wgsl::print(&function.unwrap_or_else(|e| panic!("{e}")))
    };
    let recorder = Recorder::new();
    let value = print("value", &recorder, &all(recorder.point("p")));
    let recorder = Recorder::new();
    let d = sum(Dual::point(recorder.point("p")), Args::new(&&recorder));
    let gradient = print("gradient", &recorder, &[d.d[0], d.d[1], d.d[2], d.v]);
    let head = "@group(0) @binding(0) var<storage, read> params: array<f32>;\n";
    let source = format!("{head}{value}{gradient}");
    let module = naga::front::wgsl::parse_str(&source)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(&source)));
    naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::empty(),
    )
    .validate(&module)
    .unwrap_or_else(|e| panic!("{}", e.emit_to_string(&source)));
    assert_eq!(
        value.matches("for (").count(),
        2,
        "cellular noise and the sum stay loops"
    );
}
