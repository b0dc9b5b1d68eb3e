//! Lists in the parameter array: the count, then the items.

use super::real::{Ends, steps};

/// For each item of the list at `at` and its successor: `s = step(s, item, next)`.
///
/// A list whose count is wrong is read as far as the array goes; a count that is not a number is zero.
#[inline(always)]
pub(super) fn fold_list<T, const W: usize>(
    store: &[f32],
    at: usize,
    ends: Ends,
    init: T,
    step: impl Fn(T, [f32; W], [f32; W]) -> T,
) -> T {
    let Some((count, numbers)) = store.get(at..).and_then(<[f32]>::split_first) else {
        return init;
    };
    let (items, _) = numbers.as_chunks::<W>();
    let n = items.len().min(steps((*count).into()) as usize);
    let items = &items[..n];
    let (Some(first), Some(last)) = (items.first(), items.last()) else {
        return init;
    };
    let (mut item, rest) = match ends {
        Ends::Ring => (*last, items),
        Ends::Open => (*first, &items[1..]),
    };
    let mut s = init;
    for next in rest {
        s = step(s, item, *next);
        item = *next;
    }
    s
}

/// Goes through the trees of the list at `at`: see [`super::Real::walk`]. Numbers that are wrong end the walk early, never late.
#[inline(always)]
pub(super) fn walk_list<T, const W: usize, const V: usize>(
    store: &[f32],
    at: usize,
    init: T,
    look: impl Fn(T, [f32; W]) -> (T, T, bool),
    take: impl Fn(T, [f32; V]) -> T,
) -> T {
    let Some((count, numbers)) = store.get(at..).and_then(<[f32]>::split_first) else {
        return init;
    };
    let n = (numbers.len() / W).min(steps((*count).into()) as usize);
    let (nodes, items) = numbers.split_at(n * W);
    let (nodes, items) = (nodes.as_chunks::<W>().0, items.as_chunks::<V>().0);
    let mut s = init;
    let mut i = 0;
    while i < n {
        let node = nodes[i];
        let [first, count, tree] = [W - 3, W - 2, W - 1].map(
            #[inline(always)]
            |k| steps(node[k].into()) as usize,
        );
        let (entered, passed, enters) = look(s, node);
        if enters {
            s = entered;
            for item in items.iter().skip(first).take(count) {
                s = take(s, *item);
            }
            i += 1;
        } else {
            s = passed;
            i += tree.max(1);
        }
    }
    s
}
