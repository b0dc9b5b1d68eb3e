//! One suite that holds all renderers together: every scene of `scenes/` on the plain renderer, the SIMD renderer and the
//! GPU, every method on both, and planted faults that must turn it red.
//!
//! The GPU's part runs on any adapter, software included, and says why it did not run where there is none.

use std::path::Path;
use zeroset::gpu::{GpuRenderer, Job, testing};
use zeroset::language::load::{Language, Options, load, load_text};
use zeroset::scene::accumulator::Accumulator;
use zeroset::scene::film::{Film, Plane};
use zeroset::scene::methods::{Choice, Kind, Param, Value};
use zeroset::scene::render::{Renderer, Silent};
use zeroset::scene::scene::{Scene, SceneParts};
use zeroset::scene::settings::{
    Antialias, Filter, Integrator, March, Normals, Occlusion, Settings, Shading, Shadow,
};
use zeroset::shader::FieldForm;
use zeroset::trace::CpuRenderer;
use zeroset_testkit::conform::{BUDGETS, Budget, Difference, compare, differing};
use zeroset_testkit::plain::{self, Compiled, Quality};
use zeroset_testkit::scenes;

#[path = "conformance/grids.rs"]
mod grids;
#[path = "conformance/images.rs"]
mod images;
#[path = "conformance/large.rs"]
mod large;
#[path = "conformance/lights.rs"]
mod lights;

const SIZE: [u32; 2] = [96, 72];

/// Every scene that shows something, with one ray through the middle of every pixel.
fn every_scene() -> Vec<(String, Scene)> {
    let all = scenes::all().into_iter();
    all.map(|path| (scenes::name(&path), scene(&path)))
        .collect()
}

fn scene(path: &Path) -> Scene {
    let options = Options {
        size: Some(SIZE),
        ..Options::default()
    };
    let mut scene = load(path, &options)
        .unwrap_or_else(|e| panic!("{}: {e}", path.display()))
        .scene;
    scene
        .edit(|s| s.settings.antialias = Antialias::None)
        .expect("a scene");
    let picture = CpuRenderer::new(None)
        .unwrap()
        .prepare_scene(scene.clone().into())
        .expect("a program");
    if picture.program().is_fractal() {
        // rays end anywhere under the footprint: these steps put them where the value is the footprint
        scene
            .edit(|s| s.settings.discontinuity_reduction = 16)
            .expect("a scene");
    }
    scene
}

fn hello() -> Scene {
    scene(&scenes::folder().join("hello.star"))
}

fn on(renderer: &dyn Renderer, scene: &Scene) -> Film {
    renderer.render(scene, &Silent).expect("a picture").film
}

/// What a job that was tampered with shows of its scene.
fn film_of(gpu: &GpuRenderer, scene: &Scene, job: &Job) -> Film {
    let mut sums = Accumulator::new(SIZE, scene.settings().antialias, &Plane::ALL);
    let samples = 0..sums.wanted();
    gpu.sample(job, samples, &mut sums, &Silent)
        .expect("a picture");
    sums.into_film()
}

fn reference(scene: &Scene) -> Film {
    let renderer = CpuRenderer::new(None).unwrap();
    let picture = renderer
        .prepare_scene(scene.clone().into())
        .expect("a program");
    let program = picture.program();
    plain::render(scene, &Quality::of(program, scene), || {
        Compiled::new(program, None)
    })
}

/// Share of a plane that may differ in any scene.
const MOST: f64 = 0.03;

/// How much a plane changes where every ray stops a twentieth of a pixel earlier. Fractals, noise and far cities have detail
/// finer than a pixel: what is seen of it hangs on the last bits of a hit, in any renderer.
fn restless(scene: &Scene) -> impl Fn(&Budget) -> f64 {
    let mut nearer = scene.clone();
    nearer
        .edit(|s| s.settings.footprint *= 0.9)
        .expect("a scene");
    let renderer = CpuRenderer::new(None).unwrap();
    let (a, b, scene) = (on(&renderer, scene), on(&renderer, &nearer), scene.clone());
    move |budget| compare(&scene, &b, &a, budget).share
}

