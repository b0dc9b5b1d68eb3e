//! Meshes of solids whose volumes, edges and genus are known.

use std::f64::consts::PI;
use zeroset_catalogue::bounds::Aabb;
use zeroset_contour::{Alone, Contour, ContourError, Contoured, Limits};
use zeroset_eval::Point;
use zeroset_field::program::{Limits as ProgramLimits, Program};
use zeroset_field::shape::{Shape, box3, cylinder, plane, sphere, torus};
use zeroset_number::{F64, v3};

fn program(shape: &Shape) -> Program {
    Program::compile(&shape.field().unwrap(), &ProgramLimits::default()).unwrap()
}

#[track_caller]
fn made(shape: &Shape, contour: &Contour) -> Contoured {
    let program = program(shape);
    let made = contour.of(&program, &program.bounds(), &Alone).unwrap();
    let topology = made.surface.topology();
    assert!(topology.watertight && topology.manifold, "{topology:?}");
    made
}

fn plain(resolution: u32) -> Contour {
    Contour {
        resolution,
        finest: resolution,
        simplify: false,
        ..Contour::new(1e-3)
    }
}

/// How far the vertices are from the surface, by the field in double precision, which is a distance here.
fn off(shape: &Shape, made: &Contoured) -> f64 {
    let program = program(shape);
    let mut point = Point::<F64>::new(program.values());
    (made.surface.points.iter())
        .map(|p| {
            point
                .value(v3(F64(p[0].into()), F64(p[1].into()), F64(p[2].into())))
                .0
                .abs()
        })
        .fold(0.0, f64::max)
}

#[test]
fn volumes_are_those_of_closed_forms_and_faces_look_outwards() {
    let cases = [
        (sphere(1.0), 4.0 / 3.0 * PI, 2),
        (torus(1.0, 0.4), 2.0 * PI * PI * 0.16, 0),
        (box3([2.0, 1.0, 0.5]), 1.0, 2),
        (cylinder(0.5, 2.0), 0.25 * PI * 2.0, 2),
        (sphere(1.0) - sphere(0.5), 4.0 / 3.0 * PI * (1.0 - 0.125), 4),
    ];
    for (shape, volume, euler) in cases {
        for contour in [plain(48), Contour::new(2e-3)] {
            let made = made(&shape, &contour);
            let found = made.surface.volume();
            // positive: faces look outwards
            assert!((found / volume - 1.0).abs() < 5e-3, "{found}, not {volume}");
            assert_eq!(made.surface.topology().euler, euler);
            assert!(off(&shape, &made) < 2e-5, "{}", off(&shape, &made));
            if contour.simplify {
                assert!(made.deviation <= contour.tolerance, "{}", made.deviation);
                assert!(made.surface.faces.len() < made.faces_before);
            }
        }
    }
}

#[test]
fn corners_and_edges_are_kept() {
    let half = [1.0, 0.5, 0.25];
    for angle in [0.0, 0.7, 2.0] {
        let shape = box3(half.map(|h| 2.0 * h)).rotate([0.3, 0.5, -0.2], angle);
        // the corners as the placement turns them
        let upright = self::made(&box3(half.map(|h| 2.0 * h)), &Contour::new(1e-3));
        let corners = Contour::new(1e-3);
        let turned = self::made(&shape, &corners);
        assert_eq!(upright.surface.points.len(), 8);
        for p in &upright.surface.points {
            for k in 0..3 {
                assert!((f64::from(p[k]).abs() - half[k]).abs() < 1e-4, "{p:?}");
            }
        }
        let mut distances: Vec<f64> = (turned.surface.points.iter())
            .map(|p| p.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().sqrt())
            .collect();
        distances.sort_by(|a, b| b.total_cmp(a));
        let corner = half.iter().map(|h| h * h).sum::<f64>().sqrt();
        // the eight that are farthest out; where the grid lies badly an edge keeps a few vertices more
        assert!(distances.len() < 24, "{}", distances.len());
        // a corner of which the cell sees two planes is off by no more than the tolerance allows; most are exact
        let near = |most: f64| {
            distances[..8]
                .iter()
                .filter(|d| (**d - corner).abs() < most)
                .count()
        };
        assert!(near(1e-4) >= 7 && near(1e-3) == 8, "{distances:?}");
        // what that one corner may cost
        let volume = turned.surface.volume();
        assert!((volume - 1.0).abs() < 2e-4, "{volume}");
    }
}

