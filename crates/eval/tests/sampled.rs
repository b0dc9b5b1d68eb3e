//! Fields of samples: what they know of themselves holds, on every number type.

use glam::Vec3;
use std::sync::Arc;
use zeroset_catalogue::bounds::{Aabb, Exactness};
use zeroset_eval::{Evaluator, Point};
use zeroset_field::field::Field;
use zeroset_field::program::{Limits, Program};
use zeroset_field::sampled::Sampled;
use zeroset_number::{Dual, F64, Grid, Interval, Vec3 as Point3, v3};

/// Xorshift.
struct Random(u64);

impl Random {
    fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        low + (high - low) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn place(&mut self, reach: f64) -> [f64; 3] {
        [0; 3].map(|_| self.within(-reach, reach))
    }
}

/// Samples of a field over a box that is no cube.
fn sampled(nodes: [u32; 3], field: impl Fn([f64; 3]) -> f64) -> Sampled {
    let bounds = Aabb::new([-1.4, -1.5, -1.6], [1.5, 1.4, 1.7]);
    let at = |k: usize, i: u32| {
        let t = f64::from(i) / f64::from(nodes[k] - 1);
        bounds.min[k] + t * (bounds.max[k] - bounds.min[k])
    };
    let [nx, ny, nz] = nodes;
    let values = (0..nz)
        .flat_map(|k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])))
        .map(|[i, j, k]| field([at(0, i), at(1, j), at(2, k)]) as f32)
        .collect();
    Sampled::new(Arc::new(Grid::new(nodes, values).unwrap()), bounds).unwrap()
}

fn length(p: [f64; 3]) -> f64 {
    p.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn apart(p: [f64; 3], q: [f64; 3]) -> f64 {
    length([0, 1, 2].map(|k| p[k] - q[k]))
}

fn ball(p: [f64; 3]) -> f64 {
    length(p) - 1.0
}

/// Twice as steep as a distance, with a solid that the box cuts.
fn wave(p: [f64; 3]) -> f64 {
    (2.0 * p[0]).sin() + 0.7 * p[1] - 0.4 * p[2]
}

fn program(sampled: Sampled) -> Program {
    let field = Field::sampled(Arc::new(sampled));
    Program::compile(&field, &Limits::default()).unwrap()
}

fn exact(program: &Program, p: [f64; 3]) -> f64 {
    let [x, y, z] = p.map(F64);
    Point::<F64>::new(program.values()).value(v3(x, y, z)).0
}

#[test]
fn a_grid_never_overestimates_and_its_box_holds_the_solid() {
    for (nodes, field) in [
        ([24, 25, 26], ball as fn([f64; 3]) -> f64),
        ([9, 12, 7], wave),
    ] {
        let sampled = sampled(nodes, field);
        let (bounds, slope) = (sampled.bounds(), sampled.slope());
        assert!((0.9..4.0).contains(&slope), "{slope}");
        let program = program(sampled);
        assert_eq!(program.exactness(), Exactness::Bound);
        assert_eq!(program.bounds(), bounds);
        let mut random = Random(3);
        // places on the surface, between places inside and outside
        let mut surface = Vec::new();
        while surface.len() < 300 {
            let (mut inside, mut outside) = (random.place(1.8), random.place(1.8));
            if exact(&program, inside) >= 0.0 || exact(&program, outside) <= 0.0 {
                continue;
            }
            for _ in 0..50 {
                let middle = [0, 1, 2].map(|k| 0.5 * (inside[k] + outside[k]));
                if exact(&program, middle) < 0.0 {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            // a program holds its box in single precision
            assert!(bounds.grow(1e-6).contains(inside), "{inside:?}");
            surface.push(outside);
        }
        for _ in 0..400 {
            let p = random.place(4.0);
            let value = exact(&program, p);
            for q in &surface {
                let distance = apart(p, *q);
                assert!(value.abs() <= distance + 1e-9, "{value} at {p:?}, {q:?}");
            }
            let q = [0, 1, 2].map(|k| p[k] + random.within(-0.1, 0.1));
            let rise = (exact(&program, q) - value).abs();
            assert!(rise <= apart(p, q) + 1e-9, "{rise} from {p:?} to {q:?}");
        }
    }
}

#[test]
fn a_grid_is_the_same_for_every_number() {
    let program = program(sampled([24, 25, 26], ball));
    let mut random = Random(9);
    let places: Vec<[f64; 3]> = (0..500).map(|_| random.place(2.5)).collect();
    let single: Vec<Vec3> = places
        .iter()
        .map(|p| Vec3::from(p.map(|x| x as f32)))
        .collect();
    let (mut values, mut gradients) = (vec![0.0; 500], vec![Vec3::ZERO; 500]);
    Evaluator::new(program.values())
        .gradients(&single, &mut values, &mut gradients)
        .unwrap();
    let point = |p: [f64; 3]| v3(p[0], p[1], p[2]);
    for (k, &p) in places.iter().enumerate() {
        let right = exact(&program, p);
        assert!((f64::from(values[k]) - right).abs() < 1e-5, "{p:?}");
        let [x, y, z] = p.map(F64);
        let dual = Point::<Dual<F64>>::new(program.values()).value(Dual::point(v3(x, y, z)));
        assert_eq!(dual.v.0, right);
        let slope = length(dual.d.map(|d| d.0));
        assert!((0.2..1.0001).contains(&slope), "{slope} at {p:?}");
        // far from the edges of cells, single precision is in the same one
        let off = (0..3).any(|i| (f64::from(gradients[k][i]) - dual.d[i].0).abs() > 1e-3);
        assert!(!off || is_near_an_edge(p), "{p:?}");
        for half in [0.05, 1e-3] {
            let range: Point3<Interval> = point(p).map(|c| Interval::new(c - half, c + half));
            let held = Point::<Interval>::new(program.values()).value(range);
            assert!(held.lo <= right && right <= held.hi, "{held:?} at {p:?}");
        }
    }
}

/// Whether a place lies beside a node along any axis, or beside a side of the box.
fn is_near_an_edge(p: [f64; 3]) -> bool {
    let sampled = sampled([24, 25, 26], ball);
    let (bounds, density) = (sampled.bounds(), sampled.density());
    (0..3).any(|k| {
        let node = (p[k].clamp(bounds.min[k], bounds.max[k]) - bounds.min[k]) * density[k];
        (node - node.round()).abs() < 1e-3
    })
}

#[test]
fn boxes_that_are_none_are_refused() {
    let grid = Arc::new(Grid::new([2; 3], vec![1.0; 8]).unwrap());
    for (low, high) in [(0.0, 0.0), (1.0, -1.0), (f64::NAN, 1.0), (0.0, 1e10)] {
        let bounds = Aabb::new([0.0, low, 0.0], [1.0, high, 1.0]);
        let error = Sampled::new(Arc::clone(&grid), bounds).unwrap_err();
        assert!(error.to_string().contains("its box"), "{error}");
    }
}
