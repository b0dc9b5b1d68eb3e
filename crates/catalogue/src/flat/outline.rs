//! Regions within straight-sided contours of any length.

use super::*;

/// What the edges passed so far say of a point.
#[derive(Clone, Copy)]
pub(super) struct Seen<R> {
    /// Square of the distance to the nearest.
    pub(super) nearest: R,
    /// The distance to the line through it where the square is zero: only its gradient is ever used.
    pub(super) touch: R,
}

impl<R: Real> Seen<R> {
    /// Nothing yet.
    #[inline(always)]
    pub(super) fn nothing(x: R) -> Self {
        Seen {
            nearest: x.lit(1e30),
            touch: x,
        }
    }

    /// Takes in an edge, and says whether it passes the height of `p` going up with `p` to its left, and going down with `p`
    /// to its right.
    ///
    /// A point at the height of a vertex counts as above it, so that the two edges that meet there agree, and so does a point
    /// on a level edge.
    #[inline(always)]
    pub(super) fn pass(
        self,
        p: Vec2<R>,
        from: Vec2<R::Scalar>,
        to: Vec2<R::Scalar>,
    ) -> (Self, R::Mask, R::Mask) {
        let e = edge(p, from, to);
        let (left, start, end) = (e.right.negative(), p.y.below(from.y), p.y.below(to.y));
        let level = (to.y - from.y).abs().below(1e-30) & from.x.below(to.x);
        let side = R::Scalar::select(level, from.x.lit(-1.0), from.x.lit(1.0));
        let squared = e.distance_squared();
        let seen = Seen {
            touch: R::choose(squared.below(self.nearest), e.right * side, self.touch),
            nearest: squared.min(self.nearest),
        };
        (seen, !start & end & left, start & !end & !left)
    }

    /// Distance to the nearest edge.
    #[inline(always)]
    pub(super) fn distance(self) -> R {
        R::select(self.nearest.above(0.0), self.nearest.sqrt(), self.touch)
    }
}

/// A polygon.
pub struct Polygon;
impl Primitive for Polygon {
    const INFO: Info = flat(
        "polygon",
        "The region within a closed line through any number of points.",
        "sign by the number of crossings (Shimrat 1962), even for outside",
        &[list(
            "points",
            Unit::Length,
            2,
            &[
                -0.8, -0.6, 0.3, -0.6, 0.3, -0.9, 0.9, -0.1, 0.3, 0.7, 0.3, 0.3, -0.8, 0.3,
            ],
            "The corners in their order, either way round.",
        )],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[3.0, 0.0, 1.0, 1.0, 0.0, -0.5, -0.5],
        &[5.0, 0.0, 1.0, 0.6, -0.8, -0.95, 0.3, 0.95, 0.3, -0.6, -0.8],
        &[
            6.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, -1.0, 1.0,
        ],
    ];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        R::bounded_slope(
            p,
            1.0,
            #[inline(always)]
            |p| {
                let none = Seen::nothing(p.x);
                let (nearest, touch, sign) = a.fold(
                    Ends::Ring,
                    (none.nearest, none.touch, p.x.lit(1.0)),
                    #[inline(always)]
                    |(nearest, touch, sign), from: [_; 2], to: [_; 2]| {
                        let (from, to) = (v2(from[0], from[1]), v2(to[0], to[1]));
                        let (seen, up, down) = Seen { nearest, touch }.pass(p.xy(), from, to);
                        (seen.nearest, seen.touch, R::choose(up | down, -sign, sign))
                    },
                );
                Seen { nearest, touch }.distance() * sign
            },
        )
    }
    fn bounds(a: &[f64]) -> Aabb {
        around(a[1..].chunks_exact(2).map(|p| [p[0], p[1]]), 0.0)
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        let points: Vec<[f64; 2]> = a[1..].chunks_exact(2).map(|p| [p[0], p[1]]).collect();
        odd(&points, [p[0], p[1]])
    }
    fn check(a: &[f64]) -> Result<(), String> {
        if a[0] >= 3.0 {
            Ok(())
        } else {
            Err(format!("a polygon takes at least 3 points, not {}", a[0]))
        }
    }
}

