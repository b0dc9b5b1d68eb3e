//! More faces where there are too few: edges of the mesh are split, or turned, whose middles are too far from the surface.
//!
//! A grid does not see an edge of the solid that goes through a cell without crossing any of its edges: there the mesh cuts the edge off.
//! A vertex between the faces on both sides, where their planes meet, puts it back (as Kobbelt, Botsch, Schwanecke and Seidel 2001 do). On smooth places vertices go onto the surface.

use crate::Surface;
use crate::place::{Spot, look, onto};
use crate::qef::Plane;
use crate::sampler::{Sampler, Slope};
use crate::surface::normal;
use crate::vector::{V, add, dot, length, scale, single, sub, wide};
use crate::watch::Watch;
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};

/// The share of the tolerance from which on an edge is split.
const SHARE: f64 = 0.5;
/// And that from which on one is split between faces that meet at more than 25 degrees: edges and corners are kept as they are.
const EXACT: f64 = 0.03;
const SHARP: f64 = 0.906;
/// Times that edges are split.
const PASSES: usize = 8;
/// Edges that are looked at together.
const CHUNK: usize = 128;
/// Where planes are taken: along the edge, and from its middle towards both opposite vertices.
const ALONG: [f64; 4] = [0.1, 0.35, 0.65, 0.9];
const ASIDE: f64 = 0.3;
/// New faces are turned from the gradient of the field in their middle by less than this cosine says, or by no more than those before.
const ASTRAY: f64 = 0.15;
/// A split that leaves its middle farther than this share of what it was is not worth it.
const WORTH: f64 = 0.5;

/// An edge with the vertices opposite to it, left and right.
#[derive(Clone, Copy)]
struct Edge {
    ends: [u32; 2],
    faces: [u32; 2],
    opposite: [u32; 2],
}

/// Splits edges until their middles are near enough, or that is no use. None where it was stopped.
pub(crate) fn refine<'p>(
    mut surface: Surface,
    tolerance: f64,
    most_faces: u64,
    make: impl Fn() -> Sampler<'p> + Sync + Send,
    watch: &dyn Watch,
) -> Option<Surface> {
    let mut refused: HashSet<[u32; 2]> = HashSet::new();
    for _ in 0..PASSES {
        if watch.is_stopped() {
            return None;
        }
        let edges = edges(&surface.faces);
        let at = |v: u32| wide(surface.points[v as usize]);
        let middle = |e: &Edge| scale(add(at(e.ends[0]), at(e.ends[1])), 0.5);
        let init = || (make(), Vec::new(), Vec::<Slope>::new());
        let off: Vec<f64> = (edges.par_chunks(CHUNK))
            .map_init(init, |(sampler, points, slopes), edges| {
                points.clear();
                points.extend(edges.iter().map(|e| single(middle(e))));
                sampler.whole_slopes(points, slopes);
                slopes
                    .iter()
                    .map(|s| s.distance.abs())
                    .collect::<Vec<f64>>()
            })
            .collect::<Vec<Vec<f64>>>()
            .concat();
        let sharp = |e: &Edge| {
            let [f, g] = e.faces.map(|f| normal(surface.faces[f as usize].map(at)));
            dot(f, g) < SHARP * length(f) * length(g)
        };
        let far = |i: &usize| {
            off[*i] > SHARE * tolerance || off[*i] > EXACT * tolerance && sharp(&edges[*i])
        };
        let mut worst: Vec<usize> = (0..edges.len()).filter(far).collect();
        // those that could not be split before come last: beside them others may
        let tried = |i: &usize| refused.contains(&edges[*i].ends);
        worst.sort_by(|a, b| {
            let order = tried(a).cmp(&tried(b)).then(off[*b].total_cmp(&off[*a]));
            order.then(a.cmp(b))
        });
        // each face is cut once at a time
        let mut cut = vec![false; surface.faces.len()];
        worst.retain(|i| {
            let [f, g] = edges[*i].faces.map(|f| f as usize);
            let is_free = !cut[f] && !cut[g];
            (cut[f], cut[g]) = (true, true);
            is_free
        });
        if worst.is_empty() || (surface.faces.len() + 2 * worst.len()) as u64 > most_faces {
            break;
        }
        let chosen: Vec<Edge> = worst.iter().map(|i| edges[*i]).collect();
        let mends: Vec<Vec<Option<Mend>>> = (chosen.par_chunks(CHUNK))
            .map_init(&make, |sampler, edges| between(&surface, edges, sampler))
            .collect();
        let (mut split, mut flipped, mut stuck) = (0, HashSet::new(), Vec::new());
        for (edge, mend) in chosen.iter().zip(mends.concat()) {
            match mend {
                Some(Mend::Split(vertex)) => {
                    apply(&mut surface, edge, vertex);
                    split += 1;
                }
                Some(Mend::Flip) if is_new(edge.opposite, &edges, &mut flipped) => {
                    let [f, g] = flip(&surface, edge);
                    surface.faces[edge.faces[0] as usize] = f;
                    surface.faces[edge.faces[1] as usize] = g;
                    split += 1;
                }
                _ => {
                    refused.insert(edge.ends);
                    stuck.extend(edge.ends.iter().chain(&edge.opposite));
                }
            }
        }
        // a vertex beside an edge or a corner that no cell saw belongs on it
        stuck.sort_unstable();
        stuck.dedup();
        if !stuck.is_empty() {
            split += shift(&mut surface, &stuck, &mut make());
        }
        if split == 0 {
            break;
        }
    }
    Some(surface)
}

