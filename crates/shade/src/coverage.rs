//! Antialiasing by coverage: which part of a pixel a surface covers.
//!
//! A pixel's ray is followed as a cone that holds the pixel (Amanatides 1984; Hart 1996; Tomczak 2012, chapter 5). Where the field comes
//! below the radius of the cone and rises again before it falls below minus the radius, an edge of a silhouette goes through the
//! cone. The representative of that crossing is the place where the field is least in proportion to the radius. Its value and gradient give the line in
//! which the silhouette crosses the pixel, and the line parts the pixel in two: one that is covered, one that is not. Each is
//! seen by a ray through its middle, and counts as much as its area; what is not covered goes on as a cone of its own, behind the
//! edge, and may be parted again.
//!
//! That is Hart's compositing front to back, but for two things. He takes the pixel for a disc and every edge for independent of
//! those before it; here the parts are exact polygons, so that two objects with one edge in common leave no gap. And he shades the
//! representative, where the surface is seen exactly from its side; here a part shows what is in its middle.

use crate::march::{Rough, STEEPEST, rise, slope_step};
use zeroset_number::{Real, Vec2, v2};

/// Corners of a part at most: a square's, and one more for each line that cuts it.
pub const CORNERS: usize = 12;
/// Edges that a pixel may be parted by, at most.
pub const LAYERS: u32 = (CORNERS - 4) as u32;
/// Edges that a cone may pass which turn out not to cross its part of the pixel, before that is shown by one ray.
pub const PASSES: u32 = 8;
/// Parts smaller than this share of a pixel are none.
pub const SMALLEST: f32 = 1.0 / 256.0;
/// Steps of a cone are at least this share of its radius.
pub const FINE: f32 = 0.35;
/// How far values between two samples may be from a straight line, in radii.
pub const BENT: f32 = 0.8;
/// Values may be this much larger than expected, in radii: else the step was too long.
pub const SURPRISE: f32 = 0.3;
/// How far the field rises from its least value behind an edge, in radii.
pub const RISE: f32 = 0.25;
/// How far it falls before that.
pub const FALL: f32 = 0.1;
/// A cone ends where the field should be so many radii below zero.
pub const BEYOND: f32 = 1.05;
/// Nearer to a surface than so many radii a cone guesses, as far as values go on in a straight line.
pub const NEAR: f32 = 4.0;
/// Share of the longest sure step that is taken.
pub const SURE: f32 = 0.97;
/// Under so many radii a cone is covered.
pub const SOLID: f32 = -1.0;
/// The same for fractals, whose field is hardly ever below zero.
pub const FRACTAL: f32 = 0.5;
/// Steps of a cone at most. Where they run out its pixel is shown by one ray.
pub const STEPS: u32 = 192;

/// A convex part of a pixel: its corners in order, in pixels from the pixel's middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    corners: [Vec2<f32>; CORNERS],
    count: usize,
}

/// A line across a picture: `value + slope . (p - from)`, which is negative on the covered side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// The value at `from`.
    pub value: f32,
    /// How it rises, per pixel to the right and downwards.
    pub slope: Vec2<f32>,
    /// Pixels.
    pub from: Vec2<f32>,
}

impl Part {
    /// The whole pixel.
    pub const PIXEL: Part = {
        let mut corners = [Vec2 { x: 0.0, y: 0.0 }; CORNERS];
        corners[0] = Vec2 { x: -0.5, y: -0.5 };
        corners[1] = Vec2 { x: 0.5, y: -0.5 };
        corners[2] = Vec2 { x: 0.5, y: 0.5 };
        corners[3] = Vec2 { x: -0.5, y: 0.5 };
        Part { corners, count: 4 }
    };

    /// Its corners, in order.
    pub fn corners(&self) -> &[Vec2<f32>] {
        &self.corners[..self.count]
    }