/// How many times the contours of these segments (x and y of start and end) run around a point, by the crossings of a ray
/// upwards.
pub fn winding(segments: &[f64], [x, y]: [f64; 2]) -> i32 {
    let mut winding = 0;
    for s in segments.chunks_exact(4) {
        if (s[0] <= x) != (s[2] <= x) {
            let height = s[1] + (x - s[0]) / (s[2] - s[0]) * (s[3] - s[1]);
            winding += i32::from(height > y) * if s[0] <= x { -1 } else { 1 };
        }
    }
    winding
}

/// Filled contours, as of letters.
pub struct Outline;
impl Primitive for Outline {
    const INFO: Info = flat(
        "outline",
        "The region within closed contours with holes: letters, drawings.",
        "sign by the winding number (Sunday 2001), zero for outside",
        &[list(
            "segments",
            Unit::Length,
            4,
            &[
                -0.8, -0.6, 0.8, -0.6, 0.8, -0.6, 0.8, 0.6, 0.8, 0.6, -0.8, 0.6, -0.8, 0.6, -0.8,
                -0.6, //
                -0.4, -0.3, 0.0, 0.4, 0.0, 0.4, 0.4, -0.3, 0.4, -0.3, -0.4, -0.3,
            ],
            "Start and end of every straight piece; holes run the other way round.",
        )],
    );
    /// Pieces inside, where contours overlap, shorten the distance there.
    const EXACTNESS: Exactness = Exactness::Outside;
    const SAMPLES: &'static [&'static [f64]] = &[&[
        8.0, -1.0, -0.5, 0.4, -0.5, 0.4, -0.5, 0.4, 0.5, 0.4, 0.5, -1.0, 0.5, -1.0, 0.5, -1.0,
        -0.5, //
        -0.2, -0.3, 1.0, -0.3, 1.0, -0.3, 1.0, 0.8, 1.0, 0.8, -0.2, 0.8, -0.2, 0.8, -0.2, -0.3,
    ]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        R::bounded_slope(
            p,
            1.0,
            #[inline(always)]
            |p| {
                let none = Seen::nothing(p.x);
                let (nearest, touch, winding) = a.each(
                    (none.nearest, none.touch, p.x.lit(0.0)),
                    #[inline(always)]
                    |(nearest, touch, winding), s: [_; 4]| {
                        let (from, to) = (v2(s[0], s[1]), v2(s[2], s[3]));
                        let (seen, up, down) = Seen { nearest, touch }.pass(p.xy(), from, to);
                        let winding = R::choose(up, winding + 1.0, winding);
                        let winding = R::choose(down, winding - 1.0, winding);
                        (seen.nearest, seen.touch, winding)
                    },
                );
                let d = Seen { nearest, touch }.distance();
                R::select(winding.abs().above(0.5), -d, d)
            },
        )
    }
    fn bounds(a: &[f64]) -> Aabb {
        around(a[1..].chunks_exact(2).map(|p| [p[0], p[1]]), 0.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        winding(&a[1..], [x, y]) != 0
    }
    fn check(a: &[f64]) -> Result<(), String> {
        let mut ends: Vec<([u64; 2], i32, usize)> = Vec::new();
        for (i, s) in a[1..].chunks_exact(4).enumerate() {
            // adding 0 makes both zeros one
            ends.push(([s[0] + 0.0, s[1] + 0.0].map(f64::to_bits), 1, i));
            ends.push(([s[2] + 0.0, s[3] + 0.0].map(f64::to_bits), -1, i));
        }
        if ends.is_empty() {
            return Err("an outline takes at least one segment".into());
        }
        ends.sort_unstable();
        for point in ends.chunk_by(|a, b| a.0 == b.0) {
            if point.iter().map(|p| p.1).sum::<i32>() != 0 {
                let [x, y] = point[0].0.map(f64::from_bits);
                return Err(format!(
                    "contours must be closed: at ({x}, {y}), of segment {}, more begin or end than go on",
                    point[0].2
                ));
            }
        }
        Ok(())
    }
}
