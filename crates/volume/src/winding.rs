//! The generalised winding number (Jacobson, Kavan and Sorkine-Hornung 2013): how often a surface goes around a place. 1 inside and 0
//! outside of a closed one; where it has holes, something between that changes smoothly.
//!
//! A mesh and a cone over each of its [rims](crate::check::rims) are closed together, and for what is closed the number is whole:
//! crossings of a ray tell it exactly. What is left is the number of the cones, and rims have few edges. (Martens and Bessmeltsev
//! 2025 take the same way.) Far from a cone it is a dipole (Barill, Dickson, Schmidt, Levin and Jacobson 2018).

use crate::bvh::{Bounds, Bvh};
use crate::mesh::v;

type Triangle = [[f64; 3]; 3];

/// The solid angle of a triangle over 4 pi, seen from a place: positive where the place is behind it (van Oosterom and Strackee 1983).
pub(crate) fn angle(p: [f64; 3], t: &Triangle) -> f64 {
    let (a, b, c) = (v::sub(t[0], p), v::sub(t[1], p), v::sub(t[2], p));
    let (x, y, z) = (v::length(a), v::length(b), v::length(c));
    let above = v::dot(a, v::cross(b, c));
    let below = x * y * z + v::dot(a, b) * z + v::dot(b, c) * x + v::dot(c, a) * y;
    above.atan2(below) / (2.0 * std::f64::consts::PI)
}

/// How much farther than its size a group of triangles must be to count as a dipole; the error falls with the cube.
const FAR: f64 = 4.0;

/// Triangles whose winding number can be asked for.
#[derive(Debug)]
pub(crate) struct Winding {
    triangles: Vec<Triangle>,
    tree: Bvh,
    dipoles: Vec<Dipole>,
}

/// A group of triangles from afar: where, how large, and its area as a vector.
#[derive(Clone, Copy, Debug)]
struct Dipole {
    centre: [f64; 3],
    radius: f64,
    area: [f64; 3],
    /// The sum of the triangles' areas, whichever way they face.
    all: f64,
}

impl Winding {
    /// Of no triangles: 0 everywhere.
    pub(crate) const NONE: Winding = Winding {
        triangles: Vec::new(),
        tree: Bvh {
            nodes: Vec::new(),
            items: Vec::new(),
        },
        dipoles: Vec::new(),
    };

    pub(crate) fn new(triangles: Vec<Triangle>) -> Winding {
        if triangles.is_empty() {
            return Winding::NONE;
        }
        let bounds: Vec<Bounds> = (triangles.iter())
            .map(|t| Bounds::of(t.map(|p| p.map(|x| x as f32))))
            .collect();
        let tree = Bvh::new(&bounds);
        let mut dipoles = vec![
            Dipole {
                centre: [0.0; 3],
                radius: 0.0,
                area: [0.0; 3],
                all: 0.0
            };
            tree.nodes.len()
        ];
        // children stand behind their parents
        let mut members: Vec<(usize, usize)> = vec![(0, 0); tree.nodes.len()];
        for at in (0..tree.nodes.len()).rev() {
            let node = &tree.nodes[at];
            members[at] = match node.count {
                0 => {
                    let (l, r) = (
                        members[node.first as usize],
                        members[node.first as usize + 1],
                    );
                    (l.0.min(r.0), l.1.max(r.1))
                }
                n => (node.first as usize, (node.first + n) as usize),
            };
        }
        for (at, dipole) in dipoles.iter_mut().enumerate() {
            let own = &tree.items[members[at].0..members[at].1];
            let (mut weight, mut centre, mut area) = (0.0, [0.0; 3], [0.0; 3]);
            for t in own.iter().map(|i| &triangles[*i as usize]) {
                let cross = v::cross(v::sub(t[1], t[0]), v::sub(t[2], t[0]));
                let own = 0.5 * v::length(cross);
                let middle = v::scale(v::add(t[0], v::add(t[1], t[2])), 1.0 / 3.0);
                weight += own;
                centre = v::add(centre, v::scale(middle, own));
                area = v::add(area, v::scale(cross, 0.5));
            }
            if weight > 0.0 {
                centre = v::scale(centre, 1.0 / weight);
            } else if let Some(i) = own.first() {
                centre = triangles[*i as usize][0];
            }
            let reach = (own.iter())
                .flat_map(|i| triangles[*i as usize])
                .map(|p| v::length(v::sub(p, centre)))
                .fold(0.0, f64::max);
            *dipole = Dipole {
                centre,
                radius: reach,
                area,
                all: weight,
            };
        }
        Winding {
            triangles,
            tree,
            dipoles,
        }
    }

    /// The winding number.
    pub(crate) fn number(&self, p: [f64; 3]) -> f64 {
        if self.triangles.is_empty() {
            return 0.0;
        }
        let mut sum = 0.0;
        let mut todo = vec![0];
        while let Some(at) = todo.pop() {
            let (dipole, node) = (&self.dipoles[at], &self.tree.nodes[at]);
            let d = v::sub(dipole.centre, p);
            let far = v::length(d);
            if far > FAR * dipole.radius {
                sum += v::dot(d, dipole.area) / (4.0 * std::f64::consts::PI * far.powi(3));
            } else if node.count > 0 {
                for i in self.tree.leaf(node) {
                    sum += angle(p, &self.triangles[*i as usize]);
                }
            } else {
                todo.extend([node.first as usize, node.first as usize + 1]);
            }
        }
        sum
    }

    /// No less than the winding number's size at any place within `radius` of `p`.
    pub(crate) fn most(&self, p: [f64; 3], radius: f64) -> f64 {
        if self.triangles.is_empty() {
            return 0.0;
        }
        let mut sum = 0.0;
        let mut todo = vec![0];
        while let Some(at) = todo.pop() {
            let (dipole, node) = (&self.dipoles[at], &self.tree.nodes[at]);
            let near = v::length(v::sub(dipole.centre, p)) - radius - dipole.radius;
            if near > dipole.radius {
                // seen head on, all of it as near as its nearest place
                sum += dipole.all / (4.0 * std::f64::consts::PI * near * near);
            } else if node.count > 0 {
                // a triangle is half of all there is to see at most
                sum += 0.5 * f64::from(node.count);
            } else {
                todo.extend([node.first as usize, node.first as usize + 1]);
            }
            if sum >= 0.5 {
                break;
            }
        }
        sum
    }

    /// Whether all triangles are farther than `radius` from `p`.
    pub(crate) fn is_away(&self, p: [f64; 3], radius: f64) -> bool {
        let mut todo = vec![0];
        while let Some(at) = todo.pop() {
            let Some(node) = self.tree.nodes.get(at) else {
                continue;
            };
            let b = &node.bounds;
            let mut d = [0.0; 3];
            for k in 0..3 {
                let (low, high) = (f64::from(b.low[k]), f64::from(b.high[k]));
                d[k] = (low - p[k]).max(p[k] - high).max(0.0);
            }
            if v::length(d) > radius {
                continue;
            }
            if node.count > 0 {
                return false;
            }
            todo.extend([node.first as usize, node.first as usize + 1]);
        }
        true
    }
}
