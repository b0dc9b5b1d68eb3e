//! Fewer faces: edges collapse as long as the mesh stays near the surface (Garland and Heckbert 1997; Hoppe 1996).
//!
//! A vertex moves onto a neighbour, so that every vertex that is left lies where the contour put it: on the surface, on its edges and in
//! its corners. What a collapse costs is the mean squared distance to the planes of all faces that were there before; whether it is done
//! is asked of the field itself, at points of the new faces.

use crate::Surface;
use crate::measure::spread;
use crate::sampler::{Sampler, Slope};
use crate::surface::normal;
use crate::vector::{V, dot, length, scale, sub, wide};
use crate::watch::Watch;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The share of the tolerance that new faces may take where they are looked at, for all places between.
const SHARE: f64 = 0.7;
/// New faces turn by less than about 70 degrees.
const TURN: f64 = 0.35;
/// And are turned from the field's gradient by less than about 80.
const ASTRAY: f64 = 0.2;
/// How thin a face may be that was not as thin before: twice its area over its longest side squared.
const THIN: f64 = 0.005;
/// What the length of a collapsed edge counts beside the distance: where all is flat short edges go first, so that faces stay round.
const LENGTH: f64 = 1e-6;
/// Points along a side of a new face, at most.
const POINTS: usize = 6;
/// Collapses between two looks at who watches.
const LOOK: usize = 4096;

/// A sum of squared distances to planes, weighted by areas.
#[derive(Clone, Copy, Default)]
struct Quadric {
    /// Sums of the products of normals, of normals times offsets, of offsets squared.
    a: [f64; 6],
    b: V,
    c: f64,
    weight: f64,
}

impl Quadric {
    fn plane(point: V, normal: V, weight: f64) -> Quadric {
        let d = -dot(point, normal);
        let [x, y, z] = normal;
        Quadric {
            a: [x * x, x * y, x * z, y * y, y * z, z * z].map(|q| q * weight),
            b: scale(normal, d * weight),
            c: d * d * weight,
            weight,
        }
    }

    fn add(&mut self, o: &Quadric) {
        (0..6).for_each(|i| self.a[i] += o.a[i]);
        (0..3).for_each(|i| self.b[i] += o.b[i]);
        self.c += o.c;
        self.weight += o.weight;
    }

    /// The mean squared distance of a point.
    fn at(&self, p: V) -> f64 {
        let [x, y, z] = p;
        let a = &self.a;
        let square = a[0] * x * x
            + a[3] * y * y
            + a[5] * z * z
            + 2.0 * (a[1] * x * y + a[2] * x * z + a[4] * y * z);
        let all = square + 2.0 * dot(self.b, p) + self.c;
        all.max(0.0) / self.weight.max(f64::MIN_POSITIVE)
    }
}

/// A collapse that may be done: its cost as ordered bits, from where to where, and when both were last changed.
type Candidate = Reverse<(u64, u32, u32, [u32; 2])>;

struct Mesh<'s> {
    /// About the middle of the mesh, where squares lose nothing.
    points: Vec<V>,
    middle: V,
    faces: Vec<[u32; 3]>,
    alive: Vec<bool>,
    /// The faces of each vertex.
    around: Vec<Vec<u32>>,
    quadrics: Vec<Quadric>,
    changed: Vec<u32>,
    heap: BinaryHeap<Candidate>,
    tolerance: f64,
    apart: f64,
    sampler: Sampler<'s>,
    spots: Vec<[f32; 3]>,
    slopes: Vec<Slope>,
}

/// Collapses edges while the faces stay within the tolerance. `apart` is how densely new faces are looked at. None where it was stopped.
pub(crate) fn simplify(
    surface: Surface,
    tolerance: f64,
    apart: f64,
    sampler: Sampler<'_>,
    watch: &dyn Watch,
) -> Option<Surface> {
    let mut mesh = Mesh::new(&surface, tolerance, apart, sampler);
    let all = surface.points.len() as f64;
    let mut done = 0_usize;
    while let Some(Reverse((_, from, to, changed))) = mesh.heap.pop() {
        if [from, to].map(|v| mesh.changed[v as usize]) != changed || !mesh.may(from, to) {
            continue;
        }
        mesh.collapse(from, to);
        done += 1;
        if done.is_multiple_of(LOOK) {
            if watch.is_stopped() {
                return None;
            }
            watch.advance(done as f64 / all);
        }
    }
    Some(mesh.into_surface())
}

