//! Solids that rays meet in closed form: what is marched beside them ends there.

use crate::march::ORDINAL;
use crate::ray::Queue;
use crate::simd::{Chosen, Sheet, first_lanes, load, splat, store};
use crate::tile::{Hits, Solid};
use fearless_simd::{Simd, prelude::*};
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Ops, Real};
use zeroset_shade::closed::Closed;

/// Finds where the rays of the queue meet solids in closed form, up to the far end of the view: there they are not marched on. `exists`
/// says which rays are there.
pub(crate) fn limit<S: Simd>(
    s: S,
    closed: &[Closed],
    solid: &Solid<'_>,
    queue: &mut Queue,
    exists: impl Fn(usize) -> LaneMask<S>,
) {
    s.vectorize(
        #[inline(always)]
        || {
            queue.limited = true;
            for i in (0..queue.count).step_by(S::f32s::LEN) {
                let ray = queue.ray(s, i);
                let mut t = splat(s, f32::INFINITY);
                for form in closed {
                    t = t.min(form.meet(ray.origin, ray.direction));
                }
                let seen = t.below(solid.view.far) & exists(i) & first_lanes(s, queue.count - i);
                store(
                    Lanes::select(seen, t, splat(s, f32::INFINITY)),
                    &mut queue.limit,
                    i,
                );
            }
        },
    );
}

/// Adds the rays that met nothing before a solid in closed form to the hits. `steps`: the evaluations of rays that met nothing, where
/// these are wanted.
pub(crate) fn land<S: Simd>(s: S, queue: &mut Queue, steps: Option<&Sheet>, hits: &mut Hits) {
    if !std::mem::take(&mut queue.limited) {
        return;
    }
    for word in &hits.word[..hits.count] {
        queue.limit[(word & ORDINAL) as usize] = f32::INFINITY;
    }
    s.vectorize(
        #[inline(always)]
        || {
            for i in (0..queue.count).step_by(S::f32s::LEN) {
                let t = load(s, &queue.limit, i);
                let lands = t.below(f32::INFINITY) & first_lanes(s, queue.count - i);
                let lands = Chosen::new(lands);
                if lands.none() {
                    continue;
                }
                let (n, zero) = (hits.count, splat(s, 0.0));
                hits.rays.put(lands, &hits.common, &queue.ray(s, i), n);
                lands.put(t, &mut hits.t, n);
                lands.put(zero, &mut hits.beyond, n);
                lands.put(zero, &mut hits.f, n);
                lands.put(zero, &mut hits.behind, n);
                let numbers = S::u32s::from_fn(
                    s,
                    #[inline(always)]
                    |k| (i + k) as u32,
                );
                lands.put_words(numbers, &mut hits.word, n);
                let taken = steps.map_or(zero, |steps| load(s, steps, i));
                lands.put(taken, &mut hits.steps, n);
                hits.count += lands.count;
            }
        },
    );
}
