//! From a glyph's curves to the straight pieces of its edge.

use skrifa::outline::OutlinePen;

use zeroset_catalogue::Primitive;
use zeroset_catalogue::flat::{Outline, winding};

/// A straight piece: x and y of its start and its end.
pub(super) type Piece = [f64; 4];

/// Draws curves as pieces.
pub(super) struct Contours {
    scale: f64,
    tolerance: f64,
    limit: usize,
    pieces: Vec<Piece>,
    /// Where the contour began, and where it is, in font units.
    start: [f64; 2],
    at: [f64; 2],
}

impl Contours {
    /// For outlines in font units of `scale` scene units each, with curves true to `tolerance` font units.
    pub(super) fn new(scale: f64, tolerance: f64, limit: usize) -> Self {
        Contours {
            scale,
            tolerance,
            limit,
            pieces: Vec::new(),
            start: [0.0; 2],
            at: [0.0; 2],
        }
    }

    /// The pieces, or nothing if there were more than the limit.
    pub(super) fn finish(mut self) -> Option<Vec<Piece>> {
        self.close();
        (self.pieces.len() <= self.limit).then_some(self.pieces)
    }

    fn to(&mut self, x: f64, y: f64) {
        // as the evaluators will read them, so that contours stay closed
        let stored = |x: f64| f64::from((x * self.scale) as f32);
        let piece = [stored(self.at[0]), stored(self.at[1]), stored(x), stored(y)];
        if (piece[0], piece[1]) != (piece[2], piece[3]) && self.pieces.len() <= self.limit {
            self.pieces.push(piece);
        }
        self.at = [x, y];
    }

    /// As many pieces as keep within the tolerance of a curve whose second derivative is at most `second`: a chord over a
    /// step h is off by at most h^2 / 8 of it.
    fn steps(&self, second: f64) -> usize {
        ((second / (8.0 * self.tolerance)).sqrt().ceil()).clamp(1.0, 256.0) as usize
    }
}

impl OutlinePen for Contours {
    fn move_to(&mut self, x: f32, y: f32) {
        self.close();
        self.start = [x.into(), y.into()];
        self.at = self.start;
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.to(x.into(), y.into());
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        let [a, b, c] = [self.at, [cx.into(), cy.into()], [x.into(), y.into()]];
        let bend: [f64; 2] = std::array::from_fn(|k| 2.0 * (a[k] - 2.0 * b[k] + c[k]));
        let n = self.steps(bend[0].hypot(bend[1]));
        for i in 1..=n {
            let t = i as f64 / n as f64;
            let s = 1.0 - t;
            let on = |k: usize| s * s * a[k] + 2.0 * s * t * b[k] + t * t * c[k];
            self.to(on(0), on(1));
        }
    }

    fn curve_to(&mut self, bx: f32, by: f32, cx: f32, cy: f32, x: f32, y: f32) {
        let [a, b, c, d] = [
            self.at,
            [bx.into(), by.into()],
            [cx.into(), cy.into()],
            [x.into(), y.into()],
        ];
        let bend = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
            6.0 * (p[0] - 2.0 * q[0] + r[0]).hypot(p[1] - 2.0 * q[1] + r[1])
        };
        let n = self.steps(bend(a, b, c).max(bend(b, c, d)));
        for i in 1..=n {
            let t = i as f64 / n as f64;
            let s = 1.0 - t;
            let on = |k: usize| {
                s * s * s * a[k] + 3.0 * s * t * (s * b[k] + t * c[k]) + t * t * t * d[k]
            };
            self.to(on(0), on(1));
        }
    }

    fn close(&mut self) {
        let [x, y] = self.start;
        self.to(x, y);
    }
}

/// Most pieces for which every pair is looked at.
const CUT: usize = 3000;

