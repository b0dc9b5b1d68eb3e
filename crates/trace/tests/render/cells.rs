//! Pictures with cells are those without, and steep formulas are where mathematics says.

use glam::Vec3;
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_field::field::Field;
use zeroset_field::formula::{Budget, Builder, Formula};
use zeroset_field::shape::{self, Shape};
use zeroset_scene::camera::{Camera, Lens};
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::light::{Light, Source};
use zeroset_scene::material::Material;
use zeroset_scene::render::{Evaluations, Silent};
use zeroset_scene::scene::{Object, Scene, SceneParts};
use zeroset_scene::settings::{Antialias, March, Shadow};
use zeroset_trace::{CpuRenderer, PreparedScene};

const SIZE: [u32; 2] = [96, 80];
const PLANES: [Plane; 6] = [
    Plane::Colour,
    Plane::Depth,
    Plane::Normal,
    Plane::Object,
    Plane::Occlusion,
    Plane::Residual,
];

fn scene(objects: Vec<(&str, Field)>, eye: Vec3) -> Scene {
    let lens = Lens::Pinhole {
        fov: 40f32.to_radians(),
    };
    let materials = objects.iter().map(|_| Material::default()).collect();
    let mut parts = SceneParts {
        objects: (objects.into_iter().enumerate())
            .map(|(k, (name, field))| Object {
                material: k as u16,
                ..Object::new(name, field)
            })
            .collect(),
        materials,
        lights: vec![Light {
            source: Source::Directional {
                direction: Vec3::new(-0.5, -0.8, -0.4).normalize(),
            },
            radiance: Vec3::ONE,
            shadow: Shadow::Soft { sharpness: 12.0 },
        }],
        camera: Camera::look_at(eye, Vec3::ZERO, Vec3::Y, lens).expect("a view"),
        ..SceneParts::default()
    };
    parts.settings.antialias = Antialias::None;
    parts.build().expect("a scene")
}

fn beads() -> Scene {
    let bead = |k: u32| {
        let angle = f64::from(k) * 0.7;
        let at = [
            2.0 * angle.cos(),
            f64::from(k) * 0.008 - 1.2,
            2.0 * angle.sin(),
        ];
        shape::sphere(0.25).translate(at)
    };
    let joined = shape::smooth_union((0..300).map(bead), 0.1);
    let cut = shape::union((0..20).map(|k| bead(6 * k + 3))).translate([0.1, 0.05, 0.0]);
    let floor = shape::plane().translate([0.0, -1.4, 0.0]);
    let field = |shape: &Shape| shape.field().expect("a field");
    scene(
        vec![("beads", field(&(joined - cut))), ("floor", field(&floor))],
        Vec3::new(3.0, 2.5, 6.0),
    )
}

/// Taubin's heart (1994), which takes 1,765 for its slope over a box.
fn heart_value([x, y, z]: [f64; 3]) -> f64 {
    let body = x * x + 2.25 * z * z + y * y - 1.0;
    body.powi(3) - x * x * y.powi(3) - 0.1125 * z * z * y.powi(3)
}

fn heart() -> Scene {
    let builder = Builder::new();
    let p = builder.point();
    let q = p.square();
    let body = q.x() + q.z() * 2.25 + q.y() - 1.0;
    let value = body.powi(3) - (q.x() + q.z() * 0.1125) * p.y().powi(3);
    let steps = builder.finish(&value).expect("steps");
    let bounds = Aabb::centred([1.5; 3]);
    let formula = Formula::prove(steps, bounds, &Budget::default()).expect("a slope");
    assert!(formula.slope() > 200.0);
    scene(
        vec![("heart", Field::formula(Arc::new(formula)).unwrap())],
        Vec3::new(1.5, 1.0, 4.0),
    )
}

fn prepared(scene: &Scene, threads: usize) -> PreparedScene {
    let renderer = CpuRenderer::new(Some(threads)).expect("threads");
    renderer
        .prepare_scene(Arc::new(scene.clone()))
        .expect("a program")
}

