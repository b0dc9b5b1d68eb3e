//! What is known of a hit once its ray has ended: the exact place, the residual, the normal.

use crate::bracket::Bracket;
use crate::simd::{
    INSIDE, along, first_lanes, load, load_words, load3, sided, splat, splat3, store, store3,
};
use crate::tile::{Hits, Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use zeroset_eval::{BATCH, Lane, Workspace};
use zeroset_field::program::FLAT;
use zeroset_number::{Lanes, Ops, Real, Vec3, v3};
use zeroset_scene::settings::Normals;
use zeroset_shade::march::{MIDDLE, REFINEMENTS, SETTLED, root};
use zeroset_shade::normal::{CENTRAL, NEIGHBOURS_18, NEIGHBOURS_26, TETRAHEDRON, step};

/// Vectors of rays go on together while more than this share of them moves.
const TOGETHER: f32 = 0.25;
/// Finds the points where the sign changes, and the values there if they are wanted; then, `rounds` times, puts hits where the
/// footprint of their pixel meets the surface (Keinert 2014, 3.4, equations 2 and 3).
pub(crate) fn place<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    rounds: u32,
    residual: bool,
    q: &mut Scratch,
) {
    s.vectorize(
        #[inline(always)]
        || {
            for k in (0..q.hits.count).step_by(BATCH) {
                let n = (q.hits.count - k).min(BATCH);
                if q.hits.beyond[k..k + n].iter().any(|z| *z > 0.0) {
                    refine(s, solid, k, n, q);
                }
                for _ in 0..rounds {
                    if solid.stop.is_set() {
                        break;
                    }
                    values_at(
                        s,
                        solid,
                        n,
                        &mut q.work,
                        #[inline(always)]
                        |i| point_of(s, &q.hits, k + i),
                    );
                    q.counts.march += n as u64;
                    for i in (0..n).step_by(S::f32s::LEN) {
                        let t = load(s, &q.hits.t, k + i);
                        let f = sided(
                            load(s, &q.work.values().0, i),
                            load_words(s, &q.hits.word, k + i),
                        );
                        let wanted = near(s, solid, &q.hits, k + i);
                        // a hit that was taken for want of steps may be far from the surface: it stays
                        let by = (f - wanted).clamp(-(wanted * 2.0), wanted * 2.0);
                        store((t + by).max(0.0), &mut q.hits.t, k + i);
                    }
                }
                for i in (0..n).step_by(S::f32s::LEN) {
                    let p = point_of(s, &q.hits, k + i);
                    store3(p, &mut q.hits.point, k + i);
                    // what is left of a value between places on both sides of the surface says nothing
                    let between = load(s, &q.hits.beyond, k + i).above(0.0);
                    let f = Lanes::select(between, splat(s, 0.0), load(s, &q.hits.f, k + i));
                    let near = near(s, solid, &q.hits, k + i);
                    store(f.abs().max(near) * 2.0, &mut q.hits.offset, k + i);
                }
                if residual {
                    values_at(
                        s,
                        solid,
                        n,
                        &mut q.work,
                        #[inline(always)]
                        |i| load3(s, &q.hits.point, k + i),
                    );
                    q.counts.march += n as u64;
                    q.hits.residual[k..k + n].copy_from_slice(&q.work.values().0[..n]);
                }
            }
        },
    );
}

/// The radius of the footprint at the hits from `i` on.
#[inline(always)]
fn near<S: Simd>(s: S, solid: &Solid<'_>, hits: &Hits, i: usize) -> Lanes<S> {
    solid.near(&hits.ray(s, i), load(s, &hits.t, i))
}

/// Where a line through the values at both ends of the part of a ray is zero, from its beginning.
#[inline(always)]
fn zero<S: Simd>(s: S, hits: &Hits, i: usize) -> Lanes<S> {
    let share = root(load(s, &hits.f, i), load(s, &hits.behind, i));
    load(s, &hits.beyond, i) * share
}

/// The next guess of where the sign changes, from the beginning of the part of a ray.
#[inline(always)]
fn guess<S: Simd>(s: S, hits: &Hits, i: usize, round: u32) -> Lanes<S> {
    if round.is_multiple_of(MIDDLE) {
        load(s, &hits.beyond, i) * 0.5
    } else {
        zero(s, hits, i)
    }
}