impl<'s> Mesh<'s> {
    fn new(surface: &Surface, tolerance: f64, apart: f64, sampler: Sampler<'s>) -> Mesh<'s> {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in surface.points.iter().map(|p| wide(*p)) {
            for k in 0..3 {
                (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
            }
        }
        let middle = std::array::from_fn(|k| 0.5 * (low[k] + high[k]));
        let points: Vec<V> = surface
            .points
            .iter()
            .map(|p| sub(wide(*p), middle))
            .collect();
        let count = points.len();
        let mut mesh = Mesh {
            points,
            middle,
            faces: surface.faces.clone(),
            alive: vec![true; surface.faces.len()],
            around: vec![Vec::new(); count],
            quadrics: vec![Quadric::default(); count],
            changed: vec![0; count],
            heap: BinaryHeap::new(),
            tolerance,
            apart,
            sampler,
            spots: Vec::new(),
            slopes: Vec::new(),
        };
        for (i, face) in surface.faces.iter().enumerate() {
            let n = normal(mesh.corners(*face));
            let area = length(n);
            for v in face {
                mesh.around[*v as usize].push(i as u32);
                if area > 0.0 {
                    let plane =
                        Quadric::plane(mesh.points[face[0] as usize], scale(n, 1.0 / area), area);
                    mesh.quadrics[*v as usize].add(&plane);
                }
            }
        }
        for [a, b, c] in &surface.faces {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                mesh.propose(*from, *to);
            }
        }
        mesh
    }

    fn corners(&self, face: [u32; 3]) -> [V; 3] {
        face.map(|v| self.points[v as usize])
    }

    fn propose(&mut self, from: u32, to: u32) {
        let (p, q) = (self.points[from as usize], self.points[to as usize]);
        let off = self.quadrics[from as usize].at(q);
        if off > self.tolerance * self.tolerance {
            return;
        }
        let along = sub(p, q);
        let cost = off + LENGTH * dot(along, along);
        let changed = [from, to].map(|v| self.changed[v as usize]);
        self.heap.push(Reverse((cost.to_bits(), from, to, changed)));
    }

    /// The vertices beside one, each once.
    fn ring(&self, of: u32) -> Vec<u32> {
        // each face names the one behind the vertex: all of them, where the surface is closed
        (self.around[of as usize].iter())
            .map(|f| {
                let face = self.faces[*f as usize];
                let at = face.iter().position(|v| *v == of).unwrap_or_default();
                face[(at + 1) % 3]
            })
            .collect()
    }

    /// Whether a vertex may move onto a neighbour.
    fn may(&mut self, from: u32, to: u32) -> bool {
        let (ring, others) = (self.ring(from), self.ring(to));
        if !ring.contains(&to) {
            return false;
        }
        // the surface stays one: both have two neighbours in common, and these others besides (Dey, Edelsbrunner, Guha and Nekhayev 1999)
        let common: Vec<u32> = ring.into_iter().filter(|v| others.contains(v)).collect();
        if common.len() != 2 || common.iter().any(|v| self.around[*v as usize].len() < 4) {
            return false;
        }
        let mut thinnest = f64::INFINITY;
        let mut thinnest_new = f64::INFINITY;
        self.spots.clear();
        let mut normals: Vec<(usize, V)> = Vec::new();
        for f in &self.around[from as usize] {
            let face = self.faces[*f as usize];
            let before = self.corners(face);
            thinnest = thinnest.min(roundness(before));
            if face.contains(&to) {
                continue;
            }
            let after = self.corners(face.map(|v| if v == from { to } else { v }));
            let (old, new) = (normal(before), normal(after));
            let (was, is) = (length(old), length(new));
            if is <= 0.0 || dot(old, new) < TURN * was * is {
                return false;
            }
            thinnest_new = thinnest_new.min(roundness(after));
            normals.push((self.spots.len(), scale(new, 1.0 / is)));
            let placed = after.map(|p| crate::vector::add(p, self.middle));
            spread(placed, self.apart, POINTS, &mut self.spots);
        }
        if thinnest_new < THIN.min(thinnest) {
            return false;
        }
        self.sampler.whole_slopes(&self.spots, &mut self.slopes);
        let most = SHARE * self.tolerance;
        if !self.slopes.iter().all(|s| s.distance.abs() <= most) {
            return false;
        }
        // the first of its points lies within each face
        normals.iter().all(|(first, n)| {
            let gradient = self.slopes[*first].normal;
            gradient == [0.0; 3] || dot(gradient, *n) > ASTRAY
        })
    }

    fn collapse(&mut self, from: u32, to: u32) {
        for f in std::mem::take(&mut self.around[from as usize]) {
            let face = self.faces[f as usize];
            if face.contains(&to) {
                self.alive[f as usize] = false;
                for v in face {
                    self.around[v as usize].retain(|other| *other != f);
                }
                continue;
            }
            self.faces[f as usize] = face.map(|v| if v == from { to } else { v });
            self.around[to as usize].push(f);
        }
        let gone = self.quadrics[from as usize];
        self.quadrics[to as usize].add(&gone);
        self.changed[from as usize] += 1;
        self.changed[to as usize] += 1;
        for beside in self.ring(to) {
            self.propose(to, beside);
            self.propose(beside, to);
        }
    }

    fn into_surface(self) -> Surface {
        const NONE: u32 = u32::MAX;
        let mut number = vec![NONE; self.points.len()];
        let mut points = Vec::new();
        let mut faces = Vec::new();
        for (face, _) in self
            .faces
            .iter()
            .zip(&self.alive)
            .filter(|(_, alive)| **alive)
        {
            faces.push(face.map(|v| {
                let known = &mut number[v as usize];
                if *known == NONE {
                    *known = points.len() as u32;
                    points.push(v);
                }
                *known
            }));
        }
        Surface {
            points: points.into_iter().map(|v: u32| self.placed(v)).collect(),
            faces,
        }
    }

    /// Where a vertex is, as it was given.
    fn placed(&self, v: u32) -> [f32; 3] {
        let p = crate::vector::add(self.points[v as usize], self.middle);
        crate::vector::single(p)
    }
}

/// Twice the area of a triangle over its longest side squared: 0.87 where it is regular.
fn roundness([a, b, c]: [V; 3]) -> f64 {
    let longest = [sub(b, a), sub(c, b), sub(a, c)]
        .map(|s| dot(s, s))
        .into_iter()
        .fold(0.0, f64::max);
    if longest > 0.0 {
        length(normal([a, b, c])) / longest
    } else {
        0.0
    }
}
