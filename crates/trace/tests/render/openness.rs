//! Ambient occlusion against mathematics, and against rays in double precision that see the whole sky.

use crate::scenes::{quick, stream};
use glam::{DVec3, Vec3};
use std::f64::consts::TAU;
use std::path::Path;
use zeroset_eval::Point;
use zeroset_field::program::Program;
use zeroset_language::load::{Language, Options, load, load_text};
use zeroset_number::{F64, v3};
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::{Renderer, Silent};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Occlusion, Settings};
use zeroset_shade::view::View;
use zeroset_trace::CpuRenderer;

const CONES: Occlusion = Occlusion::Cones {
    reach: None,
    steps: 14,
};

/// A point of a surface that a pixel shows.
struct Hit {
    pixel: usize,
    point: DVec3,
    normal: DVec3,
    object: f32,
}

/// A field in double precision.
struct Oracle<'p>(Point<'p, F64>);

impl Oracle<'_> {
    fn value(&mut self, p: DVec3) -> f64 {
        self.0.value(v3(F64(p.x), F64(p.y), F64(p.z))).0
    }

    fn normal(&mut self, p: DVec3, h: f64) -> DVec3 {
        let along =
            |this: &mut Self, axis: DVec3| this.value(p + axis * h) - this.value(p - axis * h);
        DVec3::new(
            along(self, DVec3::X),
            along(self, DVec3::Y),
            along(self, DVec3::Z),
        )
        .normalize()
    }

    /// The share of the sky that is seen, by `side * side` rays that follow the cosine law, each at a random place of its cell.
    fn open(&mut self, hit: &Hit, side: u32, far: f64, seed: u64) -> f64 {
        let n = hit.normal;
        let (a, b) = n.any_orthonormal_pair();
        let size = far * 1e-4;
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut random = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut seen = 0;
        for k in 0..side * side {
            let u = (f64::from(k % side) + random()) / f64::from(side);
            let v = (f64::from(k / side) + random()) / f64::from(side);
            let (sin, cos) = (v * TAU).sin_cos();
            let to = a * (u.sqrt() * cos) + b * (u.sqrt() * sin) + n * (1.0 - u).sqrt();
            let origin = hit.point + n * (1e-3 * size);
            let mut t = 1e-3 * size;
            let mut is_open = true;
            // the steps of the field itself: nothing can be passed
            for _ in 0..20_000 {
                let f = self.value(origin + to * t);
                if f < 1e-4 * size {
                    is_open = false;
                    break;
                }
                t += f;
                if t > far {
                    break;
                }
            }
            seen += u32::from(is_open);
        }
        f64::from(seen) / f64::from(side * side)
    }
}

fn program(scene: &Scene) -> Program {
    let field = scene.field().expect("a field").expect("objects");
    Program::compile(&field, &Default::default()).expect("a program")
}

/// What the pixels of a picture without antialiasing show, refined in double precision.
fn hits(scene: &Scene, film: &Film, oracle: &mut Oracle<'_>) -> Vec<Hit> {
    let settings = scene.settings();
    let view = View::new(scene.camera(), settings.size, settings.footprint);
    let (depth, object) = (film.plane(Plane::Depth), film.plane(Plane::Object));
    let mut found = Vec::new();
    for (pixel, &t) in depth.iter().enumerate().filter(|(_, t)| t.is_finite()) {
        let (x, y) = (
            pixel as u32 % settings.size[0],
            pixel as u32 / settings.size[0],
        );
        let (o, d) = view.split(view.ray(x as f32 + 0.5, y as f32 + 0.5));
        let of = |v: zeroset_number::Vec3<f32>| Vec3::from(v.array()).as_dvec3();
        let (mut point, d) = (of(o) + of(d) * f64::from(t), of(d));
        let h = 1e-5 * f64::from(t);
        let normal = oracle.normal(point, h);
        for _ in 0..3 {
            point -= normal * oracle.value(point);
        }
        // edges have no normal, silhouettes two surfaces
        let there = oracle.normal(point, h);
        if there.dot(normal) > 0.999 && there.dot(d) < -0.05 {
            found.push(Hit {
                pixel,
                point,
                normal: there,
                object: object[pixel],
            });
        }
    }
    found
}

/// A scene in the language, with one ray a pixel.
fn scene(text: &str, size: [u32; 2]) -> Scene {
    let loaded = load_text(
        "test.star",
        text,
        Language::Starlark,
        None,
        &Options::default(),
    );
    let mut scene = loaded.unwrap_or_else(|e| panic!("{}", e.report)).scene;
    scene
        .edit(|s| {
            s.settings = Settings {
                size,
                occlusion: CONES,
                ..quick()
            }
        })
        .expect("a scene");
    scene
}

/// Openness and hits of the object of this number.
fn seen(scene: &Scene, object: f32) -> Vec<(DVec3, f64)> {
    let program = program(scene);
    let mut oracle = Oracle(Point::new(program.values()));
    let film = stream(scene);
    let open = film.plane(Plane::Occlusion);
    let all = hits(scene, &film, &mut oracle);
    let of = all.iter().filter(|h| object == 0.0 || h.object == object);
    of.map(|h| (h.point, f64::from(open[h.pixel]))).collect()
}

