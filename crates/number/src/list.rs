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

/// For each node of the list of trees at `at` that is come to: what `step` says, see [`super::Real::walk`]; its third says whether the
/// node's children are next. Counts that are wrong end the walk early, never late.
#[inline(always)]
pub(super) fn walk_list<T, const W: usize>(
    store: &[f32],
    at: usize,
    init: T,
    step: impl Fn(T, [f32; W]) -> (T, T, bool),
) -> T {
    let Some((count, numbers)) = store.get(at..).and_then(<[f32]>::split_first) else {
        return init;
    };
    let (nodes, _) = numbers.as_chunks::<W>();
    let n = nodes.len().min(steps((*count).into()) as usize);
    let mut s = init;
    let mut i = 0;
    while i < n {
        let node = nodes[i];
        let (entered, passed, enters) = step(s, node);
        if enters {
            s = entered;
            i += 1;
        } else {
            s = passed;
            i += steps(node[W - 1].into()).max(1) as usize;
        }
    }
    s
}
