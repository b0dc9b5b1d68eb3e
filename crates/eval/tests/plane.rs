//! Plane shapes: every map, modifier, join, placement and repetition keeps them in their plane, or says why it cannot.
//!
//! What is right is found by another way: a plane shape pulled very far along z is a prism, and at z = 0 the prism of what an
//! operation gives must be what the operation gives of the prism.

use zeroset_catalogue::Dimension;
use zeroset_catalogue::entries::{Catalogue, catalogue};
use zeroset_eval::Point;
use zeroset_field::field::{Field, FieldError};
use zeroset_field::placement::Placement;
use zeroset_field::program::{Limits, Program};
use zeroset_field::repetition::{Polar, Repetition};
use zeroset_number::{F64, v3};

fn shape(name: &str, params: &[f64]) -> Field {
    Field::primitive(catalogue().primitive(name).unwrap(), params.to_vec()).unwrap()
}

/// A solid so long that its ends are of no matter near z = 0.
fn prism(plane: &Field) -> Field {
    let extrude = catalogue().modifier("extrude").unwrap();
    plane.modify(extrude, vec![1000.0]).unwrap()
}

fn value(solid: &Field, [x, y]: [f64; 2]) -> f64 {
    let program = Program::compile(solid, &Limits::default()).unwrap();
    Point::<F64>::new(program.values())
        .value(v3(F64(x), F64(y), F64(0.0)))
        .0
}

/// Plane shapes without any symmetry about the origin.
fn shapes() -> Vec<Field> {
    let circle = shape("circle", &[0.4]);
    let place = |x, y, angle: f64| {
        Placement::moved([x, y, 0.0]).after(&Placement::turned([0.0, 0.0, 1.0], angle))
    };
    let rectangle = shape("rectangle", &[0.9, 0.4]);
    vec![
        circle.place(place(0.7, 0.3, 0.0)).unwrap(),
        rectangle.place(place(0.9, -0.2, 0.5)).unwrap(),
        rectangle.place(place(0.05, 0.1, 0.2)).unwrap(),
    ]
}

/// A grid of places around the origin that meets no edge exactly.
fn places() -> impl Iterator<Item = [f64; 2]> {
    (0..31 * 31).map(|i| [i % 31, i / 31].map(|k| (f64::from(k) - 15.0) * 0.1371 + 0.0123))
}

#[track_caller]
fn alike(what: &str, a: &Field, b: &Field) {
    for p in places() {
        let (x, y) = (value(a, p), value(b, p));
        assert!(
            (x - y).abs() < 1e-4 * (1.0 + y.abs()),
            "{what} at {p:?}: {x}, not {y}"
        );
    }
}

#[test]
fn maps() {
    for entry in &catalogue().maps {
        let name = entry.info.name;
        let sets = entry.samples.iter().map(|s| s.to_vec());
        for params in sets.chain([entry.info.defaults()]) {
            for plane in shapes() {
                let mapped = plane.map(entry, params.clone());
                match entry.info.dimension {
                    Dimension::Three => {
                        let refused = matches!(mapped, Err(FieldError::Dimension { .. }));
                        assert!(refused, "{name} takes a plane shape");
                    }
                    Dimension::Two => {
                        let facts = *mapped.unwrap().facts();
                        assert_eq!(facts.dimension, Dimension::Three, "{name}");
                    }
                    Dimension::Any => match mapped {
                        Ok(mapped) => {
                            assert_eq!(mapped.facts().dimension, Dimension::Two, "{name}");
                            let solid = prism(&plane).map(entry, params.clone());
                            // a map may refuse what is so long, or know less of how steep it gets
                            if let Ok(solid) = solid
                                && solid.facts().slope == mapped.facts().slope
                            {
                                alike(&format!("{name}({params:?})"), &prism(&mapped), &solid);
                            }
                        }
                        Err(error) => {
                            let text = error.to_string();
                            let along_z = text.contains("plane shape");
                            assert!(along_z, "{name}({params:?}): {text}");
                        }
                    },
                }
            }
        }
    }
    // what would leave the plane
    let plane = &shapes()[0];
    for (name, params) in [("elongate", vec![0.5, 0.0, 0.3]), ("shear", vec![0.5, 0.2])] {
        let error = plane
            .map(catalogue().map(name).unwrap(), params)
            .unwrap_err();
        assert!(error.to_string().contains("extrude"), "{name}: {error}");
    }
}