/// The edge of what the contours enclose (winding number not zero), with the inside to the left. Fonts lay contours over one
/// another; what lies within the whole is no edge and would shorten the distances inside.
///
/// If the cut edge is not closed (contours that touch along a way may do that), the contours stay as they are, which is right
/// but for those distances.
pub(super) fn boundary(contours: Vec<Piece>) -> Vec<Piece> {
    if contours.len() > CUT {
        return contours;
    }
    let list = |pieces: &[Piece]| -> Vec<f64> {
        std::iter::once(pieces.len() as f64)
            .chain(pieces.iter().flatten().copied())
            .collect()
    };
    let mut edge = Vec::new();
    for [ax, ay, bx, by] in cut(&contours) {
        // a little to the left and to the right of the middle
        let aside = [1e-4 * (ay - by), 1e-4 * (bx - ax)];
        let side = |way: f64| {
            let at = [
                0.5 * (ax + bx) + way * aside[0],
                0.5 * (ay + by) + way * aside[1],
            ];
            winding(contours.as_flattened(), at) != 0
        };
        match (side(1.0), side(-1.0)) {
            (true, false) => edge.push([ax, ay, bx, by]),
            (false, true) => edge.push([bx, by, ax, ay]),
            _ => {}
        }
    }
    if !edge.is_empty() && Outline::check(&list(&edge)).is_ok() {
        edge
    } else {
        contours
    }
}

/// The pieces, cut where they cross or touch one another.
fn cut(pieces: &[Piece]) -> Vec<Piece> {
    let mut out = Vec::with_capacity(pieces.len());
    for (i, p) in pieces.iter().enumerate() {
        let mut cuts: Vec<(f64, [f64; 2])> = (pieces.iter().enumerate())
            .filter(|(j, _)| *j != i)
            .filter_map(|(j, q)| {
                if i < j {
                    crossing(p, q)
                } else {
                    crossing(q, p)
                }
            })
            .map(|at| (along(p, at), at))
            .filter(|(t, _)| (0.0..=1.0).contains(t))
            .collect();
        cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut from = [p[0], p[1]];
        for to in cuts.into_iter().map(|c| c.1).chain([[p[2], p[3]]]) {
            if from != to {
                out.push([from[0], from[1], to[0], to[1]]);
                from = to;
            }
        }
    }
    out
}

/// Where along a piece a point of it is, 0 at its start and 1 at its end.
fn along(p: &Piece, at: [f64; 2]) -> f64 {
    let e = [p[2] - p[0], p[3] - p[1]];
    ((at[0] - p[0]) * e[0] + (at[1] - p[1]) * e[1]) / (e[0] * e[0] + e[1] * e[1])
}

/// The point where two pieces meet, as the evaluators will read it; the same for either piece.
fn crossing(p: &Piece, q: &Piece) -> Option<[f64; 2]> {
    for k in 0..2 {
        if p[k].max(p[k + 2]) < q[k].min(q[k + 2]) || q[k].max(q[k + 2]) < p[k].min(p[k + 2]) {
            return None;
        }
    }
    let (e, f) = ([p[2] - p[0], p[3] - p[1]], [q[2] - q[0], q[3] - q[1]]);
    let w = [q[0] - p[0], q[1] - p[1]];
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let area = cross(e, f);
    if area == 0.0 {
        return None;
    }
    let (t, u) = (cross(w, f) / area, cross(w, e) / area);
    const END: f64 = 1e-6;
    let within = |t: f64| (-END..=1.0 + END).contains(&t);
    if !within(t) || !within(u) {
        return None;
    }
    // ends stay what they are
    let ends = [(t, p, 0), (t - 1.0, p, 2), (u, q, 0), (u - 1.0, q, 2)];
    if let Some((_, of, k)) = ends.into_iter().find(|(t, ..)| t.abs() <= END) {
        return Some([of[k], of[k + 1]]);
    }
    Some([p[0] + t * e[0], p[1] + t * e[1]].map(|x| f64::from(x as f32)))
}
