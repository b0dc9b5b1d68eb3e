//! Volumes of scenes that move: against closed forms in double precision, and composed anew against composed from scratch.

use proptest::prelude::*;
use std::sync::Arc;
use zeroset_number::Grid;
use zeroset_volume::compose::{
    Body, BodyError, Bottom, ComposeError, Heights, Lattice, LocalGrid, NOBODY, Pose, SceneVolume,
    Shape, Star,
};

/// From -1 to 1.
const LATTICE: Lattice = Lattice {
    nodes: [33; 3],
    origin: [-1.0; 3],
    voxel: 1.0 / 16.0,
};

fn place(lattice: &Lattice, n: usize) -> [f64; 3] {
    let [nx, ny, _] = lattice.nodes;
    let node = [n % nx, n / nx % ny, n / nx / ny];
    [0, 1, 2].map(|k| f64::from(lattice.origin[k]) + f64::from(lattice.voxel) * node[k] as f64)
}

fn alone(shape: Shape, pose: Pose, reach: f32) -> SceneVolume {
    let mut volume = SceneVolume::new(LATTICE, reach).unwrap();
    let body = Body::new(shape, pose, [1.0; 3]).unwrap();
    volume.compose(&[body]).unwrap();
    volume
}

/// Every node against a distance, as far as bodies reach.
fn compare(
    volume: &SceneVolume,
    reach: f64,
    tolerance: f64,
    right: impl Fn([f64; 3]) -> Option<f64>,
) {
    let mut compared = 0;
    for (n, found) in volume.values().iter().enumerate() {
        let p = place(&volume.lattice(), n);
        let Some(right) = right(p) else { continue };
        let off = (f64::from(*found) - right.min(reach)).abs();
        assert!(off <= tolerance, "at {p:?}: {found} instead of {right}");
        compared += 1;
    }
    assert!(compared > 500, "{compared} nodes are compared");
}

fn norm(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[test]
fn balls_and_cuboids_are_exact() {
    let ball = Shape::Ellipsoid { radii: [0.25; 3] };
    let volume = alone(ball, Pose::at([0.2, -0.1, 0.05]).scaled(2.0), 0.4);
    compare(&volume, 0.4, 2e-4, |p| {
        Some(norm([p[0] - 0.2, p[1] + 0.1, p[2] - 0.05]) - 0.5)
    });
    let half = [0.3, 0.2, 0.4];
    let pose = Pose::at([0.1, 0.1, -0.1]).turned([0.0, 0.6, 0.8], 0.7);
    let volume = alone(Shape::Cuboid { half }, pose, 0.4);
    compare(&volume, 0.4, 2e-6, |p| {
        let d = [0, 1, 2].map(|k| p[k] - f64::from(pose.position[k]));
        let q = pose
            .axes
            .map(|axis| (0..3).map(|k| f64::from(axis[k]) * d[k]).sum::<f64>());
        let q = [0, 1, 2].map(|k| q[k].abs() - f64::from(half[k]));
        let inside = q.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b)).min(0.0);
        Some(norm(q.map(|x| x.max(0.0))) + inside)
    });
}

/// To first order near the surface: along a normal a small way is what it is.
#[test]
fn ellipsoids_are_right_near_their_surface() {
    let radii = [0.8, 0.4, 0.6];
    let volume = alone(Shape::Ellipsoid { radii }, Pose::at([0.0; 3]), 0.5);
    let r = radii.map(f64::from);
    compare(&volume, 0.5, 2e-3, |p| {
        let scaled = [0, 1, 2].map(|k| p[k] / r[k]);
        let f = norm(scaled) - 1.0;
        if f.abs() > 0.2 {
            return None;
        }
        // the nearest place by Newton's method on x = r^2 p / (r^2 + t)
        let at = |t: f64| {
            (0..3)
                .map(|k| (r[k] * p[k] / (r[k] * r[k] + t)).powi(2))
                .sum::<f64>()
                - 1.0
        };
        let (mut low, mut high) = (-r[1] * r[1] * 0.9, 4.0);
        for _ in 0..80 {
            let t = 0.5 * (low + high);
            if at(t) > 0.0 { low = t } else { high = t }
        }
        let nearest = [0, 1, 2].map(|k| r[k] * r[k] * p[k] / (r[k] * r[k] + low));
        let d = norm([0, 1, 2].map(|k| p[k] - nearest[k])) * f.signum();
        (d.abs() < 0.06).then_some(d)
    });
}

