//! Meshes become the distances that mathematics says, in double precision and without any tree: near, far, thin, nested, touching,
//! with holes, inside out.

mod shapes;

use shapes::{Random, Soup, ball, cube, random, torus};
use std::f64::consts::PI;
use zeroset_volume::bake::{Alone, Bake, BakeError, Sign, Watch};
use zeroset_volume::check::{Check, crossings, mend};
use zeroset_volume::mesh::Mesh;
use zeroset_volume::volume::Volume;

type Point = [f64; 3];

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
fn along(a: Point, b: Point, t: f64) -> Point {
    [0, 1, 2].map(|k| a[k] + t * b[k])
}
fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The nearest place of a triangle by the regions of its plane (Ericson 2005, section 5.1.5): another way than the product's.
fn distance(p: Point, [a, b, c]: [Point; 3]) -> f64 {
    let (ab, ac, ap) = (sub(b, a), sub(c, a), sub(p, a));
    let off = |q: Point| dot(sub(p, q), sub(p, q)).sqrt();
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return off(a);
    }
    let bp = sub(p, b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return off(b);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return off(along(a, ab, d1 / (d1 - d3)));
    }
    let cp = sub(p, c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return off(c);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return off(along(a, ac, d2 / (d2 - d6)));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return off(along(b, sub(c, b), w));
    }
    let all = va + vb + vc;
    off(along(along(a, ab, vb / all), ac, vc / all))
}

/// The solid angle of a triangle over 4 pi (van Oosterom and Strackee 1983).
fn angle(p: Point, t: [Point; 3]) -> f64 {
    let [a, b, c] = t.map(|q| sub(q, p));
    let [x, y, z] = [a, b, c].map(|q| dot(q, q).sqrt());
    let below = x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y;
    dot(a, cross(b, c)).atan2(below) / (2.0 * PI)
}

fn mesh(soup: Soup) -> (Mesh, Check) {
    let mut mesh = Mesh::new(soup.points, soup.faces).expect("a mesh");
    let check = mend(&mut mesh);
    (mesh, check)
}

fn triangles(mesh: &Mesh) -> Vec<[Point; 3]> {
    (0..mesh.faces().len())
        .map(|i| mesh.corners(i).map(|p| p.map(f64::from)))
        .collect()
}

fn baked(mesh: &Mesh, check: &Check, voxels: u32, sign: Sign) -> Volume {
    let bake = Bake {
        voxels,
        sign,
        ..Bake::default()
    };
    bake.bake(mesh, check, &Alone).expect("a volume")
}

/// Every node, or every so many, of a volume.
fn nodes(volume: &Volume, step: usize) -> impl Iterator<Item = (Point, f64)> {
    let [nx, ny, _] = volume.nodes();
    (0..volume.values().len()).step_by(step).map(move |i| {
        let at = i as u32;
        let p = volume.at([at % nx, at / nx % ny, at / (nx * ny)]);
        (p, f64::from(volume.values()[i]))
    })
}

/// Distances to the nearest face of all, and the winding number.
fn right(p: Point, faces: &[[Point; 3]]) -> (f64, f64) {
    let nearest = faces
        .iter()
        .map(|t| distance(p, *t))
        .fold(f64::INFINITY, f64::min);
    (nearest, faces.iter().map(|t| angle(p, *t)).sum())
}

/// Holds every node against all faces: what is inside by `inside`, of the distance and the winding number. Gives the largest error
/// as a share of the mesh's size.
fn hold(
    name: &str,
    volume: &Volume,
    mesh: &Mesh,
    step: usize,
    inside: impl Fn(Point, f64) -> bool,
) -> f64 {
    let faces = triangles(mesh);
    let size = f64::from(volume.nodes().into_iter().max().unwrap()) * volume.step()[0];
    let mut worst = 0.0_f64;
    for (p, value) in nodes(volume, step) {
        let (d, w) = right(p, &faces);
        worst = worst.max((value.abs() - d).abs() / size);
        // on the surface there is no inside
        if d > 1e-6 * size {
            assert_eq!(
                value < 0.0,
                inside(p, w),
                "{name}: {value} at {p:?}, winding number {w}"
            );
        }
    }
    // single precision keeps seven digits of the largest distance
    assert!(worst < 1.5e-7, "{name}: off by {worst} of its size");
    worst
}

