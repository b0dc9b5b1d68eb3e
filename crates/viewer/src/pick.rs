//! What is under the cursor.

use glam::Vec3;
use zeroset_scene::camera::Camera;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::material::{Material, Pattern};
use zeroset_scene::scene::Scene;

/// A surface that was clicked.
#[derive(Clone, Debug, PartialEq)]
pub struct Picked {
    /// Number of the object.
    pub object: usize,
    /// Its name.
    pub name: String,
    /// What it is made of, for a person.
    pub material: String,
    /// A colour that stands for the material: linear.
    pub colour: Vec3,
    /// Where it was hit.
    pub point: Vec3,
    /// From the eye.
    pub distance: f32,
    /// Which way it faces.
    pub normal: Vec3,
    /// Where it is shown in the file: file, line, column.
    pub place: Option<(String, u32, u32)>,
}

impl Picked {
    /// The place in the file as editors and compilers write it.
    pub fn whereabouts(&self) -> Option<String> {
        let (file, line, column) = self.place.as_ref()?;
        Some(format!("{file}:{line}:{column}"))
    }
}

/// The pixel of a film at a place on the picture, as shares of its width and height.
fn pixel(film: &Film, [x, y]: [f32; 2]) -> Option<usize> {
    let inside = |share: f32, n: u32| {
        (0.0..1.0)
            .contains(&share)
            .then(|| ((share * n as f32) as u32).min(n.saturating_sub(1)))
    };
    let (x, y) = (inside(x, film.width())?, inside(y, film.height())?);
    Some(y as usize * film.width() as usize + x as usize)
}

/// How far it is to the surface at a place on the picture; `None` where there is none.
pub fn depth(film: &Film, at: [f32; 2]) -> Option<f32> {
    let depth = *film.plane(Plane::Depth).get(pixel(film, at)?)?;
    depth.is_finite().then_some(depth)
}

/// The surface at a place on the picture.
pub fn pick(film: &Film, camera: &Camera, scene: &Scene, at: [f32; 2]) -> Option<Picked> {
    let i = pixel(film, at)?;
    let distance = depth(film, at)?;
    let number = film.plane(Plane::Object).get(i)?.round();
    let object = (number as usize).checked_sub(1)?;
    let shown = scene.objects().get(object)?;
    let size = [film.width(), film.height()];
    let (origin, direction) = camera.ray(at[0] * size[0] as f32, at[1] * size[1] as f32, size);
    let (triples, _) = film.plane(Plane::Normal).as_chunks::<3>();
    let (albedo, _) = film.plane(Plane::Albedo).as_chunks::<3>();
    let triple = |of: &[[f32; 3]]| of.get(i).map_or(Vec3::ZERO, |t| Vec3::from(*t));
    Some(Picked {
        object,
        name: shown.name.clone(),
        material: scene
            .materials()
            .get(usize::from(shown.material))
            .map_or_else(String::new, described),
        colour: triple(albedo),
        point: origin + direction * distance,
        distance,
        normal: triple(triples),
        place: shown.place.clone(),
    })
}

/// A material in a few words.
fn described(material: &Material) -> String {
    let mut pattern = &material.pattern;
    while let Pattern::Placed { pattern: inner, .. } = pattern {
        pattern = inner;
    }
    let pattern = match pattern {
        Pattern::Solid { .. } => "one colour",
        Pattern::Checker { .. } => "checker",
        Pattern::Stripes { .. } => "stripes",
        Pattern::Noise { .. } => "noise",
        Pattern::Gradient { .. } => "gradient",
        Pattern::Triplanar { .. } => "image",
        Pattern::Orbit { .. } => "orbit traps",
        Pattern::Formula { .. } => "a formula",
        Pattern::Placed { .. } => "a pattern",
    };
    let mut words = vec![pattern.to_owned()];
    if material.metallic > 0.0 {
        words.push(format!("metallic {}", material.metallic));
        words.push(format!("roughness {}", material.roughness));
    } else {
        words.push(format!("specular {}", material.specular));
        words.push(format!("shininess {}", material.shininess));
    }
    if material.emission != Vec3::ZERO {
        words.push("glows".to_owned());
    }
    words.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_language::load::{Language, Options, load_text};
    use zeroset_scene::render::{Renderer, Silent};
    use zeroset_trace::CpuRenderer;

    #[test]
    fn a_click_finds_the_object_and_its_line() {
        let text = "show(sphere(0.5).move(x = -1), name = \"ball\")\n\
                    show(box(0.8).move(x = 1), material(color = \"#4080ff\", metallic = 1))\n\
                    camera(eye = (0, 0, 6), target = (0, 0, 0), fov = 40)\n\
                    render(size = (64, 48), aa = none())\n";
        let options = Options::default();
        let loaded = load_text("pick.star", text, Language::Starlark, None, &options).unwrap();
        let scene = loaded.scene;
        let film = CpuRenderer::new(Some(1))
            .unwrap()
            .render(&scene, &Silent)
            .unwrap()
            .film;
        // where a point of space is on the picture
        let at = |x: f32, y: f32, z: f32| {
            let scale = 1.0 / (scene.camera().plane_height() * (6.0 - z));
            [0.5 + x * scale * 48.0 / 64.0, 0.5 - y * scale]
        };
        let ball = pick(&film, scene.camera(), &scene, at(-1.0, 0.0, 0.5)).unwrap();
        assert_eq!((ball.object, ball.name.as_str()), (0, "ball"));
        assert_eq!(ball.whereabouts().as_deref(), Some("pick.star:1:1"));
        assert!(
            (ball.point - Vec3::new(-1.0, 0.0, 0.5)).length() < 0.05,
            "{:?}",
            ball.point
        );
        assert!(ball.normal.z > 0.95);
        let cube = pick(&film, scene.camera(), &scene, at(1.0, 0.0, 0.4)).unwrap();
        assert_eq!(cube.whereabouts().as_deref(), Some("pick.star:2:1"));
        assert!(cube.material.contains("metallic 1"), "{}", cube.material);
        assert!(cube.colour.z > cube.colour.x);
        for nothing in [at(0.0, 1.5, 0.0), [-0.1, 0.5], [0.5, 1.0], [f32::NAN, 0.5]] {
            assert_eq!(pick(&film, scene.camera(), &scene, nothing), None);
        }
        assert_eq!(depth(&film, at(0.0, 1.5, 0.0)), None);
    }
}