fn error(pairs: &[(f64, f64)]) -> (f64, f64) {
    let n = pairs.len() as f64;
    let bias = pairs.iter().map(|(a, b)| a - b).sum::<f64>() / n;
    let square = pairs.iter().map(|(a, b)| (a - b).powi(2)).sum::<f64>() / n;
    (square.sqrt(), bias)
}

fn worst(pairs: &[(f64, f64)]) -> f64 {
    (pairs.iter().map(|(a, b)| (a - b).abs())).fold(0.0, f64::max)
}

/// Tomczak's scenes: the default is at most 0.04 off on each of them, and the rays of `hemisphere` no more than their noise.
#[test]
fn tomczak_against_rays() {
    let step = 0.12;
    let methods: [(&str, Occlusion, f64); 7] = [
        ("cones", CONES, 0.04),
        (
            "hemisphere",
            Occlusion::Hemisphere {
                rays: 64,
                reach: None,
            },
            0.06,
        ),
        (
            "hemisphere 1.5",
            Occlusion::Hemisphere {
                rays: 64,
                reach: Some(1.5),
            },
            1.0,
        ),
        (
            "obscurance",
            Occlusion::Obscurance {
                rays: 64,
                reach: None,
                tau: 2.0,
            },
            1.0,
        ),
        (
            "quilez",
            Occlusion::Quilez {
                steps: 5,
                step,
                scale: 1.0,
            },
            1.0,
        ),
        (
            "bent",
            Occlusion::Bent {
                steps: 5,
                step,
                scale: 0.5,
                bend: 0.2,
            },
            1.0,
        ),
        (
            "evans",
            Occlusion::Evans {
                scale: 1.0,
                step: 0.1,
                bend: 0.5,
            },
            1.0,
        ),
    ];
    for name in [
        "sphere_ground_1",
        "sphere_ground_2",
        "box_1",
        "box_2",
        "sphere_box_ground",
    ] {
        let path = format!("../../scenes/papers/tomczak_{name}.star");
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
        let loaded = load(&path, &Options::default());
        let mut scene = loaded.unwrap_or_else(|e| panic!("{}", e.report)).scene;
        scene
            .edit(|s| {
                s.settings = Settings {
                    size: [40, 30],
                    ..quick()
                };
                for object in &mut s.objects {
                    object.occlusion = None;
                }
            })
            .expect("a scene");
        let program = program(&scene);
        let mut oracle = Oracle(Point::new(program.values()));
        let film = stream(&scene);
        let all = hits(&scene, &film, &mut oracle);
        let right: Vec<f64> = (all.iter())
            .map(|h| oracle.open(h, 16, 200.0, h.pixel as u64 + 1))
            .collect();
        for (method, occlusion, allowed) in methods {
            scene
                .edit(|s| s.settings.occlusion = occlusion)
                .expect("a scene");
            let renderer = CpuRenderer::new(Some(2)).expect("threads");
            let frame = renderer.render(&scene, &Silent).expect("a picture");
            let open = frame.film.plane(Plane::Occlusion);
            let pairs: Vec<(f64, f64)> = (all.iter().zip(&right))
                .map(|(h, right)| (f64::from(open[h.pixel]), *right))
                .collect();
            let (rms, bias) = error(&pairs);
            let statistics = frame.statistics;
            let per_hit = statistics.evaluations.occlusion as f64 / statistics.hits as f64;
            println!(
                "{name:18} {method:15} rmse {rms:.4} bias {bias:+.4} worst {:.3} evaluations a hit {per_hit:5.1}",
                worst(&pairs)
            );
            assert!(rms < allowed, "{name}, {method}: {rms} off");
        }
    }
}

/// Two half spaces that meet at an angle leave `(1 + cos) / 2` of the sky, wherever one stands.
#[test]
fn planes_that_meet() {
    for (degrees, allowed) in [(30, 0.08), (60, 0.08), (90, 0.08), (120, 0.08), (150, 0.08)] {
        let angle = f64::from(degrees).to_radians();
        let text = format!(
            "show(plane())\nshow(plane().turn(z = -{degrees}).move(x = -1))\n\
             camera(eye = (4, 2, 0.7), target = (0.5, 0, 0), fov = 40)"
        );
        let found = seen(&scene(&text, [40, 30]), 1.0);
        assert!(found.len() > 100, "{degrees}: {}", found.len());
        let right = 0.5 + 0.5 * angle.cos();
        let pairs: Vec<_> = found.iter().map(|(_, open)| (*open, right)).collect();
        let (rms, bias) = error(&pairs);
        println!(
            "{degrees} degrees: {right:.3}, rmse {rms:.4} bias {bias:+.4} worst {:.3}",
            worst(&pairs)
        );
        assert!(worst(&pairs) < allowed, "{degrees} degrees");
    }
}