#[test]
fn closed_meshes_are_exact() {
    let thin = cube().scaled([1.0, 0.002, 0.7]);
    let needle = torus(1.0, 0.001, 5, 3);
    for (name, soup) in [
        ("cube", cube()),
        ("ball", ball(24, 12)),
        ("torus", torus(1.0, 0.4, 30, 14)),
        ("thin", thin),
        ("needle", needle),
        ("small", ball(9, 7).scaled([1e-4; 3])),
        (
            "large and far",
            ball(9, 7).scaled([1e5; 3]).moved([3e5, 0.0, -2e5]),
        ),
        ("inside out", torus(1.0, 0.4, 30, 14).turned()),
    ] {
        let (mesh, check) = mesh(soup);
        assert!(check.watertight && check.holes == 0, "{name}: {check:?}");
        assert_eq!(check.flipped > 0, name == "inside out", "{name}: {check:?}");
        for sign in [Sign::Auto, Sign::Parity, Sign::Winding] {
            let volume = baked(&mesh, &check, 24, sign);
            let step = if sign == Sign::Auto { 1 } else { 7 };
            hold(name, &volume, &mesh, step, |_, w| w > 0.5);
        }
    }
}

/// A ray that runs along edges and through vertices crosses the surface as often as any other.
#[test]
fn rays_through_edges_and_vertices_count_once() {
    // nodes lie on the planes of the faces' edges and on the vertices: 8 cells for a side of 2, two on either side
    let (mesh, check) = mesh(cube());
    let volume = baked(&mesh, &check, 12, Sign::Parity);
    assert!(nodes(&volume, 1).any(|(p, d)| p == [1.0, 1.0, 1.0] && d == 0.0));
    hold("cube", &volume, &mesh, 1, |p, _| {
        p.iter().all(|x| x.abs() < 1.0)
    });
    // a ball whose poles and meridians are on nodes
    let (mesh, check) = self::mesh(ball(16, 8).scaled([1.0, 1.0, 1.0]));
    for sign in [Sign::Parity, Sign::Winding] {
        hold("ball", &baked(&mesh, &check, 20, sign), &mesh, 1, |_, w| {
            w > 0.5
        });
    }
}

#[test]
fn shells_within_shells() {
    let within = |r: f64| move |p: Point| dot(p, p) < r * r;
    // as files of solids have them: the inner one faces inwards
    let hollow = ball(20, 10).and(ball(20, 10).scaled([0.5; 3]).turned());
    let (hollow, check) = mesh(hollow);
    assert_eq!((check.parts, check.flipped), (2, 0));
    for sign in [Sign::Auto, Sign::Parity, Sign::Winding] {
        let volume = baked(&hollow, &check, 24, sign);
        let solid = |_: Point, w: f64| w > 0.5;
        hold("hollow", &volume, &hollow, 1, solid);
        assert!(nodes(&volume, 1).any(|(p, d)| within(0.4)(p) && d > 0.0));
    }
    // both facing outwards: parity is hollow, the winding number is solid
    let both = ball(20, 10).and(ball(20, 10).scaled([0.5; 3]));
    let (both, check) = mesh(both);
    hold(
        "nested",
        &baked(&both, &check, 24, Sign::Auto),
        &both,
        1,
        |_, w| w.round() == 1.0,
    );
    hold(
        "nested",
        &baked(&both, &check, 24, Sign::Winding),
        &both,
        1,
        |_, w| w > 0.5,
    );
}