/// Moves vertices to where the planes of the faces around them meet, if the faces are much nearer to the surface then and none is folded over.
/// Says how many moved.
fn shift(surface: &mut Surface, vertices: &[u32], sampler: &mut Sampler<'_>) -> usize {
    let mut fans: HashMap<u32, Vec<[u32; 3]>> = vertices.iter().map(|v| (*v, Vec::new())).collect();
    for face in &surface.faces {
        for v in face {
            if let Some(fan) = fans.get_mut(v) {
                fan.push(*face);
            }
        }
    }
    let mut ask = |points: &[[f32; 3]], out: &mut Vec<Slope>| sampler.whole_slopes(points, out);
    let (mut asked, mut slopes) = (Vec::new(), Vec::new());
    let mut moved = 0;
    for v in vertices {
        let fan = &fans[v];
        let own = wide(surface.points[*v as usize]);
        // the fan, were the vertex elsewhere
        let placed = |to: V| -> Vec<[V; 3]> {
            let of = |f: &[u32; 3]| {
                f.map(|w| match w == *v {
                    true => to,
                    false => wide(surface.points[w as usize]),
                })
            };
            fan.iter().map(of).collect()
        };
        let now = placed(own);
        asked.clear();
        asked.extend(now.iter().map(|f| single(scale(add(own, centre(*f)), 0.5))));
        ask(&asked, &mut slopes);
        for (p, slope) in asked.iter_mut().zip(&slopes) {
            *p = single(onto(wide(*p), slope));
        }
        ask(&asked, &mut slopes);
        let planes: Vec<Plane> = (asked.iter().zip(&slopes))
            .filter(|(_, slope)| slope.normal != [0.0; 3])
            .map(|(p, slope)| Plane {
                point: onto(wide(*p), slope),
                normal: slope.normal,
            })
            .collect();
        let reach = (now.iter().flatten()).fold(0.0_f64, |r, p| r.max(length(sub(*p, own))));
        let reach = [0.7 * reach; 3];
        let mut spots = [Spot::new(sub(own, reach), add(own, reach), planes)];
        let (found, _) = look(&mut spots, &mut ask);
        let to = wide(found[0]);
        // how far middles of faces and edges are off, and how far faces are turned away
        let mut judge = |faces: &[[V; 3]]| {
            asked.clear();
            for f in faces {
                asked.push(single(centre(*f)));
                for k in 0..3 {
                    asked.push(single(scale(add(f[k], f[(k + 1) % 3]), 0.5)));
                }
            }
            ask(&asked, &mut slopes);
            let off = slopes.iter().fold(0.0_f64, |m, s| m.max(s.distance.abs()));
            let least = faces.iter().enumerate().fold(1.0_f64, |least, (i, f)| {
                let n = normal(*f);
                let l = length(n);
                least.min(if l > 0.0 {
                    dot(n, slopes[4 * i].normal) / l
                } else {
                    -1.0
                })
            });
            (off, least)
        };
        let (before, was) = judge(&now);
        let (after, is) = judge(&placed(to));
        if after < WORTH * before && is > ASTRAY.min(was) {
            surface.points[*v as usize] = single(to);
            moved += 1;
        }
    }
    moved
}

