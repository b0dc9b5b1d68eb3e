//! The nearest place of a mesh, for the nodes of a grid: many nodes side by side in SIMD lanes.
//!
//! Neighbours share nearly all of their way through a tree. A vector of lanes holds nodes of a small cube, in Morton order, and goes
//! down together: a branch is left when it is too far for every lane. The nearest faces of the vector before are tried first,
//! so that most of the tree is too far from the start. Which face is nearest is found in single precision, its distance again
//! in double precision: of two faces that are as far but for rounding, either may be taken.

use crate::bvh::{Bounds, Bvh, STACK};
use crate::mesh::v;
use fearless_simd::{Simd, prelude::*};

/// Nodes of a tile along an axis.
pub(crate) const TILE: usize = 8;
/// Nodes of a tile.
pub(crate) const NODES: usize = TILE * TILE * TILE;
/// No face.
const NONE: u32 = u32::MAX;

/// A face as the lanes read it: its corners, one over the squares of its edges' lengths, its normal, and for each edge the
/// direction in the plane of the face that points out of it.
#[derive(Clone, Copy, Debug)]
struct Face {
    corners: [[f32; 3]; 3],
    edges: [[f32; 3]; 3],
    inverse: [f32; 3],
    normal: [f32; 3],
    out: [[f32; 3]; 3],
    number: u32,
}

impl Face {
    fn new(exact: &Exact, number: u32) -> Face {
        let single = |x: [f64; 3]| x.map(|x| x as f32);
        let [a, b, c] = exact.corners;
        Face {
            corners: exact.corners.map(single),
            edges: [v::sub(b, a), v::sub(c, b), v::sub(a, c)].map(single),
            inverse: exact.inverse.map(|x| x.min(1e30) as f32),
            normal: single(exact.normal),
            out: exact.out.map(single),
            number,
        }
    }
}

/// A face in double precision: like [`Face`].
#[derive(Clone, Copy, Debug)]
struct Exact {
    corners: [[f64; 3]; 3],
    inverse: [f64; 3],
    normal: [f64; 3],
    out: [[f64; 3]; 3],
}

impl Exact {
    fn new(corners: [[f64; 3]; 3]) -> Exact {
        let edges = [0, 1, 2].map(|k| v::sub(corners[(k + 1) % 3], corners[k]));
        let normal = v::unit(v::cross(edges[0], edges[1]));
        Exact {
            corners,
            inverse: edges.map(|e| {
                let square = v::dot(e, e);
                // a face that is a line or a point has edges without length
                if square > 0.0 { 1.0 / square } else { 0.0 }
            }),
            normal,
            out: edges.map(|e| v::unit(v::cross(e, normal))),
        }
    }

    /// The squared distance of a place: of the nearest edge, or of the plane where the foot on it is within all edges (Ericson
    /// 2005, section 5.1.5, without its regions, so that what has no area is right too).
    #[inline(always)]
    fn distance2(&self, p: [f64; 3]) -> f64 {
        let mut least = f64::INFINITY;
        let mut beyond = f64::NEG_INFINITY;
        for k in 0..3 {
            let d = v::sub(p, self.corners[k]);
            let e = v::sub(self.corners[(k + 1) % 3], self.corners[k]);
            let t = (v::dot(d, e) * self.inverse[k]).clamp(0.0, 1.0);
            let off = v::sub(d, v::scale(e, t));
            least = least.min(v::dot(off, off));
            beyond = beyond.max(v::dot(d, self.out[k]));
        }
        // a face without area is beyond all its edges nowhere, but not within them either
        if beyond < 0.0 {
            let height = v::dot(v::sub(p, self.corners[0]), self.normal);
            return height * height;
        }
        least
    }
}

/// Faces that can be asked for the nearest one.
#[derive(Debug)]
pub(crate) struct Nearest {
    tree: Bvh,
    /// In the order of the tree's leaves.
    faces: Vec<Face>,
    /// The corners by the faces' own numbers, in the space of the tree.
    exact: Vec<Exact>,
    centre: [f64; 3],
    scale: f64,
}

/// Nodes of a grid: where the first is, and how far one is from the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
    pub(crate) nodes: [usize; 3],
    pub(crate) origin: [f64; 3],
    pub(crate) step: f64,
}

impl Lattice {
    #[inline(always)]
    pub(crate) fn at(&self, node: [usize; 3]) -> [f64; 3] {
        // written out, here and where it is as often: closures of `array::map` are not inlined
        [
            self.origin[0] + self.step * node[0] as f64,
            self.origin[1] + self.step * node[1] as f64,
            self.origin[2] + self.step * node[2] as f64,
        ]
    }

    pub(crate) fn count(&self) -> usize {
        self.nodes.iter().product()
    }

