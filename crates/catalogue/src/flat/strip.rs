//! Contours of many pieces, as trees that say what a point need not look at.

use super::outline::Seen;
use super::*;
use crate::op::domain::Offset;
use crate::op::{Leaf, Warp};
use std::collections::HashMap;

/// The region within closed contours, as [`Outline`] and [`Polygon`] say it, from trees of strips (Ballard, "Strip trees: a
/// hierarchical representation for curves", 1981). Parameters: a centre, 0 for the winding number or 1 for the number of
/// crossings, then what [`strips`] makes.
///
/// A node is a segment, and how far from it a part of the contours goes at most. That part begins and ends where the segment
/// does, so a point that is farther from the segment than that has the part on the side on which it has the segment: what is
/// passed over still counts for the sign, to the same whole number. Distances are the same to the bit.
pub struct Strips;

/// Numbers a node has: start, direction, half the length, height of the end, how far its part goes, its first piece, how many,
/// nodes in its tree.
const NODE: usize = 10;
/// Numbers a piece has: start and end.
const PIECE: usize = 4;

impl Leaf for Strips {
    #[inline(always)]
    fn leaf<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        R::bounded_slope(
            Offset::warp(p, a),
            1.0,
            #[inline(always)]
            |p| {
                let p = p.xy();
                let trees = a.list(4);
                // the nearest piece is no farther than this: a first look at the roots alone
                let within = trees.walk(
                    p.x.lit(1e30),
                    #[inline(always)]
                    |within, node: [_; NODE]| {
                        let within = within.min(On::node(p, node).distance + node[6]);
                        (within, within, within.below(-1.0))
                    },
                    #[inline(always)]
                    |within, _: [_; PIECE]| within,
                );
                let none = Seen::nothing(p.x);
                let (nearest, touch, winding, _) = trees.walk(
                    (none.nearest, none.touch, p.x.lit(0.0), within),
                    #[inline(always)]
                    |(nearest, touch, winding, within), node: [_; NODE]| {
                        let on = On::node(p, node);
                        let within = within.min(on.distance + node[6]).min(nearest.sqrt());
                        // for the roundings of both
                        let far = within * (1.0 + 4e-6) + node[6];
                        let crossed = R::choose(on.up, winding + 1.0, winding);
                        let crossed = R::choose(on.down, crossed - 1.0, crossed);
                        (
                            (nearest, touch, winding, within),
                            (nearest, touch, crossed, within),
                            on.distance.below(far),
                        )
                    },
                    #[inline(always)]
                    |(nearest, touch, winding, within), s: [_; PIECE]| {
                        let (from, to) = (v2(s[0], s[1]), v2(s[2], s[3]));
                        let (seen, up, down) = Seen { nearest, touch }.pass(p, from, to);
                        let winding = R::choose(up, winding + 1.0, winding);
                        let winding = R::choose(down, winding - 1.0, winding);
                        (seen.nearest, seen.touch, winding, within)
                    },
                );
                let d = Seen { nearest, touch }.distance();
                let odd = winding - (winding * 0.5).floor() * 2.0;
                let crossings = R::choose(p.x.lit(0.0).below(a.get(3)), odd, winding);
                R::select(crossings.abs().above(0.5), -d, d)
            },
        )
    }
}

/// A point against the segment of a node.
struct On<R: Real> {
    distance: R,
    /// Whether the segment passes its height going up with the point to its left.
    up: R::Mask,
    /// Whether it does so going down with the point to its right.
    down: R::Mask,
}

impl<R: Real> On<R> {
    #[inline(always)]
    fn node(p: Vec2<R>, node: [R::Scalar; NODE]) -> Self {
        let w = p - v2(node[0], node[1]);
        let along = v2(node[2], node[3]);
        let right = w.cross(along);
        let beyond = ((w.dot(along) - node[4]).abs() - node[4]).max(0.0);
        let (left, start, end) = (right.negative(), p.y.below(node[1]), p.y.below(node[5]));
        On {
            distance: (beyond.sq() + right.sq()).sqrt(),
            up: !start & end & left,
            down: start & !end & !left,
        }
    }
}

/// Pieces from which on trees are worth it.
const WORTH: usize = 24;
/// Most pieces that a node has itself.
const PIECES: usize = 8;
/// Most children of a node.
const CHILDREN: usize = 4;

