//! What is a surface: against mathematics, in double precision.

use crate::compare::beside_edge;
use crate::scenes::{object, quick, shape, stream, view};
use glam::Vec3;
use zeroset_catalogue::Dimension;
use zeroset_catalogue::entries::catalogue;
use zeroset_eval::Point;
use zeroset_field::field::Field;
use zeroset_language::load::{Language, Options, load_text};
use zeroset_number::{F64, v3};
use zeroset_scene::camera::{Camera, Lens};
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, Filter, March, Occlusion};
use zeroset_testkit::plain::dense;
use zeroset_trace::CpuRenderer;

/// A scene in the language, with cheap light.
fn written(text: &str, size: u32) -> Scene {
    let options = Options {
        size: Some([size, size]),
        bare: true,
        ..Options::default()
    };
    let loaded = load_text("test.star", text, Language::Starlark, None, &options);
    let mut scene = loaded.expect("a scene").scene;
    scene
        .edit(|s| {
            s.settings.occlusion = Occlusion::None;
            s.settings.antialias = Antialias::None;
        })
        .expect("a scene");
    scene
}

fn supersampled(scene: &mut Scene) {
    scene
        .edit(|s| {
            s.settings.antialias = Antialias::Supersample {
                samples: 4,
                filter: Filter::Mitchell,
            }
        })
        .expect("a scene");
}

/// Sum of the coverage of all pixels.
fn covered(film: &Film) -> f64 {
    film.plane(Plane::Coverage)
        .iter()
        .map(|c| f64::from(*c))
        .sum()
}

fn share(film: &Film) -> f64 {
    covered(film) / film.plane(Plane::Coverage).len() as f64
}

/// The share of an orthographic view along -z of [-h, h]^2 behind which `f` is negative somewhere, by dense samples.
fn shadow_of(f: impl Fn(f64, f64, f64) -> f64, h: f64, n: usize) -> f64 {
    let at = |i: usize, n: usize| h * (2.0 * (i as f64 + 0.5) / n as f64 - 1.0);
    let mut hits = 0;
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        hits += u32::from((0..1600).any(|k| f(at(i, n), at(j, n), at(k, 1600)) < 0.0));
    }
    f64::from(hits) / (n * n) as f64
}