/// What differs by more than is allowed, with the scene's name; nothing if all is well.
fn check(name: &str, scene: &Scene, film: &Film, reference: &Film) -> Option<String> {
    let restless = restless(scene);
    let budgets = BUDGETS.map(|budget| Budget {
        share: (budget.share + 2.0 * restless(&budget)).min(MOST),
        ..budget
    });
    let off = differing(scene, film, reference, &budgets);
    let line = |d: &Difference| format!("{:?} {:.4} (mean {:.4})", d.plane, d.share, d.mean);
    let off: Vec<String> = off.iter().map(line).collect();
    (!off.is_empty()).then(|| format!("{name}: {}", off.join(", ")))
}

#[track_caller]
fn none(failures: Vec<String>) {
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}

#[test]
fn the_simd_renderer_shows_every_scene_as_the_plain_one() {
    let renderer = CpuRenderer::new(None).unwrap();
    let all = every_scene().into_iter().filter_map(|(name, scene)| {
        check(&name, &scene, &on(&renderer, &scene), &reference(&scene))
    });
    none(all.collect());
}

#[test]
fn the_gpu_shows_every_scene_as_the_simd_renderer() {
    let Some(gpu) = testing::renderer("scenes on the GPU") else {
        return;
    };
    let renderer = CpuRenderer::new(None).unwrap();
    let all = every_scene().into_iter().filter_map(|(name, scene)| {
        check(&name, &scene, &on(&gpu, &scene), &on(&renderer, &scene))
    });
    none(all.collect());
}

#[test]
fn an_interpreted_field_is_the_compiled_one() {
    let Some(gpu) = testing::renderer("interpreted fields") else {
        return;
    };
    let gpu = gpu.with_form(FieldForm::Interpreted);
    let renderer = CpuRenderer::new(None).unwrap();
    let few = [
        "hello",
        "papers/keinert_city",
        "gallery/joins",
        "gallery/julia",
    ];
    let all = every_scene()
        .into_iter()
        .filter(|(name, _)| few.contains(&name.as_str()))
        .filter_map(|(name, scene)| {
            check(&name, &scene, &on(&gpu, &scene), &on(&renderer, &scene))
        });
    none(all.collect());
}

/// All methods of a kind as they are by default, and where they have numbers, once more with others.
fn variants<T: Choice>() -> Vec<T> {
    let each = |&base: &T| {
        let mut other = base;
        for param in base.method().params {
            other.set(param.name, another(param)).expect("a value");
        }
        [Some(base), (other != base).then_some(other)]
    };
    T::all().iter().flat_map(each).flatten().collect()
}

/// The middle of what is usual, or the last word.
fn another(param: &Param) -> Value {
    let (low, high) = param.usual;
    let middle = if param.is_logarithmic {
        (low * high).sqrt()
    } else {
        0.5 * (low + high)
    };
    match param.kind {
        Kind::Real | Kind::Limit => param.value(middle).expect("a number"),
        Kind::Whole => param.value(middle.round()).expect("a whole number"),
        Kind::Word(methods) => Value::Word(methods.len() - 1),
    }
}

/// Every method that a scene can choose.
fn methods() -> Vec<(String, Scene)> {
    let base = hello();
    let mut all = Vec::new();
    let mut with = |edit: &dyn Fn(&mut SceneParts)| {
        let mut scene = base.clone();
        scene.edit(edit).expect("a scene");
        let (s, l) = (scene.settings(), scene.lights()[0].shadow);
        let name = format!(
            "{:?} {:?} {:?} {:?} {:?} {l:?}",
            s.march, s.normals, s.shading, s.integrator, s.occlusion
        );
        all.push((name, scene));
    };
    for march in variants::<March>() {
        with(&|s| {
            (s.settings.march, s.settings.max_steps) = (march, 2000);
        });
    }
    for normals in variants::<Normals>() {
        with(&|s| s.settings.normals = normals);
    }
    for shading in variants::<Shading>() {
        with(&|s| s.settings.shading = shading);
    }
    for integrator in variants::<Integrator>() {
        with(&|s| s.settings.integrator = integrator);
    }
    for shadow in variants::<Shadow>() {
        with(&|s| s.lights.iter_mut().for_each(|l| l.shadow = shadow));
    }
    for occlusion in variants::<Occlusion>() {
        with(&|s| s.settings.occlusion = occlusion);
        with(&|s| s.objects[0].occlusion = Some(occlusion));
    }
    with(&|s| s.settings.prepass = false);
    with(&|s| s.settings.discontinuity_reduction = 0);
    with(&|s| s.settings.hit_selection = false);
    // without cones: rays that run out of steps stop where they are. (With hit selection they are not compared: the CPU searches
    // the rest of them, the GPU has no ranges to do so.)
    with(&|s| {
        (s.settings.max_steps, s.settings.prepass) = (12, false);
        s.settings.hit_selection = false;
    });
    all
}

