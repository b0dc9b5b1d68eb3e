//! Every method of the settings, stream against plain.

use crate::compare::same;
use crate::scenes::{blend, quick, reference, stream, tomczak};
use zeroset_scene::camera::Lens;
use zeroset_scene::settings::{Antialias, Filter, Normals, Occlusion, Settings, Shading, Shadow};

fn agree(settings: Settings) {
    for mut scene in [tomczak(), blend()] {
        scene.edit(|s| s.settings = settings).expect("a scene");
        same(
            &scene,
            &stream(&scene),
            &reference(&scene),
            &format!("{} with {settings:?}", scene.name()),
        );
    }
}

#[test]
fn normals() {
    for normals in Normals::ALL {
        agree(Settings { normals, ..quick() });
    }
}

#[test]
fn shading() {
    for shading in Shading::ALL {
        agree(Settings { shading, ..quick() });
    }
}

#[test]
fn occlusion() {
    for occlusion in [
        Occlusion::None,
        Occlusion::Quilez {
            steps: 1,
            step: 0.3,
            scale: 1.0,
        },
        Occlusion::Quilez {
            steps: 5,
            step: 0.12,
            scale: 1.5,
        },
        Occlusion::Bent {
            steps: 5,
            step: 0.12,
            scale: 0.5,
            bend: 0.2,
        },
        Occlusion::Evans {
            scale: 1.0,
            step: 0.1,
            bend: 0.5,
        },
        Occlusion::Skylight {
            resolution: 32,
            step: 2.0,
            strength: 3.0,
            bend: 0.5,
            bleed: 0.0,
        },
        Occlusion::Skylight {
            resolution: 40,
            step: 1.0,
            strength: 2.0,
            bend: 0.0,
            bleed: 0.7,
        },
        Occlusion::Upward { scale: 0.5 },
        Occlusion::Cones {
            reach: None,
            steps: 14,
        },
        Occlusion::Cones {
            reach: Some(0.5),
            steps: 5,
        },
    ] {
        agree(Settings {
            occlusion,
            ..quick()
        });
    }
}

#[test]
fn sampled_occlusion() {
    let size = [48, 36];
    for occlusion in [
        Occlusion::Hemisphere {
            rays: 8,
            reach: None,
        },
        Occlusion::Hemisphere {
            rays: 16,
            reach: Some(2.0),
        },
        Occlusion::Obscurance {
            rays: 16,
            reach: Some(2.0),
            tau: 1.0,
        },
    ] {
        agree(Settings {
            occlusion,
            size,
            ..quick()
        });
    }
}

#[test]
fn occlusion_of_objects() {
    let mut scene = tomczak();
    scene
        .edit(|s| {
            s.objects[0].occlusion = Some(Occlusion::Bent {
                steps: 5,
                step: 0.12,
                scale: 0.5,
                bend: 0.2,
            });
            s.objects[1].occlusion = Some(Occlusion::Upward { scale: 0.5 });
        })
        .expect("a scene");
    same(
        &scene,
        &stream(&scene),
        &reference(&scene),
        "occlusion by object",
    );
}

#[test]
fn shadows() {
    for shadow in [
        Shadow::None,
        Shadow::Hard,
        Shadow::Soft { sharpness: 4.0 },
        Shadow::Soft { sharpness: 64.0 },
        Shadow::SoftClosest { sharpness: 12.0 },
        Shadow::Advected {
            resolution: 32,
            spread: 0.5,
            bias: 2.0,
        },
    ] {
        for mut scene in [tomczak(), blend()] {
            scene
                .edit(|s| s.lights.iter_mut().for_each(|l| l.shadow = shadow))
                .expect("a scene");
            same(
                &scene,
                &stream(&scene),
                &reference(&scene),
                &format!("{} with {shadow:?}", scene.name()),
            );
        }
    }
}

#[test]
fn antialiasing() {
    for filter in [Filter::Box, Filter::Tent, Filter::Mitchell] {
        agree(Settings {
            size: [80, 50],
            antialias: Antialias::Supersample { samples: 4, filter },
            ..quick()
        });
    }
}

#[test]
fn lenses() {
    for mut scene in [tomczak(), blend()] {
        scene
            .edit(|s| s.camera.lens = Lens::Orthographic { height: 3.5 })
            .expect("a scene");
        same(&scene, &stream(&scene), &reference(&scene), "orthographic");
    }
}

#[test]
fn no_prepass_and_more_reduction() {
    agree(Settings {
        prepass: false,
        ..quick()
    });
    agree(Settings {
        discontinuity_reduction: 5,
        ..quick()
    });
}
