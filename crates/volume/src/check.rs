//! What is wrong with a mesh: holes, faces turned the wrong way, faces without area, surfaces that cross themselves.

use crate::bvh::{Bounds, Bvh};
use crate::mesh::{Mesh, Welding, v};
use robust::{Coord, Coord3D, orient2d, orient3d};
use std::collections::HashMap;

/// Crossings that are counted; a mesh with more is not looked through to its end.
pub const MOST_CROSSINGS: usize = 1_000_000;

/// What a mesh is like.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Vertices, after those at one place became one.
    pub vertices: usize,
    /// Faces, all with three corners at different places.
    pub faces: usize,
    /// What was put together and left out.
    pub welding: Welding,
    /// Parts that hang together by edges.
    pub parts: usize,
    /// Closed chains of edges that have a face on one side only.
    pub holes: usize,
    /// Edges with a face on one side only (or, with more faces, without another that runs the other way).
    pub open_edges: usize,
    /// Edges of more than two faces.
    pub crowded_edges: usize,
    /// Faces that ran the other way round than most of their part, or of a mesh that was inside out. They are turned around.
    pub flipped: usize,
    /// Faces with an area that is none: their corners are on a line.
    pub flat: usize,
    /// Faces over the same three corners as another.
    pub duplicates: usize,
    /// Whether every edge has an even number of faces: then what is inside is never a matter of opinion.
    pub watertight: bool,
    /// Area, square scene units.
    pub area: f64,
    /// Volume, cubic scene units; with its holes closed by cones.
    pub volume: f64,
}

/// An edge's two vertices, the smaller number first.
type Edge = [u32; 2];

/// Edges with their faces: the face, and whether it runs from the smaller vertex to the larger.
pub(crate) struct Edges {
    /// Sorted by edge.
    sides: Vec<(Edge, u32, bool)>,
}

impl Edges {
    pub(crate) fn new(mesh: &Mesh) -> Edges {
        let mut sides = Vec::with_capacity(3 * mesh.faces().len());
        for (i, face) in mesh.faces().iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (face[k], face[(k + 1) % 3]);
                sides.push(([a.min(b), a.max(b)], i as u32, a < b));
            }
        }
        sides.sort_unstable();
        Edges { sides }
    }

    fn groups(&self) -> impl Iterator<Item = &[(Edge, u32, bool)]> {
        self.sides.chunk_by(|a, b| a.0 == b.0)
    }
}

/// Sets that are put together (Tarjan 1975).
struct Sets(Vec<u32>);

impl Sets {
    fn new(n: usize) -> Sets {
        Sets((0..n as u32).collect())
    }
    fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let up = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = up;
            i = up;
        }
        i
    }
    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a as usize] = b;
    }
    fn count(&mut self) -> usize {
        (0..self.0.len() as u32)
            .filter(|i| self.root(*i) == *i)
            .count()
    }
}

/// A closed chain of edges around a hole, each once for every time it is needed: from a vertex to the next.
pub(crate) type Rim = Vec<[u32; 2]>;

/// The rims of a mesh: what closes every edge. Each is a cycle (or several that meet), so that a cone over it closes its part.
pub(crate) fn rims(mesh: &Mesh) -> Vec<Rim> {
    let mut open: Rim = Vec::new();
    for group in Edges::new(mesh).groups() {
        let net: i64 = group.iter().map(|s| if s.2 { 1 } else { -1 }).sum();
        let [a, b] = group[0].0;
        // a face that ran from b to a is missing, or the other way round
        let edge = if net > 0 { [b, a] } else { [a, b] };
        open.extend(std::iter::repeat_n(edge, net.unsigned_abs() as usize));
    }
    let mut sets = Sets::new(mesh.points().len());
    for [a, b] in &open {
        sets.join(*a, *b);
    }
    let mut number: HashMap<u32, usize> = HashMap::new();
    let mut rims: Vec<Rim> = Vec::new();
    for edge in open {
        let root = sets.root(edge[0]);
        let at = *number.entry(root).or_insert_with(|| {
            rims.push(Vec::new());
            rims.len() - 1
        });
        rims[at].push(edge);
    }
    rims
}

