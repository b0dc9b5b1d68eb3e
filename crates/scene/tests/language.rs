//! The language: what scene files may say and what comes out.

use zeroset_scene::load::{Language, Loaded, Options, load_text};

fn scene(text: &str) -> Loaded {
    match load_text(
        "scene.star",
        text,
        Language::Starlark,
        None,
        &Options::default(),
    ) {
        Ok(loaded) => loaded,
        Err(failed) => panic!("{:?}", miette::Report::new(*failed.report)),
    }
}

#[test]
fn hello() {
    let loaded = scene("show(sphere())");
    assert_eq!(loaded.scene.objects.len(), 1);
    assert_eq!(loaded.scene.lights.len(), 1);
}

#[test]
fn the_tour() {
    let loaded = scene(
        r##"
bite  = slider("bite", 0.4, min = 0.0, max = 1.0)
body  = box(size = 1.0) & sphere(0.68)
cheese = body - sphere(0.5).move(x = bite)
knot  = sphere(0.6).twist(30).move(y = 1.2)

def ring(n, shape, radius):
    return union([shape.move(x = radius).turn(y = 360 * i / n) for i in range(n)])

gold  = material(color = "#e8b04a", metallic = 1, roughness = 0.25)
show(cheese.blend(knot, 0.2), gold)
show(ring(12, sphere(0.1), 1.5), material(color = hsv(time() * 60, 0.6, 0.9)))
show(plane(), material(color = "#888"), ao = quilez(steps = 5, scale = 1.0))

camera(eye = (3, 2, 4), target = (0, 0.5, 0), fov = 40)
sun(direction = (-1, -2, -1), shadow = soft(16))
sky(top = "#cfe3ff", ambient = 0.4)
render(size = (512, 512), march = auto(), aa = supersample(8))
"##,
    );
    assert_eq!(loaded.scene.objects.len(), 3);
    assert!(loaded.animated);
    assert_eq!(loaded.parameters.len(), 1);
}
