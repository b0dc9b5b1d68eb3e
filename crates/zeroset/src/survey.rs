//! What a few looks at a field tell of a scene: whether the camera stands in a solid, how loose a bound is, what single
//! precision still tells apart.

use zeroset_catalogue::bounds::Aabb;
use zeroset_eval::Point;
use zeroset_field::field::Field;
use zeroset_field::program::{Limits, Program};
use zeroset_number::{Dual, F64, Vec3, v3};
use zeroset_scene::camera::Camera;
use zeroset_scene::scene::Scene;

/// Rays that are sent through a solid to find its surface.
const RAYS: u32 = 200;
/// Steps of each.
const STEPS: u32 = 96;

fn at(p: [f64; 3]) -> Vec3<F64> {
    v3(F64(p[0]), F64(p[1]), F64(p[2]))
}

/// The name of the object that the camera stands in, if it stands in one.
pub(crate) fn around_camera(scene: &Scene) -> Option<&str> {
    let Camera { eye, near, .. } = *scene.camera();
    let from = (eye - scene.camera().axes.z_axis * near)
        .as_dvec3()
        .to_array();
    let inside = |field: &Field| {
        let program = Program::compile(field, &Limits::default()).ok()?;
        Some(Point::<F64>::new(program.values()).value(at(from)).0 < 0.0)
    };
    let holds = |b: &Aabb| b.contains(from);
    (scene.objects().iter())
        .find(|o| holds(&o.field.facts().bounds) && inside(&o.field) == Some(true))
        .map(|o| o.name.as_str())
}

/// What is said of a camera that stands in an object of this name.
pub(crate) fn inside_words(name: &str) -> String {
    format!(
        "the camera stands inside `{name}`: the picture shows it from within, lit as if there were no solid. Move `eye` out of it, or \
         cut it open."
    )
}

/// How many times less than the distance the marched value of a field is near its surface: the median over places that rays
/// through its box find. `None` where they find none.
pub(crate) fn looseness(field: &Field) -> Option<f64> {
    let bounds = field.facts().bounds;
    let program = Program::compile(field, &Limits::default()).ok()?;
    if program.is_close() || program.is_fractal() || !bounds.is_finite() {
        return None;
    }
    let (mut values, mut gradients) = (
        Point::<F64>::new(program.values()),
        Point::<Dual<F64>>::new(program.values()),
    );
    let mut slopes = Vec::new();
    for ray in 0..RAYS {
        // two points of the box from a sequence without gaps (Roberts 2018)
        let [a, b] = [0, 3].map(|first| {
            std::array::from_fn::<f64, 3, _>(|k| {
                let share = (0.5 + f64::from(ray + 1) * SEQUENCE[first + k]).fract();
                bounds.min[k] + share * (bounds.max[k] - bounds.min[k])
            })
        });
        let place = |i: f64| {
            let share = i / f64::from(STEPS);
            std::array::from_fn::<f64, 3, _>(|k| a[k] + share * (b[k] - a[k]))
        };
        let mut before = values.value(at(a)).0;
        for i in 1..=STEPS {
            let f = values.value(at(place(f64::from(i)))).0;
            if (f < 0.0) != (before < 0.0) {
                let share = before.abs() / (before.abs() + f.abs()).max(f64::MIN_POSITIVE);
                let p = place(f64::from(i - 1) + share);
                let d = gradients.value(Dual::point(at(p))).d;
                slopes.push(d.iter().map(|x| x.0 * x.0).sum::<f64>().sqrt());
            }
            before = f;
        }
    }
    slopes.retain(|s| s.is_finite() && *s > 0.0);
    slopes.sort_by(f64::total_cmp);
    let median = *slopes.get(slopes.len() / 2)?;
    Some(1.0 / median)
}

/// Powers of the inverse of the root of x^7 = x + 1.
const SEQUENCE: [f64; 6] = [
    0.898_654_7,
    0.807_580_3,
    0.725_735_8,
    0.652_185_9,
    0.586_090_0,
    0.526_692_3,
];

/// The smallest step that single precision tells apart where the camera looks, and the width of a pixel there, where the
/// first is the larger part of the second.
pub(crate) fn coarse(scene: &Scene) -> Option<(f64, f64)> {
    let bounds = scene.finite_bounds()?;
    let largest = (bounds.min.iter().chain(&bounds.max)).fold(
        scene.camera().eye.abs().max_element().into(),
        |m: f64, x| m.max(x.abs()),
    );
    let centre = glam::DVec3::from(bounds.centre());
    let distance = (scene.camera().eye.as_dvec3() - centre).length();
    let (slope, constant) = scene.camera().pixel_width(scene.settings().size[1]);
    let pixel = f64::from(slope) * distance + f64::from(constant);
    let grain = largest * f64::from(f32::EPSILON);
    (grain > 0.25 * pixel).then_some((grain, pixel))
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_language::load::{Language, Options, load_text};

    fn scene(text: &str) -> Scene {
        load_text(
            "t.star",
            text,
            Language::Starlark,
            None,
            &Options::default(),
        )
        .expect("a scene")
        .scene
    }

    #[test]
    fn a_camera_in_a_solid_is_noticed() {
        let within =
            "show(sphere(2), name = \"shell\")\ncamera(eye = (0, 0, 1), target = (0, 0, 0))";
        assert_eq!(around_camera(&scene(within)), Some("shell"));
        let without = "show(sphere(2))\ncamera(eye = (0, 0, 5), target = (0, 0, 0))";
        assert_eq!(around_camera(&scene(without)), None);
        // a hole that the camera stands in is not the solid
        let hollow = "show(sphere(2) - sphere(1.5))\ncamera(eye = (0, 0, 1), target = (0, 0, 0))";
        assert_eq!(around_camera(&scene(hollow)), None);
    }

    #[test]
    fn a_loose_bound_is_measured() {
        let stated = scene("show(field(lambda p: length(p) - 1, size = 4, slope = 30))");
        let loose = looseness(&stated.objects()[0].field).expect("a surface");
        assert!((loose - 30.0).abs() < 0.1, "{loose}");
        let exact = scene("show(sphere(1))");
        assert_eq!(looseness(&exact.objects()[0].field), None);
    }

    #[test]
    fn far_from_the_origin_is_noticed() {
        assert_eq!(coarse(&scene("show(sphere(1))")), None);
        let far = scene("show(sphere(1).move(x = 100000))");
        let (grain, pixel) = coarse(&far).expect("coarse");
        assert!(grain > 0.01 && pixel < 0.02, "{grain} {pixel}");
    }
}
