//! Meshes made here.

use std::f64::consts::TAU;

/// Corners and faces.
#[derive(Clone, Default)]
pub(crate) struct Soup {
    pub(crate) points: Vec<[f32; 3]>,
    pub(crate) faces: Vec<[u32; 3]>,
}

impl Soup {
    pub(crate) fn and(mut self, other: Soup) -> Soup {
        let first = self.points.len() as u32;
        self.points.extend(other.points);
        (self.faces).extend(other.faces.iter().map(|f| f.map(|v| v + first)));
        self
    }

    pub(crate) fn moved(mut self, by: [f32; 3]) -> Soup {
        self.points
            .iter_mut()
            .for_each(|p| (0..3).for_each(|k| p[k] += by[k]));
        self
    }

    pub(crate) fn scaled(mut self, by: [f32; 3]) -> Soup {
        self.points
            .iter_mut()
            .for_each(|p| (0..3).for_each(|k| p[k] *= by[k]));
        self
    }

    pub(crate) fn turned(mut self) -> Soup {
        self.faces.iter_mut().for_each(|f| f.swap(0, 1));
        self
    }

    /// Without the faces that are chosen by the middle of their corners.
    pub(crate) fn without(mut self, gone: impl Fn([f32; 3]) -> bool) -> Soup {
        let points = &self.points;
        self.faces.retain(|f| {
            let middle =
                [0, 1, 2].map(|k| f.iter().map(|v| points[*v as usize][k]).sum::<f32>() / 3.0);
            !gone(middle)
        });
        self
    }
}

/// A cube of side 2 about the origin.
pub(crate) fn cube() -> Soup {
    let points = (0..8)
        .map(|i| [0, 1, 2].map(|k| if i >> k & 1 == 1 { 1.0 } else { -1.0 }))
        .collect();
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let faces = (quads.iter())
        .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
        .collect();
    Soup { points, faces }
}

/// A torus about z, or with `knots` a line that goes around it `knots` times: its faces are thin where it is bent.
pub(crate) fn torus(radius: f64, tube: f64, around: u32, across: u32) -> Soup {
    let mut soup = Soup::default();
    for i in 0..around {
        let a = TAU * f64::from(i) / f64::from(around);
        for j in 0..across {
            let b = TAU * f64::from(j) / f64::from(across);
            let r = radius + tube * b.cos();
            soup.points
                .push([r * a.cos(), r * a.sin(), tube * b.sin()].map(|x| x as f32));
            let at = |i: u32, j: u32| (i % around) * across + j % across;
            let [p, q, s, t] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            soup.faces.extend([[p, q, s], [p, s, t]]);
        }
    }
    soup
}

/// A ball of radius 1 with a pole at each end of z.
pub(crate) fn ball(around: u32, down: u32) -> Soup {
    let mut soup = Soup::default();
    soup.points.push([0.0, 0.0, 1.0]);
    for j in 1..down {
        let b = 0.5 * TAU * f64::from(j) / f64::from(down);
        for i in 0..around {
            let a = TAU * f64::from(i) / f64::from(around);
            soup.points
                .push([b.sin() * a.cos(), b.sin() * a.sin(), b.cos()].map(|x| x as f32));
        }
    }
    soup.points.push([0.0, 0.0, -1.0]);
    let at = |i: u32, j: u32| 1 + (j - 1) * around + i % around;
    let last = soup.points.len() as u32 - 1;
    for i in 0..around {
        soup.faces.push([0, at(i, 1), at(i + 1, 1)]);
        for j in 1..down - 1 {
            let [p, q, s, t] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            soup.faces.extend([[p, q, s], [p, s, t]]);
        }
        soup.faces
            .push([last, at(i + 1, down - 1), at(i, down - 1)]);
    }
    soup
}

/// Triangles anywhere.
pub(crate) fn random(count: u32, seed: u64) -> Soup {
    let mut random = Random(seed);
    let mut soup = Soup::default();
    for i in 0..count {
        let middle = [(); 3].map(|()| random.next());
        let size = 0.5 * random.next().powi(3);
        for _ in 0..3 {
            soup.points
                .push(middle.map(|x| (x + size * (random.next() - 0.5)) as f32));
        }
        soup.faces.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    soup
}

/// Numbers from 0 to 1 (Knuth's multiplier).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