/// Finds where the sign changes: false position, with the value at the end that stays a second time halved (Illinois; Dowell
/// and Jarratt 1971).
#[inline(always)]
fn refine<S: Simd>(s: S, solid: &Solid<'_>, k: usize, n: usize, q: &mut Scratch) {
    // 1 where the last guess was before the surface, -1 where it was behind it
    let mut last = Lane::ZERO;
    let mut moving = [0u32; BATCH];
    let (mut count, mut rounds) = (n, 0);
    while count as f32 > TOGETHER * n as f32 && rounds < REFINEMENTS && !solid.stop.is_set() {
        rounds += 1;
        let round = rounds;
        let hits = &q.hits;
        if !solid.stop.before(n) {
            fill(
                n,
                &mut q.work,
                #[inline(always)]
                |i| {
                    let ray = hits.ray(s, k + i);
                    let t = load(s, &hits.t, k + i) + guess(s, hits, k + i, round);
                    along(ray.origin, ray.direction, t)
                },
            );
            // as the rays were marched
            solid.sides(s, &mut q.work, n);
        }
        q.counts.march += n as u64;
        count = 0;
        for i in (0..n).step_by(S::f32s::LEN) {
            let wanted = near(s, solid, &q.hits, k + i) * SETTLED;
            let hits = &mut q.hits;
            let value = sided(
                load(s, &q.work.values().0, i),
                load_words(s, &hits.word, k + i),
            );
            let by = guess(s, hits, k + i, round);
            let (t, beyond) = (load(s, &hits.t, k + i), load(s, &hits.beyond, k + i));
            let (f, behind) = (load(s, &hits.f, k + i), load(s, &hits.behind, k + i));
            let (open, past) = (beyond.above(0.0), value.below(0.0));
            let before = load(s, &last.0, i);
            let one = splat(s, 1.0);
            let half = splat(s, 0.5);
            store(Lanes::select(past, -one, one), &mut last.0, i);
            let keep_front = Lanes::select(past & before.below(0.0), half, one);
            let keep_back = Lanes::select(!past & before.above(0.0), half, one);
            store(Lanes::select(open & !past, t + by, t), &mut hits.t, k + i);
            let rest = Lanes::select(past, by, beyond - by);
            store(Lanes::select(open, rest, beyond), &mut hits.beyond, k + i);
            let front = Lanes::select(past, f * keep_front, value);
            store(Lanes::select(open, front, f), &mut hits.f, k + i);
            let back = Lanes::select(past, value, behind * keep_back);
            store(Lanes::select(open, back, behind), &mut hits.behind, k + i);
            // from the end that moved to the guess: how far a line through both leads on
            let wanted = wanted.max(t * f32::EPSILON);
            let length = Lanes::select(past, beyond - by, by);
            let fall = Lanes::select(past, value - behind, f - value);
            let settled = (value.abs() * length).below(fall * wanted) | rest.below(wanted);
            let mut moves = (open & !settled & first_lanes(s, n - i)).0.to_bitmask();
            while moves != 0 {
                moving[count] = i as u32 + moves.trailing_zeros();
                count += 1;
                moves &= moves - 1;
            }
        }
    }
    refine_rest(s, solid, k, &mut moving[..count], &last, rounds, q);
    for i in (0..n).step_by(S::f32s::LEN) {
        let (t, beyond) = (load(s, &q.hits.t, k + i), load(s, &q.hits.beyond, k + i));
        let by = zero(s, &q.hits, k + i);
        store(
            Lanes::select(beyond.above(0.0), t + by, t),
            &mut q.hits.t,
            k + i,
        );
    }
}

/// Goes on after `rounds` guesses with those hits from `k` on that still move, and no others.
#[inline(always)]
fn refine_rest<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    k: usize,
    moving: &mut [u32],
    last: &Lane,
    rounds: u32,
    q: &mut Scratch,
) {
    let mut parts = [Bracket::NONE; BATCH];
    for (part, &i) in parts.iter_mut().zip(&*moving) {
        let (at, hits) = (k + i as usize, &q.hits);
        *part = Bracket {
            t: hits.t[at],
            above: hits.f[at],
            beyond: hits.beyond[at],
            below: hits.behind[at],
            last: last.0[i as usize],
        };
    }
    let mut count = moving.len();
    for round in rounds + 1..=REFINEMENTS {
        if count == 0 || solid.stop.before(count) {
            break;
        }
        for (j, (part, &i)) in parts.iter().zip(&*moving).take(count).enumerate() {
            let ray = q.hits.rays.get(&q.hits.common, k + i as usize);
            let p = (ray.origin + ray.direction * (part.t + part.guess(round))).array();
            for (column, x) in q.work.points_mut().iter_mut().zip(p) {
                column.0[j] = x;
            }
        }
        solid.sides(s, &mut q.work, count);
        q.counts.march += count as u64;
        let mut kept = 0;
        for j in 0..count {
            let (mut part, i) = (parts[j], moving[j]);
            let (at, hits) = (k + i as usize, &mut q.hits);
            let inside = hits.word[at] & INSIDE != 0;
            let value = q.work.values().0[j] * if inside { -1.0 } else { 1.0 };
            let near = solid.near(&hits.rays.get(&hits.common, at), part.t);
            let wanted = (near * SETTLED).max(part.t * f32::EPSILON);
            let settled = part.narrow(part.guess(round), value, wanted);
            (hits.t[at], hits.f[at]) = (part.t, part.above);
            (hits.beyond[at], hits.behind[at]) = (part.beyond, part.below);
            if !settled {
                (parts[kept], moving[kept]) = (part, i);
                kept += 1;
            }
        }
        count = kept;
    }
}

