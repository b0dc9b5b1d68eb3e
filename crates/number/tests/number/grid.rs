//! Samples on grids: every number type interpolates the same function, and proofs about it hold.

use crate::support::levels;
use fearless_simd::{Simd, dispatch, prelude::*};
use std::sync::Arc;
use zeroset_number::{
    Args, Argument, Data, Dual, F64, Grid, GridError, Interval, Lanes, Real, Recorder, Slope, Vec3,
    v3, wgsl,
};
use zeroset_testkit::wgsl::Shader;

/// Nodes of the grid, odd on purpose.
const NODES: [u32; 3] = [5, 4, 7];

/// Xorshift.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A place in the grid, or beyond it.
    fn place(&mut self) -> [f64; 3] {
        NODES.map(|n| self.unit() * (f64::from(n) + 1.0) - 1.0)
    }
}

/// A rough grid as number 1, behind one that is never asked for; the parameters say where it is.
fn data() -> Data {
    let mut random = Random(7);
    let count = NODES.iter().product::<u32>() as usize;
    let values = (0..count)
        .map(|_| random.unit() as f32 * 2.0 - 1.0)
        .collect();
    let other = Grid::new([2; 3], vec![9.0; 8]).unwrap();
    Data {
        params: [1.0].into_iter().chain(NODES.map(|n| n as f32)).collect(),
        grids: vec![Arc::new(other), Arc::new(Grid::new(NODES, values).unwrap())],
    }
}

fn vector<T>([x, y, z]: [T; 3]) -> Vec3<T> {
    v3(x, y, z)
}

#[inline(always)]
fn sample<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
    a.sample(0, p)
}

/// Trilinear interpolation as it is defined: the mean of the eight nodes around a place, weighted by the volumes opposite.
fn oracle(grid: &Grid, p: [f64; 3]) -> f64 {
    let mut sum = 0.0;
    for corner in 0..8 {
        let (mut weight, mut node) = (1.0, [0; 3]);
        for axis in 0..3 {
            let most = f64::from(NODES[axis] - 1);
            let held = p[axis].clamp(0.0, most);
            let first = held.floor().min(most - 1.0);
            let far = corner >> axis & 1 == 1;
            let t = held - first;
            weight *= if far { t } else { 1.0 - t };
            node[axis] = first as usize + usize::from(far);
        }
        sum += weight * f64::from(grid.at(node));
    }
    sum
}

#[test]
fn every_number_interpolates() {
    let data = data();
    let mut random = Random(1);
    let places: Vec<[f64; 3]> = (0..500).map(|_| random.place()).collect();
    for p in &places {
        let right = oracle(&data.grids[1], *p);
        let exact = sample(vector(p.map(F64)), Args::new(&data)).0;
        assert!((exact - right).abs() < 1e-13, "{p:?}: {exact}, {right}");
        let single = sample(vector(p.map(|x| x as f32)), Args::new(&data));
        assert!((f64::from(single) - right).abs() < 1e-5, "{p:?}");
    }
    for (name, level) in levels() {
        let found = dispatch!(level, s => lanes(s, &data, &places));
        for (p, found) in places.iter().zip(found) {
            let right = oracle(&data.grids[1], *p);
            assert!((f64::from(found) - right).abs() < 1e-5, "{name} at {p:?}");
        }
    }
}

#[inline(always)]
fn lanes<S: Simd>(s: S, data: &Data, places: &[[f64; 3]]) -> Vec<f32> {
    let mut out = Vec::new();
    for chunk in places.chunks(S::f32s::LEN) {
        let axis = |k: usize| {
            let at = |i: usize| chunk[i.min(chunk.len() - 1)][k] as f32;
            Lanes::<S>(S::f32s::from_fn(s, at))
        };
        let found = sample(v3(axis(0), axis(1), axis(2)), Args::new(data));
        out.extend_from_slice(&found.0.as_slice()[..chunk.len()]);
    }
    out
}

/// Beyond the grid they are those at its nearest place, from within.
#[test]
fn gradients_are_those_of_the_interpolation() {
    let data = data();
    let mut random = Random(2);
    for _ in 0..500 {
        let p = random.place();
        let d = sample(Dual::point(vector(p.map(F64))), Args::new(&data)).d;
        let held: [f64; 3] = std::array::from_fn(|k| p[k].clamp(0.0, f64::from(NODES[k] - 1)));
        for axis in 0..3 {
            let by = 1e-6;
            let (x, last) = (held[axis], f64::from(NODES[axis] - 1));
            let (low, high) = ((x - by).max(0.0), (x + by).min(last));
            let at = |x: f64| {
                let mut q = held;
                q[axis] = x;
                oracle(&data.grids[1], q)
            };
            // not across the border of a cell
            if low.floor() == high.floor() || high == last || low == 0.0 {
                let slope = (at(high) - at(low)) / (high - low);
                assert!((d[axis].0 - slope).abs() < 1e-7, "{p:?} along {axis}");
            }
        }
    }
}