#[test]
fn the_gpu_has_every_method() {
    let Some(gpu) = testing::renderer("methods on the GPU") else {
        return;
    };
    let renderer = CpuRenderer::new(None).unwrap();
    let all = methods().into_iter().filter_map(|(name, scene)| {
        // without cones the GPU starts each ray by itself, as the plain renderer does
        let right = if scene.settings().prepass {
            on(&renderer, &scene)
        } else {
            reference(&scene)
        };
        check(&name, &scene, &on(&gpu, &scene), &right)
    });
    none(all.collect());
}

#[test]
fn the_gpu_filters_as_the_cpu() {
    let Some(gpu) = testing::renderer("filters on the GPU") else {
        return;
    };
    let renderer = CpuRenderer::new(None).unwrap();
    for filter in Filter::ALL {
        let mut scene = hello();
        scene
            .edit(|s| s.settings.antialias = Antialias::Supersample { samples: 5, filter })
            .expect("a scene");
        // here everything counts: silhouettes are what filters are for
        let (a, b) = (on(&gpu, &scene), on(&renderer, &scene));
        for plane in [Plane::Colour, Plane::Coverage] {
            let pairs = a.plane(plane).iter().zip(b.plane(plane));
            let square: f32 = pairs.map(|(x, y)| (x - y) * (x - y)).sum();
            let rms = (square / a.plane(plane).len() as f32).sqrt();
            assert!(rms < 0.01, "{filter:?} {plane:?}: {rms}");
        }
    }
}

/// Light through holes whose cutters end where they leave the solid.
#[test]
fn skins_are_passed_alike() {
    let text = "
show((cylinder(1, 2) - cylinder(0.5, 2)).move(y = 1))
show((box((3, 2, 0.4)) - box((1.6, 1.2, 0.4))).turn(y = 20).move((-0.5, 1, -2)))
show(plane())
camera(eye = (1.5, 4.5, 4), target = (0, 0.8, -0.5), fov = 45)
sun(direction = (-0.3, -1, -0.6), shadow = soft(8))
point_light(position = (2, 3, 1), shadow = soft_closest(6))
";
    let options = Options {
        size: Some(SIZE),
        ..Options::default()
    };
    let mut scene = load_text("skins.star", text, Language::Starlark, None, &options)
        .unwrap_or_else(|e| panic!("{}", e.report))
        .scene;
    scene
        .edit(|s| s.settings.antialias = Antialias::None)
        .expect("a scene");
    let film = on(&CpuRenderer::new(None).unwrap(), &scene);
    none(
        check("skins", &scene, &film, &reference(&scene))
            .into_iter()
            .collect(),
    );
    let Some(gpu) = testing::renderer("skins on the GPU") else {
        return;
    };
    none(
        check("skins", &scene, &on(&gpu, &scene), &film)
            .into_iter()
            .collect(),
    );
}

