//! Formulas without a Lipschitz constant are where mathematics says: each picture against dense samples of the same formula, written down a second
//! time in double precision.

use glam::Vec3;
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_field::field::Field;
use zeroset_field::formula::{Budget, Builder, Expression, Formula, Steps};
use zeroset_field::shape;
use zeroset_scene::camera::{Camera, Lens};
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::material::Material;
use zeroset_scene::render::Silent;
use zeroset_scene::scene::{Object, Scene, SceneParts};
use zeroset_scene::settings::Antialias;
use zeroset_trace::certify::Verdict;
use zeroset_trace::{CpuRenderer, PreparedScene};

const SIZE: [u32; 2] = [56, 48];
const PLANES: [Plane; 3] = [Plane::Depth, Plane::Colour, Plane::Normal];
/// Half the side of the box of every formula.
const HALF: f64 = 1.6;

/// A formula, in our words and in those of Rust.
struct Case {
    name: &'static str,
    formula: fn(&Expression) -> Expression,
    value: fn([f64; 3]) -> f64,
}

const CASES: [Case; 8] = [
    Case {
        name: "roots, steep along three planes",
        formula: |p| {
            let q = p.abs().sqrt();
            q.x() + q.y() + q.z() - 1.5
        },
        value: |p| p.iter().map(|c| c.abs().sqrt()).sum::<f64>() - 1.5,
    },
    Case {
        name: "a cusp, whose slope is endless where the surface is",
        formula: |p| p.swizzle("xz").expect("two parts").length().sqrt() - (1.0 - p.y()),
        value: |p| p[0].hypot(p[2]).sqrt() - (1.0 - p[1]),
    },
    Case {
        name: "a pole",
        formula: |p| p.x().square() + p.z().square() - 0.3 / (p.y() + 0.011),
        value: |p| p[0] * p[0] + p[2] * p[2] - 0.3 / (p[1] + 0.011),
    },
    Case {
        name: "stairs",
        formula: |p| p.y() - ((p.x() + p.z()) * 2.0).floor() * 0.25,
        value: |p| p[1] - ((p[0] + p[2]) * 2.0).floor() * 0.25,
    },
    Case {
        name: "a staircase that winds, which jumps by a turn",
        formula: |p| p.y() - p.z().atan2(p.x()) * 0.3,
        value: |p| p[1] - p[2].atan2(p[0]) * 0.3,
    },
    Case {
        name: "remainders, which jump between walls",
        formula: |p| p.length() - 0.7 - p.x().modulo(0.37) * 0.8,
        value: |p| {
            let r = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
            r - 0.7 - p[0].rem_euclid(0.37) * 0.8
        },
    },
    Case {
        name: "high powers, steeper than a million at the corners",
        formula: |p| p.x().powi(40) + p.y().powi(40) + p.z().powi(40) - 1.0,
        value: |p| p.iter().map(|c| c.powi(40)).sum::<f64>() - 1.0,
    },
    Case {
        name: "a choice whose sides do not meet",
        formula: |p| {
            let (ball, small) = (p.length() - 1.2, p.length() - 0.6);
            p.y().less(p.x() * 0.3).choose(&ball, &small)
        },
        value: |p| {
            let r = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
            if p[1] < p[0] * 0.3 { r - 1.2 } else { r - 0.6 }
        },
    },
];

fn steps(f: fn(&Expression) -> Expression) -> Steps {
    let builder = Builder::new();
    builder.finish(&f(&builder.point())).expect("steps")
}

fn scene(field: Field) -> Scene {
    let lens = Lens::Pinhole {
        fov: 40f32.to_radians(),
    };
    let eye = Vec3::new(2.3, 1.9, 4.1);
    let mut parts = SceneParts {
        objects: vec![Object::new("it", field)],
        materials: vec![Material::default()],
        camera: Camera::look_at(eye, Vec3::ZERO, Vec3::Y, lens).expect("a view"),
        ..SceneParts::default()
    };
    parts.settings.antialias = Antialias::None;
    parts.build().expect("a scene")
}

fn prepared(scene: &Scene, threads: usize) -> PreparedScene {
    let renderer = CpuRenderer::new(Some(threads)).expect("threads");
    renderer
        .prepare_scene(Arc::new(scene.clone()))
        .expect("a program")
}

fn picture(prepared: &PreparedScene) -> Film {
    prepared.render_part(SIZE, &PLANES, &Silent).1
}