/// The parameters of [`Strips`] behind its centre, for what `outline` or `polygon` draw with these parameters; nothing if they are
/// few pieces, or if these are no closed contours.
pub fn strips(name: &str, params: &[f64]) -> Option<Vec<f64>> {
    let numbers = params.get(1..)?;
    let (rule, pieces): (f64, Vec<[f64; 4]>) = match name {
        "outline" => (0.0, numbers.as_chunks::<4>().0.to_vec()),
        "polygon" => {
            let points = numbers.as_chunks::<2>().0;
            let next = points.iter().cycle().skip(1);
            let pieces = points
                .iter()
                .zip(next)
                .map(|(a, b)| [a[0], a[1], b[0], b[1]]);
            (1.0, pieces.collect())
        }
        _ => return None,
    };
    if pieces.len() < WORTH {
        return None;
    }
    let contours = contours(&pieces)?;
    let mut list: Vec<&[[f64; 2]]> = contours.iter().map(Vec::as_slice).collect();
    let mut trees = Trees::default();
    trees.forest(&mut list);
    let count = (trees.nodes.len() / NODE) as f64;
    Some([&[rule, count], &trees.nodes[..], &trees.pieces].concat())
}

/// Closed lines through points, the first of which is also the last, made of all pieces.
fn contours(pieces: &[[f64; 4]]) -> Option<Vec<Vec<[f64; 2]>>> {
    // adding 0 makes both zeros one
    let key = |x: f64, y: f64| [x + 0.0, y + 0.0].map(f64::to_bits);
    let mut starts: HashMap<[u64; 2], Vec<usize>> = HashMap::new();
    for (i, p) in pieces.iter().enumerate().rev() {
        starts.entry(key(p[0], p[1])).or_default().push(i);
    }
    let mut used = vec![false; pieces.len()];
    let mut out = Vec::new();
    let mut first = 0;
    while first < pieces.len() {
        if used[first] {
            first += 1;
            continue;
        }
        let origin = key(pieces[first][0], pieces[first][1]);
        let mut points = vec![[pieces[first][0], pieces[first][1]]];
        loop {
            let last = points[points.len() - 1];
            let open = starts.get_mut(&key(last[0], last[1]))?;
            let next = open.pop()?;
            used[next] = true;
            points.push([pieces[next][2], pieces[next][3]]);
            if key(pieces[next][2], pieces[next][3]) == origin {
                break;
            }
        }
        out.push(points);
    }
    Some(out)
}

/// Trees as they are written down.
#[derive(Default)]
struct Trees {
    nodes: Vec<f64>,
    pieces: Vec<f64>,
}

impl Trees {
    /// Contours by place: few beside each other, more in discs.
    fn forest(&mut self, contours: &mut [&[[f64; 2]]]) {
        if contours.len() <= CHILDREN {
            for contour in contours {
                self.contour(contour);
            }
            return;
        }
        let half = halve(contours);
        let (before, behind) = contours.split_at_mut(half);
        for side in [before, behind] {
            let quarter = halve(side);
            let (before, behind) = side.split_at_mut(quarter);
            for group in [before, behind] {
                match group {
                    [] => {}
                    [contour] => self.contour(contour),
                    group => {
                        let points: Vec<[f64; 2]> =
                            group.iter().copied().flatten().copied().collect();
                        let centre = middle(&points);
                        self.node(centre, centre, &points, |trees| trees.forest(group));
                    }
                }
            }
        }
    }

    /// A closed line: in a disc, which has no sides.
    fn contour(&mut self, points: &[[f64; 2]]) {
        let centre = middle(points);
        self.node(centre, centre, points, |trees| trees.parts(points));
    }

    /// What a node of a line holds: the pieces of a short one, the parts of a long one.
    fn parts(&mut self, points: &[[f64; 2]]) {
        let pieces = points.len() - 1;
        if pieces <= PIECES {
            for ends in points.windows(2) {
                self.pieces.extend([ends[0], ends[1]].as_flattened());
            }
            return;
        }
        let count = pieces.div_ceil(PIECES).min(CHILDREN);
        for part in 0..count {
            let line = &points[part * pieces / count..=(part + 1) * pieces / count];
            let (a, b) = (line[0], line[line.len() - 1]);
            self.node(a, b, line, |trees| trees.parts(line));
        }
    }