/// A wall on a floor, white, under a sky that is as bright as high up it is: nothing else lights them.
fn wall() -> Scene {
    let text = "
show(box((1, 8, 16)).move((-0.5, 4, 0)), material(color = \"white\"))
show(plane(), material(color = \"white\"))
camera(eye = (3, 1.2, 0), target = (0, 0.5, 0), fov = 40)
";
    let options = Options {
        size: Some(SIZE),
        ..Options::default()
    };
    let mut scene = load_text("wall.star", text, Language::Starlark, None, &options)
        .unwrap_or_else(|e| panic!("{}", e.report))
        .scene;
    scene
        .edit(|s| {
            s.settings.antialias = Antialias::None;
            s.settings.shading = Shading::Lambert;
            s.lights.clear();
            (s.sky.top, s.sky.ambient) = ([1.0; 3].into(), 1.0);
            (s.sky.horizon, s.sky.bottom) = ([0.0; 3].into(), [0.0; 3].into());
        })
        .expect("a scene");
    scene
}

/// The height of a normal whose surface gets this share of the light of the sky of [`wall`], which is `1.1225 y^2 / (y^2 + 0.1225)` at the
/// height y above the horizon: found by halving, the share by summing up over the hemisphere by the cosine law.
fn height_of(share: f32) -> f32 {
    let share_of = |height: f64| {
        let (mut sum, mut all) = (0.0, 0.0);
        for i in 0..100 {
            let y = (f64::from(i) + 0.5) / 50.0 - 1.0;
            for k in 0..100 {
                let phi = (f64::from(k) + 0.5) / 100.0 * std::f64::consts::TAU;
                let r = (1.0 - y * y).sqrt();
                let cosine = ((1.0 - height * height).sqrt() * r * phi.cos() + height * y).max(0.0);
                sum += if y > 0.0 {
                    cosine * 1.1225 * y * y / (y * y + 0.1225)
                } else {
                    0.0
                };
                all += cosine;
            }
        }
        sum / all
    };
    let (mut low, mut high) = (-1.0, 1.0);
    for _ in 0..20 {
        let middle = 0.5 * (low + high);
        if share_of(middle) < f64::from(share) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low as f32
}

/// At the foot of a wall a quarter of all directions is open. Weighted by the cosine to the wall's normal x, the mean of them
/// has the direction (integral of x x, integral of x y) = (pi / 3, 2 / 3): its height is 0.537, where the normal's is 0.
#[test]
fn the_light_at_the_foot_of_a_wall_comes_from_the_open_side() {
    let scene = wall();
    let heights = |film: &Film| -> Vec<f32> {
        let [width, height] = SIZE.map(|n| n as usize);
        let column = width / 2;
        let foot = (0..height).rev().map(|y| y * width + column);
        let at = |plane: Plane, i: usize| film.plane(plane)[plane.channels() * i];
        foot.filter(|i| at(Plane::Object, *i) == 1.0)
            .map(|i| {
                height_of(at(Plane::Colour, i) / (at(Plane::Albedo, i) * at(Plane::Occlusion, i)))
            })
            .collect()
    };
    let by_cpu = heights(&on(&CpuRenderer::new(None).unwrap(), &scene));
    println!("{by_cpu:?}");
    // the lowest pixels of the wall
    assert!((by_cpu[1] - 0.537).abs() < 0.2, "{by_cpu:?}");
    let Some(gpu) = testing::renderer("the foot of a wall on the GPU") else {
        return;
    };
    let by_gpu = heights(&on(&gpu, &scene));
    assert!((by_gpu[1] - 0.537).abs() < 0.2, "{by_gpu:?}");
}

/// Faults in the text of a shader, each of which must be noticed in a plane.
const FAULTS: [(&str, &str, &str, Plane); 10] = [
    (
        "rays that stop too early",
        "return Found(true, bracket_root(part), 0.0, side, steps - refined, refined);",
        "return Found(true, bracket_root(part) - 0.05, 0.0, side, steps - refined, refined);",
        Plane::Depth,
    ),
    (
        "a camera that is off by half a pixel",
        "vec2f(pixel) + within",
        "vec2f(pixel) + within + 0.5",
        Plane::Normal,
    ),
    (
        "normals inside out",
        "* found.side;",
        "* -found.side;",
        Plane::Normal,
    ),
    (
        "shadows that start too late",
        "const SECONDARY_FIRST: f32 = 2.0f;",
        "const SECONDARY_FIRST: f32 = 200.0f;",
        Plane::Shadow,
    ),
    (
        "cones that find less room than there is",
        "cone_clear(sine)",
        "cone_clear(0.6 * sine)",
        Plane::Occlusion,
    ),
    (
        "a sky that is dark",
        "return frame.ambient;",
        "return 0.5 * frame.ambient;",
        Plane::Colour,
    ),
    (
        "materials that are mixed up",
        "which * MATERIAL_ROWS",
        "0u * which",
        Plane::Albedo,
    ),
    (
        "objects that are counted from one",
        "marks.object + 1.0",
        "marks.object + 2.0",
        Plane::Object,
    ),
    (
        "bent normals that are ignored",
        "seen.open, seen.tint, seen.bent,",
        "seen.open, seen.tint, at.normal,",
        Plane::Colour,
    ),
    (
        "residuals that are not measured",
        "abs(residual)",
        "abs(residual) + 2.0 * pixel_here",
        Plane::Residual,
    ),
];

#[test]
fn planted_faults_are_noticed() {
    let Some(gpu) = testing::renderer("planted faults") else {
        return;
    };
    let cpu = CpuRenderer::new(None).unwrap();
    let scenes = [hello(), wall()].map(|scene| {
        let right = on(&cpu, &scene);
        (scene, right)
    });
    let draw = |gpu: &GpuRenderer, scene: &Scene, from: &str, to: &str| {
        let mut job = gpu.job(scene).expect("a job");
        assert!(job.source.contains(from), "no `{from}` in the shader");
        job.source = job.source.replace(from, to).into();
        film_of(gpu, scene, &job)
    };
    for (what, from, to, plane) in FAULTS {
        // light from everywhere shows by itself on the wall only
        let (scene, right) = &scenes[usize::from(what.contains("bent"))];
        let off = differing(scene, &draw(&gpu, scene, from, to), right, &BUDGETS);
        assert!(
            off.iter().any(|d| d.plane == plane),
            "{what} went unnoticed: {off:?}"
        );
        none(
            check(
                "the same without the fault",
                scene,
                &draw(&gpu, scene, from, from),
                right,
            )
            .into_iter()
            .collect(),
        );
    }
}

#[test]
fn steps_are_counted_alike() {
    let Some(gpu) = testing::renderer("steps on the GPU") else {
        return;
    };
    let mut scene = hello();
    // without cones both start each ray by itself
    scene
        .edit(|s| {
            s.settings = Settings {
                prepass: false,
                ..s.settings
            }
        })
        .expect("a scene");
    let (a, b) = (on(&gpu, &scene), reference(&scene));
    let budget = Budget {
        plane: Plane::Steps,
        tolerance: 4.0,
        share: 0.02,
    };
    let found = compare(&scene, &a, &b, &budget);
    assert!(found.share <= budget.share && found.mean < 1.0, "{found:?}");
}

#[test]
fn pixels_are_parted_alike() {
    let gpu = testing::renderer("coverage on the GPU");
    let renderer = CpuRenderer::new(None).unwrap();
    for (name, layers) in [
        ("hello.star", 4),
        ("papers/tomczak_sphere_ground_1.star", 8),
        ("papers/keinert_dodecahedron.star", 1),
    ] {
        let mut scene = scene(&scenes::folder().join(name));
        let coverage = Antialias::Coverage { layers };
        scene
            .edit(|s| s.settings.antialias = coverage)
            .expect("a scene");
        let film = on(&renderer, &scene);
        let rms = |other: &Film, plane: Plane| {
            let pairs = film.plane(plane).iter().zip(other.plane(plane));
            let square: f32 = pairs.map(|(x, y)| (x.min(1.0) - y.min(1.0)).powi(2)).sum();
            (square / film.plane(plane).len() as f32).sqrt()
        };
        // what is covered, by counting rays, which need no light for that
        let mut dark = scene.clone();
        let edit = |s: &mut SceneParts| {
            s.settings.occlusion = Occlusion::None;
            s.settings.integrator = Integrator::Direct;
            s.lights.clear();
        };
        dark.edit(edit).expect("a scene");
        let counted = rms(&reference(&dark), Plane::Coverage);
        assert!(counted < 0.01, "{name}: {counted} from what rays say");
        let Some(gpu) = &gpu else { continue };
        let other = on(gpu, &scene);
        for plane in [Plane::Colour, Plane::Coverage, Plane::Normal] {
            let off = rms(&other, plane);
            assert!(off < 0.01, "{name} {plane:?}: {off} on the GPU");
        }
    }
}