/// Ranges and slopes over boxes of all sizes hold what is found inside, and single cells are not given away.
#[test]
fn ranges_and_slopes_are_proofs() {
    let data = data();
    let grid = &data.grids[1];
    let mut random = Random(3);
    for round in 0..400 {
        let size = [0.05, 0.6, 3.0, 9.0][round % 4];
        let low = random.place();
        let side = |k: usize| Interval::new(low[k], low[k] + size * (0.1 + 0.9 * k as f64 / 2.0));
        let within = v3(side(0), side(1), side(2));
        let range = sample(within, Args::new(&data));
        let slope = sample(Slope::point(within), Args::new(&data));
        let dual = sample(Dual::point(within), Args::new(&data));
        let mut inside = || within.array().map(|c| c.lo + random.unit() * (c.hi - c.lo));
        let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
        for _ in 0..40 {
            let (p, q) = (inside(), inside());
            let (f, g) = (oracle(grid, p), oracle(grid, q));
            (lo, hi) = (lo.min(f), hi.max(f));
            for range in [range, slope.v, dual.v] {
                assert!(range.lo <= f && f <= range.hi, "{f} in {range:?}");
            }
            let way = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
            assert!((f - g).abs() <= slope.l * way + 1e-12, "{slope:?}");
        }
        if size < 0.1 {
            let most = 0.2 + 2.0 * (hi - lo);
            assert!(range.hi - range.lo < most, "{range:?} for {lo} to {hi}");
        }
        let all = grid.values().iter().copied();
        let (least, greatest) = (
            all.clone().fold(f32::INFINITY, f32::min),
            all.fold(f32::NEG_INFINITY, f32::max),
        );
        let hair = 1e-9;
        assert!(f64::from(least) - hair <= range.lo && range.hi <= f64::from(greatest) + hair);
    }
}

/// The recorded function, with the samples where a test can put them: behind the parameters.
#[test]
fn shaders_interpolate() {
    let data = data();
    let recorder = Recorder::new();
    let value = sample(recorder.point("p"), Args::new(&&recorder));
    let arguments = [("p", Argument::Vec3), ("at", Argument::Offset)];
    let function = recorder.function("f", &arguments, &[value]).unwrap();
    let [nx, ny, _] = NODES;
    let source = format!(
        "fn grid_sample(grid: f32, node: vec3f) -> f32 {{
            return params[u32(node.x + {nx}.0 * (node.y + {ny}.0 * node.z)) + 4u];
        }}
        {}",
        wgsl::print(&function)
    );
    let shader = Shader::new(&source);
    let mut params = data.params.clone();
    params.extend(data.grids[1].values());
    let mut random = Random(4);
    for _ in 0..100 {
        let p = random.place();
        let found = shader.call("f", p.map(|x| x as f32), 0, &params)[0];
        let right = oracle(&data.grids[1], p);
        assert!(
            (f64::from(found) - right).abs() < 1e-5,
            "{p:?}: {found}, {right}"
        );
    }
}

#[test]
fn what_is_no_grid_is_refused() {
    assert_eq!(
        Grid::new([1, 4, 4], vec![0.0; 16]),
        Err(GridError::Nodes { nodes: [1, 4, 4] })
    );
    assert_eq!(
        Grid::new([2; 3], vec![0.0; 7]),
        Err(GridError::Count {
            nodes: 8,
            values: 7
        })
    );
    let mut values = vec![0.0; 8];
    values[5] = f32::INFINITY;
    assert!(matches!(
        Grid::new([2; 3], values),
        Err(GridError::Value { at: 5, .. })
    ));
    // a grid that is not there has no value
    let none = Data::from(vec![3.0, 2.0, 2.0, 2.0]);
    assert!(sample(v3(0.5_f32, 0.5, 0.5), Args::new(&none)).is_nan());
    let whole = Vec3::splat(Interval::new(0.0, 1.0));
    assert_eq!(sample(whole, Args::new(&none)), Interval::WHOLE);
}
