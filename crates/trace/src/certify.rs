//! What a picture shows, proven pixel by pixel: that a hit is one, the first on its ray, and that a miss meets nothing.
//!
//! The picture is rendered as ever, in single precision, by whatever marcher the scene asks for. Each of its rays is then looked at again in
//! double precision, by what cannot err: spheres where the field is a bound of the distance, ranges of the field (Moore 1966) where it is not or
//! where spheres get nowhere. What neither shows in limited work is unknown, and estimates of fractals always are.

use crate::isolate::{Isolation, Line};
use crate::renderer::PreparedScene;
use rayon::prelude::*;
use zeroset_number::Vec3;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::{Observer, RenderError};
use zeroset_scene::settings::Antialias;
use zeroset_shade::view::View;

/// What is known of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The ray through its middle meets the surface where the picture says, within the pixel's own width there, and nothing before.
    Hit,
    /// It meets nothing.
    Miss,
    /// Neither could be shown.
    Unknown,
    /// The picture is wrong: the ray meets the surface before, or at all.
    Wrong,
}

/// The verdicts of a picture, row by row from the upper left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Certificate {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// One a pixel.
    pub verdicts: Vec<Verdict>,
}

impl Certificate {
    /// Pixels with a verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.verdicts.iter().filter(|v| **v == verdict).count()
    }

    /// The share of pixels of which it is proven what they show, 0 to 1.
    pub fn proven(&self) -> f64 {
        let proven = self.count(Verdict::Hit) + self.count(Verdict::Miss);
        proven as f64 / self.verdicts.len().max(1) as f64
    }
}

/// Spheres that a ray may take before ranges are asked.
const SPHERES: u32 = 512;
/// A sphere of less than this share of a pixel's width leads nowhere.
const STUCK: f64 = 0.02;
/// Parts of a ray of which the ranges may be looked at.
const PARTS: u32 = 2048;

impl PreparedScene {
    /// Renders the scene at this size with a ray through the middle of each pixel, and proves what it can of each.
    ///
    /// # Errors
    /// [`RenderError::Cancelled`] where the observer ended it.
    pub fn certify(
        &self,
        size: [u32; 2],
        observer: &dyn Observer,
    ) -> Result<Certificate, RenderError> {
        let mut sums = zeroset_scene::accumulator::Accumulator::new(
            size,
            Antialias::None,
            &[Plane::Depth, Plane::Coverage],
        );
        let camera = *self.scene.camera();
        let part = self.sample_part(&camera, 0..1, &mut sums, observer);
        if !part.is_whole {
            return Err(RenderError::Cancelled);
        }
        self.certify_film(&sums.into_film(), observer)
    }

    /// Proves what it can of each pixel of a picture of this scene, from its depths, those of rays through the middles of pixels.
    ///
    /// # Errors
    /// [`RenderError::Cancelled`] where the observer ended it.
    pub fn certify_film(
        &self,
        film: &Film,
        observer: &dyn Observer,
    ) -> Result<Certificate, RenderError> {
        let size = [film.width(), film.height()];
        let settings = self.scene.settings();
        let view = View::new(self.scene.camera(), size, settings.footprint);
        let (depths, coverage) = (film.plane(Plane::Depth), film.plane(Plane::Coverage));
        let width = size[0] as usize;
        let row = |y: usize| -> Vec<Verdict> {
            if observer.is_cancelled() {
                return Vec::new();
            }
            let mut prover = Prover::new(self, &view);
            let verdict = |x: usize| {
                let at = y * width + x;
                let depth = (coverage[at] > 0.0).then_some(depths[at]);
                prover.verdict(x as f32 + 0.5, y as f32 + 0.5, depth)
            };
            (0..width).map(verdict).collect()
        };
        let rows = (0..size[1] as usize).into_par_iter();
        let rows = || rows.flat_map_iter(row).collect::<Vec<_>>();
        let verdicts = self.renderer.pool.install(rows);
        match verdicts.len() == width * size[1] as usize {
            true => Ok(Certificate { size, verdicts }),
            false => Err(RenderError::Cancelled),
        }
    }
}

