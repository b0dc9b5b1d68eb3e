//! The oracle of the marchers: rays in double precision, with steps so short that nothing can be passed.

use zeroset_eval::Point;
use zeroset_field::program::Program;
use zeroset_number::{F64, v3};

/// Marches a ray from `start` to `end` in double precision, by half of the field's value but not less than `least(t)`, to the
/// first change of sign, and finds the place by bisection. Values that are up to twice too large would not matter.
pub fn march(
    program: &Program,
    o: [f64; 3],
    d: [f64; 3],
    start: f64,
    end: f64,
    least: impl Fn(f64) -> f64,
) -> Option<f64> {
    let mut point = Point::<F64>::new(program.values());
    let mut f = |t: f64| {
        let p: [F64; 3] = std::array::from_fn(|k| F64(o[k] + d[k] * t));
        point.value(v3(p[0], p[1], p[2])).0
    };
    let inside = f(start) < 0.0;
    let side = if inside { -1.0 } else { 1.0 };
    let (mut t, mut value) = (start, side * f(start));
    while t < end {
        let z = (0.5 * value).max(least(t));
        let next = side * f(t + z);
        if next <= 0.0 {
            let (mut near, mut far) = (t, t + z);
            for _ in 0..60 {
                let middle = 0.5 * (near + far);
                if side * f(middle) <= 0.0 {
                    far = middle;
                } else {
                    near = middle;
                }
            }
            return (far <= end).then_some(far);
        }
        (t, value) = (t + z, next);
    }
    None
}