    /// Area in pixels, and the middle (the centroid).
    pub fn measure(&self) -> (f32, Vec2<f32>) {
        let corners = self.corners();
        let Some(&first) = corners.first() else {
            return (0.0, v2(0.0, 0.0));
        };
        // triangles from the first corner
        let (mut twice, mut sum) = (0.0, v2(0.0, 0.0));
        for pair in corners.windows(2).skip(1) {
            let (a, b) = (pair[0] - first, pair[1] - first);
            let area = a.x * b.y - a.y * b.x;
            twice += area;
            sum = sum + (a + b) * area;
        }
        if twice <= 0.0 {
            return (0.0, first);
        }
        (0.5 * twice, first + sum * (1.0 / (3.0 * twice)))
    }

    /// How far its corners are from a place at most, pixels.
    pub fn reach(&self, from: Vec2<f32>) -> f32 {
        let squares = self.corners().iter().map(|&c| (c - from).dot(c - from));
        squares.fold(0.0, f32::max).sqrt()
    }

    /// What of it is on one side of an edge: the covered one, or the other (Sutherland and Hodgman 1974).
    pub fn side(&self, edge: &Edge, covered: bool) -> Part {
        let value = |p: Vec2<f32>| {
            let value = edge.value + edge.slope.dot(p - edge.from);
            if covered { -value } else { value }
        };
        let (mut corners, mut count) = ([v2(0.0, 0.0); CORNERS], 0);
        let mut push = |p| {
            // a line cuts a convex part in two places, so that there is room
            if count < CORNERS {
                corners[count] = p;
                count += 1;
            }
        };
        let own = self.corners();
        for (k, &a) in own.iter().enumerate() {
            let b = own[(k + 1) % own.len()];
            let (at_a, at_b) = (value(a), value(b));
            if at_a >= 0.0 {
                push(a);
            }
            if (at_a >= 0.0) != (at_b >= 0.0) {
                push(a + (b - a) * (at_a / (at_a - at_b)));
            }
        }
        Part { corners, count }
    }
}

/// A cone on its way.
#[derive(Clone, Copy, Debug)]
pub struct Cone<R> {
    /// Where the last sample was that counts.
    pub t: R,
    /// How much farther the next one is. Negative, with the same meaning, where that is a guess of where the cone is covered.
    pub z: R,
    /// The field there, from the side that the cone is on.
    pub f: R,
    /// How the field changes along the ray.
    pub slope: R,
    /// The least value since it began to fall, in radii.
    pub low: R,
    /// Where that was.
    pub at: R,
    /// The largest value before it began to fall, in radii; below [`FALLING`] once it did.
    pub high: R,
    /// Up to here the field is larger than the radius, for sure.
    pub free: R,
}

/// See [`Cone::high`].
pub const FALLING: f32 = -1e30;
/// [`Cone::high`] of a cone that has seen nothing yet.
pub const UNSEEN: f32 = -1e29;

/// What a sample of a cone led to.
#[derive(Clone, Copy, Debug)]
pub struct Watched<R: Real> {
    /// The cone afterwards.
    pub cone: Cone<R>,
    /// Whether what it met covers it, or there is no telling without a ray.
    pub covered: R::Mask,
    /// Whether it passed an edge, at `cone.at`.
    pub edge: R::Mask,
    /// Whether it ended without meeting anything.
    pub clear: R::Mask,
}

