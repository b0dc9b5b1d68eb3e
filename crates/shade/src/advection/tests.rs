use super::*;
use zeroset_language::load::{Language, Options, load_text};

fn scene(text: &str) -> Scene {
    let options = Options::default();
    load_text("test.star", text, Language::Starlark, None, &options)
        .unwrap_or_else(|e| panic!("{}", e.report))
        .scene
}

fn program(scene: &Scene) -> Program {
    let field = scene.field().unwrap().unwrap();
    Program::compile(&field, &Default::default()).unwrap()
}

fn volume(text: &str) -> Arc<LightVolume> {
    let scene = scene(text);
    LightVolume::renewed(None, &scene, &program(&scene))
        .unwrap()
        .unwrap()
}

/// What is left at a node of the first grid.
fn left(volume: &LightVolume, [i, j, k]: [u32; 3]) -> f64 {
    let [nx, ny, _] = volume.extent.nodes(0);
    f64::from(volume.data.grids[0].values()[((k * ny + j) * nx + i) as usize])
}

fn flow(source: Source, p: [f32; 3]) -> Flow {
    let lamp = Lamp::of(&Light {
        source,
        radiance: glam::Vec3::ONE,
        shadow: Shadow::None,
    });
    Flow::of(&source, lamp.as_ref(), v3(p[0], p[1], p[2]))
}

/// Inverse squares away from a point. A sphere sends along its axis what a point does (its flux through spheres around it is the same), and
/// together what the solid angle under which it is seen says.
#[test]
fn flow_is_that_of_points_and_spheres() {
    let position = glam::vec3(0.3, -0.2, 0.5);
    for p in [[1.0f32, 2.0, 3.0], [0.3, -1.4, 0.5], [-2.0, 0.1, 0.4]] {
        let away = glam::Vec3::from(p) - position;
        let right = away.normalize() / away.length_squared();
        let point = flow(Source::Point { position }, p);
        assert!(glam::Vec3::from(point.flux.array()).distance(right) < 1e-5);
        assert!((point.fluence - right.length()).abs() < 1e-5);
        for radius in [0.01f32, 0.4, 0.9] {
            let sphere = flow(
                Source::Sphere {
                    position,
                    radius,
                    visible: true,
                },
                p,
            );
            assert!(glam::Vec3::from(sphere.flux.array()).distance(right) < 1e-5);
            let sine = f64::from(radius / away.length());
            let solid = std::f64::consts::TAU * (1.0 - (1.0 - sine * sine).sqrt());
            // its radiance times that
            let all = solid / (std::f64::consts::PI * f64::from(radius).powi(2));
            assert!(
                (f64::from(sphere.fluence) / all - 1.0).abs() < 1e-4,
                "{radius}"
            );
        }
    }
}

/// A small sheet is a point that shines by the cosine law, to one side; near a large one light comes from many sides.
#[test]
fn flow_of_sheets_is_that_of_their_places() {
    let sheet = |half: f32| Source::Rectangle {
        position: glam::Vec3::ZERO,
        right: glam::Vec3::X * half,
        up: glam::Vec3::Y * half,
        visible: true,
    };
    let small = flow(sheet(1e-3), [1.0, 2.0, 2.0]);
    assert!((small.fluence - 2.0 / 27.0).abs() < 1e-5, "{small:?}");
    assert!((small.flux.z - 4.0 / 81.0).abs() < 1e-5, "{small:?}");
    assert_eq!(flow(sheet(1e-3), [1.0, 2.0, -2.0]).fluence, 0.0);
    let near = flow(sheet(1.0), [0.0, 0.0, 0.3]);
    assert!(near.flux.length() < 0.8 * near.fluence);
    assert!(near.flux.x.abs() < 1e-5 && near.flux.y.abs() < 1e-5);
}

#[test]
fn light_comes_in_where_its_way_does() {
    let cells = v3(4.0, 8.0, 6.0f32);
    let found = |p: [f32; 3], d: [f32; 3]| entry(v3(p[0], p[1], p[2]), v3(d[0], d[1], d[2]), cells);
    assert_eq!(found([1.0, 1.0, 1.0], [0.6, 0.8, 0.0]), 0.0);
    assert_eq!(found([-3.0, 1.0, 1.0], [1.0, 0.0, 0.0]), 3.0);
    assert!((found([-3.0, -4.0, 1.0], [0.6, 0.8, 0.0]) - 5.0).abs() < 1e-5);
    assert!(found([-3.0, 1.0, 1.0], [-1.0, 0.0, 0.0]) < 0.0);
    assert!(found([-3.0, 9.0, 1.0], [1.0, 0.0, 0.0]) < 0.0);
}