/// Proves pixels of a row.
pub(crate) struct Prover<'a> {
    scene: &'a PreparedScene,
    view: &'a View,
    pub(crate) isolation: Isolation<'a>,
}

/// What was shown of a part of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shown {
    /// There is no surface in it.
    Free,
    /// There is one.
    Met,
    /// Neither.
    Nothing,
}

impl<'a> Prover<'a> {
    pub(crate) fn new(scene: &'a PreparedScene, view: &'a View) -> Self {
        Prover {
            scene,
            view,
            isolation: Isolation::new(scene.program.marched()),
        }
    }

    /// What is known of the ray through a place of the picture, in pixels, that ends at a depth or meets nothing.
    pub(crate) fn verdict(&mut self, x: f32, y: f32, depth: Option<f32>) -> Verdict {
        if self.isolation.is_chaotic() {
            return Verdict::Unknown;
        }
        let view = self.view;
        let ray: Vec3<f32> = view.ray(x, y);
        let (origin, direction) = view.split(ray);
        let narrow = view.narrow(ray);
        let start = f64::from(view.near);
        let mut line = Line {
            origin: origin.array(),
            direction: direction.array(),
            inside: false,
        };
        line.inside = self.isolation.value(&line, start) < 0.0;
        let region = &self.scene.region;
        // outside the box of the solid there is nothing to be shown: the box is proven
        let enter = f64::from(region.enter(origin, direction, 0.0, 0.0));
        let leave = f64::from(region.leave(origin, direction, 0.0, 0.0).min(view.far));
        let (from, to) = match line.inside {
            true => (start, f64::from(view.far)),
            // single precision rounds: a little more than the box
            false => (start.max(enter * (1.0 - 1e-5)), leave * (1.0 + 1e-5)),
        };
        let Some(t) = depth else {
            return match self.free(&line, from, to, f64::from(view.near(leave as f32, narrow))) {
                Shown::Free => Verdict::Miss,
                Shown::Met => Verdict::Wrong,
                Shown::Nothing => Verdict::Unknown,
            };
        };
        let (t, near) = (f64::from(t), f64::from(view.near(t, narrow)));
        let before = match self.free(&line, from, t - near, near) {
            Shown::Free => true,
            Shown::Met => return Verdict::Wrong,
            Shown::Nothing => false,
        };
        let behind = [0.02, 0.1, 0.3, 1.0].iter().any(|k| {
            let at = t + near * k;
            self.isolation.value(&line, at) < -self.isolation.rounding(&line, at)
        });
        match before && behind {
            true => Verdict::Hit,
            false => Verdict::Unknown,
        }
    }

    /// Whether a part of a ray meets nothing, as far as features of the width `near` are concerned in what takes too long.
    fn free(&mut self, line: &Line, from: f64, to: f64, near: f64) -> Shown {
        let mut from = from;
        if self.isolation.is_bound() {
            for _ in 0..SPHERES {
                if from >= to {
                    return Shown::Free;
                }
                let rounding = self.isolation.rounding(line, from);
                let f = self.isolation.value(line, from) - rounding;
                if f < -2.0 * rounding {
                    return Shown::Met;
                }
                if f < near * STUCK {
                    break;
                }
                from += f;
            }
        }
        let mut parts = vec![(from, to)];
        let mut looked = 0;
        while let Some((from, to)) = parts.pop() {
            if from >= to {
                continue;
            }
            looked += 1;
            if looked > PARTS {
                return Shown::Nothing;
            }
            let limit =
                -(self.isolation.rounding(line, from)).max(self.isolation.rounding(line, to));
            if self.isolation.is_clear(line, from, to, limit) {
                continue;
            }
            let middle = 0.5 * (from + to);
            if self.isolation.value(line, middle) < limit {
                return Shown::Met;
            }
            if to - from < near * 1e-3 || middle <= from || middle >= to {
                return Shown::Nothing;
            }
            parts.push((middle, to));
            parts.push((from, middle));
        }
        Shown::Free
    }
}