    /// A node from `a` to `b` around points, and what it holds.
    fn node(
        &mut self,
        a: [f64; 2],
        b: [f64; 2],
        points: &[[f64; 2]],
        fill: impl FnOnce(&mut Self),
    ) {
        let (mut far, mut large) = (0.0f64, 0.0f64);
        for p in points {
            far = far.max(beside(*p, a, b));
            large = large.max(p[0].abs()).max(p[1].abs());
        }
        // for the roundings of places and of distances to them
        let far = far * (1.0 + 4e-6) + 4e-6 * large;
        let e = [b[0] - a[0], b[1] - a[1]];
        let length = e[0].hypot(e[1]);
        let along = if length > 0.0 {
            [e[0] / length, e[1] / length]
        } else {
            [1.0, 0.0]
        };
        let (at, first) = (self.nodes.len(), self.pieces.len() / PIECE);
        let segment = [a[0], a[1], along[0], along[1], length / 2.0, b[1], far];
        self.nodes.extend(segment);
        self.nodes.extend([first as f64, 0.0, 0.0]);
        fill(self);
        let tree = (self.nodes.len() - at) / NODE;
        // a node with children has no pieces of its own
        let own = if tree == 1 {
            self.pieces.len() / PIECE - first
        } else {
            0
        };
        self.nodes[at + NODE - 2] = own as f64;
        self.nodes[at + NODE - 1] = tree as f64;
    }
}

/// The middle of the box of points.
fn middle(points: &[[f64; 2]]) -> [f64; 2] {
    let [lo, hi] = hull(points);
    [0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1])]
}

/// Sorts contours along the longer side of what they fill; half of their number.
fn halve(contours: &mut [&[[f64; 2]]]) -> usize {
    let all = hull(contours.iter().copied().flatten());
    let k = usize::from(all[1][1] - all[0][1] > all[1][0] - all[0][0]);
    // found once each: a long contour may be compared with all others
    let mut sorted: Vec<_> = contours.iter().map(|c| (middle(c)[k], *c)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (to, (_, contour)) in contours.iter_mut().zip(sorted) {
        *to = contour;
    }
    contours.len() / 2
}

/// The smallest and largest coordinates of points.
fn hull<'a>(points: impl IntoIterator<Item = &'a [f64; 2]>) -> [[f64; 2]; 2] {
    let none = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    points.into_iter().fold(none, |[lo, hi], p| {
        [
            [lo[0].min(p[0]), lo[1].min(p[1])],
            [hi[0].max(p[0]), hi[1].max(p[1])],
        ]
    })
}

