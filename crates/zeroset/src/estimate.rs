//! What a picture will cost, from a small one.

use serde::Serialize;
use std::thread;
use std::time::{Duration, Instant};
use zeroset_scene::film::Plane;
use zeroset_scene::render::{Observer, RenderError};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::Antialias;
use zeroset_trace::CpuRenderer;

/// Longer sides of the small pictures, pixels: the last is as wide as a tile.
const SIDES: [u32; 5] = [4, 8, 16, 32, 64];
/// A small picture that takes this long tells enough.
const ENOUGH: Duration = Duration::from_millis(60);
/// How long all of them may take.
const MOST: Duration = Duration::from_millis(1500);

/// What a picture costs on the CPU.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Cost {
    /// Rays a pixel.
    pub rays_per_pixel: u32,
    /// Evaluations of the field a pixel, by all of its rays and what they lead to.
    pub evaluations_per_pixel: f64,
    /// On one thread.
    pub nanoseconds_per_evaluation: f64,
    /// Threads that the time is for.
    pub threads: usize,
    /// Time of the picture.
    pub seconds: f64,
    /// Memory of the picture as a PNG, apart from the scene.
    pub bytes: u64,
    /// Whether not even the smallest picture was done in time: it costs more than this.
    pub is_least: bool,
}

struct Deadline(Instant);

impl Observer for Deadline {
    fn advance(&self, _rays: u64, _total: u64) {}
    fn is_cancelled(&self) -> bool {
        Instant::now() >= self.0
    }
}

/// Renders small pictures of few rays a pixel, larger and larger ones until one says enough.
///
/// # Errors
/// See [`RenderError`].
pub(crate) fn cost(scene: &Scene) -> Result<Cost, RenderError> {
    let size = scene.settings().size;
    let rays_per_pixel = scene.settings().antialias.samples();
    let renderer = CpuRenderer::new(Some(1))?;
    // beside the film, the picture that becomes a PNG is as large as its colour plane
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    let bytes = renderer.memory(scene, &[Plane::Colour]) + 12 * pixels;
    let mut plain = scene.clone();
    // as many rays a pixel as share what they find
    let few = rays_per_pixel.min(4);
    plain.edit(|parts| {
        if let Antialias::Supersample { samples, .. } = &mut parts.settings.antialias {
            *samples = few;
        }
    })?;
    let picture = renderer.prepare_scene(plain.into())?;
    let began = Instant::now();
    // rays, evaluations, seconds
    let (mut found, mut is_least) = ((1.0, 0.0, 0.0), true);
    for side in SIDES {
        let longer = size[0].max(size[1]);
        let scaled = |n: u32| (u64::from(n) * u64::from(side) / u64::from(longer.max(1))).max(1);
        let [width, height] = size.map(|n| if longer <= side { n } else { scaled(n) as u32 });
        let deadline = Deadline(began + MOST);
        let (part, _) = picture.render_part([width, height], &Plane::ALL, &deadline);
        if part.is_whole || is_least {
            let rays = f64::from(width) * f64::from(height) * f64::from(few);
            found = (rays, part.spent as f64, part.statistics.seconds);
        }
        is_least &= !part.is_whole;
        if !part.is_whole || part.statistics.seconds > ENOUGH.as_secs_f64() || longer <= side {
            break;
        }
    }
    let (rays, evaluations, seconds) = found;
    let all = f64::from(size[0]) * f64::from(size[1]) * f64::from(rays_per_pixel);
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let tiles = u64::from(size[0]).div_ceil(64) * u64::from(size[1]).div_ceil(32);
    let threads = cores
        .min(usize::try_from(tiles).unwrap_or(usize::MAX))
        .max(1);
    Ok(Cost {
        rays_per_pixel,
        evaluations_per_pixel: evaluations / rays * f64::from(rays_per_pixel),
        nanoseconds_per_evaluation: 1e9 * seconds / evaluations.max(1.0),
        threads,
        seconds: seconds * all / rays / threads as f64,
        bytes,
        is_least,
    })
}