#[test]
fn round_edges_are_kept_too() {
    // the rim of a cylinder: no vertex is anywhere but on the rim or on one of the faces, and many are on the rim
    let shape = cylinder(0.7, 1.0).rotate([0.5, 0.1, 0.3], 0.6);
    let made = made(&shape, &Contour::new(1e-3));
    assert_eq!(made.resolution, 64);
    assert!(off(&shape, &made) < 2e-5, "{}", off(&shape, &made));
    assert!((made.surface.volume() / (0.49 * PI) - 1.0).abs() < 2e-3);
    assert!(made.deviation <= 1e-3, "{}", made.deviation);
}

#[test]
fn a_finer_grid_is_taken_where_it_is_needed() {
    // at first the small ball is between the nodes
    let small = sphere(1.0) | sphere(0.02).translate([1.5, 0.013, 0.0]);
    let contour = Contour {
        resolution: 64,
        ..Contour::new(1e-4)
    };
    let made = made(&small, &contour);
    assert!(made.resolution > 64, "{}", made.resolution);
    assert!(made.surface.topology().parts <= 2);
}

#[test]
fn what_cannot_be_is_refused() {
    let of = |shape: &Shape, contour: &Contour| {
        let program = program(shape);
        contour.of(&program, &program.bounds(), &Alone)
    };
    let ball = sphere(1.0);
    assert_eq!(
        of(&plane(), &Contour::new(0.01)),
        Err(ContourError::Endless)
    );
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = of(&ball, &Contour::new(tolerance)).unwrap_err();
        assert!(matches!(error, ContourError::Setting { .. }), "{error}");
    }
    let few = Contour {
        resolution: 1,
        ..Contour::new(0.01)
    };
    assert!(
        of(&ball, &few)
            .unwrap_err()
            .to_string()
            .contains("from 4 to 8192")
    );
    // the finest grid is refused before it is made
    let limits = Limits {
        cells: 1 << 16,
        ..Limits::default()
    };
    let dear = Contour {
        resolution: 8192,
        limits,
        ..Contour::new(0.01)
    };
    assert!(matches!(of(&ball, &dear), Err(ContourError::Cells { .. })));
    let limits = Limits {
        faces: 1000,
        ..Limits::default()
    };
    let many = Contour {
        limits,
        ..plain(64)
    };
    assert!(matches!(of(&ball, &many), Err(ContourError::Faces { .. })));
    // far away single precision has no room for cells
    let far = sphere(0.001).translate([1e5, 0.0, 0.0]);
    assert!(matches!(
        of(&far, &Contour::new(1e-6)),
        Err(ContourError::Fine { .. })
    ));
    // what is cut away wholly
    let nothing = sphere(0.5) & sphere(0.5).translate([3.0, 0.0, 0.0]);
    let program = program(&nothing);
    let error = Contour::new(0.01).of(&program, &Aabb::centred([2.0; 3]), &Alone);
    assert_eq!(error, Err(ContourError::Empty { inside: false }));
    // a box that is too small for the solid
    let program = self::program(&ball);
    let error = Contour::new(0.01).of(&program, &Aabb::centred([0.5; 3]), &Alone);
    assert!(error.is_err(), "{error:?}");
}

#[test]
fn the_same_mesh_comes_every_time() {
    let shape = (sphere(1.0) - box3([1.0, 1.0, 3.0])) | torus(1.0, 0.2);
    let contour = Contour::new(4e-3);
    assert_eq!(made(&shape, &contour), made(&shape, &contour));
}