/// Distance of a point to a segment.
fn beside(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (e, w) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let squared = e[0] * e[0] + e[1] * e[1];
    let t = if squared > 0.0 {
        ((w[0] * e[0] + w[1] * e[1]) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (w[0] - t * e[0]).hypot(w[1] - t * e[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use zeroset_number::{Data, Dual, F64, Interval, v3};

    /// Rings of many corners, some of them where others are, wound either way, anywhere; as parameters of `outline`.
    fn contours() -> impl Strategy<Value = Vec<f64>> {
        let corner = (0.05..1.0f64, prop_oneof![4 => Just(0.0), 1 => 0.0..0.5f64]);
        let ring = (
            proptest::collection::vec(corner, 3..60),
            -3.0..3.0f64,
            -2.0..2.0f64,
            any::<bool>(),
            prop_oneof![Just(1.0), Just(1e-4), Just(300.0)],
        );
        proptest::collection::vec(ring, 1..12).prop_map(|rings| {
            let mut out = vec![0.0];
            for (corners, x, y, back, size) in rings {
                let n = corners.len() as f64;
                let mut points: Vec<[f64; 2]> = (0..)
                    .zip(&corners)
                    .map(|(i, (r, off))| {
                        let turn = std::f64::consts::TAU * (f64::from(i) + off) / n;
                        let at = [x + size * r * turn.cos(), y + size * r * turn.sin()];
                        at.map(|c| f64::from(c as f32))
                    })
                    .collect();
                if back {
                    points.reverse();
                }
                for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
                    out.extend([a[0], a[1], b[0], b[1]]);
                }
            }
            out[0] = ((out.len() - 1) / 4) as f64;
            out
        })
    }

    fn stored(numbers: &[f64]) -> Data {
        Data::from(numbers.iter().map(|x| *x as f32).collect::<Vec<f32>>())
    }

    /// With a centre that moves nothing.
    fn trees(name: &str, params: &[f64]) -> Option<Data> {
        strips(name, params).map(|s| stored(&[&[0.0; 3], &s[..]].concat()))
    }

    /// Points near corners and pieces, and anywhere, far away too.
    fn places(list: &[f64], about: &[(usize, f64, f64, f64)]) -> Vec<[f64; 2]> {
        let pieces = list[1..].as_chunks::<4>().0;
        let near = |&(i, t, x, y): &(usize, f64, f64, f64)| {
            let p = pieces[i % pieces.len()];
            [
                [0.0, 0.0],
                [1e-6 * x, 1e-6 * y],
                [0.1 * x, 0.1 * y],
                [x, y],
                [1e4 * x, 1e4 * y],
            ]
            .map(|by| {
                let t = if t < 0.2 { 0.0 } else { t };
                [
                    p[0] + t * (p[2] - p[0]) + by[0],
                    p[1] + t * (p[3] - p[1]) + by[1],
                ]
            })
        };
        about.iter().flat_map(near).collect()
    }

    proptest! {
        /// Nothing that is passed over counts: not for a distance, not for a sign, not for a gradient away from the edge.
        #[test]
        fn trees_are_what_they_stand_for(
            list in contours(),
            about in proptest::collection::vec((0..9999usize, 0.0..1.0f64, -4.0..4.0f64, -4.0..4.0f64), 1..12),
        ) {
            let Some(trees) = trees("outline", &list) else { return Ok(()) };
            let plain = stored(&list);
            for [x, y] in places(&list, &about) {
                let p = v3(x as f32, y as f32, 0.0);
                let (a, b) = (Outline::distance(p, Args::new(&plain)), Strips::leaf(p, Args::new(&trees)));
                prop_assert_eq!(a, b, "{} and {} at {}, {}", a, b, x, y);
                let p = v3(F64(x), F64(y), F64(0.0));
                let (a, b) = (Outline::distance(p, Args::new(&plain)), Strips::leaf(p, Args::new(&trees)));
                prop_assert_eq!(a.0, b.0, "{} and {} at {}, {}", a.0, b.0, x, y);
                let p = Dual::point(v3(x as f32, y as f32, 0.0));
                let (a, b) = (Outline::distance(p, Args::new(&plain)), Strips::leaf(p, Args::new(&trees)));
                // at a corner two pieces are as near as each other, and either may say the direction, with roundings of its own
                let clear = a.v.abs() > 1e-3 * (1.0 + p.x.v.abs() + p.y.v.abs());
                let off = (a.d[0] - b.d[0]).hypot(a.d[1] - b.d[1]);
                prop_assert!(!clear || off < 1e-3, "{:?} and {:?} at {}, {}", a.d, b.d, x, y);
            }
        }

        /// Ranges hold the values.
        #[test]
        fn ranges_hold(
            list in contours(),
            about in proptest::collection::vec((0..9999usize, 0.0..1.0f64, -4.0..4.0f64, -4.0..4.0f64), 1..4),
            half in 0.0..0.5f64,
            at in proptest::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 8),
        ) {
            let Some(trees) = trees("outline", &list) else { return Ok(()) };
            for [x, y] in places(&list, &about) {
                let side = |c: f64| Interval::new(c - half, c + half);
                let range = Strips::leaf(v3(side(x), side(y), Interval::from(0.0f32)), Args::new(&trees));
                for (u, v) in &at {
                    let p = v3(F64(x + half * u), F64(y + half * v), F64(0.0));
                    let value = Strips::leaf(p, Args::new(&trees)).0;
                    prop_assert!(range.lo <= value + 1e-9 && value <= range.hi + 1e-9, "{value} in {range:?}");
                }
            }
        }
    }

    #[test]
    fn polygons_count_crossings() {
        // a star that crosses itself: its middle is outside by crossings, inside by winding
        let points: Vec<[f64; 2]> = (0..25)
            .map(|i| {
                let turn = std::f64::consts::TAU * f64::from(i * 11 % 25) / 25.0;
                [turn.cos(), turn.sin()].map(|c| f64::from(c as f32))
            })
            .collect();
        let list: Vec<f64> = [25.0]
            .into_iter()
            .chain(points.into_iter().flatten())
            .collect();
        let (plain, trees) = (stored(&list), trees("polygon", &list).expect("trees"));
        for i in -20..=20i8 {
            for j in -20..=20i8 {
                let p = v3(f32::from(i) / 16.3, f32::from(j) / 16.7, 0.0);
                let (a, b) = (
                    Polygon::distance(p, Args::new(&plain)),
                    Strips::leaf(p, Args::new(&trees)),
                );
                assert_eq!(a.to_bits(), b.to_bits(), "{i}, {j}");
            }
        }
    }

    #[test]
    fn few_pieces_have_none() {
        assert_eq!(strips("outline", Outline::INFO.params[0].default), None);
        assert_eq!(strips("box", &[1.0; 40]), None);
        // what is not closed
        let open: Vec<f64> = [20.0].into_iter().chain((0..160).map(f64::from)).collect();
        assert_eq!(strips("outline", &open), None);
    }
}
