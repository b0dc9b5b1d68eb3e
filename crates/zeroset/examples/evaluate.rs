//! A field at points: the volume of a solid, and the way back to its surface.
//!
//! `cargo run --release --example evaluate`

use std::error::Error;
use zeroset::eval::Evaluator;
use zeroset::field::program::{Limits, Program};
use zeroset::glam::{Vec3, vec3};
use zeroset::shape::{box3, sphere};

fn main() -> Result<(), Box<dyn Error>> {
    let shape = sphere(1.0) & box3([2.0, 2.0, 1.0]);
    let program = Program::compile(&shape.field()?, &Limits::default())?;
    let mut evaluator = Evaluator::new(program.values());

    // how many points of a grid are inside
    let side = 100;
    let at = |i: u32| 2.0 * (i as f32 + 0.5) / side as f32 - 1.0;
    let points: Vec<Vec3> = (0..side * side * side)
        .map(|i| vec3(at(i % side), at(i / side % side), at(i / side / side)))
        .collect();
    let mut values = vec![0.0; points.len()];
    evaluator.values(&points, &mut values)?;
    let inside = values.iter().filter(|v| **v < 0.0).count();
    let volume = 8.0 * inside as f64 / points.len() as f64;
    println!(
        "volume {volume:.3}, where mathematics says {:.3}",
        11.0 / 12.0 * std::f64::consts::PI
    );

    // along the gradient to the surface, as far as the value says
    let mut p = vec3(0.4, 1.5, 0.2);
    for _ in 0..3 {
        let (value, gradient) = evaluator.gradient(p);
        p -= value * gradient;
    }
    println!(
        "nearest surface at {p:.3}, where the value is {:.1e}",
        evaluator.value(p)
    );
    Ok(())
}