/// Looks at the sample `f` of a cone that has this radius there and ends at `end`. `first`: it is the first sample, at `cone.t`.
/// `touched`: under so many radii a cone is covered.
#[inline(always)]
pub fn watch<R: Rough>(
    cone: Cone<R>,
    f: R,
    radius: R,
    end: R,
    first: R::Mask,
    touched: R::Scalar,
) -> Watched<R> {
    let (zero, one) = (f.lit(0.0), f.lit(1.0));
    let (z, fine) = (cone.z.abs(), radius * FINE);
    let to = cone.t + z;
    // what is sure is free, from the last sample and from this one
    let (before, here) = ((cone.f - radius).max(zero), f - radius);
    let gap = z.above(before + here);
    let guessed = cone.z.below(zero);
    let surprised = (f - cone.f - cone.slope * z).above(radius * SURPRISE);
    let wrong = (guessed & surprised) | (!guessed & before.above(zero) & gap);
    let strayed = wrong & z.above(before.max(fine) * 1.001) & !first;
    let shorter = z * 0.25;
    let least = before.max(fine);
    let back = R::select(guessed & shorter.above(least), -shorter, least);

    let slope = R::select(first, cone.slope, rise(cone.f, f, z));
    let share = f * radius.max(f.lit(f32::MIN_POSITIVE)).recip();
    let near = share.below(one);
    let falling = cone.high.below(f.lit(FALLING)) | share.below(cone.high - FALL);
    let lower = share.below(cone.low) | !falling;
    let low = R::select(lower, share, cone.low);
    let met = falling & low.below(one);
    let ended = !to.below(end);
    // spheres that overlap, from the beginning on, leave nothing between them
    let chained = first | (!gap & !cone.free.below(cone.t));
    let unknown = ended & !met & !chained;
    let covered = ((share.below(f.like(touched)) & !first) | unknown) & !strayed;
    let edge = met & (ended | share.above(low + RISE)) & !covered & !strayed;
    let clear = ended & !met & !covered & !strayed;

    // as far as values go on in a straight line, but not beyond where the cone should be covered
    let bend = (slope - cone.slope).abs() * z.max(fine).recip();
    let straight = (radius * BENT * bend.max(f.lit(1e-12)).recip()).sqrt();
    let longest = (z.max(radius * NEAR)) * 2.0;
    let covers = (f + radius * BEYOND) * (-slope).max(f.lit(1e-6)).recip();
    let goes_down = slope.below(zero);
    let ahead = straight.min(longest);
    let ahead = R::select(goes_down, ahead.min(covers), ahead);
    let close = share.below(f.lit(NEAR));
    // the radius grows on the way
    let sure = (slope_step(here.max(zero), slope.min(f.lit(STEEPEST))) * SURE).max(fine);
    let guesses = close & ahead.above(sure);
    let rest = R::select(strayed, end - cone.t, end - to).max(fine * 0.01);
    let step = R::select(guesses, -ahead, sure);
    let step = R::select(strayed, back, step).min(rest).max(-rest);

    let free = R::select(chained & !near, to, cone.free);
    Watched {
        cone: Cone {
            t: R::select(strayed, cone.t, to),
            z: step,
            f: R::select(strayed, cone.f, f),
            slope: R::select(strayed, cone.slope, slope),
            low: R::select(strayed, cone.low, low),
            at: R::select(lower & !strayed, to, cone.at),
            high: {
                let high = R::select(falling, f.lit(2.0 * FALLING), cone.high.max(share));
                R::select(strayed, cone.high, high)
            },
            free: R::select(strayed, cone.free, free),
        },
        covered,
        edge,
        clear,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn line(angle: f32, offset: f32) -> Edge {
        let (y, x) = angle.sin_cos();
        Edge {
            value: offset,
            slope: v2(x, y),
            from: v2(0.0, 0.0),
        }
    }

    /// The share of a grid of points in a pixel that lie where all lines say so, and their mean.
    fn counted(lines: &[(Edge, bool)]) -> (f32, Vec2<f32>) {
        const SIDE: usize = 256;
        let (mut count, mut sum) = (0.0, v2(0.0, 0.0));
        for k in 0..SIDE * SIDE {
            let at = |n: usize| (n as f32 + 0.5) / SIDE as f32 - 0.5;
            let p = v2(at(k % SIDE), at(k / SIDE));
            let holds = |(edge, covered): &(Edge, bool)| {
                (edge.value + edge.slope.dot(p - edge.from) < 0.0) == *covered
            };
            if lines.iter().all(holds) {
                count += 1.0;
                sum = sum + p;
            }
        }
        (
            count / (SIDE * SIDE) as f32,
            sum * (1.0 / f32::max(count, 1.0)),
        )
    }

    proptest! {
        #[test]
        fn parts_have_their_areas_and_middles(
            lines in prop::collection::vec((0.0f32..6.3, -0.6f32..0.6, any::<bool>()), 0..8)
        ) {
            let lines: Vec<(Edge, bool)> =
                lines.into_iter().map(|(angle, offset, side)| (line(angle, offset), side)).collect();
            let part = lines.iter().fold(Part::PIXEL, |part, (edge, side)| part.side(edge, *side));
            let (area, middle) = part.measure();
            let (wanted, at) = counted(&lines);
            prop_assert!((area - wanted).abs() < 0.01, "{area} for {wanted}");
            if wanted > 0.05 {
                prop_assert!((middle - at).dot(middle - at).sqrt() < 0.02, "{middle:?} for {at:?}");
            }
        }

        #[test]
        fn both_sides_of_an_edge_make_the_whole(angle in 0.0f32..6.3, offset in -0.7f32..0.7) {
            let edge = line(angle, offset);
            let [a, b] = [true, false].map(|side| Part::PIXEL.side(&edge, side).measure().0);
            prop_assert!((a + b - 1.0).abs() < 1e-5, "{a} and {b}");
        }
    }

    /// Follows a cone of radius `wide` along the x axis of a field.
    fn followed(f: impl Fn(f32) -> f32, wide: f32, end: f32) -> (&'static str, f32, u32) {
        let mut cone = Cone {
            t: 0.0,
            z: 0.0,
            f: 0.0,
            slope: -1.0,
            low: 0.0,
            at: 0.0,
            high: UNSEEN,
            free: 0.0,
        };
        for steps in 1..=STEPS {
            let found = watch(cone, f(cone.t + cone.z.abs()), wide, end, steps == 1, SOLID);
            cone = found.cone;
            match (found.covered, found.edge, found.clear) {
                (true, ..) => return ("covered", cone.t, steps),
                (_, true, _) => return ("edge", cone.at, steps),
                (.., true) => return ("clear", cone.t, steps),
                _ => {}
            }
        }
        ("spent", cone.t, STEPS)
    }

    #[test]
    fn cones_find_edges_of_spheres_and_boxes_and_nothing_else() {
        for wide in [0.001, 0.01, 0.05] {
            // past a sphere at (5, 0), at heights around its radius, in radii of the cone
            for by in [-3.0, -1.2, -0.9, -0.5, -0.1, 0.1, 0.5, 0.9, 1.2, 3.0] {
                let height = 1.0 + by * wide;
                let sphere = |x: f32| (x - 5.0).hypot(height) - 1.0;
                let (what, at, steps) = followed(sphere, wide, 20.0);
                // near by, a guess may have to be looked after by a ray
                let wanted: &[&str] = match by {
                    b if b < -1.0 => &["covered"],
                    b if b > 1.0 => &["clear", "covered", "spent"],
                    _ => &["edge"],
                };
                assert!(wanted.contains(&what), "{what}: sphere by {by} of {wide}");
                assert!(steps < 100, "sphere by {by} of {wide}: {steps} steps");
                if what == "edge" {
                    let off = sphere(at) - sphere(5.0);
                    assert!(off < 0.12 * wide, "sphere by {by} of {wide}: {off} off");
                }
                // past a long box that begins at x = 4, head-on
                let side = |x: f32| {
                    let (dx, dy) = ((x - 14.0).abs() - 10.0, by * wide);
                    dx.max(0.0).hypot(dy.max(0.0)) + dx.max(dy).min(0.0)
                };
                let (what, _, steps) = followed(side, wide, 40.0);
                assert!(wanted.contains(&what), "{what}: box by {by} of {wide}");
                assert!(
                    steps < 150 || by > 1.0,
                    "box by {by} of {wide}: {steps} steps"
                );
            }
            // a plane is met at any angle
            for slope in [1.0f32, 0.5, 0.1, 0.02] {
                let plane = |x: f32| 0.5 - slope * x;
                let (what, _, steps) = followed(plane, wide, 100.0);
                assert_eq!(what, "covered", "plane of slope {slope}, {wide}");
                assert!(
                    (steps as f32) < 20.0 + 3.0 / slope,
                    "plane of slope {slope}, {wide}: {steps} steps"
                );
            }
            // a plate that is thinner than the cone, head-on, is no edge without a wall behind it and none with one
            let plate = |x: f32| (x - 3.0).abs() - 0.3 * wide;
            assert_eq!(followed(plate, wide, 10.0).0, "edge", "plate, {wide}");
        }
    }
}
