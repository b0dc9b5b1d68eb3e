//! Rays of one's own: what they meet against a dense search for changes of sign in double precision.

use glam::Vec3;
use std::sync::Arc;
use zeroset_eval::Point;
use zeroset_field::program::Program;
use zeroset_field::shape::{Shape, box3, sphere, torus};
use zeroset_number::{F64, v3};
use zeroset_scene::material::Material;
use zeroset_scene::scene::{Object, Scene, SceneParts};
use zeroset_scene::settings::March;
use zeroset_trace::{CpuRenderer, PreparedScene, QueryError, Ray};

const WIDTH: f32 = 1e-3;
const FAR: f32 = 12.0;

fn scene(shapes: &[(&str, Shape)], march: March) -> Scene {
    let mut parts = SceneParts {
        objects: (shapes.iter())
            .map(|(name, shape)| Object::new(*name, shape.field().expect("a field")))
            .collect(),
        materials: vec![Material::default()],
        ..SceneParts::default()
    };
    parts.settings.march = march;
    parts.build().expect("a scene")
}

fn prepared(scene: Scene) -> PreparedScene {
    let renderer = CpuRenderer::new(Some(2)).expect("threads");
    renderer.prepare_scene(Arc::new(scene)).expect("a program")
}

/// Solids with many surfaces behind each other, thin walls and insides to start from.
fn solids() -> Vec<(&'static str, Shape)> {
    let shells = sphere(2.0).onion(0.1) | sphere(1.2).onion(0.05) | sphere(0.5);
    vec![
        ("shells", shells.clone()),
        ("rings", torus(1.5, 0.3) | torus(1.5, 0.3).rotate_x(90.0)),
        (
            "cut",
            shells - box3([2.0, 5.0, 5.0]).translate([1.3, 0.0, 0.0]),
        ),
        ("grid", sphere(0.3).repeat([1.0, 1.0, 1.0], [4, 4, 4])),
    ]
}

/// Rays from everywhere to everywhere, spread by the golden ratios of six dimensions.
fn rays(count: usize) -> Vec<Ray> {
    const STEPS: [f64; 6] = [
        0.898_653_7,
        0.807_578_5,
        0.725_733_4,
        0.652_183_3,
        0.586_087_0,
        0.526_689_2,
    ];
    let place = |i: usize, k: usize| (6.0 * ((i + 1) as f64 * STEPS[k]).fract() - 3.0) as f32;
    let vector = |i: usize, k: usize| Vec3::new(place(i, k), place(i, k + 1), place(i, k + 2));
    (0..count)
        .map(|i| Ray {
            far: FAR,
            ..Ray::new(vector(i, 0), vector(i, 3))
        })
        .collect()
}

/// All changes of sign along a ray; `None` where some are so near to each other, or to none, that single precision may differ.
fn dense(program: &Program, ray: &Ray) -> Option<Vec<f64>> {
    const STEPS: usize = 6000;
    let mut point = Point::<F64>::new(program.values());
    let [o, d] = [ray.origin, ray.direction.normalize()].map(|v| v.to_array().map(f64::from));
    let mut f = |t: f64| {
        let p: [F64; 3] = std::array::from_fn(|k| F64(o[k] + d[k] * t));
        point.value(v3(p[0], p[1], p[2])).0
    };
    let step = f64::from(FAR) / STEPS as f64;
    let values: Vec<f64> = (0..=STEPS).map(|i| f(i as f64 * step)).collect();
    let mut found = Vec::new();
    if values[0].abs() < 2e-3 {
        return None;
    }
    for i in 0..STEPS {
        let (a, b) = (values[i], values[i + 1]);
        if (a < 0.0) != (b < 0.0) {
            let (mut low, mut high) = (i as f64 * step, (i + 1) as f64 * step);
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                if (f(middle) < 0.0) == (a < 0.0) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            found.push(low);
        } else if i > 0
            && a.abs() < 2.0 * step
            && a.abs() <= values[i - 1].abs()
            && a.abs() <= b.abs()
        {
            return None;
        }
    }
    let near = |pair: &[f64]| pair[1] - pair[0] < 4.0 * step;
    let grazes = (found.iter()).any(|t| (f(t + 1e-5) - f(t - 1e-5)).abs() < 2e-6);
    (!found.windows(2).any(near) && !grazes).then_some(found)
}