#[test]
fn modifiers() {
    for entry in &catalogue().modifiers {
        let name = entry.info.name;
        for params in (entry.samples.iter().map(|s| s.to_vec())).chain([entry.info.defaults()]) {
            for plane in shapes() {
                let changed = plane.modify(entry, params.clone());
                match entry.info.dimension {
                    Dimension::Three => {
                        let refused = matches!(changed, Err(FieldError::Dimension { .. }));
                        assert!(refused, "{name} takes a plane shape");
                    }
                    Dimension::Two => {
                        let facts = *changed.unwrap().facts();
                        assert_eq!(facts.dimension, Dimension::Three, "{name}");
                    }
                    Dimension::Any => {
                        let changed = changed.unwrap();
                        assert_eq!(changed.facts().dimension, Dimension::Two, "{name}");
                        let solid = prism(&plane).modify(entry, params.clone()).unwrap();
                        alike(&format!("{name}({params:?})"), &prism(&changed), &solid);
                    }
                }
            }
        }
    }
}

#[test]
fn joins() {
    let all = shapes();
    let (a, b) = (&all[0], &all[1]);
    for entry in &catalogue().joins {
        let name = entry.info.name;
        for params in (entry.samples.iter().map(|s| s.to_vec())).chain([entry.info.defaults()]) {
            let both = |a: Field, b: Field| Field::join(entry, params.clone(), vec![a, b]);
            let joined = both(a.clone(), b.clone()).unwrap();
            assert_eq!(joined.facts().dimension, Dimension::Two, "{name}");
            let solid = both(prism(a), prism(b)).unwrap();
            alike(&format!("{name}({params:?})"), &prism(&joined), &solid);
            let mixed = both(a.clone(), prism(b));
            assert!(matches!(mixed, Err(FieldError::Dimension { .. })), "{name}");
        }
    }
}

#[test]
fn placements() {
    let axis = |x, y, z, degrees: f64| Placement::turned([x, y, z], degrees.to_radians());
    for plane in shapes() {
        for stays in [
            Placement::moved([0.3, -0.4, 0.0]),
            Placement::scaled(1.7),
            axis(0.0, 0.0, 1.0, 40.0),
            axis(0.0, 0.0, -2.0, 400.0),
            // on their back
            axis(1.0, 0.0, 0.0, 180.0),
            axis(0.0, 3.0, 0.0, -180.0),
            axis(1.0, 2.0, 0.0, 180.0),
            axis(1.0, 0.0, 0.0, 360.0).after(&Placement::moved([0.2, 0.1, 0.0])),
            Placement::euler([180.0_f64.to_radians(), 0.0, 0.7]),
        ] {
            let placed = plane.place(stays).unwrap();
            assert_eq!(placed.facts().dimension, Dimension::Two);
            // where a point comes from, by the inverse in f64
            let solid = prism(&plane);
            for p in places() {
                let [x, y, z] = stays.invert([p[0], p[1], 0.0]);
                assert!(z.abs() < 1e-9);
                let (got, wanted) = (
                    value(&prism(&placed), p),
                    stays.scale * value(&solid, [x, y]),
                );
                assert!(
                    (got - wanted).abs() < 1e-4,
                    "{stays:?} at {p:?}: {got}, not {wanted}"
                );
            }
        }
        for leaves in [
            Placement::moved([0.0, 0.0, 0.1]),
            Placement::moved([1.0, 1.0, -1e-3]),
            axis(1.0, 0.0, 0.0, 90.0),
            axis(1.0, 0.0, 0.0, 1.0),
            axis(0.0, 1.0, 0.0, 30.0),
            axis(1.0, 1.0, 1.0, 120.0),
        ] {
            let error = plane.place(leaves).unwrap_err().to_string();
            assert!(
                error.contains("plane") && error.contains("extrude"),
                "{error}"
            );
        }
    }
}

