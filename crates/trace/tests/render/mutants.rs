//! Wrong renderers that the comparison must refuse: one that cannot fail proves nothing.

use crate::compare::{differing, same};
use crate::scenes::{quick, reference, stream, tomczak};
use glam::Vec3;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{March, Settings};
use zeroset_testkit::plain::{self, Compiled, Mark, Probe, Quality};
use zeroset_trace::CpuRenderer;

fn scene() -> Scene {
    let mut scene = tomczak();
    scene
        .edit(|s| {
            s.settings = Settings {
                march: March::Sphere,
                ..quick()
            }
        })
        .expect("a scene");
    scene
}

/// A field with a fault.
struct Faulty<'p> {
    right: Compiled<'p>,
    /// Factor on every value.
    value: f32,
    /// Factor on every gradient.
    gradient: f32,
}

impl Probe for Faulty<'_> {
    fn value(&mut self, p: Vec3) -> f32 {
        self.right.value(p) * self.value
    }
    fn gradient(&mut self, p: Vec3) -> Vec3 {
        self.right.gradient(p) * self.gradient
    }
    fn marks(&mut self, p: Vec3) -> Mark {
        self.right.marks(p)
    }
    fn placed(&mut self, mark: f32, materials: usize, p: Vec3) -> Option<(usize, Vec3, [Vec3; 3])> {
        self.right.placed(mark, materials, p)
    }
}

fn faulty(scene: &Scene, value: f32, gradient: f32) -> Film {
    let renderer = CpuRenderer::new(Some(1)).expect("threads");
    let picture = renderer
        .prepare_scene(scene.clone().into())
        .expect("a program");
    let program = picture.program();
    plain::render(scene, &Quality::of(program, scene), || Faulty {
        right: Compiled::new(program, None),
        value,
        gradient,
    })
}

#[test]
fn an_unchanged_field_is_accepted() {
    same(
        &scene(),
        &stream(&scene()),
        &faulty(&scene(), 1.0, 1.0),
        "itself",
    );
}

#[test]
fn too_long_steps_are_refused() {
    assert!(!differing(&scene(), &stream(&scene()), &faulty(&scene(), 1.3, 1.0)).is_empty());
}

#[test]
fn wrong_normals_are_refused() {
    let mut scene = scene();
    scene
        .edit(|s| s.settings.normals = zeroset_scene::settings::Normals::Exact)
        .expect("a scene");
    let off = differing(&scene, &stream(&scene), &faulty(&scene, 1.0, -1.0));
    assert!(off.iter().any(|d| d.plane == Plane::Normal), "{off:?}");
}

/// A compaction that loses one lane of 16, or mixes two up.
#[test]
fn lost_and_swapped_lanes_are_refused() {
    let right = reference(&scene());
    let mut lost = stream(&scene());
    let mut swapped = lost.clone();
    let pixels = (lost.width() * lost.height()) as usize;
    for i in (0..pixels).step_by(16) {
        for plane in Plane::ALL {
            let n = plane.channels();
            lost.plane_mut(plane)[i * n..(i + 1) * n].fill(0.0);
            for k in 0..n {
                swapped
                    .plane_mut(plane)
                    .swap(i * n + k, (i + 5) % pixels * n + k);
            }
        }
    }
    assert!(differing(&scene(), &lost, &right).len() > 4);
    assert!(!differing(&scene(), &swapped, &right).is_empty());
}