/// The tip of the cone over a rim: the middle of its edges.
pub(crate) fn tip(mesh: &Mesh, rim: &Rim) -> [f64; 3] {
    let at = |v: u32| mesh.points()[v as usize].map(f64::from);
    let sum = (rim.iter()).fold([0.0; 3], |s, [a, b]| v::add(s, v::add(at(*a), at(*b))));
    v::scale(sum, 0.5 / rim.len() as f64)
}

/// Looks a mesh through and turns those faces around that run the other way than most of their part. A mesh that is inside out as
/// a whole is turned around too. Time and memory grow with the faces, times their logarithm.
pub fn mend(mesh: &mut Mesh) -> Check {
    let edges = Edges::new(mesh);
    let count = mesh.faces().len();
    let mut parts = Sets::new(count);
    let (mut crowded, mut watertight) = (0, true);
    // faces that share an edge of two: whether they agree
    let mut beside: Vec<(u32, u32, bool)> = Vec::with_capacity(edges.sides.len());
    for group in edges.groups() {
        watertight &= group.len() % 2 == 0;
        crowded += usize::from(group.len() > 2);
        for pair in group.windows(2) {
            parts.join(pair[0].1, pair[1].1);
        }
        if let [a, b] = group {
            let agree = a.2 != b.2;
            beside.extend([(a.1, b.1, agree), (b.1, a.1, agree)]);
        }
    }
    beside.sort_unstable();
    let mut turned = agreed(count, &beside);
    mesh.turn(&turned);
    // holes closed by cones, the volume says which way is out
    let rims = rims(mesh);
    let mut volume = 0.0;
    let mut area = 0.0;
    let mut flat = 0;
    for i in 0..count {
        let [a, b, c] = mesh.corners64(i);
        let cross = v::cross(v::sub(b, a), v::sub(c, a));
        volume += signed(a, b, c);
        area += 0.5 * v::length(cross);
        flat += usize::from(is_flat([a, b, c]));
    }
    for rim in &rims {
        let q = tip(mesh, rim);
        let at = |i: u32| mesh.points()[i as usize].map(f64::from);
        volume += (rim.iter())
            .map(|[a, b]| signed(at(*a), at(*b), q))
            .sum::<f64>();
    }
    if volume < 0.0 {
        mesh.turn(&vec![true; count]);
        turned.iter_mut().for_each(|t| *t = !*t);
        volume = -volume;
    }
    let mut corners: Vec<[u32; 3]> = mesh.faces().to_vec();
    corners.iter_mut().for_each(|c| c.sort_unstable());
    corners.sort_unstable();
    let duplicates = corners.windows(2).filter(|w| w[0] == w[1]).count();
    Check {
        vertices: mesh.points().len(),
        faces: count,
        welding: mesh.welding(),
        parts: parts.count(),
        holes: rims.len(),
        open_edges: rims.iter().map(Vec::len).sum(),
        crowded_edges: crowded,
        flipped: turned.iter().filter(|t| **t).count(),
        flat,
        duplicates,
        watertight,
        area,
        volume,
    }
}

/// Six times the volume between a triangle and the origin, over six.
fn signed(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    v::dot(a, v::cross(b, c)) / 6.0
}

/// Which faces to turn so that neighbours agree: of each part that hangs together by edges of two faces, the smaller half.
fn agreed(count: usize, beside: &[(u32, u32, bool)]) -> Vec<bool> {
    let mut turned = vec![false; count];
    let mut seen = vec![false; count];
    for start in 0..count as u32 {
        if std::mem::replace(&mut seen[start as usize], true) {
            continue;
        }
        let mut part = vec![start];
        let mut at = 0;
        while let Some(&face) = part.get(at) {
            at += 1;
            let from = beside.partition_point(|b| b.0 < face);
            for (_, other, agree) in beside[from..].iter().take_while(|b| b.0 == face) {
                if !std::mem::replace(&mut seen[*other as usize], true) {
                    turned[*other as usize] = turned[face as usize] == *agree;
                    part.push(*other);
                }
            }
        }
        let turns = part.iter().filter(|f| turned[**f as usize]).count();
        if 2 * turns > part.len() {
            part.iter().for_each(|f| turned[*f as usize] ^= true);
        }
    }
    turned
}

