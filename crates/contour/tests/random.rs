//! Meshes of random solids are closed and manifold, whatever their signs are.

use proptest::prelude::*;
use zeroset_contour::{Alone, Contour, ContourError};
use zeroset_field::program::{Limits, Program};
use zeroset_field::shape::{Shape, box3, cylinder, gyroid, smooth_union, sphere, torus};

fn leaf() -> impl Strategy<Value = Shape> {
    // sides on a lattice, so that faces and edges of parts lie on each other
    let size = (1..6_i32).prop_map(|n| f64::from(n) * 0.25);
    (0..4, size.clone(), size.clone(), size).prop_map(|(kind, a, b, c)| match kind {
        0 => sphere(0.7 * a),
        1 => box3([a, b, c]),
        2 => cylinder(0.5 * a, b),
        _ => torus(0.5 * a + 0.1, 0.15 * b),
    })
}

fn solid() -> impl Strategy<Value = Shape> {
    let place = prop::array::uniform3((-4..5_i32).prop_map(|n| f64::from(n) * 0.25));
    let axis = prop::array::uniform3(-1.0..1.0_f64);
    let turn = prop_oneof![Just(0.0), Just(std::f64::consts::FRAC_PI_4), 0.0..3.0_f64];
    let placed = |s: BoxedStrategy<Shape>| {
        (s, place.clone(), axis.clone(), turn.clone())
            .prop_map(|(s, p, a, t)| s.rotate(a, t).translate(p))
    };
    placed(leaf().boxed()).prop_recursive(4, 24, 2, move |inner| {
        (0..4, inner.clone(), inner).prop_map(|(kind, a, b)| match kind {
            0 => a | b,
            1 => a & b,
            2 => a - b,
            _ => smooth_union([a, b], 0.2),
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn random_solids_are_watertight(shape in solid(), resolution in 5..40_u32, simplify: bool) {
        let program = Program::compile(&shape.field().unwrap(), &Limits::default()).unwrap();
        let contour = Contour { resolution, finest: resolution, simplify, ..Contour::new(0.01) };
        match contour.of(&program, &program.bounds(), &Alone) {
            Ok(made) => {
                let topology = made.surface.topology();
                prop_assert!(topology.watertight, "{topology:?}");
                prop_assert!(topology.manifold, "{topology:?}");
                prop_assert!(made.surface.volume() > -1e-3);
            }
            // nothing may be left, or nothing that a cell sees
            Err(ContourError::Empty { .. }) => {}
            Err(error) => prop_assert!(false, "{error}"),
        }
    }
}

/// Signs of nodes that no solid of a catalogue has: a gyroid that is thinner than the cells leaves every case there is.
#[test]
fn noise_is_watertight() {
    for (resolution, scale) in [(24, 9.0), (31, 14.0), (40, 17.0)] {
        let shape = gyroid(1.0 / scale, 0.3 / scale) & box3([1.0; 3]);
        let program = Program::compile(&shape.field().unwrap(), &Limits::default()).unwrap();
        let contour = Contour {
            resolution,
            finest: resolution,
            simplify: false,
            ..Contour::new(0.01)
        };
        let made = contour.of(&program, &program.bounds(), &Alone).unwrap();
        let topology = made.surface.topology();
        assert!(topology.watertight && topology.manifold, "{topology:?}");
    }
}