/// What was sampled, moved and scaled, and never too far beyond its box.
#[test]
fn grids_are_what_was_sampled() {
    let samples = (0..17 * 17 * 17).map(|n| {
        let node = [n % 17, n / 17 % 17, n / 289];
        norm(node.map(|c| c as f64 / 8.0 - 1.0)) as f32 - 0.6
    });
    let grid = Grid::of_points([17; 3], samples.collect()).unwrap();
    let grid = LocalGrid::new(Arc::new(grid), [-1.0; 3], [1.0; 3]).unwrap();
    let pose = Pose::at([0.2, 0.0, 0.1])
        .turned([0.0, 1.0, 0.0], 0.5)
        .scaled(0.5);
    let volume = alone(Shape::Grid(Arc::new(grid)), pose, 0.6);
    let right = |p: [f64; 3]| norm([p[0] - 0.2, p[1], p[2] - 0.1]) - 0.3;
    compare(&volume, 0.6, 0.012, |p| (right(p) < 0.15).then(|| right(p)));
    for (n, found) in volume.values().iter().enumerate() {
        let p = place(&LATTICE, n);
        assert!(f64::from(*found) <= right(p).min(0.6) + 0.012, "{p:?}");
    }
}

/// An even slope has the variance of its blur, and so its distance is that of a plane.
#[test]
fn heights_know_their_slope() {
    let n = 65;
    let slope = 0.75;
    let map: Vec<f32> = (0..n * n)
        .map(|k| slope * ((k % n) as f32 / 32.0 - 1.0))
        .collect();
    let lower: Vec<f32> = map.iter().map(|y| y - 0.4).collect();
    let make = |bottom: &Bottom| Heights::new([n as u32; 2], [1.0; 2], &map, bottom, 0.06).unwrap();
    let steep = f64::from(slope).hypot(1.0);
    let above = |p: [f64; 3]| (p[1] - f64::from(slope) * p[0]) / steep;
    let inner = |p: [f64; 3]| p[0].abs() < 0.7 && p[2].abs() < 0.7;
    let two = make(&Bottom::Heights(lower));
    let volume = alone(Shape::Heights(Arc::new(two)), Pose::at([0.0; 3]), 0.5);
    compare(&volume, 0.5, 4e-3, |p| {
        let below = (f64::from(slope) * p[0] - 0.4 - p[1]) / steep;
        inner(p).then(|| above(p).max(below).max(p[0].abs().max(p[2].abs()) - 1.0))
    });
    let one = make(&Bottom::Flat(-0.9));
    let volume = alone(Shape::Heights(Arc::new(one)), Pose::at([0.0; 3]), 0.5);
    compare(&volume, 0.5, 4e-3, |p| {
        inner(p).then(|| {
            above(p)
                .max(-0.9 - p[1])
                .max(p[0].abs().max(p[2].abs()) - 1.0)
        })
    });
}

/// A ball is exact; where the radii of a star vary, it falls off more softly, as far as they vary.
#[test]
fn stars_know_their_slope() {
    let ball = Star::new(16, 0.1, |_| 0.5).unwrap();
    let volume = alone(Shape::Star(Arc::new(ball)), Pose::at([0.1, 0.0, 0.0]), 0.5);
    compare(&volume, 0.5, 1e-5, |p| {
        Some(norm([p[0] - 0.1, p[1], p[2]]) - 0.5)
    });
    // the plane y = 0.5 as a star around the origin, seen up to 50 degrees from above
    let plane = Star::new(96, 0.05, |d| (0.5 / d[1].max(0.2)).min(2.5)).unwrap();
    let volume = alone(Shape::Star(Arc::new(plane)), Pose::at([0.0; 3]), 0.5);
    compare(&volume, 0.5, 0.02, |p| {
        let near = (p[1] - 0.5).abs() < 0.15;
        (near && p[0].hypot(p[2]) < p[1] * 1.2).then_some(p[1] - 0.5)
    });
}

/// A body from some numbers: all kinds, anywhere.
fn body(kind: u32, at: [f32; 3], turn: f32, shapes: &[Shape]) -> Body {
    let shape = shapes[kind as usize % shapes.len()].clone();
    let pose = Pose::at(at).turned([0.6, 0.0, 0.8], turn).scaled(0.5);
    Body::new(shape, pose, [0.5; 3]).unwrap()
}