/// Three walls leave a quarter, a room nothing.
#[test]
fn corners_and_rooms() {
    let walls = "show(plane())\nshow(plane().turn(z = -90))\nshow(plane().turn(x = 90))\n\
                 camera(eye = (5, 4, 6), target = (0.8, 0, 0.8), fov = 30)";
    let found = seen(&scene(walls, [40, 30]), 0.0);
    let pairs: Vec<_> = found.iter().map(|(_, open)| (*open, 0.25)).collect();
    println!("three walls: {:?} worst {}", error(&pairs), worst(&pairs));
    assert!(worst(&pairs) < 0.1);
    for room in [
        "box(4).onion(0.1)",
        "sphere(3).onion(0.05)",
        "box((6, 4, 5)).onion(0.4)",
    ] {
        let text = format!(
            "show({room})\ncamera(eye = (0.3, 0.2, 0.1), target = (1, 0.1, 0.4), fov = 90)"
        );
        let found = seen(&scene(&text, [40, 30]), 0.0);
        let pairs: Vec<_> = found.iter().map(|(_, open)| (*open, 0.0)).collect();
        println!("{room}: {:?} worst {}", error(&pairs), worst(&pairs));
        // rays start two footprints from a wall, which at this size is as far as the wall is thick: corners leak
        assert!(error(&pairs).0 < 0.1 && worst(&pairs) < 0.75, "{room}");
    }
}

/// A ball over a floor hides `(r / d)^2 cos` of the sky: the whole floor is right and smooth, without rings or petals.
#[test]
fn a_floor_under_a_ball() {
    for height in [1.0, 1.3, 2.0, 4.0] {
        let text = format!(
            "show(plane())\nshow(sphere(1).move(y = {height}))\n\
             camera(eye = (0, 6, 5), target = (0, 0.7, 0), fov = 60)"
        );
        let scene = scene(&text, [160, 120]);
        let right = |p: DVec3| {
            let d = (p.x * p.x + p.z * p.z + height * height).sqrt();
            1.0 - height / (d * d * d)
        };
        let found = seen(&scene, 1.0);
        let pairs: Vec<_> = found.iter().map(|(p, open)| (*open, right(*p))).collect();
        let (rms, bias) = error(&pairs);
        // between neighbours the error must not jump
        let film = stream(&scene);
        let (open, object) = (film.plane(Plane::Occlusion), film.plane(Plane::Object));
        let (mut jump, mut square, mut count) = (0.0f32, 0.0f32, 0);
        for y in 1..119 {
            for x in 1..159 {
                let at = y * 160 + x;
                let around = [at, at - 1, at + 1, at - 160, at + 160];
                if around.iter().all(|&k| object[k] == 1.0) {
                    let mean = around[1..].iter().map(|&k| open[k]).sum::<f32>() / 4.0;
                    jump = jump.max((open[at] - mean).abs());
                    square += (open[at] - mean).powi(2);
                    count += 1;
                }
            }
        }
        let rough = (square / count as f32).sqrt();
        println!(
            "ball at {height}: rmse {rms:.4} bias {bias:+.4} worst {:.3} roughness {rough:.5} worst {jump:.4}",
            worst(&pairs)
        );
        assert!(rms < 0.06 && worst(&pairs) < 0.2, "ball at {height}");
        assert!(rough < 0.002 && jump < 0.03, "ball at {height}");
    }
}

/// A disc hides the squared sine of its half angle from the place under its middle.
#[test]
fn under_a_disc() {
    for (radius, height) in [(1.0, 1.0), (2.0, 1.0), (0.5, 1.0), (0.4, 0.6f64)] {
        let text = format!(
            "show(plane())\nshow(cylinder(radius = {radius}, height = 0.01).move(y = {}))\n\
             camera(eye = ({}, {}, 0.0), target = (0, 0, 0), fov = 10)",
            height + 0.005,
            3.0 * radius + 2.0,
            height * 0.5
        );
        let size = [31, 31];
        let found = seen(&scene(&text, size), 1.0);
        let right = height * height / (radius * radius + height * height);
        let near = (found.iter()).min_by(|a, b| a.0.length().total_cmp(&b.0.length()));
        let (place, open) = near.expect("a floor");
        println!("disc {radius} at {height}: {right:.3}, found {open:.3} at {place:?}");
        assert!(place.length() < 0.2 * height && (open - right).abs() < 0.3);
    }
}

/// A field that is a bound makes occlusion darker, never lighter: by how much.
#[test]
fn bounds_darken() {
    let means = [1, 2, 4].map(|slope| {
        let text = format!(
            "show(plane())\nshow(field(lambda p: length(p) - 1, size = 2.2, slope = {slope}).move(y = 1))\n\
             camera(eye = (0, 2.2, 6.5), target = (0, 0.9, 0), fov = 36)"
        );
        let found = seen(&scene(&text, [40, 30]), 1.0);
        found.iter().map(|(_, open)| open).sum::<f64>() / found.len() as f64
    });
    println!("mean openness with slopes 1, 2, 4: {means:?}");
}