/// Whether no edge joins two vertices yet; remembers that one will.
fn is_new([a, b]: [u32; 2], edges: &[Edge], flipped: &mut HashSet<[u32; 2]>) -> bool {
    let ends = [a.min(b), a.max(b)];
    // in the order of their ends
    edges.binary_search_by_key(&ends, |e| e.ends).is_err() && flipped.insert(ends)
}

/// The edges of a closed mesh, in the order of their ends.
fn edges(faces: &[[u32; 3]]) -> Vec<Edge> {
    let mut sides: Vec<([u32; 2], bool, u32, u32)> = Vec::with_capacity(3 * faces.len());
    for (i, face) in faces.iter().enumerate() {
        for k in 0..3 {
            let (a, b, c) = (face[k], face[(k + 1) % 3], face[(k + 2) % 3]);
            sides.push(([a.min(b), a.max(b)], a > b, i as u32, c));
        }
    }
    sides.sort_unstable();
    (sides.chunk_by(|a, b| a.0 == b.0))
        .filter_map(|pair| match pair {
            [left, right] => Some(Edge {
                ends: left.0,
                faces: [left.2, right.2],
                opposite: [left.3, right.3],
            }),
            _ => None,
        })
        .collect()
}

/// What brings an edge to the surface.
#[derive(Clone, Copy)]
enum Mend {
    /// A vertex on it.
    Split([f32; 3]),
    /// Another edge, between the vertices opposite to it.
    Flip,
}

