//! Makes the mesh of `scenes/meshes`: a sitting hare of balls and capsules that flow into each other, by marching tetrahedra (Doi and
//! Koide 1991). Who has no other mesh to try things on has this one.
//!
//! `cargo run --release -p zeroset-volume --example figure -- scenes/meshes/hare.ply`

use std::collections::HashMap;
use std::error::Error;

type Point = [f64; 3];

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The distance from a line, less a radius that goes from one to another along it.
fn capsule(p: Point, a: Point, b: Point, radii: [f64; 2]) -> f64 {
    let (d, e) = (sub(p, a), sub(b, a));
    let t = (dot(d, e) / dot(e, e)).clamp(0.0, 1.0);
    let off = sub(d, [t * e[0], t * e[1], t * e[2]]);
    dot(off, off).sqrt() - (radii[0] + t * (radii[1] - radii[0]))
}

/// The smooth minimum (Quilez).
fn blend(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - 0.25 * h * h * k
}

/// The hare: negative inside. It stands on y = 0, is about 1.5 high and looks along x.
fn hare(p: Point) -> f64 {
    let mirrored = [p[0], p[1], p[2].abs()];
    let body = capsule(p, [-0.28, 0.42, 0.0], [0.12, 0.5, 0.0], [0.4, 0.32]);
    let chest = capsule(p, [0.18, 0.42, 0.0], [0.34, 0.84, 0.0], [0.26, 0.15]);
    let head = capsule(p, [0.36, 0.98, 0.0], [0.6, 0.9, 0.0], [0.2, 0.1]);
    let ear = capsule(mirrored, [0.28, 1.1, 0.08], [0.08, 1.5, 0.2], [0.06, 0.075]);
    let thigh = capsule(mirrored, [-0.24, 0.28, 0.3], [0.0, 0.2, 0.34], [0.24, 0.14]);
    let foot = capsule(
        mirrored,
        [-0.12, 0.07, 0.34],
        [0.26, 0.06, 0.34],
        [0.07, 0.06],
    );
    let leg = capsule(mirrored, [0.3, 0.34, 0.14], [0.42, 0.06, 0.15], [0.1, 0.06]);
    let tail = capsule(p, [-0.68, 0.3, 0.0], [-0.72, 0.34, 0.0], [0.11, 0.11]);
    let mut d = blend(body, chest, 0.3);
    for (part, k) in [
        (head, 0.14),
        (ear, 0.08),
        (thigh, 0.12),
        (foot, 0.06),
        (leg, 0.1),
        (tail, 0.05),
    ] {
        d = blend(d, part, k);
    }
    d
}

/// Corners of the tetrahedra that a cube falls into, all around the diagonal from 0 to 7: neighbours share their faces.
const TETRAHEDRA: [[usize; 4]; 6] = [
    [0, 1, 3, 7],
    [0, 3, 2, 7],
    [0, 2, 6, 7],
    [0, 6, 4, 7],
    [0, 4, 5, 7],
    [0, 5, 1, 7],
];

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("name the file to write")?;
    const SIDE: usize = 36;
    let (first, step) = ([-0.94, -0.06, -0.79], 0.0475);
    let place = |i: [usize; 3]| [0, 1, 2].map(|k| first[k] + step * i[k] as f64);
    let mut vertices: Vec<[f32; 3]> = Vec::new();
    let mut faces: Vec<[u32; 3]> = Vec::new();
    let mut cuts: HashMap<[[usize; 3]; 2], u32> = HashMap::new();
    for cell in 0..SIDE * SIDE * SIDE {
        let at = [cell % SIDE, cell / SIDE % SIDE, cell / (SIDE * SIDE)];
        let corner = |c: usize| [at[0] + (c & 1), at[1] + (c >> 1 & 1), at[2] + (c >> 2)];
        for tetrahedron in TETRAHEDRA {
            let nodes = tetrahedron.map(corner);
            let values = nodes.map(|n| hare(place(n)));
            let (within, outside): (Vec<usize>, Vec<usize>) =
                (0..4).partition(|i| values[*i] < 0.0);
            let mut cut = |a: usize, b: usize| {
                let ends = [nodes[a].min(nodes[b]), nodes[a].max(nodes[b])];
                *cuts.entry(ends).or_insert_with(|| {
                    let [p, q] = ends.map(place);
                    let along = |t: f64| [0, 1, 2].map(|k| p[k] + t * (q[k] - p[k]));
                    // where the sign changes, by halves; not at a node, where faces would have no area
                    let (mut low, mut high) = (0.0, 1.0);
                    for _ in 0..20 {
                        let t = 0.5 * (low + high);
                        if (hare(along(t)) < 0.0) == (hare(p) < 0.0) {
                            low = t;
                        } else {
                            high = t;
                        }
                    }
                    let t = low.clamp(0.05, 0.95);
                    vertices.push([0, 1, 2].map(|k| (p[k] + t * (q[k] - p[k])) as f32));
                    vertices.len() as u32 - 1
                })
            };
            let polygon: Vec<u32> = match (&within[..], &outside[..]) {
                ([a], [x, y, z]) | ([x, y, z], [a]) => vec![cut(*a, *x), cut(*a, *y), cut(*a, *z)],
                ([a, b], [x, y]) => vec![cut(*a, *x), cut(*a, *y), cut(*b, *y), cut(*b, *x)],
                _ => continue,
            };
            // outwards is away from the nodes within
            let vertex = |v: u32| vertices[v as usize].map(f64::from);
            let [p, q, r] = [vertex(polygon[0]), vertex(polygon[1]), vertex(polygon[2])];
            let (e, d) = (sub(q, p), sub(r, p));
            let normal = [
                e[1] * d[2] - e[2] * d[1],
                e[2] * d[0] - e[0] * d[2],
                e[0] * d[1] - e[1] * d[0],
            ];
            let inner = place(nodes[within[0]]);
            let turned = dot(normal, sub(inner, p)) > 0.0;
            for i in 2..polygon.len() {
                let [a, b, c] = [polygon[0], polygon[i - 1], polygon[i]];
                faces.push(if turned { [a, c, b] } else { [a, b, c] });
            }
        }
    }
    let mut out = format!(
        "ply\nformat binary_little_endian 1.0\ncomment a hare, made by Zeroset (crates/volume/examples/figure.rs)\n\
         element vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n\
         property list uchar ushort vertex_indices\nend_header\n",
        vertices.len(),
        faces.len()
    )
    .into_bytes();
    vertices
        .iter()
        .flatten()
        .for_each(|x| out.extend(x.to_le_bytes()));
    for face in &faces {
        out.push(3);
        for v in face {
            out.extend(u16::try_from(*v)?.to_le_bytes());
        }
    }
    std::fs::write(&path, &out)?;
    println!(
        "{path}: {} vertices, {} faces, {} bytes",
        vertices.len(),
        faces.len(),
        out.len()
    );
    Ok(())
}
