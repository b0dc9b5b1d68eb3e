//! How the surface goes through a cell: which of its edges it crosses, and which crossings hang together.
//!
//! On each face of a cell crossings are joined in pairs, so that all of them lie on closed loops; each loop bounds a patch of the surface
//! (Nielson 2004). A face whose corners have alternating signs can be paired in two ways. What way is chosen is a property of the face, so
//! that both of its cells say the same.

/// A bit for each corner of a cell that is inside; the corner's own bits say on which side it lies along x, y and z.
pub(crate) type Mask = u8;

/// Edges of a cell: four along each axis.
pub(crate) const EDGES: usize = 12;

/// No patch.
const NONE: u8 = 3 + 1;

/// The number of the edge along an axis that lies at `b` along the axis behind it and at `c` along the next one.
pub(crate) const fn edge(axis: usize, b: usize, c: usize) -> usize {
    4 * axis + b + 2 * c
}

/// An edge's axis and its place along the two others.
pub(crate) const fn parts(edge: usize) -> (usize, usize, usize) {
    (edge / 4, edge & 1, edge >> 1 & 1)
}

/// The two corners of an edge, the lower one first.
pub(crate) fn ends(number: usize) -> [usize; 2] {
    let (axis, b, c) = parts(number);
    let low = b << ((axis + 1) % 3) | c << ((axis + 2) % 3);
    [low, low | 1 << axis]
}

/// Whether the surface crosses an edge.
pub(crate) fn crosses(mask: Mask, number: usize) -> bool {
    let [a, b] = ends(number);
    (mask >> a & 1) != (mask >> b & 1)
}

/// Faces: the lower and the upper one of each axis.
pub(crate) const FACES: usize = 6;

/// The edges of a face in their order around it; corner k of the face lies between edges k - 1 and k.
fn around(face: usize) -> [usize; 4] {
    let (axis, side) = (face / 2, face % 2);
    let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
    // along b an edge lies at (c, axis), along c at (axis, b)
    [
        edge(b, 0, side),
        edge(c, side, 1),
        edge(b, 1, side),
        edge(c, side, 0),
    ]
}

/// The corners of a face, as [`around`] its edges.
fn corners(face: usize) -> [usize; 4] {
    let (axis, side) = (face / 2, face % 2);
    let (b, c) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
    let low = side << axis;
    [low, low | b, low | b | c, low | c]
}

/// Whether the corners of a face have alternating signs.
pub(crate) fn is_ambiguous(mask: Mask, face: usize) -> bool {
    let inside = corners(face).map(|k| mask >> k & 1 == 1);
    inside[0] == inside[2] && inside[1] == inside[3] && inside[0] != inside[1]
}

/// Of an ambiguous face, whether its second and fourth corners are cut off and its first and third joined, where `joined` says whether
/// the corners inside are.
pub(crate) fn cuts_odd(mask: Mask, face: usize, joined: bool) -> bool {
    let first_is_inside = mask >> corners(face)[0] & 1 == 1;
    first_is_inside == joined
}

/// The patches of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Patches {
    /// How many, at most four.
    pub(crate) count: u8,
    /// For each edge that is crossed, its patch.
    of: [u8; EDGES],
}

impl Default for Patches {
    fn default() -> Patches {
        Patches {
            count: 0,
            of: [NONE; EDGES],
        }
    }
}

