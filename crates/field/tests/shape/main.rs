//! Shapes written in Rust: nothing of the catalogue is missing, and errors wait until the field is asked for.

mod generate;

use glam::{DQuat, DVec2, DVec3, vec3};
use std::path::Path;
use zeroset_catalogue::entries::catalogue;
use zeroset_field::field::{Field, FieldError, Node, Paint};
use zeroset_field::placement::Placement;
use zeroset_field::shape::*;

/// A new entry of the catalogue is a new function: written by `ZEROSET_BLESS=1 cargo test -p zeroset-field --test shape`.
#[test]
fn the_catalogue_is_there() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/shape/entries.rs");
    let wanted = generate::entries();
    if std::env::var_os("ZEROSET_BLESS").is_some() {
        std::fs::write(&path, &wanted).expect("a file");
    }
    let there = std::fs::read_to_string(&path).expect("a file");
    let first = wanted.lines().zip(there.lines()).find(|(a, b)| a != b);
    assert!(
        wanted == there,
        "src/shape/entries.rs is not what the catalogue says, first at {first:?}: write it with \
         `ZEROSET_BLESS=1 cargo test -p zeroset-field --test shape`"
    );
}

fn made(shape: impl Into<Shape>) -> Field {
    shape.into().field().expect("a field")
}

/// A field as text, of which equal ones are equal.
fn text(shape: impl Into<Shape>) -> String {
    fn write(field: &Field) -> String {
        let children: Vec<String> = field.children().into_iter().map(write).collect();
        let own = match field.node() {
            Node::Primitive { entry, params } => format!("{} {params:?}", entry.info.name),
            Node::Map { entry, params, .. } => format!("{} {params:?}", entry.info.name),
            Node::Modify { entry, params, .. } => format!("{} {params:?}", entry.info.name),
            Node::Join { entry, params, .. } => format!("{} {params:?}", entry.info.name),
            Node::Place { placement, .. } => format!("{placement:?}"),
            Node::Repeat { repetition, .. } => format!("{repetition:?}"),
            Node::Polar { polar, .. } => format!("{polar:?}"),
            Node::Formula(_) => "formula".into(),
            Node::Sampled(_) => "sampled".into(),
            Node::Sided(_) => "sided".into(),
            Node::Paint { paint, .. } => format!("{paint:?}"),
        };
        format!("{own}({})", children.join(", "))
    }
    write(&made(shape))
}

#[test]
fn parameters_are_in_their_places() {
    let all = catalogue();
    let primitive = |name: &str, params: &[f64]| {
        Field::primitive(all.primitive(name).expect("there"), params.to_vec()).expect("fits")
    };
    for (shape, field) in [
        (sphere(2), primitive("sphere", &[2.0])),
        (sphere(0.5f32), primitive("sphere", &[0.5])),
        (plane(), primitive("plane", &[])),
        (
            rounded_box([1.0, 2.0, 3.0], 0.1),
            primitive("rounded_box", &[1.0, 2.0, 3.0, 0.1]),
        ),
        (
            box3(vec3(1.0, 2.0, 3.0)),
            primitive("box", &[1.0, 2.0, 3.0]),
        ),
        (
            polyline_tube(0.1, [DVec3::ZERO, DVec3::ONE]),
            primitive("polyline_tube", &[0.1, 2.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0]),
        ),
        (
            polygon([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]),
            primitive("polygon", &[3.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]),
        ),
        (star(5, 1.0, 0.4), primitive("star", &[5.0, 1.0, 0.4])),
    ] {
        assert_eq!(text(&shape), text(field));
    }
    let corners = [DVec2::ZERO, DVec2::X, DVec2::Y];
    let sides = (0..3).map(|i| [corners[i], corners[(i + 1) % 3]]);
    let segments = primitive(
        "outline",
        &[
            3.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0,
        ],
    );
    assert_eq!(text(outline(sides)), text(segments));
    let extruded = circle(1.0).extrude(2.0);
    let by_hand = primitive("circle", &[1.0])
        .modify(all.modifier("extrude").expect("there"), vec![2.0])
        .expect("fits");
    assert_eq!(text(&extruded), text(by_hand));
    let twisted = primitive("box", &[1.0, 1.0, 1.0])
        .map(all.map("twist").expect("there"), vec![0.3])
        .expect("fits");
    assert_eq!(text(box3([1.0; 3]).twist(0.3)), text(twisted));
}

