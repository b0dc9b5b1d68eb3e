//! How fast meshes are sampled, as a ratio of what was measured in one run: all cores and their SIMD lanes against a plain hierarchy
//! of boxes that one thread asks for each node by itself.
//!
//! `cargo run --release -p zeroset-volume --example against_plain [-- FILE [VOXELS]]`; a knot without a file.

use cpu_time::ProcessTime;
use std::error::Error;
use std::time::Instant;
use zeroset_volume::bake::{Alone, Bake};
use zeroset_volume::check::mend;
use zeroset_volume::mesh::{Mesh, MeshLimits};
use zeroset_volume::read::{MeshFormat, nothing_beside, read};

type Point = [f32; 3];

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
fn dot(a: Point, b: Point) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The squared distance from a triangle (Ericson 2005, section 5.1.5).
fn distance2(p: Point, [a, b, c]: [Point; 3]) -> f32 {
    let off = |q: Point| dot(sub(p, q), sub(p, q));
    let along = |a: Point, e: Point, t: f32| [a[0] + t * e[0], a[1] + t * e[1], a[2] + t * e[2]];
    let (ab, ac, ap) = (sub(b, a), sub(c, a), sub(p, a));
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return off(a);
    }
    let bp = sub(p, b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return off(b);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return off(along(a, ab, d1 / (d1 - d3)));
    }
    let cp = sub(p, c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return off(c);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return off(along(a, ac, d2 / (d2 - d6)));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return off(along(b, sub(c, b), (d4 - d3) / ((d4 - d3) + (d5 - d6))));
    }
    let all = va + vb + vc;
    off(along(along(a, ab, vb / all), ac, vc / all))
}

/// Boxes of boxes: halved at the middle face along the longest side.
struct Plain {
    nodes: Vec<(Point, Point, usize, usize)>,
    faces: Vec<[Point; 3]>,
}

impl Plain {
    fn new(mesh: &Mesh) -> Plain {
        let faces = (0..mesh.faces().len()).map(|i| mesh.corners(i)).collect();
        let mut plain = Plain {
            nodes: Vec::new(),
            faces,
        };
        plain.build(0, plain.faces.len());
        plain
    }

    /// A node over the faces from `first` to before `last`; leaves name their faces, others the second of their two nodes.
    fn build(&mut self, first: usize, last: usize) {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for p in self.faces[first..last].iter().flatten() {
            for k in 0..3 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        let at = self.nodes.len();
        self.nodes.push((low, high, first, last));
        if last - first <= 4 {
            return;
        }
        let longest = |a: &usize, b: &usize| (high[*a] - low[*a]).total_cmp(&(high[*b] - low[*b]));
        let k = (0..3).max_by(longest).unwrap_or(0);
        let middle = |t: &[Point; 3]| t[0][k] + t[1][k] + t[2][k];
        let half = (last - first) / 2;
        self.faces[first..last]
            .select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
        self.build(first, first + half);
        let right = self.nodes.len();
        self.build(first + half, last);
        self.nodes[at].2 = right;
        self.nodes[at].3 = 0;
    }

    fn apart2(&self, node: usize, p: Point) -> f32 {
        let (low, high, ..) = &self.nodes[node];
        let away = |k: usize| (low[k] - p[k]).max(p[k] - high[k]).max(0.0);
        let d = [away(0), away(1), away(2)];
        dot(d, d)
    }

    fn nearest2(&self, p: Point) -> f32 {
        let mut best = f32::INFINITY;
        let mut todo = [(0, 0.0); 64];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (at, d) = todo[height];
            let (_, _, first, last) = self.nodes[at];
            if d >= best {
                continue;
            }
            if last > 0 {
                for t in &self.faces[first..last] {
                    best = best.min(distance2(p, *t));
                }
                continue;
            }
            let (l, r) = (
                (at + 1, self.apart2(at + 1, p)),
                (first, self.apart2(first, p)),
            );
            (todo[height], todo[height + 1]) = if l.1 < r.1 { (r, l) } else { (l, r) };
            height += 2;
        }
        best
    }
}

/// A tube along a torus knot: 80,000 faces.
fn knot() -> Result<Mesh, Box<dyn Error>> {
    let (around, across) = (2000_u32, 20_u32);
    let turn = |i: u32, n: u32| std::f32::consts::TAU * (i % n) as f32 / n as f32;
    let mut points = Vec::new();
    let mut faces = Vec::new();
    for i in 0..around {
        let a = turn(i, around);
        for j in 0..across {
            let b = turn(j, across);
            let r = 2.0 + (3.0 * a).cos() + 0.3 * b.cos();
            points.push([
                r * (2.0 * a).cos(),
                r * (2.0 * a).sin(),
                (3.0 * a).sin() + 0.3 * b.sin(),
            ]);
            let at = |i: u32, j: u32| (i % around) * across + j % across;
            let [p, q, s, t] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            faces.extend([[p, q, s], [p, s, t]]);
        }
    }
    Ok(Mesh::new(points, faces)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let mut mesh = match words.next() {
        Some(path) => {
            let bytes = std::fs::read(&path)?;
            let start = Instant::now();
            let format = MeshFormat::of_name(&path)?;
            let mesh = read(&bytes, format, &MeshLimits::default(), &mut nothing_beside)?;
            println!("read           {:8.3} s", start.elapsed().as_secs_f64());
            mesh
        }
        None => knot()?,
    };
    let voxels = words.next().map_or(Ok(128), |w| w.parse())?;
    let start = Instant::now();
    let check = mend(&mut mesh);
    println!(
        "looked through {:8.3} s\n{check:#?}",
        start.elapsed().as_secs_f64()
    );
    let bake = Bake {
        voxels,
        ..Bake::default()
    };
    let mut times = [f64::INFINITY; 2];
    let mut works = times;
    let mut worst = 0.0_f32;
    for _ in 0..3 {
        let (start, work) = (Instant::now(), ProcessTime::now());
        let volume = bake.bake(&mesh, &check, &Alone)?;
        times[0] = times[0].min(start.elapsed().as_secs_f64());
        works[0] = works[0].min(work.elapsed().as_secs_f64());
        let (start, work) = (Instant::now(), ProcessTime::now());
        let plain = Plain::new(&mesh);
        let [nx, ny, nz] = volume.nodes();
        let mut distances = Vec::with_capacity(volume.values().len());
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let p = volume.at([i, j, k]).map(|x| x as f32);
                    distances.push(plain.nearest2(p).sqrt());
                }
            }
        }
        times[1] = times[1].min(start.elapsed().as_secs_f64());
        works[1] = works[1].min(work.elapsed().as_secs_f64());
        // lids of holes are nearer than what the plain one knows
        for (a, b) in volume.values().iter().zip(&distances) {
            worst = worst.max(a.abs() - b);
        }
    }
    let row = |what: &str, times: [f64; 2]| {
        let [own, plain] = times;
        let ratio = plain / own;
        println!(
            "{what:14} {own:8.3} s with signs, plain {plain:8.3} s without: {ratio:.1} times as fast"
        );
    };
    println!(
        "{} faces, {voxels} voxels along the longest side",
        mesh.faces().len()
    );
    row("wall clock", times);
    row("processor", works);
    println!("farther than the plain one's nearest place by {worst:e} at most");
    Ok(())
}
