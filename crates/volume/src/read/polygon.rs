//! Polygons with more than three corners, cut into triangles.

/// Comparisons that the ears of all polygons of a file may take: the cube of the corners in the worst case. Beyond, a polygon that is
/// not convex becomes a fan, as one that is convex always does.
const WORK: usize = 1 << 28;

/// What is needed for a while.
#[derive(Default)]
pub(super) struct Scratch {
    flat: Vec<[f64; 2]>,
    left: Vec<usize>,
    work: usize,
}

impl Scratch {
    /// Appends the triangles of a polygon: a fan where it is convex, else ears (Meisters 1975), seen along its normal.
    pub(super) fn cut(&mut self, corners: &[i64], points: &[[f32; 3]], faces: &mut Vec<[u32; 3]>) {
        let vertex = |i: usize| corners[i] as u32;
        let at = |i: usize| points[corners[i] as usize].map(f64::from);
        let n = corners.len();
        // twice the area seen along each axis (Newell)
        let mut normal = [0.0; 3];
        for i in 0..n {
            let (p, q) = (at(i), at((i + 1) % n));
            for k in 0..3 {
                let (u, v) = ((k + 1) % 3, (k + 2) % 3);
                normal[k] += (p[u] - q[u]) * (p[v] + q[v]);
            }
        }
        let axis = (0..3)
            .max_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()))
            .unwrap_or(0);
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let side = if normal[axis] < 0.0 { -1.0 } else { 1.0 };
        self.flat.clear();
        self.flat.extend((0..n).map(|i| {
            let p = at(i);
            [p[u] * side, p[v]]
        }));
        self.left.clear();
        self.left.extend(0..n);
        let flat = &self.flat;
        let turn = |a: usize, b: usize, c: usize| {
            let [p, q, r] = [flat[a], flat[b], flat[c]];
            (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        };
        let convex = (0..n).all(|i| turn(i, (i + 1) % n, (i + 2) % n) >= 0.0);
        self.work += if convex { 0 } else { n * n };
        if convex || self.work > WORK {
            faces.extend((2..n).map(|i| [0, i - 1, i].map(vertex)));
            return;
        }
        while self.left.len() > 3 {
            let m = self.left.len();
            let three = |i: usize| [(i + m - 1) % m, i, (i + 1) % m].map(|k| self.left[k]);
            let mut looked = 0;
            let is_ear = |i: &usize| {
                let [a, b, c] = three(*i);
                looked += m;
                turn(a, b, c) > 0.0
                    && !self.left.iter().any(|&p| {
                        ![a, b, c].contains(&p)
                            && turn(a, b, p) >= 0.0
                            && turn(b, c, p) >= 0.0
                            && turn(c, a, p) >= 0.0
                    })
            };
            // a polygon that crosses itself may have none
            let ear = (0..m).find(is_ear).unwrap_or(1);
            self.work += looked;
            faces.push(three(ear).map(vertex));
            self.left.remove(ear);
        }
        if let [a, b, c] = self.left[..] {
            faces.push([a, b, c].map(vertex));
        }
    }
}