#[test]
fn rays_cross_what_a_dense_search_finds() {
    let marches = [
        March::default(),
        March::Sphere,
        March::Relaxed { omega: 1.6 },
        March::Enhanced { share: 0.9 },
    ];
    for (k, (name, shape)) in solids().into_iter().enumerate() {
        let scene = prepared(scene(&[(name, shape)], marches[k]));
        let rays = rays(3000);
        let (mut clear, mut most, mut inside) = (0, 0, 0);
        let all = scene.crossings(&rays, WIDTH, 32).expect("rays");
        let first = scene.closest(&rays, WIDTH).expect("rays");
        let blocked = scene.occluded(&rays, WIDTH).expect("rays");
        for (i, ray) in rays.iter().enumerate() {
            let Some(wanted) = dense(scene.program(), ray) else {
                continue;
            };
            clear += 1;
            most = most.max(wanted.len());
            let found: Vec<f32> = all[i].iter().map(|hit| hit.t).collect();
            let alike = found.len() == wanted.len()
                && (found.iter().zip(&wanted)).all(|(a, b)| (f64::from(*a) - b).abs() < 1e-4);
            assert!(alike, "{name}, ray {i}: {found:?} instead of {wanted:?}");
            // each crossing comes from the other side, and its normal looks back
            for (k, hit) in all[i].iter().enumerate() {
                assert_eq!(
                    hit.inside,
                    all[i][0].inside ^ (k % 2 == 1),
                    "{name}, ray {i}"
                );
                assert!(hit.normal.dot(ray.direction) <= 1e-3, "{name}, ray {i}");
                assert_eq!((hit.object, hit.material), (Some(0), Some(0)));
            }
            assert_eq!(
                first[i].map(|hit| hit.inside),
                all[i].first().map(|hit| hit.inside)
            );
            assert_eq!(first[i].is_some(), !wanted.is_empty(), "{name}, ray {i}");
            if let Some(hit) = first[i] {
                assert!(
                    (f64::from(hit.t) - wanted[0]).abs() < 1e-4,
                    "{name}, ray {i}"
                );
                inside += usize::from(hit.inside);
            }
            let stands_in_its_own = all[i].first().is_some_and(|hit| hit.inside);
            assert_eq!(
                blocked[i],
                !wanted.is_empty() || stands_in_its_own,
                "{name}, ray {i}"
            );
        }
        assert!(
            clear > 2000 && most >= 4 && inside > 5,
            "{name}: {clear} rays tell, {most} crossings, {inside} from inside"
        );
    }
}

#[test]
fn a_ray_that_may_cross_once_stops_there() {
    let scene = prepared(scene(&solids()[..1], March::default()));
    let rays = rays(500);
    let (one, two) = (
        scene.crossings(&rays, WIDTH, 1),
        scene.crossings(&rays, WIDTH, 2),
    );
    let first = scene.closest(&rays, WIDTH).expect("rays");
    for ((one, two), first) in one
        .expect("rays")
        .iter()
        .zip(&two.expect("rays"))
        .zip(&first)
    {
        assert_eq!(one.first(), first.as_ref());
        assert!(one.len() <= 1 && two.len() <= 2);
        assert_eq!(one.is_empty(), two.is_empty());
    }
    assert_eq!(scene.crossings(&rays, WIDTH, 0), Ok(vec![Vec::new(); 500]));
}

/// A ray from the eye and the same from where it is after three units: nothing but where they begin differs.
#[test]
fn answers_are_those_of_pictures() {
    use zeroset_scene::film::Plane;
    use zeroset_scene::render::{Renderer, Silent};
    let (_, shape) = &solids()[2];
    let mut scene = scene(&[("cut", shape.clone())], March::default());
    scene
        .edit(|s| {
            s.settings.size = [48, 32];
            s.settings.antialias = zeroset_scene::settings::Antialias::None;
        })
        .expect("a scene");
    let renderer = CpuRenderer::new(Some(1)).expect("a thread");
    let film = renderer.render(&scene, &Silent).expect("a picture").film;
    let mut rays = Vec::new();
    for (y, x) in (0..32).flat_map(|y| (0..48).map(move |x| (y, x))) {
        let (origin, direction) = (scene.camera()).ray(x as f32 + 0.5, y as f32 + 0.5, [48, 32]);
        let origin = origin + direction * 1.5;
        rays.push(Ray::new(origin, direction * 7.0));
    }
    let hits = prepared(scene).closest(&rays, WIDTH).expect("rays");
    let mut met = 0;
    for (depth, hit) in film.plane(Plane::Depth).iter().zip(&hits) {
        assert_eq!(depth.is_finite(), hit.is_some());
        if let Some(hit) = hit {
            met += 1;
            assert!(
                (hit.t + 1.5 - depth).abs() < 2e-3,
                "{} and {depth}",
                hit.t + 1.5
            );
        }
    }
    assert!(met > 300);
}

#[test]
fn rays_that_are_none_are_refused() {
    let scene = prepared(scene(&solids()[..1], March::default()));
    let fine = Ray::new(Vec3::ZERO, Vec3::X);
    let ask = |ray: Ray| scene.closest(&[fine, ray], WIDTH).map(|_| ());
    let origin = Vec3::new(0.0, f32::NAN, 0.0);
    assert_eq!(ask(Ray { origin, ..fine }), Err(QueryError::NotFinite(1)));
    let origin = Vec3::new(0.0, 1e30, 0.0);
    assert_eq!(ask(Ray { origin, ..fine }), Err(QueryError::NotFinite(1)));
    for length in [1e-30, 1e30] {
        let direction = Vec3::new(0.0, length, 0.0);
        assert_eq!(ask(Ray { direction, ..fine }), Ok(()));
    }
    let direction = Vec3::ZERO;
    assert_eq!(
        ask(Ray { direction, ..fine }),
        Err(QueryError::NoDirection(1))
    );
    let (number, near, far) = (1, 2.0, 2.0);
    let refused = ask(Ray { near, far, ..fine });
    assert_eq!(refused, Err(QueryError::NoLength { number, near, far }));
    assert_eq!(ask(fine), Ok(()));
    assert_eq!(scene.closest(&[], WIDTH), Ok(Vec::new()));
    assert_eq!(scene.occluded(&[fine], 0.0), Err(QueryError::Width(0.0)));
}
