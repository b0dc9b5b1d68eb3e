//! A bounding volume hierarchy over boxes: binned by the surface area heuristic (Wald 2007).
//!
//! obvhs and parry3d (read about, not measured) have queries that take a point at a time, where eight neighbours of a grid share nearly all of their
//! way through the tree (see [`nearest`](crate::nearest)). What is needed of a tree itself is short.

/// A box in single precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: [f32; 3],
    pub(crate) high: [f32; 3],
}

impl Bounds {
    pub(crate) const NONE: Bounds = Bounds {
        low: [f32::INFINITY; 3],
        high: [f32::NEG_INFINITY; 3],
    };

    #[inline(always)]
    pub(crate) fn with(self, o: Bounds) -> Bounds {
        let mut b = self;
        for k in 0..3 {
            b.low[k] = b.low[k].min(o.low[k]);
            b.high[k] = b.high[k].max(o.high[k]);
        }
        b
    }

    pub(crate) fn of(points: impl IntoIterator<Item = [f32; 3]>) -> Bounds {
        (points.into_iter()).fold(Bounds::NONE, |b, p| b.with(Bounds { low: p, high: p }))
    }

    pub(crate) fn meets(&self, o: &Bounds) -> bool {
        (0..3).all(|k| self.low[k] <= o.high[k] && o.low[k] <= self.high[k])
    }

    /// Half the surface.
    fn area(&self) -> f32 {
        let side = |k: usize| (self.high[k] - self.low[k]).max(0.0);
        let (x, y, z) = (side(0), side(1), side(2));
        x * y + y * z + z * x
    }

    fn centre(&self, k: usize) -> f32 {
        0.5 * (self.low[k] + self.high[k])
    }
}

/// A node: a leaf of `count` items from `first`, or two nodes, `first` and the one behind it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BvhNode {
    pub(crate) bounds: Bounds,
    pub(crate) first: u32,
    /// 0 of a node with children.
    pub(crate) count: u32,
}

/// The tree. The first node is the root.
#[derive(Debug)]
pub(crate) struct Bvh {
    pub(crate) nodes: Vec<BvhNode>,
    /// The items of leaves.
    pub(crate) items: Vec<u32>,
}

/// Items up to which a node is a leaf.
const LEAF: usize = 6;
const BINS: usize = 16;
/// What deeper trees would need: a stack of this many nodes suffices for one that is halved at least from here on.
const DEEP: u32 = 40;
/// Nodes that a traversal may have put aside.
pub(crate) const STACK: usize = 80;

impl Bvh {
    /// The tree over these boxes.
    pub(crate) fn new(bounds: &[Bounds]) -> Bvh {
        let mut items: Vec<u32> = (0..bounds.len() as u32).collect();
        let all = bounds.iter().fold(Bounds::NONE, |b, o| b.with(*o));
        let mut nodes = Vec::with_capacity(bounds.len());
        nodes.push(BvhNode {
            bounds: all,
            first: 0,
            count: bounds.len() as u32,
        });
        let mut todo = vec![(0, 0)];
        while let Some((at, depth)) = todo.pop() {
            let BvhNode { first, count, .. } = nodes[at];
            if count as usize <= LEAF {
                continue;
            }
            let items = &mut items[first as usize..(first + count) as usize];
            let half = split(bounds, items, depth >= DEEP);
            let child = |items: &[u32], first| BvhNode {
                bounds: (items.iter()).fold(Bounds::NONE, |b, i| b.with(bounds[*i as usize])),
                first,
                count: items.len() as u32,
            };
            let (left, right) = items.split_at(half);
            let next = nodes.len();
            nodes[at].first = next as u32;
            nodes[at].count = 0;
            nodes.push(child(left, first));
            nodes.push(child(right, first + half as u32));
            todo.extend([(next, depth + 1), (next + 1, depth + 1)]);
        }
        Bvh { nodes, items }
    }

    /// Every pair of items whose boxes meet, each once.
    pub(crate) fn pairs(&self, bounds: &[Bounds], mut found: impl FnMut(u32, u32) -> bool) {
        let mut todo = vec![(0_usize, 0_usize)];
        while let Some((a, b)) = todo.pop() {
            let (n, m) = (&self.nodes[a], &self.nodes[b]);
            if a != b && !n.bounds.meets(&m.bounds) {
                continue;
            }
            match (n.count, m.count) {
                (0, 0) if a == b => {
                    let l = n.first as usize;
                    todo.extend([(l, l), (l + 1, l + 1), (l, l + 1)]);
                }
                (0, _) if m.count > 0 || n.bounds.area() >= m.bounds.area() => {
                    let l = n.first as usize;
                    todo.extend([(l, b), (l + 1, b)]);
                }
                (_, 0) => {
                    let l = m.first as usize;
                    todo.extend([(a, l), (a, l + 1)]);
                }
                _ => {
                    for (i, x) in self.leaf(n).iter().enumerate() {
                        let from = if a == b { i + 1 } else { 0 };
                        for y in &self.leaf(m)[from..] {
                            if bounds[*x as usize].meets(&bounds[*y as usize]) && !found(*x, *y) {
                                return;
                            }
                        }
                    }
                }
            }
        }
    }