/// What is flat takes nothing of light that comes from its front, from whichever side, however it is blurred,
/// as far before it as light is read: light that nearly grazes it is blurred into voxels that are solid in part, and these take a little.
#[test]
fn floors_throw_no_shadow_on_themselves() {
    for light in [
        "sun(direction = (0, -1, 0), shadow = advected(resolution = 32, spread = 1))",
        "sun(direction = (3, -1, 0.5), shadow = advected(resolution = 32, spread = 0.5))",
        "point_light(position = (0.2, 0.7, 0.1), shadow = advected(resolution = 32))",
        "sphere_light(position = (3, 2, 0.1), radius = 0.5, shadow = advected(resolution = 32))",
    ] {
        let volume = volume(&format!(
            "show(plane())\nshow(box(2).move(y = -1.2))\n{light}"
        ));
        let Extent { origin, voxel, .. } = volume.extent;
        let [nx, ny, nz] = volume.extent.nodes(0);
        for n in 0..nx * ny * nz {
            let node = [n % nx, n / nx % ny, n / nx / ny];
            if origin[1] + voxel * node[1] as f32 > 2.0 * voxel {
                let left = left(&volume, node);
                assert!(left > 0.99, "{light} {node:?}: {left}");
            }
        }
    }
}

/// What a ball takes of the light goes on along the shadow: blurred, not less and not more.
#[test]
fn shadows_keep_what_is_missing() {
    let volume = volume(
        "show(sphere(0.5).move(y = 2))\nshow(sphere(0.01))\nsun(direction = (0, -1, 0), shadow = advected(resolution = 80, spread = 0.6))",
    );
    let Extent { origin, voxel, .. } = volume.extent;
    let [nx, ny, nz] = volume.extent.nodes(0);
    let missing = |j: u32| -> f64 {
        let all = (0..nx * nz).map(|n| 1.0 - left(&volume, [n % nx, j, n / nx]));
        all.sum::<f64>() * f64::from(voxel).powi(2)
    };
    let level = |y: f32| ((y - origin[1]) / voxel).round() as u32;
    let (near, far) = (missing(level(1.3)), missing(level(0.7)));
    assert!((far / near - 1.0).abs() < 0.01, "{far} after {near}");
    // voxels that are solid in part count as solid
    let area = |r: f64| std::f64::consts::PI * r * r;
    let voxel = f64::from(voxel);
    assert!(near > area(0.5) && near < area(0.5 + voxel), "{near}");
    assert!(ny > 64);
}

/// The same from the left and from the right.
#[test]
fn mirrored_scenes_have_mirrored_shadows() {
    let text = |side: i32| {
        format!(
            "show(sphere(0.5).move(x = {}, y = 0.9))\nshow(box((2, 0.2, 1)))\nsphere_light(position = ({}, 2, 0.3), radius = 0.2, shadow = advected(resolution = 40))",
            0.3 * f64::from(side),
            0.9 * f64::from(side)
        )
    };
    let (one, other) = (volume(&text(1)), volume(&text(-1)));
    let [nx, ny, nz] = one.extent.nodes(0);
    let mut dark = 0;
    for n in 0..nx * ny * nz {
        let [i, j, k] = [n % nx, n / nx % ny, n / nx / ny];
        let (a, b) = (left(&one, [i, j, k]), left(&other, [nx - 1 - i, j, k]));
        // where the whole changes by less than the limit, either may have gone on
        assert!((a - b).abs() < 2e-3, "{i} {j} {k}: {a} {b}");
        dark += usize::from(a < 0.5);
    }
    assert!(dark > 1000);
}

/// What makes no difference to light leaves its volume; a lamp that moves does not.
#[test]
fn volumes_are_kept_while_light_stays() {
    let text = |x: f32, bias: f32, more: &str| {
        format!(
            "show(sphere(1))\nsun(shadow = hard())\npoint_light(position = ({x}, 3, 0), shadow = advected(resolution = 16, bias = {bias})){more}"
        )
    };
    let first = scene(&text(1.0, 2.0, ""));
    let made = LightVolume::renewed(None, &first, &program(&first))
        .unwrap()
        .unwrap();
    assert!(made.readings[0].is_none() && made.readings[1].is_some());
    let renewed = |text: &str| {
        let scene = scene(text);
        LightVolume::renewed(Some(&made), &scene, &program(&scene)).unwrap()
    };
    let same = renewed(&text(1.0, 1.0, "")).unwrap();
    assert!(Arc::ptr_eq(&same.data.grids[0], &made.data.grids[0]));
    assert_eq!(same.readings[1].unwrap().before, same.extent.voxel);
    let moved = renewed(&text(1.5, 2.0, "")).unwrap();
    assert!(!Arc::ptr_eq(&moved.data.grids[0], &made.data.grids[0]));
    assert!(renewed(&text(1.0, 2.0, "\nrender(integrator = path())")).is_none());
    assert!(renewed("show(sphere(1))").is_none());
}