impl Cost {
    /// For a person, on one line.
    pub(crate) fn words(&self, [width, height]: [u32; 2]) -> String {
        let about = if self.is_least { "more than" } else { "about" };
        let rays = match self.rays_per_pixel {
            1 => "a ray a pixel".to_owned(),
            n => format!("{n} rays a pixel"),
        };
        let threads = match self.threads {
            1 => "1 thread".to_owned(),
            n => format!("{n} threads"),
        };
        let evaluations = crate::console::short(self.evaluations_per_pixel);
        format!(
            "A picture of {width}x{height} with {rays} takes {about} {evaluations} evaluations a pixel, {} on {threads} of \
             the CPU, {} of memory.",
            time(self.seconds),
            memory(self.bytes),
        )
    }
}

/// A time in a unit that fits.
fn time(seconds: f64) -> String {
    match seconds {
        s if s < 0.1 => format!("{:.0} ms", (1e3 * s).max(1.0)),
        s if s < 10.0 => format!("{s:.1} s"),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} minutes", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} hours", s / 3600.0),
        s => format!("{:.0} days", s / 86_400.0),
    }
}

fn memory(bytes: u64) -> String {
    match bytes {
        b if b < 1 << 20 => format!("{} KiB", b.div_ceil(1 << 10)),
        b if b < 10 << 30 => format!("{} MiB", b.div_ceil(1 << 20)),
        b => format!("{} GiB", b.div_ceil(1 << 30)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_language::load::{Language, Options, load_text};

    fn scene(text: &str) -> Scene {
        load_text(
            "a.star",
            text,
            Language::Starlark,
            None,
            &Options::default(),
        )
        .unwrap()
        .scene
    }

    #[test]
    fn units_fit() {
        let said = [0.00001, 0.04, 1.26, 45.0, 600.0, 10_000.0, 1e6].map(time);
        assert_eq!(
            said,
            [
                "1 ms",
                "40 ms",
                "1.3 s",
                "45 s",
                "10 minutes",
                "3 hours",
                "12 days"
            ]
        );
        let said = [1, 5 << 20, 3 << 30, 72 << 30].map(memory);
        assert_eq!(said, ["1 KiB", "5 MiB", "3072 MiB", "72 GiB"]);
    }

    /// Counts are the same on every machine; times are not looked at.
    #[test]
    fn evaluations_are_about_those_of_the_picture() {
        for text in [
            "show(sphere())\nshow(plane())\nrender(size = (320, 240), aa = none())",
            "show(box((1, 2, 1)))\nrender(size = (200, 300), aa = supersample(4), ao = none())",
            "show(plane())\nrender(size = (256, 256), ao = hemisphere(16))",
        ] {
            let scene = scene(text);
            let estimate = cost(&scene).unwrap();
            let renderer = CpuRenderer::new(Some(2)).unwrap();
            let picture = renderer.prepare_scene(scene.clone().into()).unwrap();
            let [width, height] = scene.settings().size;
            let (part, _) = picture.render_part(
                [width, height],
                &Plane::ALL,
                &Deadline(Instant::now() + Duration::from_secs(600)),
            );
            let right = part.spent as f64 / f64::from(width * height);
            let found = estimate.evaluations_per_pixel;
            assert!(
                (0.6..1.7).contains(&(found / right)),
                "{text}: {found}, right {right}"
            );
            assert!(estimate.bytes >= 24 * u64::from(width * height));
        }
    }

    #[test]
    fn a_picture_without_end_is_estimated_soon() {
        let began = Instant::now();
        let text = "show(sphere())\nrender(size = (4000, 4000), aa = supersample(1024), ao = hemisphere(4096))";
        let estimate = cost(&scene(text)).unwrap();
        assert!(estimate.seconds > 600.0, "{estimate:?}");
        assert!(began.elapsed() < Duration::from_secs(20));
    }
}