fn picture(prepared: &PreparedScene) -> (Evaluations, Film) {
    let (part, film) = prepared.render_part(SIZE, &PLANES, &Silent);
    (part.statistics.evaluations, film)
}

fn assert_same(a: &Film, b: &Film) {
    for plane in PLANES {
        let bits = |film: &Film| {
            film.plane(plane)
                .iter()
                .map(|x| x.to_bits())
                .collect::<Vec<_>>()
        };
        assert!(bits(a) == bits(b), "another {plane:?}");
    }
}

#[test]
fn pictures_with_cells_have_the_same_bits() {
    let scene = beads();
    let with = prepared(&scene, 2).with_cells();
    let cells = with.cells().expect("a program with cells");
    let (_, film) = picture(&with);
    let census = cells.census();
    let whole = with.program().values().code.instructions.len();
    let mean = census.instructions as f64 / census.points as f64;
    assert!(mean < whole as f64, "{mean} of {whole} instructions");
    assert!(census.cells > 100 && census.bytes < 16 << 20, "{census:?}");
    // the second picture finds all cells there
    assert_same(&film, &picture(&with).1);
    assert_same(&film, &picture(&prepared(&scene, 1).with_cells()).1);
    assert_same(&film, &picture(&prepared(&scene, 2)).1);
}

#[test]
fn small_scenes_have_no_cells() {
    assert!(
        prepared(&zeroset_trace::bench::frame(), 1)
            .cells()
            .is_none()
    );
}

#[test]
fn a_heart_is_where_its_formula_changes_its_sign() {
    for march in [March::Sphere, March::default()] {
        let mut scene = heart();
        scene
            .edit(|parts| parts.settings.march = march)
            .expect("a scene");
        let with = prepared(&scene, 2);
        let (fast, film) = picture(&with);
        assert_same(&film, &picture(&prepared(&scene, 1)).1);
        let (slow, _) = picture(&prepared(&scene, 2).without_cells());
        let march = |e: Evaluations| (e.march + e.prepass) as f64;
        assert!(
            march(fast) * 8.0 < march(slow),
            "{} evaluations instead of {}",
            march(fast),
            march(slow)
        );
        let camera = scene.camera();
        let depth = film.plane(Plane::Depth);
        let (mut hits, mut unclear) = (0, 0);
        for (i, &found) in depth.iter().enumerate() {
            let (x, y) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
            let (origin, direction) = camera.ray(x as f32 + 0.5, y as f32 + 0.5, SIZE);
            let at = |t: f64| {
                let c = |k: usize| f64::from(origin[k]) + t * f64::from(direction[k]);
                heart_value([c(0), c(1), c(2)])
            };
            // dense, and whether anything is as near as a tenth of a pixel
            let (mut first, mut least) = (None, f64::INFINITY);
            let steps = 6000;
            for k in 0..steps {
                let t = 2.0 + 5.0 * f64::from(k) / f64::from(steps);
                let value = at(t);
                least = least.min(value);
                if value < 0.0 {
                    let (mut outside, mut inside) = (t - 5.0 / f64::from(steps), t);
                    for _ in 0..60 {
                        let middle = 0.5 * (outside + inside);
                        if at(middle) < 0.0 {
                            inside = middle;
                        } else {
                            outside = middle;
                        }
                    }
                    first = Some(inside);
                    break;
                }
            }
            let is_hit = found.is_finite() && found > 0.0;
            match first {
                Some(t) if is_hit => {
                    hits += 1;
                    let off = (f64::from(found) - t).abs();
                    assert!(off < 2e-3, "pixel {x}, {y}: {found} instead of {t}");
                }
                None if !is_hit => {}
                // the edge, where the surface is thinner than rounding
                _ => {
                    unclear += 1;
                    assert!(
                        least.abs() < 1e-3,
                        "pixel {x}, {y}: {found} and {first:?}, {least}"
                    );
                }
            }
        }
        assert!(hits > 1000 && unclear < 8, "{hits} hits, {unclear} unclear");
    }
}
