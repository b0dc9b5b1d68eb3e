//! Skins: places without thickness at which a field is zero and not negative on either side, as between two faces that
//! coincide. `cylinder(1, 2) - cylinder(0.5, 2)` has one at either end of its hole.
//!
//! A ray that looks for a change of sign passes them. But what reads distances takes them for surfaces: a soft shadow and the
//! cones of occlusion see a lid. Where there are skins, such rays go on to where they touch something, and what does not
//! become negative behind it was none.

use crate::view::ROUNDING;
use zeroset_catalogue::bounds::Aabb;
use zeroset_eval::Point;
use zeroset_field::program::Program;
use zeroset_number::{Dual, F64, Real, v3};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Occlusion, Shadow};

/// Instructions that one step of the search may take, at all places together: a scene may come from a stranger.
const WORK: usize = 400_000;
/// Places that it looks at, at most.
const MOST: usize = 2048;
/// Steps to the surface.
const STEPS: usize = 8;
/// What is thinner than this share of its object's box counts as a skin.
const THIN: f64 = 1e-5;

/// Whether there are skins, and methods that would see them. What is less than a hundredth of an object's surface may be
/// overlooked, and more than that in a scene of thousands of instructions: the search is as short as it is there.
pub fn has_skins(scene: &Scene, program: &Program) -> bool {
    if !program.is_close() || program.is_fractal() || !reads_distances(scene) {
        return false;
    }
    let boxes: Vec<Aabb> = (scene.objects().iter())
        .map(|object| object.field.facts().bounds)
        .filter(Aabb::is_finite)
        .collect();
    if boxes.is_empty() {
        return false;
    }
    let instructions = program.structure().values.instructions.len();
    let count = (WORK / instructions.max(1)).min(MOST);
    let mut field = Point::<Dual<F64>>::new(program.values());
    (0..count).any(|i| {
        let (object, number) = (&boxes[i % boxes.len()], i / boxes.len());
        ends_at_skin(&mut field, object, number)
    })
}

fn reads_distances(scene: &Scene) -> bool {
    let cones = |o: &Occlusion| match o {
        Occlusion::Cones { .. } => true,
        Occlusion::None
        | Occlusion::Quilez { .. }
        | Occlusion::Bent { .. }
        | Occlusion::Evans { .. }
        | Occlusion::Skylight { .. }
        | Occlusion::Curvature { .. }
        | Occlusion::Upward { .. }
        | Occlusion::Hemisphere { .. }
        | Occlusion::Obscurance { .. } => false,
    };
    let soft = |s: &Shadow| match s {
        Shadow::Soft { .. } | Shadow::SoftClosest { .. } => true,
        Shadow::None | Shadow::Hard | Shadow::Advected { .. } => false,
    };
    cones(&scene.settings().occlusion)
        || (scene.objects().iter()).any(|o| o.occlusion.as_ref().is_some_and(cones))
        || scene.lights().iter().any(|light| soft(&light.shadow))
}

/// Whether the way down the field from place `number` in the box ends where the field rises on both sides.
fn ends_at_skin(field: &mut Point<'_, Dual<F64>>, within: &Aabb, number: usize) -> bool {
    // an even spread: multiples of the inverse powers of the root of x^4 = x + 1 (Roberts 2018)
    const SPREAD: [f64; 3] = [
        0.819_172_513_396_164_5,
        0.671_043_606_703_789_3,
        0.549_700_477_901_970_3,
    ];
    let (centre, half) = (within.centre(), within.half());
    let size = half.iter().fold(0.0, |a: f64, b| a.max(*b));
    let mut at: [f64; 3] = std::array::from_fn(|k| {
        let share = (0.5 + SPREAD[k] * (number + 1) as f64).fract();
        centre[k] + half[k] * (2.2 * share - 1.1)
    });
    let mut sample = |p: [f64; 3]| {
        let value = field.value(Dual::point(v3(F64(p[0]), F64(p[1]), F64(p[2]))));
        (value.v.0, value.d.map(|d| d.0))
    };
    for _ in 0..STEPS {
        let (value, slope) = sample(at);
        let square = slope.iter().map(|d| d * d).sum::<f64>();
        if !(value.is_finite() && square > 1e-12 && square.is_finite()) {
            return false;
        }
        if value.abs() < 1e-3 * THIN * size {
            let uphill = slope.map(|d| d / square.sqrt());
            let mut rises = |by: f64| {
                let beside = std::array::from_fn(|k| at[k] + by * uphill[k]);
                sample(beside).0 > 0.5 * by.abs()
            };
            return rises(THIN * size) && rises(-THIN * size);
        }
        at = std::array::from_fn(|k| at[k] - value * slope[k] / square);
    }
    false
}

/// A value below this touches something: `offset` is how far a ray began from its surface, `size` the sum of the coordinates
/// there.
#[inline(always)]
pub fn touch<R: Real>(offset: R, size: R) -> R {
    (offset * (1.0 / 1024.0)).max(size * (4.0 * ROUNDING))
}

/// Below this share of [`touch`] it is behind the surface of a solid.
pub const BEHIND: f32 = -0.25;
/// Steps that a cone may take beyond its own to find out what it touched.
pub const MORE: u32 = 64;

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_language::load::{Language, Options, load_text};

    fn skins(text: &str) -> bool {
        let options = Options::default();
        let scene = load_text("test.star", text, Language::Starlark, None, &options)
            .unwrap_or_else(|e| panic!("{}", e.report))
            .scene;
        let field = scene.field().unwrap().unwrap();
        let program = Program::compile(&field, &Default::default()).unwrap();
        has_skins(&scene, &program)
    }

    #[test]
    fn coincident_faces_are_found_and_nothing_else_is() {
        for text in [
            "show(cylinder(1, 2) - cylinder(0.5, 2))",
            "show((cylinder(1, 2) - cylinder(0.5, 2)).turn(x = 31, z = 12).move((3, 2, 1)))\nshow(plane())",
            "show((box(1) ^ box(1)) | sphere(0.3))",
            "show(box((3, 2, 0.2)) - box((0.8, 0.8, 0.2)))\nshow(plane().move(y = -1))",
            "show((box(2) - box((1, 1, 2))).scale(1e-4))",
        ] {
            assert!(skins(text), "{text}");
        }
        for text in [
            "show(cylinder(1, 2) - cylinder(0.5, 2.1))",
            "show(box(2) - sphere(1.25))\nshow(plane())",
            "show(sphere(1).onion(0.001))",
            "show(box(1) | box(1).move(x = 1))",
            "show(torus(1, 0.01))",
            "show(plane())",
        ] {
            assert!(!skins(text), "{text}");
        }
    }

    #[test]
    fn nobody_looks_where_no_distance_is_read() {
        let tube = "show(cylinder(1, 2) - cylinder(0.5, 2))";
        assert!(!skins(&format!(
            "{tube}\nrender(ao = none())\nsun(shadow = hard())"
        )));
        assert!(skins(&format!(
            "{tube}\nrender(ao = none())\nsun(shadow = soft(8))"
        )));
    }
}