/// How many pixels of an orthographic view along -z show a normal that is not that of the first root along their ray.
fn turned(scene: &Scene, film: &Film, f: &dyn Fn(f64, f64, f64) -> f64) -> usize {
    let [width, height] = scene.settings().size;
    let view = zeroset_shade::view::View::new(scene.camera(), [width, height], 1.0);
    let mut wrong = 0;
    for (i, (x, y)) in (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .enumerate()
    {
        if film.plane(Plane::Object)[i] == 0.0 || beside_edge(film, x as usize, y as usize) {
            continue;
        }
        let (o, _) = view.split(view.ray(x as f32 + 0.5, y as f32 + 0.5));
        let [x, y, _] = o.array().map(f64::from);
        let along = |k: u32| 1.8 - 3.6 * f64::from(k) / 20_000.0;
        let Some(k) = (1..20_000).find(|k| f(x, y, along(*k)) < 0.0) else {
            continue;
        };
        let (mut outside, mut inside) = (along(k - 1), along(k));
        for _ in 0..60 {
            let middle = 0.5 * (outside + inside);
            if f(x, y, middle) < 0.0 {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        let h = 1e-6;
        let slope = |d: [f64; 3]| {
            let at = |s: f64| f(x + s * d[0], y + s * d[1], inside + s * d[2]);
            (at(h) - at(-h)) as f32
        };
        let right = Vec3::new(
            slope([1.0, 0.0, 0.0]),
            slope([0.0, 1.0, 0.0]),
            slope([0.0, 0.0, 1.0]),
        );
        let shown = Vec3::from_slice(&film.plane(Plane::Normal)[3 * i..][..3]);
        wrong += usize::from(shown.dot(right.normalize()) < 0.95);
    }
    wrong
}

const FRONT: &str = "\ncamera(eye = (0, 0, 8), target = (0, 0, 0), lens = orthographic(3))";

#[test]
fn a_loose_bound_does_not_inflate() {
    let heart = |x: f64, y: f64, z: f64| {
        let a = x * x + 2.25 * z * z + y * y - 1.0;
        a * a * a - x * x * y * y * y - 0.1125 * z * z * y * y * y
    };
    let quartic = |x: f64, y: f64, z: f64| {
        let s = x * x + y * y + z * z + 0.75;
        s * s - 4.0 * (x * x + y * y)
    };
    let fourth = |x: f64, y: f64, z: f64| x.powi(4) + y.powi(4) + z.powi(4) - 1.0;
    type Case<'a> = (&'a str, &'a dyn Fn(f64, f64, f64) -> f64);
    let cases: [Case<'_>; 4] = [
        (
            "def f(p):\n    a = p.x*p.x + 9/4*p.z*p.z + p.y*p.y - 1\n    return a*a*a - p.x*p.x*p.y*p.y*p.y - 9/80*p.z*p.z*p.y*p.y*p.y\nshow(field(f, size = 4))",
            &heart,
        ),
        (
            "def f(p):\n    s = p.x*p.x + p.y*p.y + p.z*p.z + 0.75\n    return s*s - 4*(p.x*p.x + p.y*p.y)\nshow(field(f, size = 4))",
            &quartic,
        ),
        (
            "def f(p):\n    x, y, z = p.x*p.x, p.y*p.y, p.z*p.z\n    return x*x + y*y + z*z - 1\nshow(field(f, size = 4))",
            &fourth,
        ),
        (
            "show(field(lambda p: length(p) - 1, size = 4, slope = 30))",
            &|x, y, z| (x * x + y * y + z * z).sqrt() - 1.0,
        ),
    ];
    for (text, f) in cases {
        let scene = written(&format!("{text}{FRONT}"), 64);
        let wrong = turned(&scene, &stream(&scene), f);
        assert!(wrong <= 3, "{text}: {wrong} normals");
        let (found, right) = (share(&stream(&scene)), shadow_of(f, 1.5, 64));
        // the same rays: but for those that touch
        assert!(
            (found - right).abs() <= 6.0 / 4096.0,
            "{text}: {found} instead of {right}"
        );
    }
}

#[test]
fn a_taper_is_no_box() {
    let scene = written(
        &format!("show(box((1, 2, 1)).taper(height = 2, top = 0.1)){FRONT}"),
        96,
    );
    let film = stream(&scene);
    // a trapezoid whose sides are 1 and 0.1, or wider at the bottom where the taper begins in the middle
    let row = |y: usize| -> f32 { film.plane(Plane::Coverage)[y * 96..][..96].iter().sum() };
    assert!(row(20) < 0.5 * row(60), "{} and {}", row(20), row(60));
}

#[test]
fn coincident_faces_have_no_skin() {
    let top =
        "\ncamera(eye = (0, 8, 0), target = (0, 0, 0), up = (0, 0, 1), lens = orthographic(3))";
    let pi = std::f64::consts::PI;
    let cases = [
        // a tube from above: the hole is open
        ("show(cylinder(1, 2) - cylinder(0.5, 2))", top, pi * 0.75),
        (
            "show(cylinder(1, 2).turn(x = 90, y = 20) - cylinder(0.5, 2).turn(x = 90, y = 20))",
            FRONT,
            f64::NAN,
        ),
        ("show(box(1) - box(1))", FRONT, 0.0),
        ("show(box(1) ^ box(1))", FRONT, 0.0),
        (
            "show((box(1) - box(1)).turn(x = 31, y = 12).move(x = 0.3))",
            FRONT,
            0.0,
        ),
        ("show(sphere(1) - sphere(1))", FRONT, 0.0),
        // two faces of a window
        ("show(box((2, 2, 0.2)) - box((1, 1, 0.2)))", FRONT, 3.0),
        (
            "show(box((2, 2, 0.2)) - box((1, 1, 0.2)).move(x = 0.5))",
            FRONT,
            3.0,
        ),
    ];
    for (text, camera, area) in cases {
        let film = stream(&written(&format!("{text}{camera}"), 96));
        if area.is_nan() {
            // seen along its axis but for 20 degrees: something of the hole is seen through
            let middle = film.plane(Plane::Coverage)[48 * 96 + 48];
            assert_eq!(middle, 0.0, "{text}");
            continue;
        }
        let found = share(&film) * 9.0;
        // half a pixel along outlines of at most 12 units
        assert!(
            (found - area).abs() < 0.02 * 9.0_f64.min(1.0 + area),
            "{text}: {found}, not {area}"
        );
    }
}

#[test]
fn silhouettes_are_where_they_are() {
    for size in [64, 128, 256] {
        for fov in [20.0_f64, 90.0, 170.0] {
            let half = f64::from(size) / 2.0;
            let focal = half / (0.5 * fov).to_radians().tan();
            // a ball of half the picture's height
            let radius_pixels = 0.5 * half;
            let angle = (radius_pixels / focal).atan();
            let eye = 1.0 / angle.sin();
            let mut scene = written("show(sphere(1))", size);
            supersampled(&mut scene);
            look(&mut scene, [0.0, 0.0, eye], fov);
            let area = std::f64::consts::PI * radius_pixels * radius_pixels;
            let outline = 2.0 * std::f64::consts::PI * radius_pixels;
            let off = (covered(&stream(&scene)) - area) / outline;
            assert!(off.abs() < 0.1, "ball {size} {fov}: {off} pixels");

            // a wire of a quarter of a pixel from left to right, with its middle off the rows of pixels
            let distance = 4.0;
            let width = 0.25 * distance / focal;
            let height = 0.37 * distance / focal;
            let text = format!(
                "show(capsule(radius = {}, height = 2000).turn(z = 90).move(y = {height}))",
                0.5 * width
            );
            let mut scene = written(&text, size);
            supersampled(&mut scene);
            look(&mut scene, [0.0, 0.0, distance], fov);
            let film = stream(&scene);
            let middle: f64 = (0..size as usize)
                .map(|y| {
                    f64::from(film.plane(Plane::Coverage)[y * size as usize + size as usize / 2])
                })
                .sum();
            let all = covered(&film) / f64::from(size);
            assert!(
                (all - 0.25).abs() < 0.1,
                "wire {size} {fov}: {all} pixels, {middle} in the middle"
            );

            // the upper edge of a box that fills the lower part of the picture
            let edge = 0.3 * half / focal * distance;
            let text = format!("show(box((10000, 1000, 0.001)).move(y = {}))", edge - 500.0);
            let mut scene = written(&text, size);
            supersampled(&mut scene);
            look(&mut scene, [0.0, 0.0, distance], fov);
            let film = stream(&scene);
            if std::env::var("ZS_DEBUG").is_ok() && fov > 160.0 {
                for y in 0..size as usize {
                    eprintln!(
                        "row {y} {}",
                        film.plane(Plane::Coverage)[y * size as usize..][..size as usize]
                            .iter()
                            .sum::<f32>()
                            / size as f32
                    );
                }
            }
            let rows = covered(&film) / f64::from(size);
            let right = half + 0.3 * half * (distance / (distance - 0.000_5));
            assert!(
                (rows - right).abs() < 0.1,
                "edge {size} {fov}: {rows}, not {right}"
            );
        }
    }
}

fn look(scene: &mut Scene, eye: [f64; 3], fov: f64) {
    let lens = Lens::Pinhole {
        fov: fov.to_radians() as f32,
    };
    let eye = Vec3::from(eye.map(|c| c as f32));
    let far = 1e5;
    scene
        .edit(|s| {
            s.camera = Camera {
                far,
                ..Camera::look_at(eye, Vec3::ZERO, Vec3::Y, lens).expect("a view")
            }
        })
        .expect("a scene");
}

/// A ray that goes along a plane, or through a gap, comes out at the other end.
#[test]
fn grazing_rays_get_through() {
    // eye level, on the floor: the floor is a line, and what is above it is the ball
    let front = "show(sphere(0.5).move(y = 0.5))\nshow(plane())\ncamera(eye = (0, 0.75, 8), target = (0, 0.75, 0), lens = orthographic(1.5))";
    for size in [63, 64] {
        let film = stream(&written(front, size));
        let right = std::f64::consts::PI * 0.25 / 2.25;
        assert!((share(&film) - right).abs() < 0.02, "{}", share(&film));
        let corner = &film.plane(Plane::Coverage)[..size as usize / 4];
        assert!(corner.iter().all(|c| *c == 0.0));
    }
    // between two walls, a thousandth apart for each unit of their length
    let gap = "show(box((2, 2, 4)).move(x = 1.002))\nshow(box((2, 2, 4)).move(x = -1.002))\ncamera(eye = (0, 0, 8), target = (0, 0, 0), lens = orthographic(0.016))";
    let film = stream(&written(gap, 32));
    assert!((share(&film) - 0.75).abs() < 0.03, "{}", share(&film));
    // along a floor a hair above it, to a wall at the end
    let along = "show(plane())\nshow(box((20, 20, 1)).move(z = -60))\ncamera(eye = (0, 0.001, 8), target = (0, 0.001, 0), fov = 40)";
    let scene = written(along, 64);
    let film = stream(&scene);
    for y in 20..31 {
        let t = film.plane(Plane::Depth)[y * 64 + 32];
        assert!((60.0..75.0).contains(&t), "row {y}: {t}");
    }
}

/// Whatever the solid and the camera, a ray that starts outside ends where the sign first changes.
#[test]
fn rays_never_begin_behind_a_surface() {
    let mut failures = Vec::new();
    for entry in &catalogue().primitives {
        if entry.info.dimension == Dimension::Two
            || entry.exactness > zeroset_catalogue::bounds::Exactness::Bound
        {
            continue;
        }
        let field = Field::primitive(entry, entry.info.defaults()).expect("defaults fit");
        let mut scene = view([0.0, 0.0, 4.0], [0.0; 3], 0.7);
        scene
            .edit(|s| {
                s.settings = quick();
                s.settings.occlusion = Occlusion::None;
                s.settings.size = [48, 48];
                s.lights.clear();
            })
            .expect("a scene");
        let bounds = field.facts().bounds;
        let reach = if bounds.is_finite() {
            let h = bounds.half();
            h.iter().map(|x| x * x).sum::<f64>().sqrt()
        } else {
            2.0
        };
        let centre = Vec3::from(bounds.centre().map(|c| c as f32));
        scene
            .edit(|s| s.objects.push(object(field.clone(), 0)))
            .expect("a scene");
        for number in 0..5 {
            let h = |k: u32| ((number * 7919 + k * 104_729 + 31) % 2003) as f32 / 1001.5 - 1.0;
            let away = Vec3::new(h(1), h(2) * 0.8 + 0.1, h(3) + 0.05).normalize_or(Vec3::Z);
            let eye = centre + away * reach as f32 * (1.3 + h(4).abs() * 3.0);
            let lens = if number == 4 {
                Lens::Orthographic {
                    height: 2.2 * reach as f32,
                }
            } else {
                Lens::Pinhole { fov: 0.6 }
            };
            let Some(camera) = Camera::look_at(eye, centre, Vec3::Y, lens) else {
                continue;
            };
            let far = 20.0 * reach as f32 + 20.0;
            scene
                .edit(|s| s.camera = Camera { far, ..camera })
                .expect("a scene");
            let bad = behind(&scene);
            if bad > 0 {
                failures.push(format!("{} from {eye}: {bad} pixels", entry.info.name));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Pixels whose depth, with cones, is not where the sign first changes, other than beside silhouettes.
fn behind(scene: &Scene) -> usize {
    let film = stream(scene);
    let renderer = CpuRenderer::new(Some(1)).expect("threads");
    let picture = renderer
        .prepare_scene(scene.clone().into())
        .expect("a program");
    let [width, height] = scene.settings().size;
    let (slope, constant) = scene.camera().pixel_width(height);
    let mut bad = 0;
    let mut point = Point::<F64>::new(picture.program().values());
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let found = f64::from(film.plane(Plane::Depth)[(y * width + x) as usize]);
        if !found.is_finite() || beside_edge(&film, x as usize, y as usize) {
            continue;
        }
        let (o, d) = scene
            .camera()
            .ray(x as f32 + 0.5, y as f32 + 0.5, [width, height]);
        let [o, d] = [o, d].map(|v| v.to_array().map(f64::from));
        let pixel = |t: f64| f64::from(slope) * t + f64::from(constant);
        let least = |t: f64| pixel(t) / 64.0 + 1e-7;
        let mut f = |t: f64| {
            let p: [F64; 3] = std::array::from_fn(|k| F64(o[k] + d[k] * t));
            point.value(v3(p[0], p[1], p[2])).0
        };
        let far = f64::from(scene.camera().far);
        let Some(t) = dense::march(picture.program(), o, d, 0.0, far, least) else {
            // a ray that touches an edge, as far as single precision tells
            bad += usize::from(f(found).abs() > 1e-6);
            continue;
        };
        // on the surface, at the first one but for those that are thinner than the least step, or than single precision tells
        let on = f(found).abs() < 0.05 * pixel(t) + 1e-6 * t;
        let thin = f(t + pixel(t) / 32.0) > 0.0;
        let touch = found < t && f(found) < 1e-6;
        if !on || (found < t - 0.5 * pixel(t) && !touch) || (found > t + 0.5 * pixel(t) && !thin) {
            if std::env::var("ZS_DEBUG").is_ok() {
                eprintln!(
                    "({x}, {y}): {found} instead of {t}, pixel {}, {}",
                    pixel(t),
                    f(found)
                );
            }
            bad += 1;
        }
    }
    bad
}

/// No speck: whatever the marcher, with cones and without, a surface that is seen faces the eye.
#[test]
fn surfaces_face_the_eye() {
    for text in [
        "show(cylinder())",
        "show(box((2, 0.2, 2)))",
        "show(menger())",
        "show(torus())",
    ] {
        let mut scene = written(text, 160);
        for march in [
            March::Sphere,
            March::Relaxed { omega: 1.4 },
            March::Auto { beta: 0.3 },
        ] {
            for prepass in [true, false] {
                scene
                    .edit(|s| (s.settings.march, s.settings.prepass) = (march, prepass))
                    .expect("a scene");
                let film = stream(&scene);
                let mut away = 0;
                for (i, n) in film.plane(Plane::Normal).chunks(3).enumerate() {
                    let (x, y) = (i % 160, i / 160);
                    let (_, d) = scene
                        .camera()
                        .ray(x as f32 + 0.5, y as f32 + 0.5, [160, 160]);
                    away += u32::from(Vec3::from_slice(n).dot(d) > 0.01);
                }
                assert_eq!(away, 0, "{text} {march:?} {prepass}");
            }
        }
    }
}

/// The inside of a solid is shown, and lit.
#[test]
fn the_inside_is_seen() {
    let mut scene = view([0.1, 0.2, 0.1], [1.0, 0.4, -0.3], 1.2);
    scene
        .edit(|s| s.objects.push(object(shape("box", &[2.0, 2.0, 2.0]), 0)))
        .expect("a scene");
    let film = stream(&scene);
    assert_eq!(share(&film), 1.0);
    let colours = film.plane(Plane::Colour);
    let mean = colours.iter().sum::<f32>() / colours.len() as f32;
    assert!(mean > 0.1, "{mean}");
}

/// A model and its camera scaled together give the same picture.
#[test]
fn scale_does_not_matter() {
    let text = |k: f64| {
        format!(
            "show(sphere({}).move(y = {}) | box(({}, {}, {})).move(x = {}))\nshow(plane())",
            0.8 * k,
            0.8 * k,
            0.5 * k,
            0.6 * k,
            0.7 * k,
            1.2 * k
        )
    };
    let right = stream(&written(&text(1.0), 64));
    for k in [1e-6, 1e-3, 1e3, 1e6] {
        let film = stream(&written(&text(k), 64));
        let off = (film.plane(Plane::Colour).iter())
            .zip(right.plane(Plane::Colour))
            .filter(|(a, b)| (*a - *b).abs() > 0.02)
            .count();
        assert!(off < 3 * 64 * 64 / 100, "{k}: {off} numbers differ");
    }
}

/// A constant that a field is divided by changes how rays step, and nothing that is shown.
#[test]
fn a_stated_slope_changes_no_light() {
    let picture = |shape: &str| {
        let text = format!(
            "show({shape}.move(y = 1))\nshow(plane())\nsun(direction = (-1, -2, -1), shadow = soft(8))\ncamera(eye = (2, 3, 5), target = (0, 0.8, 0), fov = 40)"
        );
        let mut scene = written(&text, 64);
        scene
            .edit(|s| s.settings.occlusion = zeroset_scene::settings::Settings::default().occlusion)
            .expect("a scene");
        stream(&scene)
    };
    let right = picture("sphere(1)");
    let formula = |slope: &str| format!("field(lambda p: length(p) - 1, size = 4{slope})");
    for shape in [formula(""), formula(", slope = 5"), formula(", slope = 30")] {
        let film = picture(&shape);
        for plane in [Plane::Occlusion, Plane::Shadow, Plane::Colour] {
            let (a, b) = (film.plane(plane), right.plane(plane));
            let off = a
                .iter()
                .zip(b)
                .map(|(x, y)| f64::from((x - y).abs()))
                .sum::<f64>();
            let mean = off / a.len() as f64;
            eprintln!("{shape} {plane:?}: {mean}");
            assert!(
                mean < 0.02,
                "{shape}: {plane:?} is off by {mean} in the mean"
            );
        }
    }
}

/// A hole is the same whether its cutter ends where it leaves the solid or sticks out. Ending there it leaves skins, which no
/// shadow and no occlusion may see.
#[test]
fn light_falls_through_skins() {
    for (name, solid, ends, sticks_out) in [
        (
            "a tube",
            "(cylinder(1, 2) - CUTTER).move(y = 1)",
            "cylinder(0.5, 2)",
            "cylinder(0.5, 2.6)",
        ),
        (
            "a turned tube",
            "(cylinder(1, 2) - CUTTER).turn(x = 25, z = 50).move(y = 1.3)",
            "cylinder(0.5, 2)",
            "cylinder(0.5, 2.6)",
        ),
        (
            "a window",
            "(box((3, 2, 0.4)) - CUTTER).turn(y = 20).move(y = 1)",
            "box((1.6, 1.2, 0.4))",
            "box((1.6, 1.2, 1))",
        ),
    ] {
        for shadow in ["soft(8)", "soft_closest(8)", "hard()"] {
            let film = |cutter: &str| {
                let mut scene = written(
                    &format!(
                        "show({})\nshow(plane())\ncamera(eye = (1.5, 4.5, 4), target = (0, 1, 0), fov = 40)\n\
                         sun(direction = (-0.3, -1, -0.6), shadow = {shadow})",
                        solid.replace("CUTTER", cutter)
                    ),
                    96,
                );
                scene
                    .edit(|s| {
                        s.settings.occlusion = Occlusion::Cones {
                            reach: None,
                            steps: 14,
                        }
                    })
                    .expect("a scene");
                stream(&scene)
            };
            let (skin, open) = (film(ends), film(sticks_out));
            for plane in [Plane::Shadow, Plane::Occlusion] {
                let mut off: Vec<f32> = (0..96 * 96)
                    .filter(|i| !beside_edge(&open, i % 96, i / 96))
                    .map(|i| (skin.plane(plane)[i] - open.plane(plane)[i]).abs())
                    .collect();
                off.sort_by(f32::total_cmp);
                let mean = off.iter().sum::<f32>() / off.len() as f32;
                println!(
                    "{name}, {shadow}: {plane:?} {mean} {}",
                    off[off.len() * 99 / 100]
                );
                // what a cone sees beside the rim of its hole is not the same
                let most = if plane == Plane::Shadow { 0.005 } else { 0.02 };
                assert!(mean < most, "{name}, {shadow}: {plane:?} differs by {mean}");
            }
        }
    }
}