    #[inline(always)]
    pub(crate) fn leaf(&self, node: &BvhNode) -> &[u32] {
        &self.items[node.first as usize..(node.first + node.count) as usize]
    }
}

/// Sorts items into two parts and says how many the first one has.
fn split(bounds: &[Bounds], items: &mut [u32], in_half: bool) -> usize {
    let centres = items.iter().fold(Bounds::NONE, |b, i| {
        let item = &bounds[*i as usize];
        let c = [item.centre(0), item.centre(1), item.centre(2)];
        b.with(Bounds { low: c, high: c })
    });
    let mut best: Option<(f32, usize, usize)> = None;
    let bin = |i: u32, k: usize| {
        let width = centres.high[k] - centres.low[k];
        let x = (bounds[i as usize].centre(k) - centres.low[k]) / width;
        ((x * BINS as f32) as usize).min(BINS - 1)
    };
    for k in 0..3 {
        if in_half || centres.high[k] <= centres.low[k] {
            continue;
        }
        let mut bins = [(Bounds::NONE, 0_usize); BINS];
        for &i in &*items {
            let b = &mut bins[bin(i, k)];
            *b = (b.0.with(bounds[i as usize]), b.1 + 1);
        }
        let mut right = [(0.0, 0); BINS];
        let mut sum = (Bounds::NONE, 0);
        for at in (1..BINS).rev() {
            sum = (sum.0.with(bins[at].0), sum.1 + bins[at].1);
            right[at] = (sum.0.area(), sum.1);
        }
        let mut sum = (Bounds::NONE, 0);
        for at in 1..BINS {
            sum = (sum.0.with(bins[at - 1].0), sum.1 + bins[at - 1].1);
            if sum.1 == 0 || right[at].1 == 0 {
                continue;
            }
            let cost = sum.0.area() * sum.1 as f32 + right[at].0 * right[at].1 as f32;
            if best.is_none_or(|b| cost < b.0) {
                best = Some((cost, k, at));
            }
        }
    }
    let Some((_, k, at)) = best else {
        // all in one place, or too deep already: by halves
        let k = (0..3)
            .max_by(|a, b| {
                let width = |k: usize| centres.high[k] - centres.low[k];
                width(*a).total_cmp(&width(*b))
            })
            .unwrap_or(0);
        let half = items.len() / 2;
        items.select_nth_unstable_by(half, |a, b| {
            let centre = |i: u32| bounds[i as usize].centre(k);
            centre(*a).total_cmp(&centre(*b)).then(a.cmp(b))
        });
        return half;
    };
    let mut half = 0;
    for i in 0..items.len() {
        if bin(items[i], k) < at {
            items.swap(i, half);
            half += 1;
        }
    }
    half
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes at one place, in a row of growing distances, and everywhere.
    fn sets() -> Vec<Vec<Bounds>> {
        let mut seed = 1_u64;
        let mut random = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 40) as f32 / (1 << 24) as f32
        };
        let cube = |p: [f32; 3], s: f32| Bounds {
            low: p,
            high: p.map(|x| x + s),
        };
        vec![
            vec![cube([0.0; 3], 1.0); 1000],
            (0..100)
                .map(|i| cube([1.5_f32.powi(i), 0.0, 0.0], 0.0))
                .collect(),
            (0..500)
                .map(|_| cube([random(), random(), random()], 0.1 * random()))
                .collect(),
        ]
    }

    #[test]
    fn trees_hold_every_item_once_within_their_boxes_and_are_not_deep() {
        for bounds in sets() {
            let tree = Bvh::new(&bounds);
            let mut items = tree.items.clone();
            items.sort_unstable();
            assert!(items.iter().enumerate().all(|(i, x)| i == *x as usize));
            let mut todo = vec![(0, 1)];
            let mut seen = 0;
            while let Some((at, depth)) = todo.pop() {
                let node: &BvhNode = &tree.nodes[at];
                assert!(depth < STACK);
                if node.count > 0 {
                    seen += node.count as usize;
                    for i in tree.leaf(node) {
                        assert_eq!(node.bounds.with(bounds[*i as usize]), node.bounds);
                    }
                } else {
                    let l = node.first as usize;
                    todo.extend([(l, depth + 1), (l + 1, depth + 1)]);
                }
            }
            assert_eq!(seen, bounds.len());
        }
    }

    #[test]
    fn pairs_are_those_whose_boxes_meet() {
        for bounds in sets() {
            let n = bounds.len();
            let mut wanted = Vec::new();
            for a in 0..n as u32 {
                for b in a + 1..n as u32 {
                    if bounds[a as usize].meets(&bounds[b as usize]) {
                        wanted.push((a, b));
                    }
                }
            }
            let mut got = Vec::new();
            Bvh::new(&bounds).pairs(&bounds, |a, b| {
                got.push((a.min(b), a.max(b)));
                true
            });
            got.sort_unstable();
            assert_eq!(got, wanted);
        }
    }
}