/// Whether three points are on a line, exactly.
fn is_flat(t: [[f64; 3]; 3]) -> bool {
    (0..3).all(|k| {
        let [a, b, c] = t.map(|p| Coord {
            x: p[(k + 1) % 3],
            y: p[(k + 2) % 3],
        });
        orient2d(a, b, c) == 0.0
    })
}

/// Pairs of faces that cross or overlap without sharing a vertex, by exact predicates (Shewchuk 1997); at most [`MOST_CROSSINGS`].
pub fn crossings(mesh: &Mesh) -> usize {
    count_crossings(mesh, MOST_CROSSINGS)
}

/// Whether any faces cross.
pub(crate) fn crosses(mesh: &Mesh) -> bool {
    count_crossings(mesh, 1) > 0
}

fn count_crossings(mesh: &Mesh, most: usize) -> usize {
    let bounds: Vec<Bounds> = (0..mesh.faces().len())
        .map(|i| Bounds::of(mesh.corners(i)))
        .collect();
    let mut count = 0;
    Bvh::new(&bounds).pairs(&bounds, |a, b| {
        let (fa, fb) = (mesh.faces()[a as usize], mesh.faces()[b as usize]);
        let share = fa.iter().any(|x| fb.contains(x));
        let corners = |f: u32| mesh.corners64(f as usize);
        count += usize::from(!share && meet(corners(a), corners(b)));
        count < most
    });
    count
}

type Triangle = [[f64; 3]; 3];

fn side(t: &Triangle, p: [f64; 3]) -> f64 {
    let c = |p: [f64; 3]| Coord3D {
        x: p[0],
        y: p[1],
        z: p[2],
    };
    orient3d(c(t[0]), c(t[1]), c(t[2]), c(p))
}

/// Whether two triangles have a point in common.
fn meet(a: Triangle, b: Triangle) -> bool {
    let of_b = b.map(|p| side(&a, p));
    if of_b.iter().all(|s| *s > 0.0) || of_b.iter().all(|s| *s < 0.0) {
        return false;
    }
    let of_a = a.map(|p| side(&b, p));
    if of_a.iter().all(|s| *s > 0.0) || of_a.iter().all(|s| *s < 0.0) {
        return false;
    }
    if of_b == [0.0; 3] && of_a == [0.0; 3] {
        return meet_in_plane(&a, &b);
    }
    let edges = |t: &Triangle| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    edges(&b).iter().any(|e| pierces(e, &a)) || edges(&a).iter().any(|e| pierces(e, &b))
}

/// Whether a segment meets a triangle that is not in one plane with it.
fn pierces(e: &[[f64; 3]; 2], t: &Triangle) -> bool {
    let (s, u) = (side(t, e[0]), side(t, e[1]));
    if s == 0.0 && u == 0.0 || s > 0.0 && u > 0.0 || s < 0.0 && u < 0.0 {
        return false;
    }
    let around = [0, 1, 2].map(|k| side(&[e[0], e[1], t[k]], t[(k + 1) % 3]));
    around.iter().all(|s| *s >= 0.0) || around.iter().all(|s| *s <= 0.0)
}

fn meet_in_plane(a: &Triangle, b: &Triangle) -> bool {
    let normal = v::cross(v::sub(a[1], a[0]), v::sub(a[2], a[0]));
    let k = (0..3)
        .max_by(|i, j| normal[*i].abs().total_cmp(&normal[*j].abs()))
        .unwrap_or(0);
    let flat = |t: &Triangle| {
        t.map(|p| Coord {
            x: p[(k + 1) % 3],
            y: p[(k + 2) % 3],
        })
    };
    let (a, b) = (flat(a), flat(b));
    let within = |p: Coord<f64>, t: &[Coord<f64>; 3]| {
        let s = [0, 1, 2].map(|k| orient2d(t[k], t[(k + 1) % 3], p));
        s != [0.0; 3] && (s.iter().all(|s| *s >= 0.0) || s.iter().all(|s| *s <= 0.0))
    };
    let cross = |p: Coord<f64>, q: Coord<f64>, r: Coord<f64>, s: Coord<f64>| {
        orient2d(p, q, r) * orient2d(p, q, s) < 0.0 && orient2d(r, s, p) * orient2d(r, s, q) < 0.0
    };
    a.iter().any(|p| within(*p, &b))
        || b.iter().any(|p| within(*p, &a))
        || (0..3).any(|i| (0..3).any(|j| cross(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3])))
}