/// The union of plane copies, each placed by itself.
fn copies(plane: &Field, placements: impl Iterator<Item = Placement>) -> Field {
    let all = placements.map(|p| plane.place(p).unwrap()).collect();
    Field::join(Catalogue::union(), Vec::new(), all).unwrap()
}

/// A field that may be less than the distance to its copies, but shows the same.
#[track_caller]
fn stands_for(what: &str, field: &Field, copies: &Field) {
    for p in places() {
        let (got, wanted) = (value(&prism(field), p), value(&prism(copies), p));
        assert!(
            got <= wanted + 1e-4,
            "{what} at {p:?}: {got} above {wanted}"
        );
        // inside the same, and outside only where the copies are outside: there the wall before the next copies may be nearer
        let fine = if wanted <= 0.0 {
            (got - wanted).abs() < 1e-4
        } else {
            got > 0.0
        };
        assert!(fine, "{what} at {p:?}: {got}, not {wanted}");
    }
}

#[test]
fn copies_around_the_origin() {
    for plane in shapes() {
        for count in [1, 2, 3, 5, 8] {
            let polar = plane.polar(Polar { count }).unwrap();
            assert_eq!(polar.facts().dimension, Dimension::Two);
            let turned = (0..count).map(|k| {
                let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
                Placement::turned([0.0, 0.0, 1.0], angle)
            });
            stands_for(&format!("polar({count})"), &polar, &copies(&plane, turned));
        }
    }
    // by mathematics: 12 circles of radius 0.2 at a distance of 1.5
    let circle = shape("circle", &[0.2]);
    let circle = circle.place(Placement::moved([1.5, 0.0, 0.0])).unwrap();
    let ring = circle.polar(Polar { count: 12 }).unwrap();
    let b = ring.facts().bounds;
    assert!(
        b.min[2] == f64::NEG_INFINITY && b.max[2] == f64::INFINITY,
        "{b:?}"
    );
    assert!(
        b.min[0] <= -1.7 && b.max[1] >= 1.7 && b.max[0] < 2.0,
        "{b:?}"
    );
    let solid = prism(&ring);
    for [x, y] in places() {
        let nearest = (0..12)
            .map(|k| {
                let (s, c) = (std::f64::consts::TAU * f64::from(k) / 12.0).sin_cos();
                (x - 1.5 * c).hypot(y - 1.5 * s) - 0.2
            })
            .fold(f64::INFINITY, f64::min);
        let got = value(&solid, [x, y]);
        assert!(got <= nearest + 1e-4 && (got > 0.0) == (nearest > 0.0));
    }
    // a solid goes around y as before
    let ball = shape("sphere", &[0.2]);
    let ball = ball.place(Placement::moved([1.5, 0.0, 0.0])).unwrap();
    let ring = ball.polar(Polar { count: 4 }).unwrap();
    assert!(value(&ring, [0.0, 1.5]) > 0.5 && value(&ring, [-1.5, 0.0]) < -0.19);
}

#[test]
fn copies_on_a_grid() {
    let repetition = Repetition {
        spacing: [1.4, 1.3, 0.0],
        count: [3, 2, 0],
        vary: [0.0; 3],
        seed: 0,
    };
    let plane = shape("circle", &[0.4]);
    let grid = plane.repeat(repetition).unwrap();
    assert_eq!(grid.facts().dimension, Dimension::Two);
    let offsets = (0..6).map(|i| {
        let (k, l) = (f64::from(i % 3), f64::from(i / 3));
        Placement::moved([1.4 * (k - 1.0), 1.3 * (l - 0.5), 0.0])
    });
    stands_for("repeat", &grid, &copies(&plane, offsets));
    for (spacing, vary) in [([1.0; 3], [0.0; 3]), ([1.0, 1.0, 0.0], [0.0, 0.0, 0.1])] {
        let error = plane.repeat(Repetition {
            spacing,
            vary,
            ..repetition
        });
        assert!(error.unwrap_err().to_string().contains("plane"));
    }
}
