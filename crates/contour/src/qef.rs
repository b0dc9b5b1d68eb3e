//! The point that is nearest to some planes: the quadratic error function of dual contouring (Ju, Losasso, Schaefer and Warren 2002).

use crate::vector::{V, add, dot, scale, sub};

/// Directions in which planes say less than this of what they say in the best one, squared, are left to the middle of their points
/// (Schaefer and Warren 2002): two planes that meet at less than about 4 degrees have no edge.
const WEAK: f64 = 1e-3;

/// A point of a surface and its unit normal there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    pub(crate) point: V,
    pub(crate) normal: V,
}

/// The middle of the points.
pub(crate) fn middle(planes: &[Plane]) -> V {
    let sum = planes.iter().fold([0.0; 3], |s, p| add(s, p.point));
    scale(sum, 1.0 / planes.len().max(1) as f64)
}

/// The cosine of the largest angle between two of the normals.
pub(crate) fn least_cosine(planes: &[Plane]) -> f64 {
    let mut least = 1.0_f64;
    for (i, a) in planes.iter().enumerate() {
        for b in &planes[i + 1..] {
            least = least.min(dot(a.normal, b.normal));
        }
    }
    least
}

/// The point with the least squared distances to the planes; where that leaves a choice, the one nearest to the middle of their points.
pub(crate) fn nearest(planes: &[Plane]) -> V {
    let middle = middle(planes);
    let mut matrix = [[0.0; 3]; 3];
    let mut right = [0.0; 3];
    for p in planes {
        let d = dot(p.normal, sub(p.point, middle));
        for i in 0..3 {
            right[i] += p.normal[i] * d;
            for j in 0..3 {
                matrix[i][j] += p.normal[i] * p.normal[j];
            }
        }
    }
    let (values, vectors) = eigen(matrix);
    let largest = values.iter().fold(0.0_f64, |m, x| m.max(*x));
    let mut at = middle;
    for (value, vector) in values.into_iter().zip(vectors) {
        if value > WEAK * largest && value > 0.0 {
            at = add(at, scale(vector, dot(vector, right) / value));
        }
    }
    at
}

/// Eigenvalues and unit eigenvectors of a symmetric matrix, by rotations (Jacobi 1846).
fn eigen(mut a: [[f64; 3]; 3]) -> ([f64; 3], [V; 3]) {
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..12 {
        let off = a[0][1].abs() + a[0][2].abs() + a[1][2].abs();
        if off < 1e-14 * (a[0][0].abs() + a[1][1].abs() + a[2][2].abs()) {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for row in &mut a {
                let (x, y) = (row[p], row[q]);
                (row[p], row[q]) = (c * x - s * y, s * x + c * y);
            }
            let (x, y) = (a[p], a[q]);
            for k in 0..3 {
                (a[p][k], a[q][k]) = (c * x[k] - s * y[k], s * x[k] + c * y[k]);
            }
            let (x, y) = (v[p], v[q]);
            for k in 0..3 {
                (v[p][k], v[q][k]) = (c * x[k] - s * y[k], s * x[k] + c * y[k]);
            }
        }
    }
    ([a[0][0], a[1][1], a[2][2]], v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::length;

    fn plane(point: V, normal: V) -> Plane {
        let normal = scale(normal, 1.0 / length(normal));
        Plane { point, normal }
    }

    #[test]
    fn three_planes_meet_in_their_corner() {
        let corner = [0.3, -0.2, 0.7];
        let planes = [
            plane(add(corner, [0.0, 0.4, -0.1]), [1.0, 0.0, 0.0]),
            plane(add(corner, [0.2, 0.0, 0.3]), [0.0, 1.0, 0.0]),
            plane(add(corner, [-0.3, 0.3, 0.0]), [0.0, 0.0, 1.0]),
        ];
        assert!(length(sub(nearest(&planes), corner)) < 1e-12);
    }

    #[test]
    fn two_planes_meet_in_an_edge_beside_the_middle() {
        let planes = [
            plane([0.0, -0.3, 0.2], [1.0, 0.0, 0.0]),
            plane([-0.5, 0.0, 0.4], [0.6, 0.8, 0.0]),
        ];
        let at = nearest(&planes);
        for p in planes {
            assert!(dot(p.normal, sub(at, p.point)).abs() < 1e-12);
        }
        // along the edge it stays in the middle
        assert!((at[2] - 0.3).abs() < 1e-12);
    }

    #[test]
    fn planes_that_are_one_give_the_middle() {
        let planes = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
            .map(|p| plane(p, [1e-4 * p[0], 0.0, 1.0]));
        let at = nearest(&planes);
        assert!(length(sub(at, middle(&planes))) < 1e-3);
    }
}