/// What mends edges; none where neither brings it much nearer to the surface without folding a face over.
fn between(surface: &Surface, edges: &[Edge], sampler: &mut Sampler<'_>) -> Vec<Option<Mend>> {
    let at = |v: u32| wide(surface.points[v as usize]);
    let mut points: Vec<V> = Vec::new();
    for edge in edges {
        let [a, b] = edge.ends.map(at);
        points.extend(ALONG.map(|t| add(a, scale(sub(b, a), t))));
        let middle = scale(add(a, b), 0.5);
        points.extend(
            edge.opposite
                .map(|v| add(middle, scale(sub(at(v), middle), ASIDE))),
        );
    }
    let each = ALONG.len() + 2;
    let mut ask = |points: &[[f32; 3]], out: &mut Vec<Slope>| sampler.whole_slopes(points, out);
    let mut slopes = Vec::new();
    let mut asked: Vec<[f32; 3]> = points.iter().map(|p| single(*p)).collect();
    ask(&asked, &mut slopes);
    for (p, slope) in asked.iter_mut().zip(&slopes) {
        *p = single(onto(wide(*p), slope));
    }
    ask(&asked, &mut slopes);
    let mut spots: Vec<Spot> = (edges.iter().enumerate())
        .map(|(i, edge)| {
            let [a, b] = edge.ends.map(at);
            let (middle, half) = (scale(add(a, b), 0.5), 0.5 * length(sub(b, a)));
            let planes = (i * each..(i + 1) * each)
                .filter(|k| slopes[*k].normal != [0.0; 3])
                .map(|k| Plane {
                    point: onto(wide(asked[k]), &slopes[k]),
                    normal: slopes[k].normal,
                })
                .collect();
            let reach = [half; 3];
            Spot::new(sub(middle, reach), add(middle, reach), planes)
        })
        .collect();
    let (found, off) = look(&mut spots, &mut ask);
    // the middles of edges before, and of faces before and after
    asked.clear();
    for (edge, vertex) in edges.iter().zip(&found) {
        let [a, b] = edge.ends.map(at);
        asked.push(single(scale(add(a, b), 0.5)));
        for corners in faces(surface, edge, wide(*vertex)) {
            asked.push(single(centre(corners)));
        }
        let [c, d] = edge.opposite.map(at);
        asked.push(single(scale(add(c, d), 0.5)));
        asked.extend(flip(surface, edge).map(|f| single(centre(f.map(at)))));
    }
    ask(&asked, &mut slopes);
    let each = 10;
    (edges.iter().zip(found).zip(off).enumerate())
        .map(|(i, ((edge, vertex), off))| {
            let slopes = &slopes[i * each..(i + 1) * each];
            let upright = faces(surface, edge, wide(vertex)).map(normal);
            let cosine = |k: usize| {
                let n = upright[k];
                let l = length(n);
                if l > 0.0 {
                    dot(n, slopes[k + 1].normal) / l
                } else {
                    -1.0
                }
            };
            let before = cosine(0).min(cosine(1));
            let after = (2..6).map(cosine).fold(1.0, f64::min);
            let is_nearer = off < WORTH * slopes[0].distance.abs();
            if is_nearer && after > ASTRAY.min(before) {
                return Some(Mend::Split(vertex));
            }
            let flipped = slopes[7].distance.abs() < WORTH * slopes[0].distance.abs();
            let turned = flip(surface, edge).map(|f| normal(f.map(at)));
            let cosine = |k: usize| {
                let (n, l) = (turned[k], length(turned[k]));
                if l > 0.0 {
                    dot(n, slopes[k + 8].normal) / l
                } else {
                    -1.0
                }
            };
            (flipped && cosine(0).min(cosine(1)) > ASTRAY).then_some(Mend::Flip)
        })
        .collect()
}

/// The middle of a triangle.
fn centre([a, b, c]: [V; 3]) -> V {
    scale(add(a, add(b, c)), 1.0 / 3.0)
}

/// The two faces that there are when an edge joins the vertices opposite to it instead of its ends.
fn flip(surface: &Surface, edge: &Edge) -> [[u32; 3]; 2] {
    let ([a, b], [c, d]) = (edge.ends, edge.opposite);
    let turned = |f: u32, from: u32, to: u32| {
        surface.faces[f as usize].map(|v| if v == from { to } else { v })
    };
    let [f, g] = edge.faces;
    [turned(f, b, d), turned(g, a, c)]
}

/// The two faces of an edge, and the four that there are when it is split.
fn faces(surface: &Surface, edge: &Edge, vertex: V) -> [[V; 3]; 6] {
    let of = |f: u32| surface.faces[f as usize];
    let [f, g] = edge.faces;
    let [a, b] = edge.ends;
    let before = |f: u32| of(f).map(|v| wide(surface.points[v as usize]));
    let after = |f: u32, end: u32| {
        of(f).map(|v| match v == end {
            true => vertex,
            false => wide(surface.points[v as usize]),
        })
    };
    [
        before(f),
        before(g),
        after(f, a),
        after(f, b),
        after(g, a),
        after(g, b),
    ]
}

/// Splits an edge.
fn apply(surface: &mut Surface, edge: &Edge, vertex: [f32; 3]) {
    let new = surface.points.len() as u32;
    surface.points.push(vertex);
    for f in edge.faces {
        let face = surface.faces[f as usize];
        let [first, second] = edge
            .ends
            .map(|end| face.map(|v| if v == end { new } else { v }));
        surface.faces[f as usize] = first;
        surface.faces.push(second);
    }
}