    /// Tiles along each axis.
    pub(crate) fn tiles(&self) -> [usize; 3] {
        self.nodes.map(|n| n.div_ceil(TILE))
    }

    /// The nodes of a tile, from the first to behind the last, along each axis.
    pub(crate) fn tile(&self, tile: usize) -> [std::ops::Range<usize>; 3] {
        let [x, y, _] = self.tiles();
        let at = [tile % x, tile / x % y, tile / (x * y)];
        [0, 1, 2].map(|k| at[k] * TILE..((at[k] + 1) * TILE).min(self.nodes[k]))
    }
}

/// Where the n-th node of a tile is, along the Morton curve (Morton 1966).
#[inline(always)]
fn morton(n: usize) -> [usize; 3] {
    let every_third = |n: usize| n & 1 | n >> 2 & 2 | n >> 4 & 4;
    [every_third(n), every_third(n >> 1), every_third(n >> 2)]
}

impl Nearest {
    /// For these triangles, which may be points or lines; there must be one at least.
    pub(crate) fn new(triangles: &[[[f64; 3]; 3]]) -> Nearest {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in triangles.iter().flatten() {
            for k in 0..3 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        // about the origin and of size 1, so that single precision is as good for a mesh of any size at any place
        let centre = [0, 1, 2].map(|k| 0.5 * (low[k] + high[k]));
        let size = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
        let exact: Vec<Exact> = (triangles.iter())
            .map(|t| Exact::new(t.map(|p| v::scale(v::sub(p, centre), scale))))
            .collect();
        let bounds: Vec<Bounds> = (exact.iter())
            .map(|t| Bounds::of(t.corners.map(|p| p.map(|x| x as f32))))
            .collect();
        let tree = Bvh::new(&bounds);
        let faces = (tree.items.iter())
            .map(|i| Face::new(&exact[*i as usize], *i))
            .collect();
        Nearest {
            tree,
            faces,
            exact,
            centre,
            scale,
        }
    }

    /// The distances of a tile's nodes: written where `values` has a node that is farther, in the order x, y, z of the tile. What is
    /// farther than that stays.
    #[inline(always)]
    pub(crate) fn tile<S: Simd>(
        &self,
        simd: S,
        lattice: &Lattice,
        tile: usize,
        values: &mut [f32; NODES],
    ) {
        let ranges = lattice.tile(tile);
        let wide = S::f32s::LEN;
        let mut seeds = [NONE; 2];
        let mut columns = [[0.0_f32; 16]; 3];
        let mut farthest = [0.0_f32; 16];
        let mut best = [NONE; 16];
        let start = [ranges[0].start, ranges[1].start, ranges[2].start];
        let last = [
            ranges[0].end - 1 - start[0],
            ranges[1].end - 1 - start[1],
            ranges[2].end - 1 - start[2],
        ];
        let place = |at: [usize; 3]| {
            let p = lattice.at([start[0] + at[0], start[1] + at[1], start[2] + at[2]]);
            v::scale(v::sub(p, self.centre), self.scale)
        };
        let mut first = 0;
        while first < NODES {
            let mut places = [[0; 3]; 16];
            let mut any = false;
            for lane in 0..wide {
                let [x, y, z] = morton(first + lane);
                any |= x <= last[0] && y <= last[1] && z <= last[2];
                // beyond the grid its last nodes stand in
                let at = [x.min(last[0]), y.min(last[1]), z.min(last[2])];
                let p = place(at);
                columns[0][lane] = p[0] as f32;
                columns[1][lane] = p[1] as f32;
                columns[2][lane] = p[2] as f32;
                let known = f64::from(values[index(at)]) * self.scale;
                farthest[lane] = (known * known).min(1e30) as f32;
                places[lane] = at;
            }
            first += wide;
            if !any {
                continue;
            }
            self.nearest(simd, &columns, &farthest, seeds, &mut best);
            for lane in 0..wide {
                let (at, found) = (places[lane], best[lane]);
                if found == NONE {
                    continue;
                }
                let number = self.faces[found as usize].number;
                let d = self.exact[number as usize].distance2(place(at)).sqrt();
                let value = &mut values[index(at)];
                *value = value.min((d / self.scale) as f32);
            }
            if best[0] != NONE {
                seeds = [best[0], best[wide - 1]];
            }
        }
    }

    /// The nearest faces of the places in `columns`, as far as they are nearer than `farthest` (squares).
    #[inline(always)]
    fn nearest<S: Simd>(
        &self,
        simd: S,
        columns: &[[f32; 16]; 3],
        farthest: &[f32; 16],
        seeds: [u32; 2],
        found: &mut [u32; 16],
    ) {
        let wide = S::f32s::LEN;
        let p = [
            S::f32s::from_slice(simd, &columns[0][..wide]),
            S::f32s::from_slice(simd, &columns[1][..wide]),
            S::f32s::from_slice(simd, &columns[2][..wide]),
        ];
        let mut best = S::f32s::from_slice(simd, &farthest[..wide]);
        let mut number = S::u32s::splat(simd, NONE);
        for seed in seeds {
            if seed != NONE {
                (best, number) = self.face(simd, seed, &p, best, number);
            }
        }
        // what is put aside, with its distance from each lane
        let mut stack = [(0_u32, S::f32s::splat(simd, 0.0)); STACK];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (at, near) = stack[height];
            // lanes may have found something nearer since
            if !near.simd_lt(best).any_true() {
                continue;
            }
            let node = &self.tree.nodes[at as usize];
            if node.count > 0 {
                for face in node.first..node.first + node.count {
                    (best, number) = self.face(simd, face, &p, best, number);
                }
                continue;
            }
            let first = node.first;
            let left = apart2(simd, &self.tree.nodes[first as usize].bounds, &p);
            let right = apart2(simd, &self.tree.nodes[first as usize + 1].bounds, &p);
            let enters_left = left.simd_lt(best).any_true();
            let enters_right = right.simd_lt(best).any_true();
            // the one that is nearer to the first lane comes off the stack first
            let swap = left[0] <= right[0];
            let (near, far) = if swap { (left, right) } else { (right, left) };
            let (enters_near, enters_far) = if swap {
                (enters_left, enters_right)
            } else {
                (enters_right, enters_left)
            };
            if enters_far {
                stack[height] = (first + u32::from(swap), far);
                height += 1;
            }
            if enters_near {
                stack[height] = (first + u32::from(!swap), near);
                height += 1;
            }
        }
        number.store_slice(&mut found[..wide]);
    }

