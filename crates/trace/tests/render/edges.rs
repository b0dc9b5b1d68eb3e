//! Pictures where pixels hold silhouettes: what antialiasing is for.

use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::Silent;
use zeroset_scene::scene::{Scene, SceneParts};
use zeroset_scene::settings::Antialias;
use zeroset_trace::CpuRenderer;

/// Rays along the side of a pixel of the reference.
const FINE: u32 = 16;
/// Two rays beside each other see two surfaces where their distances differ by so much more than on a surface at this angle.
const STEEPEST: f32 = 40.0;

/// A scene's picture with 256 rays a pixel that all count alike, and the pixels that hold silhouettes.
pub(crate) struct Edges {
    size: [u32; 2],
    reference: Vec<[f32; 3]>,
    holds: Vec<bool>,
}

/// What was measured of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measured {
    /// Root of the mean squared difference from the reference over the pixels that hold silhouettes, of light up to white.
    pub(crate) error: f64,
    /// The shortest of a few renderings.
    pub(crate) seconds: f64,
    /// Evaluations of the field.
    pub(crate) evaluations: f64,
}

fn rendered(
    renderer: &CpuRenderer,
    scene: &Scene,
    size: [u32; 2],
    antialias: Antialias,
    planes: &[Plane],
) -> (Film, f64, f64) {
    let mut scene = scene.clone();
    let edit = |s: &mut SceneParts| {
        s.settings.size = size;
        s.settings.antialias = antialias;
    };
    scene.edit(edit).expect("a scene");
    let prepared = renderer.prepare_scene(scene.into()).expect("a program");
    let (part, film) = prepared.render_part(size, planes, &Silent);
    let evaluations = part.statistics.evaluations.total() as f64;
    (film, part.statistics.seconds, evaluations)
}

/// The first three numbers of each pixel, not above white.
fn light(film: &Film) -> Vec<[f32; 3]> {
    let pixels = film.plane(Plane::Colour).as_chunks::<3>().0;
    pixels.iter().map(|p| p.map(|c| c.min(1.0))).collect()
}

impl Edges {
    /// Renders the reference: a picture so many pixels across, from a larger one of which each pixel is a ray.
    pub(crate) fn of(renderer: &CpuRenderer, scene: &Scene, across: u32) -> Edges {
        let [width, height] = scene.settings().size;
        let size = [across, (across * height / width).max(1)];
        let planes = [Plane::Colour, Plane::Depth, Plane::Object];
        let (film, ..) = rendered(
            renderer,
            scene,
            size.map(|n| n * FINE),
            Antialias::None,
            &planes,
        );
        let (colour, depth, object) = (
            light(&film),
            film.plane(Plane::Depth),
            film.plane(Plane::Object),
        );
        let pixel = scene.camera().pixel_width(size[1] * FINE);
        let row = (size[0] * FINE) as usize;
        let differ = |a: usize, b: usize| {
            let (near, far) = (depth[a].min(depth[b]), depth[a].max(depth[b]));
            let width = pixel.0 * near + pixel.1;
            near.is_finite()
                && (object[a] != object[b] && far - near > 2.0 * width
                    || far - near > STEEPEST * width)
        };
        let (mut reference, mut holds) = (Vec::new(), Vec::new());
        for y in 0..size[1] {
            for x in 0..size[0] {
                let (mut sum, mut held) = ([0.0; 3], false);
                for k in 0..FINE * FINE {
                    let (dx, dy) = (k % FINE, k / FINE);
                    let at = (y * FINE + dy) as usize * row + (x * FINE + dx) as usize;
                    sum = std::array::from_fn(|c| sum[c] + colour[at][c]);
                    held |= dx + 1 < FINE && differ(at, at + 1);
                    held |= dy + 1 < FINE && differ(at, at + row);
                }
                reference.push(sum.map(|c| c / (FINE * FINE) as f32));
                holds.push(held);
            }
        }
        Edges {
            size,
            reference,
            holds,
        }
    }

    /// Share of the pixels that hold a silhouette.
    pub(crate) fn share(&self) -> f64 {
        self.holds.iter().filter(|h| **h).count() as f64 / self.holds.len() as f64
    }

    /// Renders the scene with another antialiasing and compares.
    pub(crate) fn measure(
        &self,
        renderer: &CpuRenderer,
        scene: &Scene,
        antialias: Antialias,
    ) -> Measured {
        let (mut seconds, mut found) = (f64::INFINITY, None);
        for _ in 0..5 {
            let (film, took, evaluations) =
                rendered(renderer, scene, self.size, antialias, &[Plane::Colour]);
            seconds = seconds.min(took);
            found = Some((film, evaluations));
        }
        let (film, evaluations) = found.expect("it was rendered");
        let pairs = light(&film)
            .into_iter()
            .zip(&self.reference)
            .zip(&self.holds);
        let (mut sum, mut count) = (0.0, 0.0);
        for ((a, b), _) in pairs.filter(|(_, held)| **held) {
            for c in 0..3 {
                sum += f64::from(a[c] - b[c]).powi(2);
            }
            count += 3.0;
        }
        Measured {
            error: (sum / f64::max(count, 1.0)).sqrt(),
            seconds,
            evaluations,
        }
    }
}