#[test]
fn operators_are_joins() {
    let (a, b) = (sphere(1.0), box3([1.0; 3]));
    assert_eq!(text(&a | &b), text(a.union(&b)));
    assert_eq!(text(&a & &b), text(a.intersection(&b)));
    assert_eq!(text(&a - &b), text(a.subtraction(&b)));
    assert_eq!(text(&a ^ &b), text(a.xor(&b)));
    assert_eq!(text(!&a), text(a.complement()));
    assert_eq!(text(a.clone() | b.clone()), text(union([a, b])));
}

/// A chain is one join, not a tree that is as deep as it is long; from the left, as it is written.
#[test]
fn chains_are_flat() {
    let ball = |i: u32| sphere(0.1).translate([f64::from(i), 0.0, 0.0]);
    let chain = (1..2000).fold(ball(0), |shape, i| shape | ball(i));
    assert_eq!(text(&chain), text(union((0..2000).map(ball))));
    assert_eq!(made(chain).facts().depth, 3);
    let (a, b, c) = (ball(0), ball(1), ball(2));
    assert_eq!(text(&a - &b - &c), text(subtraction([&a, &b, &c])));
    assert_eq!(made(&a - (&b - &c)).children().len(), 2);
    let blend = a.smooth_union(&b, 0.1).smooth_union(&c, 0.1);
    assert_eq!(text(blend), text(smooth_union([&a, &b, &c], 0.1)));
    let other = a.smooth_union(&b, 0.1).smooth_union(&c, 0.2);
    assert_eq!(made(other).children().len(), 2);
}

#[test]
fn placements_are_placements() {
    let ball = sphere(1.0);
    let field = made(&ball);
    let placed = |p: Placement| field.place(p).expect("a place");
    let moved = ball.translate(vec3(1.0, 2.0, 3.0));
    assert_eq!(text(moved), text(placed(Placement::moved([1.0, 2.0, 3.0]))));
    assert_eq!(text(ball.scale(2.0)), text(placed(Placement::scaled(2.0))));
    let turned = placed(Placement::turned([0.0, 1.0, 0.0], 0.5));
    assert_eq!(text(ball.rotate_y(0.5)), text(&turned));
    assert_eq!(
        text(ball.rotate_by(DQuat::from_rotation_y(0.5))),
        text(turned)
    );
    let copies = ball.repeat([3.0, 0.0, 3.0], [4, 0, 0]);
    assert_eq!(made(copies).facts().bounds.half()[0], 5.5);
    assert_eq!(made(ball.polar(3)).children().len(), 1);
    let painted = made(ball.paint(3) | ball.translate([5.0, 0.0, 0.0]));
    assert_eq!(painted.facts().materials, 4);
    let Node::Paint { paint, .. } = painted.children()[0].node() else {
        panic!("painted")
    };
    assert_eq!(*paint, Paint::Material(3));
}

#[test]
fn the_first_error_waits() {
    let wrong = sphere(-1.0);
    let error = wrong.field().expect_err("no radius");
    let FieldError::Range {
        entry,
        param,
        value,
        ..
    } = error
    else {
        panic!("{error}")
    };
    assert_eq!((entry, param, value), ("sphere", "radius", -1.0));
    let later = (wrong.onion(0.1).translate([1.0, 0.0, 0.0]) | box3([-1.0; 3])).scale(0.0);
    assert_eq!(later.field().err(), sphere(-1.0).field().err());
    // on the right as well
    assert_eq!(
        (sphere(1.0) - sphere(-1.0)).field().err(),
        sphere(-1.0).field().err()
    );
    for wrong in [
        sphere(f64::NAN),
        sphere(1.0).scale(0.0),
        sphere(1.0).translate([f64::INFINITY, 0.0, 0.0]),
        sphere(1.0).extrude(1.0),
        sphere(1.0) | circle(1.0),
        sphere(1.0).repeat([1.0; 3], [0; 3]),
        union(Vec::<Shape>::new()),
        polygon(Vec::<DVec2>::new()),
        star(2, 1.0, 0.4),
    ] {
        let error = wrong.field().expect_err("wrong");
        assert!(!error.to_string().is_empty());
    }
}