#[test]
fn parts_that_touch_or_overlap() {
    // cubes that share a side, an edge, a corner
    for by in [[2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0; 3]] {
        let (mesh, check) = mesh(cube().and(cube().moved(by)));
        assert!(check.watertight, "{check:?}");
        hold(
            "touching",
            &baked(&mesh, &check, 20, Sign::Auto),
            &mesh,
            1,
            |_, w| w > 0.5,
        );
    }
    // where they overlap they are one
    let (both, check) = mesh(ball(20, 10).and(cube().moved([0.9, 0.3, 0.2])));
    assert!(check.watertight && crossings(&both) > 0);
    hold(
        "overlapping",
        &baked(&both, &check, 24, Sign::Auto),
        &both,
        1,
        |_, w| w > 0.5,
    );
}

/// Holes: the winding number decides, the mesh's own places are as far as ever, and nothing is steeper than a distance.
#[test]
fn holes_are_closed_smoothly() {
    let holed = ball(32, 16).without(|p| p[2] > 0.85 || (p[0] > 0.9 && p[1] < 0.2));
    for (name, soup, holes) in [
        ("ball with two holes", holed.clone(), 2),
        ("inside out with two holes", holed.turned(), 2),
        ("cube without a lid", cube().without(|p| p[1] > 0.9), 1),
        (
            "half of the faces of a ball",
            ball(24, 12).without(|p| p[0] > 0.0),
            1,
        ),
    ] {
        let (mesh, check) = mesh(soup);
        assert_eq!((check.holes, check.watertight), (holes, false), "{name}");
        let volume = baked(&mesh, &check, 32, Sign::Auto);
        let faces = triangles(&mesh);
        let h = volume.step()[0];
        let (mut lid, mut inside) = (0, 0);
        for (p, value) in nodes(&volume, 3) {
            let (d, w) = right(p, &faces);
            // dipoles stand for distant parts of the rim
            if d > 1e-6 && (w - 0.5).abs() > 0.01 {
                assert_eq!(
                    value < 0.0,
                    w > 0.5,
                    "{name}: {value} at {p:?}, winding number {w}"
                );
            }
            inside += usize::from(value < 0.0);
            // near a lid, the lid is nearer
            assert!(value.abs() < d + 1e-6, "{name}: {value} at {p:?}, but {d}");
            lid += usize::from(value.abs() < d - 1e-5);
            if w.abs() < 0.05 && p[1].abs() > 1.2 {
                assert!((value - d).abs() < 1e-6 || value.abs() < d, "{name}");
            }
        }
        assert!(lid > 20 && inside > 100, "{name}: {lid} {inside}");
        steep(name, &volume, h);
    }
}

/// No two neighbours differ by more than how far they are apart.
fn steep(name: &str, volume: &Volume, h: f64) {
    let [nx, ny, nz] = volume.nodes().map(|n| n as usize);
    let at = |i, j, k| f64::from(volume.values()[i + nx * (j + ny * k)]);
    for k in 1..nz {
        for j in 1..ny {
            for i in 1..nx {
                for other in [at(i - 1, j, k), at(i, j - 1, k), at(i, j, k - 1)] {
                    let step = (at(i, j, k) - other).abs();
                    assert!(
                        step < h * (1.0 + 1e-4),
                        "{name}: {} voxels a voxel at {i}, {j}, {k}",
                        step / h
                    );
                }
            }
        }
    }
}

/// Triangles that are no surface at all: each is its own hole. Distances are right all the same, and the sign is the winding number's.
#[test]
fn anything_has_distances() {
    for seed in 0..3 {
        let (mesh, check) = mesh(random(150, seed));
        let volume = baked(&mesh, &check, 20, Sign::Winding);
        let faces = triangles(&mesh);
        for (p, value) in nodes(&volume, 5) {
            let (d, w) = right(p, &faces);
            assert!(value.abs() < d + 1e-6);
            if d > 1e-6 && (w - 0.5).abs() > 0.05 {
                assert_eq!(value < 0.0, w > 0.5, "{value} at {p:?}, winding number {w}");
            }
        }
        steep("random", &volume, volume.step()[0]);
    }
}