    /// The nearer of what is known and a face.
    #[inline(always)]
    fn face<S: Simd>(
        &self,
        simd: S,
        at: u32,
        p: &[S::f32s; 3],
        best: S::f32s,
        number: S::u32s,
    ) -> (S::f32s, S::u32s) {
        let f = &self.faces[at as usize];
        let d = from_corner(simd, p, &f.corners[0]);
        let height = dot(simd, &d, &f.normal);
        let above = height * height;
        // no place of a face is nearer than its plane
        if !above.simd_lt(best).any_true() {
            return (best, number);
        }
        let mut nearest = S::f32s::splat(simd, f32::INFINITY);
        let mut beyond = S::f32s::splat(simd, f32::NEG_INFINITY);
        let mut k = 0;
        while k < 3 {
            let d = from_corner(simd, p, &f.corners[k]);
            let t = dot(simd, &d, &f.edges[k]) * f.inverse[k];
            let t = t
                .max(S::f32s::splat(simd, 0.0))
                .min(S::f32s::splat(simd, 1.0));
            let e = [
                d[0] - t * f.edges[k][0],
                d[1] - t * f.edges[k][1],
                d[2] - t * f.edges[k][2],
            ];
            nearest = nearest.min(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
            beyond = beyond.max(dot(simd, &d, &f.out[k]));
            k += 1;
        }
        // where the foot on the plane is within the face; a face without area has no such places
        let within = beyond.simd_lt(S::f32s::splat(simd, 0.0));
        let d2 = within.select(above, nearest);
        let nearer = d2.simd_lt(best);
        (
            nearer.select(d2, best),
            nearer.select(S::u32s::splat(simd, at), number),
        )
    }
}

/// The place of a node in the values of a tile.
#[inline(always)]
pub(crate) fn index(at: [usize; 3]) -> usize {
    at[0] + TILE * (at[1] + TILE * at[2])
}

#[inline(always)]
fn from_corner<S: Simd>(simd: S, p: &[S::f32s; 3], c: &[f32; 3]) -> [S::f32s; 3] {
    let _ = simd;
    [p[0] - c[0], p[1] - c[1], p[2] - c[2]]
}

#[inline(always)]
fn dot<S: Simd>(simd: S, a: &[S::f32s; 3], b: &[f32; 3]) -> S::f32s {
    let _ = simd;
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Squared distances to a box.
#[inline(always)]
fn apart2<S: Simd>(simd: S, b: &Bounds, p: &[S::f32s; 3]) -> S::f32s {
    let zero = S::f32s::splat(simd, 0.0);
    let x = (S::f32s::splat(simd, b.low[0]) - p[0])
        .max(p[0] - b.high[0])
        .max(zero);
    let y = (S::f32s::splat(simd, b.low[1]) - p[1])
        .max(p[1] - b.high[1])
        .max(zero);
    let z = (S::f32s::splat(simd, b.low[2]) - p[2])
        .max(p[2] - b.high[2])
        .max(zero);
    x * x + y * y + z * z
}
