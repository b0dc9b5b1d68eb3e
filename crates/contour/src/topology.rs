//! What a mesh of triangles is as a surface: whether it is closed, how many parts and holes through it has.

/// How the faces of a mesh hang together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Topology {
    /// Edges.
    pub edges: u64,
    /// Parts that hang together by vertices.
    pub parts: u64,
    /// Vertices less edges plus faces: 2 for each ball-like part, 0 for each ring-like one (Euler 1758).
    pub euler: i64,
    /// Whether every edge has exactly two faces, which run along it in opposite directions.
    pub watertight: bool,
    /// Whether, beyond that, the faces of every vertex are one fan.
    pub manifold: bool,
}

impl Topology {
    /// Of faces over vertices numbered below `vertices`, each used by a face.
    pub fn of(vertices: usize, faces: &[[u32; 3]]) -> Topology {
        // where a face leaves a vertex: to the next, and what comes after it
        let mut sides: Vec<[u32; 3]> = Vec::with_capacity(3 * faces.len());
        for &[a, b, c] in faces {
            sides.extend([[a, b, c], [b, c, a], [c, a, b]]);
        }
        sides.sort_unstable();
        let number = |from: u32, to: u32| {
            let at = sides.partition_point(|s| [s[0], s[1]] < [from, to]);
            sides
                .get(at)
                .filter(|s| [s[0], s[1]] == [from, to])
                .map(|_| at)
        };
        let is_twice = sides.windows(2).any(|w| w[0][..2] == w[1][..2]);
        let watertight = !is_twice && sides.iter().all(|s| number(s[1], s[0]).is_some());
        let edges = (sides.iter())
            .filter(|s| s[0] < s[1] || number(s[1], s[0]).is_none())
            .count() as u64;
        let mut manifold = watertight;
        if watertight {
            for fan in sides.chunk_by(|a, b| a[0] == b[0]) {
                let (mut at, mut count) = (Some(&fan[0]), 0);
                while let Some([from, _, after]) = at {
                    count += 1;
                    // the face on the other side of the edge to the last vertex of this one
                    at = number(*from, *after).map(|n| &sides[n]);
                    if count > fan.len() || at.is_some_and(|s| s == &fan[0]) {
                        break;
                    }
                }
                manifold &= count == fan.len();
            }
        }
        let mut sets: Vec<u32> = (0..vertices as u32).collect();
        let mut parts = vertices as u64;
        for side in &sides {
            let (a, b) = (root(&mut sets, side[0]), root(&mut sets, side[1]));
            if a != b {
                sets[a as usize] = b;
                parts -= 1;
            }
        }
        Topology {
            edges,
            parts,
            euler: vertices as i64 - edges as i64 + faces.len() as i64,
            watertight,
            manifold,
        }
    }
}

fn root(sets: &mut [u32], mut i: u32) -> u32 {
    while sets[i as usize] != i {
        let up = sets[sets[i as usize] as usize];
        sets[i as usize] = up;
        i = up;
    }
    i
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn a_tetrahedron_is_a_ball() {
        let found = Topology::of(4, &TETRAHEDRON);
        let wanted = Topology {
            edges: 6,
            parts: 1,
            euler: 2,
            watertight: true,
            manifold: true,
        };
        assert_eq!(found, wanted);
    }

    #[test]
    fn what_is_wrong_is_found() {
        let open = Topology::of(4, &TETRAHEDRON[1..]);
        assert_eq!((open.watertight, open.euler), (false, 1));
        let mut turned = TETRAHEDRON;
        turned[0] = [0, 1, 2];
        assert!(!Topology::of(4, &turned).watertight);
        let mut twice = TETRAHEDRON.to_vec();
        twice.extend(TETRAHEDRON);
        assert!(!Topology::of(4, &twice).watertight);
        // two that share a vertex: closed, and no surface at that vertex
        let mut touching = TETRAHEDRON.to_vec();
        touching.extend(TETRAHEDRON.map(|f| f.map(|v| if v == 0 { 0 } else { v + 3 })));
        let found = Topology::of(7, &touching);
        assert_eq!(
            (found.watertight, found.manifold, found.parts),
            (true, false, 1)
        );
    }
}