impl Patches {
    /// The patches of a cell. `cuts_odd` says of each ambiguous face how it is paired: see [`cuts_odd`].
    pub(crate) fn new(mask: Mask, cuts_odd: impl Fn(usize) -> bool) -> Patches {
        let mut beside = [[usize::MAX; 2]; EDGES];
        let mut join = |a: usize, b: usize| {
            for (from, to) in [(a, b), (b, a)] {
                let free = usize::from(beside[from][0] != usize::MAX);
                beside[from][free] = to;
            }
        };
        for face in 0..FACES {
            let edges = around(face);
            if is_ambiguous(mask, face) {
                // corner k lies between edges k - 1 and k
                let pairs = match cuts_odd(face) {
                    true => [(0, 1), (2, 3)],
                    false => [(3, 0), (1, 2)],
                };
                pairs
                    .into_iter()
                    .for_each(|(i, j)| join(edges[i], edges[j]));
                continue;
            }
            let mut crossed = edges.into_iter().filter(|e| crosses(mask, *e));
            if let (Some(a), Some(b)) = (crossed.next(), crossed.next()) {
                join(a, b);
            }
        }
        let mut patches = Patches::default();
        for start in 0..EDGES {
            if !crosses(mask, start) || patches.of[start] != NONE {
                continue;
            }
            let mut at = start;
            loop {
                patches.of[at] = patches.count;
                let next = beside[at]
                    .into_iter()
                    .find(|e| patches.of.get(*e) == Some(&NONE));
                match next {
                    Some(next) => at = next,
                    None => break,
                }
            }
            patches.count += 1;
        }
        patches
    }

    /// The patch of an edge that is crossed.
    pub(crate) fn of(&self, edge: usize) -> u8 {
        self.of[edge]
    }

    /// Whether all crossings of a face are in one patch.
    pub(crate) fn is_one_on(&self, face: usize) -> bool {
        let [first, rest @ ..] = around(face).map(|e| self.of[e]);
        rest.iter().all(|p| *p == first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_and_faces_fit_their_corners() {
        for face in 0..FACES {
            let (edges, corners) = (around(face), corners(face));
            for k in 0..4 {
                let mut ends = ends(edges[k]);
                let mut wanted = [corners[k], corners[(k + 1) % 4]];
                ends.sort_unstable();
                wanted.sort_unstable();
                assert_eq!(ends, wanted, "face {face}, edge {k}");
            }
            for corner in corners {
                assert_eq!(corner >> (face / 2) & 1, face % 2);
            }
        }
    }

    /// Every crossing is in one patch; a patch is a loop over at least three of them; what is cut off at faces decides how many there are.
    #[test]
    fn every_sign_of_eight_corners_has_whole_loops() {
        for mask in 0..=255_u8 {
            let ambiguous: Vec<usize> = (0..FACES).filter(|f| is_ambiguous(mask, *f)).collect();
            for choice in 0..1_u32 << ambiguous.len() {
                let cuts = |face: usize| {
                    let at = ambiguous.iter().position(|f| *f == face).unwrap();
                    choice >> at & 1 == 1
                };
                let patches = Patches::new(mask, cuts);
                assert!(patches.count <= 4, "{mask:08b}");
                let mut sizes = [0; 4];
                for e in 0..EDGES {
                    assert_eq!(patches.of(e) < patches.count, crosses(mask, e));
                    if crosses(mask, e) {
                        sizes[usize::from(patches.of(e))] += 1;
                    }
                }
                assert!(sizes[..usize::from(patches.count)].iter().all(|n| *n >= 3));
                // a face with both its pairs in one patch has them in two when it is paired the other way: this is what makes the mesh
                // manifold
                for face in &ambiguous {
                    if patches.is_one_on(*face) {
                        let other = Patches::new(mask, |f| cuts(f) != (f == *face));
                        assert_eq!(other.count, patches.count + 1, "{mask:08b}");
                        assert!(!other.is_one_on(*face));
                        // what was apart stays apart
                        for (a, b) in (0..EDGES).flat_map(|a| (0..a).map(move |b| (a, b))) {
                            if crosses(mask, a)
                                && crosses(mask, b)
                                && patches.of(a) != patches.of(b)
                            {
                                assert_ne!(other.of(a), other.of(b));
                            }
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn corners_inside_are_joined_through_a_face_or_not() {
        // corners 0 and 3 of the lower face along z are inside, nothing else
        let mask = 0b0000_1001;
        let face = 4;
        assert!(is_ambiguous(mask, face));
        let joined = Patches::new(mask, |f| cuts_odd(mask, f, true));
        let apart = Patches::new(mask, |f| cuts_odd(mask, f, false));
        assert_eq!((joined.count, apart.count), (1, 2));
    }
}