/// Evaluates the field at `n` points that are made by vectors. (Where it is time to stop, nothing is evaluated: nobody looks
/// at what comes of it.)
#[inline(always)]
pub(crate) fn values_at<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    n: usize,
    work: &mut Workspace,
    point: impl Fn(usize) -> Vec3<Lanes<S>>,
) {
    if solid.stop.before(n) {
        return;
    }
    fill(n, work, point);
    solid.values(s, work, n);
}

/// What is shown as the distance to the surface, at `n` points that are made by vectors: the value of the field where it is
/// close to the distance, else the value over the length of the gradient (Taubin 1994), which no constant that the value was
/// divided by changes.
#[inline(always)]
pub(crate) fn sample<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    n: usize,
    work: &mut Workspace,
    point: impl Fn(usize) -> Vec3<Lanes<S>>,
) {
    if solid.close {
        values_at(s, solid, n, work, point);
    } else if !solid.stop.before(n) {
        fill(n, work, point);
        distances(s, solid, n, work);
    }
}

/// The second kind of [`sample`], where the points are there already.
#[inline(always)]
pub(crate) fn distances<S: Simd>(s: S, solid: &Solid<'_>, n: usize, work: &mut Workspace) {
    solid.gradients(s, work, n);
    for i in (0..n).step_by(S::f32s::LEN) {
        let f = load(s, &work.gradient_values().0, i);
        let slope = load3(s, work.gradients(), i).length();
        let distance = f / slope.max(FLAT);
        store(distance, &mut work.values_mut().0, i);
    }
}

/// What is shown as the distance, into the values, and how far rays may go, into the values beside the gradients: for fields without a
/// Lipschitz constant, whose values are about distances but no bounds.
#[inline(always)]
pub(crate) fn values_and_clearances<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    n: usize,
    work: &mut Workspace,
) {
    solid.sides(s, work, n);
    let sides = *work.values();
    solid.widen(work, n);
    let mut free = *work.values();
    for (free, side) in free.0.iter_mut().zip(sides.0).take(n) {
        // where nothing is known but the side
        if free.abs() < f32::MIN_POSITIVE {
            *free = side.min(0.0);
        }
    }
    solid.values(s, work, n);
    work.gradients_mut()[0] = free;
}

#[inline(always)]
fn fill<S: Simd>(n: usize, work: &mut Workspace, point: impl Fn(usize) -> Vec3<Lanes<S>>) {
    let points = work.points_mut();
    for i in (0..n).step_by(S::f32s::LEN) {
        store3(point(i), points, i);
    }
}

#[inline(always)]
fn point_of<S: Simd>(s: S, hits: &Hits, i: usize) -> Vec3<Lanes<S>> {
    let ray = hits.ray(s, i);
    along(ray.origin, ray.direction, load(s, &hits.t, i))
}

/// Finds the normals of all hits, on the side that is marched.
pub(crate) fn normals<S: Simd>(s: S, solid: &Solid<'_>, kind: Normals, q: &mut Scratch) {
    match kind {
        Normals::Tetrahedron => by_samples(s, solid, &TETRAHEDRON, q),
        Normals::Central => by_samples(s, solid, &CENTRAL, q),
        Normals::Samples18 => by_samples(s, solid, &NEIGHBOURS_18, q),
        Normals::Samples26 => by_samples(s, solid, &NEIGHBOURS_26, q),
        Normals::Exact => by_gradients(s, solid, q),
    }
}