/// Pixels of a picture in which the surface is not where dense samples of `value` find it first; and those in which it is.
fn compare(scene: &Scene, film: &Film, value: impl Fn([f64; 3]) -> f64) -> (u32, u32) {
    let depth = film.plane(Plane::Depth);
    let (mut hits, mut wrong) = (0, 0);
    for (i, &found) in depth.iter().enumerate() {
        let (x, y) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
        let ray = (scene.camera()).ray(x as f32 + 0.5, y as f32 + 0.5, SIZE);
        let (origin, direction) = (ray.0.as_dvec3(), ray.1.as_dvec3());
        let at = |t: f64| (origin + direction * t).to_array();
        // the solid ends at the box, as a formula's does
        let behind = |t: f64| {
            let p = at(t);
            p.iter().all(|c| c.abs() <= HALF) && value(p) < 0.0
        };
        let is_hit = found.is_finite();
        const STEP: f64 = 1.0 / 2048.0;
        let first = (0..).map(|k| 1.0 + f64::from(k) * STEP);
        let first = first.take_while(|t| *t < 8.0).find(|t| behind(*t));
        // what single precision leaves open, and bodies thinner than a sixteenth of a pixel's width, which may be passed (ARCHITECTURE.md)
        let near = |t: f64| {
            let around = |k: i32| behind(t + f64::from(k) * 1e-5);
            (-200..=200).any(around) && !(-200..=200).all(around)
        };
        let is_thin = |t: f64| (1..=10).any(|k| !behind(t + f64::from(k) * 5e-4));
        let is_right = match first {
            Some(t) if is_hit && f64::from(found) < t => near(f64::from(found)),
            Some(t) => (is_hit && f64::from(found) < t + 3e-3) || is_thin(t),
            None => !is_hit || near(f64::from(found)),
        };
        hits += u32::from(is_hit && is_right);
        wrong += u32::from(!is_right);
    }
    (wrong, hits)
}

#[test]
fn surfaces_are_where_mathematics_says() {
    let mut lost_in_all = 0;
    for case in &CASES {
        let bounds = Aabb::centred([HALF; 3]);
        let formula = Formula::new(steps(case.formula), bounds, &Budget::default()).unwrap();
        assert!(formula.is_unbounded(), "{} has a slope", case.name);
        let usual = formula.slope();
        let scene = scene(Field::formula(Arc::new(formula)).unwrap());
        let film = picture(&prepared(&scene, 2));
        let (wrong, hits) = compare(&scene, &film, case.value);
        // a ray that grazes an edge may pass it by a hair
        assert!(
            wrong <= 1 && hits > 150,
            "{}: {wrong} wrong, {hits} right",
            case.name
        );
        let again = picture(&prepared(&scene, 1));
        for plane in PLANES {
            let bits = |film: &Film| {
                film.plane(plane)
                    .iter()
                    .map(|x| x.to_bits())
                    .collect::<Vec<_>>()
            };
            assert!(
                bits(&film) == bits(&again),
                "{}: {plane:?} depends on threads",
                case.name
            );
        }
        // and the comparison can fail: marched as if the usual slope held everywhere, they lose parts
        let stated = Formula::stated(steps(case.formula), bounds, usual).unwrap();
        let stated = self::scene(Field::formula(Arc::new(stated)).unwrap());
        let (lost, _) = compare(&stated, &picture(&prepared(&stated, 2)), case.value);
        println!(
            "{}: {wrong} wrong of {hits}; {lost} with the slope {usual}",
            case.name
        );
        lost_in_all += lost;
    }
    assert!(lost_in_all > 500, "{lost_in_all} pixels lost in all");
}

#[test]
fn others_beside_it_and_joined_with_it_stay_where_they_are() {
    let bounds = Aabb::centred([HALF; 3]);
    let stairs = Formula::new(steps(CASES[3].formula), bounds, &Budget::default()).unwrap();
    let stairs = shape::Shape::from(Field::formula(Arc::new(stairs)).unwrap());
    let ball = shape::sphere(0.9).translate([0.4, 0.2, 0.3]);
    let value = |p: [f64; 3]| {
        let off = [p[0] - 0.4, p[1] - 0.2, p[2] - 0.3];
        let ball = off.iter().map(|c| c * c).sum::<f64>().sqrt() - 0.9;
        (CASES[3].value)(p).max(-ball)
    };
    let scene = scene((stairs - ball).field().expect("a field"));
    let with = prepared(&scene, 2);
    let (wrong, hits) = compare(&scene, &picture(&with), value);
    assert!(wrong <= 4 && hits > 150, "{wrong} wrong, {hits} right");
    // double precision agrees
    let certificate = with.certify(SIZE, &Silent).expect("a certificate");
    assert!(
        certificate.count(Verdict::Wrong) <= 2,
        "{}",
        certificate.count(Verdict::Wrong)
    );
}

#[test]
fn without_cells_every_ray_is_searched() {
    let case = &CASES[0];
    let bounds = Aabb::centred([HALF; 3]);
    let formula = Formula::new(steps(case.formula), bounds, &Budget::default()).unwrap();
    let scene = scene(Field::formula(Arc::new(formula)).unwrap());
    let (wrong, hits) = compare(
        &scene,
        &picture(&prepared(&scene, 2).without_cells()),
        case.value,
    );
    assert!(wrong <= 4 && hits > 150, "{wrong} wrong, {hits} right");
}