fn shapes() -> Vec<Shape> {
    let grid = Grid::of_points(
        [3; 3],
        (0..27).map(|n| (n % 5) as f32 * 0.2 - 0.2).collect(),
    );
    let grid = LocalGrid::new(Arc::new(grid.unwrap()), [-0.5; 3], [0.5; 3]).unwrap();
    let map: Vec<f32> = (0..64).map(|n| (n % 7) as f32 * 0.05).collect();
    let low = Bottom::Heights(map.iter().map(|y| -0.3 - 0.5 * y).collect());
    let heights = |bottom: &Bottom| {
        Shape::Heights(Arc::new(
            Heights::new([8; 2], [0.5; 2], &map, bottom, 0.1).unwrap(),
        ))
    };
    let star = Star::new(6, 0.2, |d| {
        0.4 + 0.15 * (5.0 * d[0]).sin() * (4.0 * d[1]).cos()
    })
    .unwrap();
    vec![
        Shape::Cuboid {
            half: [0.3, 0.2, 0.4],
        },
        Shape::Ellipsoid {
            radii: [0.4, 0.2, 0.3],
        },
        Shape::Grid(Arc::new(grid)),
        heights(&Bottom::Flat(-0.2)),
        heights(&low),
        Shape::Star(Arc::new(star)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// However bodies come, go and move, what was composed bit by bit is what is composed at once.
    #[test]
    fn composed_anew_is_composed_from_scratch(
        frames in prop::collection::vec(
            prop::collection::vec((0u32..6, [-1.2f32..1.2, -1.2f32..1.2, -1.2f32..1.2], -3.0f32..3.0), 0..6),
            1..4,
        ),
        stay in 0usize..4,
    ) {
        let shapes = shapes();
        let lattice = Lattice { nodes: [33, 26, 17], ..LATTICE };
        let mut volume = SceneVolume::new(lattice, 0.3).unwrap();
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let mut bodies: Vec<Body> = Vec::new();
        for frame in frames {
            // some stay where they were
            bodies.truncate(stay);
            bodies.extend(frame.into_iter().map(|(kind, at, turn)| body(kind, at, turn, &shapes)));
            let touched = volume.compose(&bodies).unwrap();
            prop_assert!(touched <= volume.bricks());
            let mut scratch = SceneVolume::new(lattice, 0.3).unwrap();
            one.install(|| scratch.compose_anew(&bodies)).unwrap();
            let bits = |v: &SceneVolume| v.values().iter().map(|x| x.to_bits()).collect::<Vec<u32>>();
            prop_assert_eq!(bits(&volume), bits(&scratch));
            prop_assert_eq!(volume.nearest(), scratch.nearest());
            prop_assert_eq!(volume.compose(&bodies).unwrap(), 0, "nothing moved");
        }
    }
}

/// The least of all counts, and whose it is.
#[test]
fn the_nearest_body_counts() {
    let ball = |x: f32| {
        Body::new(
            Shape::Ellipsoid { radii: [0.2; 3] },
            Pose::at([x, 0.0, 0.0]),
            [1.0; 3],
        )
        .unwrap()
    };
    let mut volume = SceneVolume::new(LATTICE, 0.25).unwrap();
    volume.compose(&[ball(-0.5), ball(0.5)]).unwrap();
    let number = |i: usize| volume.nearest()[i + 33 * (16 + 33 * 16)];
    assert_eq!([number(5), number(27), number(16)], [0, 1, NOBODY]);
    assert_eq!(volume.at([16, 16, 16]), 0.25);
    volume.compose(&[ball(0.5)]).unwrap();
    assert_eq!(volume.at([5, 16, 16]), 0.25);
    // who is gone leaves nothing behind
    volume.compose(&[]).unwrap();
    assert!(volume.values().iter().all(|x| *x == 0.25));
}

#[test]
fn what_is_no_body_is_refused() {
    let cuboid = |half| Shape::Cuboid { half };
    let refused = |shape: Shape, pose: Pose| Body::new(shape, pose, [1.0; 3]).expect_err("refused");
    let place = Pose::at([0.0; 3]);
    for half in [[0.0, 1.0, 1.0], [1.0, f32::NAN, 1.0], [1.0, 1.0, 1e10]] {
        assert!(matches!(
            refused(cuboid(half), place),
            BodyError::Length { .. }
        ));
    }
    let pose = Pose::at([f32::INFINITY, 0.0, 0.0]);
    assert!(matches!(
        refused(cuboid([1.0; 3]), pose),
        BodyError::Place(_)
    ));
    let pose = Pose {
        axes: [[1.0, 0.0, 0.0]; 3],
        ..place
    };
    assert!(matches!(
        refused(cuboid([1.0; 3]), pose),
        BodyError::Axes(_)
    ));
    assert!(matches!(
        refused(cuboid([1.0; 3]), place.scaled(-1.0)),
        BodyError::Length { .. }
    ));
    let flat = Bottom::Flat(0.0);
    assert!(matches!(
        Heights::new([2, 2], [1.0; 2], &[0.0; 3], &flat, 0.1),
        Err(BodyError::Map { .. })
    ));
    assert!(matches!(
        Heights::new([2, 2], [1.0; 2], &[0.0, 1.0, f32::NAN, 0.0], &flat, 0.1),
        Err(BodyError::Sample { at: 2, .. })
    ));
    assert!(matches!(
        Star::new(1, 0.1, |_| 1.0),
        Err(BodyError::Map { .. })
    ));
    assert!(matches!(
        Star::new(4, 0.1, |_| -1.0),
        Err(BodyError::Length { .. })
    ));
    let none = Lattice {
        nodes: [1, 9, 9],
        ..LATTICE
    };
    assert!(matches!(
        SceneVolume::new(none, 1.0),
        Err(ComposeError::Nodes(_))
    ));
    assert!(SceneVolume::new(LATTICE, 0.0).is_err());
}