/// Sum of the samples' directions, each times the value found there: for samples that are spread evenly it points along the
/// gradient (Zucker and Hummel 1981 weight the neighbours on a grid so).
fn by_samples<S: Simd>(s: S, solid: &Solid<'_>, samples: &[[f32; 3]], q: &mut Scratch) {
    s.vectorize(
        #[inline(always)]
        || {
            for k in (0..q.hits.count).step_by(BATCH) {
                let n = (q.hits.count - k).min(BATCH);
                let mut sum = [Lane::ZERO; 3];
                for &to in samples {
                    let length = (to[0] * to[0] + to[1] * to[1] + to[2] * to[2]).sqrt();
                    let hits = &q.hits;
                    values_at(
                        s,
                        solid,
                        n,
                        &mut q.work,
                        #[inline(always)]
                        |i| {
                            let p = load3(s, &hits.point, k + i);
                            let width = solid.width(&hits.ray(s, k + i), load(s, &hits.t, k + i));
                            let h = step(p, width);
                            along(p, splat3(s, to), h)
                        },
                    );
                    q.counts.normal += n as u64;
                    for i in (0..n).step_by(S::f32s::LEN) {
                        let f = load(s, &q.work.values().0, i);
                        let way = splat3(s, [to[0] / length, to[1] / length, to[2] / length]);
                        store3(along(load3(s, &sum, i), way, f), &mut sum, i);
                    }
                }
                for i in (0..n).step_by(S::f32s::LEN) {
                    finish(s, &mut q.hits, k + i, load3(s, &sum, i));
                }
            }
        },
    );
}

fn by_gradients<S: Simd>(s: S, solid: &Solid<'_>, q: &mut Scratch) {
    s.vectorize(
        #[inline(always)]
        || {
            for k in (0..q.hits.count).step_by(BATCH) {
                let n = (q.hits.count - k).min(BATCH);
                let mut away = Lane::ZERO;
                for attempt in 0..2 {
                    // what is seen faces the eye: on an edge the gradient may be that of the face behind it, and that of the one
                    // before it is found a little nearer
                    if solid.stop.before(n) {
                        break;
                    }
                    let hits = &q.hits;
                    fill(
                        n,
                        &mut q.work,
                        #[inline(always)]
                        |i| {
                            let d = hits.ray(s, k + i).direction;
                            let by = load(s, &away.0, i) * near(s, solid, hits, k + i);
                            along(load3(s, &hits.point, k + i), d, -by)
                        },
                    );
                    solid.gradients(s, &mut q.work, n);
                    q.counts.normal += n as u64;
                    let mut any = false;
                    for i in (0..n).step_by(S::f32s::LEN) {
                        let g = load3(s, q.work.gradients(), i);
                        let old = load(s, &away.0, i);
                        let normal = normal_of(s, &q.hits, k + i, g);
                        let d = q.hits.ray(s, k + i).direction;
                        let hidden = normal.dot(d).above(0.0);
                        let normal = if attempt == 0 {
                            normal
                        } else {
                            // what is still not seen is seen edge-on
                            let before = load3(s, &q.hits.normal, k + i);
                            let aside = (before - d * before.dot(d)).normalize();
                            let turned = old.above(0.0);
                            let new = turned & !hidden;
                            let old = turned & hidden;
                            v3(
                                Lanes::select(new, normal.x, Lanes::select(old, aside.x, before.x)),
                                Lanes::select(new, normal.y, Lanes::select(old, aside.y, before.y)),
                                Lanes::select(new, normal.z, Lanes::select(old, aside.z, before.z)),
                            )
                        };
                        store3(normal, &mut q.hits.normal, k + i);
                        let hidden = hidden & first_lanes(s, n - i);
                        any |= hidden.0.to_bitmask() != 0;
                        let mark = Lanes::select(hidden, splat(s, 1.0), splat(s, 0.0));
                        store(mark, &mut away.0, i);
                    }
                    if !any {
                        break;
                    }
                }
            }
        },
    );
}

/// Keeps the normal of a gradient.
#[inline(always)]
fn finish<S: Simd>(s: S, hits: &mut Hits, i: usize, g: Vec3<Lanes<S>>) {
    let n = normal_of(s, hits, i, g);
    store3(n, &mut hits.normal, i);
}

/// Normalises; where there is no gradient the normal looks back along the ray.
#[inline(always)]
fn normal_of<S: Simd>(s: S, hits: &Hits, i: usize, g: Vec3<Lanes<S>>) -> Vec3<Lanes<S>> {
    let word = load_words(s, &hits.word, i);
    let d = hits.ray(s, i).direction;
    let square = g.length_squared();
    let fit = square.above(1e-36) & square.below(f32::INFINITY);
    let scale = square.lit(1.0) / square.sqrt();
    let n = g * sided(scale, word);
    v3(
        Lanes::select(fit, n.x, -d.x),
        Lanes::select(fit, n.y, -d.y),
        Lanes::select(fit, n.z, -d.z),
    )
}
