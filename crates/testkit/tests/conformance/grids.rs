//! Fields of samples: every renderer shows the same of a grid, and what it was sampled from.

use crate::{SIZE, check, film_of, none, on, reference};
use std::sync::Arc;
use zeroset::catalogue::bounds::Aabb;
use zeroset::eval::Evaluator;
use zeroset::field::field::Field;
use zeroset::field::placement::Placement;
use zeroset::field::program::{Limits, Program};
use zeroset::field::sampled::Sampled;
use zeroset::gpu::{Job, testing};
use zeroset::language::load::{Language, Options, load_text};
use zeroset::number::Grid;
use zeroset::scene::film::Plane;
use zeroset::scene::scene::Scene;
use zeroset::scene::settings::{Antialias, Normals};
use zeroset::shader::FieldForm;
use zeroset::trace::CpuRenderer;
use zeroset_testkit::conform::{BUDGETS, Budget, differing};

/// Nodes along an axis.
const NODES: u32 = 33;
/// The box's largest coordinate.
const REACH: f64 = 1.5;

/// The samples of a field.
fn samples(field: &Field) -> Sampled {
    let program = Program::compile(field, &Limits::default()).expect("a program");
    let at = |i: u32| (REACH * (2.0 * f64::from(i) / f64::from(NODES - 1) - 1.0)) as f32;
    let points: Vec<glam::Vec3> = (0..NODES)
        .flat_map(|k| (0..NODES).flat_map(move |j| (0..NODES).map(move |i| [i, j, k])))
        .map(|node| node.map(at).into())
        .collect();
    let mut values = vec![0.0; points.len()];
    Evaluator::new(program.values())
        .values(&points, &mut values)
        .expect("a value a point");
    let grid = Arc::new(Grid::new([NODES; 3], values).expect("a grid"));
    Sampled::new(grid, Aabb::centred([REACH; 3])).expect("a box")
}

/// A sphere and a torus on a floor, with shadows and occlusion.
fn analytic() -> Scene {
    let text = "
show(sphere(1).move((-1.2, 1, 0)), material(color = \"gold\"))
show(torus(radius = 0.9, tube = 0.35).turn(x = 60).move((1.4, 1.1, 0.2)), material(color = \"navy\"))
show(plane(), material(color = \"white\"))
camera(eye = (0.5, 3, 5.5), target = (0.1, 0.8, 0), fov = 45)
sun(direction = (-1, -1.6, -0.7), shadow = soft(12))
";
    let options = Options {
        size: Some(SIZE),
        ..Options::default()
    };
    let mut scene = load_text("grids.star", text, Language::Starlark, None, &options)
        .unwrap_or_else(|e| panic!("{}", e.report))
        .scene;
    scene
        .edit(|s| s.settings.antialias = Antialias::None)
        .expect("a scene");
    scene
}

/// The same of grids: what stands on the floor is sampled about the middle of its box.
fn of_grids(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene
        .edit(|s| {
            for object in &mut s.objects[..2] {
                let bounds = object.field.facts().bounds;
                let there = Placement::moved(bounds.centre());
                let back = Placement::moved(bounds.centre().map(|c| -c));
                let centred = object.field.place(back).expect("a field");
                let grid = Field::sampled(Arc::new(samples(&centred)));
                object.field = grid.place(there).expect("a field");
            }
        })
        .expect("a scene");
    scene
}

/// What interpolation between nodes this far apart may change: normals jump from cell to cell.
fn coarse() -> [Budget; 9] {
    BUDGETS.map(|budget| Budget {
        tolerance: match budget.plane {
            Plane::Normal => 0.12,
            Plane::Colour | Plane::Occlusion => 0.1,
            Plane::Shadow => 0.25,
            _ => budget.tolerance,
        },
        share: budget.share.max(match budget.plane {
            Plane::Coverage | Plane::Object => 0.0,
            _ => 0.02,
        }),
        ..budget
    })
}

#[test]
fn grids_are_the_same_on_every_renderer() {
    let analytic = analytic();
    let scene = of_grids(&analytic);
    let by_cpu = on(&CpuRenderer::new(None).unwrap(), &scene);
    let right = reference(&scene);
    none(
        check("grids", &scene, &by_cpu, &right)
            .into_iter()
            .collect(),
    );
    let off = differing(&analytic, &by_cpu, &reference(&analytic), &coarse());
    assert!(off.is_empty(), "{off:?}");
    let Some(gpu) = testing::renderer("grids on the GPU") else {
        return;
    };
    for form in [FieldForm::Compiled, FieldForm::Interpreted] {
        let gpu = gpu.clone().with_form(form);
        for normals in [Normals::Exact, Normals::Tetrahedron] {
            let mut scene = scene.clone();
            scene
                .edit(|s| s.settings.normals = normals)
                .expect("a scene");
            let by_cpu = on(&CpuRenderer::new(None).unwrap(), &scene);
            let what = format!("grids, {form:?}, {normals:?}");
            none(
                check(&what, &scene, &on(&gpu, &scene), &by_cpu)
                    .into_iter()
                    .collect(),
            );
        }
    }
}

/// A sample in the place of another does not go unseen.
#[test]
fn grids_that_are_mixed_up_are_seen() {
    let Some(gpu) = testing::renderer("grids that are mixed up") else {
        return;
    };
    let scene = of_grids(&analytic());
    let by_cpu = on(&CpuRenderer::new(None).unwrap(), &scene);
    let good = gpu.job(&scene).expect("a job");
    for (right, wrong) in [
        ("u32(number) * GRID_ROWS", "0u"),
        ("u32(node.z) * u32(grid.nodes_y)", "u32(node.z)"),
        ("row / TEXTURE_SIDE, 0).x", "row / TEXTURE_SIDE, 0).y"),
    ] {
        assert!(good.source.contains(right), "{right}");
        let job = Job {
            source: good.source.replace(right, wrong).into(),
            ..good.clone()
        };
        let film = film_of(&gpu, &scene, &job);
        let off = check("a fault", &scene, &film, &by_cpu);
        assert!(off.is_some(), "{wrong} for {right}");
    }
}