/// Faces without an area and faces that run the wrong way change nothing.
#[test]
fn flat_and_flipped_faces_are_borne() {
    let mut soup = torus(1.0, 0.4, 24, 12);
    let mut random = Random(7);
    // as many as a careless export turns around
    let turned = soup
        .faces
        .iter_mut()
        .filter(|_| random.next() < 0.2)
        .map(|f| f.swap(1, 2))
        .count();
    // a corner in the middle of an edge makes a face without area
    let [a, b, _] = soup.faces[10];
    let middle = [0, 1, 2].map(|k| 0.5 * (soup.points[a as usize][k] + soup.points[b as usize][k]));
    soup.points.push(middle);
    soup.faces.push([a, b, soup.points.len() as u32 - 1]);
    let (mesh, check) = mesh(soup);
    assert_eq!((check.flipped, check.parts), (turned, 1), "{check:?}");
    let volume = baked(&mesh, &check, 24, Sign::Auto);
    hold("torus", &volume, &mesh, 1, |p, _| {
        let r = p[0].hypot(p[1]) - 1.0;
        // as the faces have it: only where that is clear
        let d = r.hypot(p[2]) - 0.4;
        if d.abs() > 0.03 {
            d < 0.0
        } else {
            let w: f64 = triangles(&mesh).iter().map(|t| angle(p, *t)).sum();
            w > 0.5
        }
    });
}

#[test]
fn a_band_ends_where_it_says() {
    let (mesh, check) = mesh(ball(24, 12));
    let whole = baked(&mesh, &check, 32, Sign::Auto);
    let bake = Bake {
        voxels: 32,
        band: Some(3.0),
        ..Bake::default()
    };
    let band = bake.bake(&mesh, &check, &Alone).unwrap();
    let width = (3.0 * band.step()[0]) as f32;
    assert_eq!(band.background(), Some(width));
    for (b, w) in band.values().iter().zip(whole.values()) {
        // which of two faces that are as near is taken may differ
        assert!((b - w.clamp(-width, width)).abs() < 1e-6, "{b} {w}");
    }
}

#[test]
fn what_cannot_be_sampled_is_refused() {
    let (mesh, check) = mesh(cube());
    for voxels in [0, 7, 2048, u32::MAX] {
        let bake = Bake {
            voxels,
            ..Bake::default()
        };
        assert_eq!(
            bake.bake(&mesh, &check, &Alone),
            Err(BakeError::Voxels { given: voxels })
        );
    }
    let (far, check) = self::mesh(
        cube()
            .scaled([0.01; 3])
            .moved([1e6, 0.0, 0.0])
            .and(cube().scaled([0.0; 3]).moved([1e6, 0.5, 0.0]))
            .and(random(2, 1))
            .moved([0.0; 3])
            .without(|p| p[0] < 1e5),
    );
    assert!(matches!(
        baked_or(&far, &check),
        Err(BakeError::Small { .. })
    ));
    struct Never;
    impl Watch for Never {
        fn is_stopped(&self) -> bool {
            true
        }
    }
    let bake = Bake::default();
    assert_eq!(
        bake.bake(&mesh, &self::mesh(cube()).1, &Never),
        Err(BakeError::Stopped)
    );
}

fn baked_or(mesh: &Mesh, check: &Check) -> Result<Volume, BakeError> {
    Bake {
        voxels: 200,
        ..Bake::default()
    }
    .bake(mesh, check, &Alone)
}

/// The same on every level of SIMD and with any number of threads: what is compared here is one thread with all.
#[test]
fn threads_change_nothing() {
    let (mesh, check) = mesh(torus(1.0, 0.4, 30, 14));
    let one = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    let alone = one.install(|| baked(&mesh, &check, 40, Sign::Auto));
    assert_eq!(alone, baked(&mesh, &check, 40, Sign::Auto));
}

/// A check that never fails is worth nothing: a node that is a little off is noticed.
#[test]
#[should_panic(expected = "off by")]
fn a_wrong_distance_is_noticed() {
    let (mesh, check) = mesh(cube());
    let volume = baked(&mesh, &check, 24, Sign::Auto);
    let mut values = volume.values().to_vec();
    values[1234] *= 1.0 + 1e-5;
    let wrong = Volume::new(volume.nodes(), volume.origin(), volume.step(), values).unwrap();
    hold("wrong", &wrong, &mesh, 1, |_, w| w > 0.5);
}
