//! How near cheap occlusion is to sampled occlusion, and with which numbers it is nearest.

use crate::failure::Failure;
use crate::simplex::minimum;
use std::sync::Arc;
use zeroset_scene::accumulator::Accumulator;
use zeroset_scene::film::Plane;
use zeroset_scene::methods::{Choice, Kind, Param, Value};
use zeroset_scene::render::{Observer, Prepared, RenderError, Renderer, Statistics};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, Integrator, Occlusion};

/// Numbers of samples that are tried, where a method takes some.
const STEPS: [u32; 4] = [3, 5, 8, 12];
/// What a number is multiplied by where the search begins.
const GRID: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];
/// How often a picture is rendered for the last step of the search.
const MOST: usize = 90;

/// A scene that tells how near a method is to what rays find.
pub(crate) struct Judge<'a> {
    scene: Scene,
    prepared: Box<dyn Prepared>,
    observer: &'a dyn Observer,
    /// By pixel: how open rays find it, none where nothing is hit.
    pub(crate) reference: Vec<Option<f32>>,
    /// How far the reference itself is off, root mean square.
    pub(crate) noise: f64,
}

/// What a method found.
#[derive(Clone)]
pub(crate) struct Found {
    pub(crate) method: Occlusion,
    /// Root mean square of how far it is off, over all pixels that hit something.
    pub(crate) rmse: f64,
    /// Evaluations of the field for occlusion, for each of these.
    pub(crate) evaluations: f64,
    /// By pixel.
    pub(crate) open: Vec<f32>,
    /// Seconds that the whole picture took.
    pub(crate) seconds: f64,
}

impl<'a> Judge<'a> {
    /// Renders the reference twice, with so many rays a pixel each.
    ///
    /// # Errors
    /// The scene cannot be rendered, or shows nothing.
    pub(crate) fn new(
        renderer: &dyn Renderer,
        mut scene: Scene,
        rays: u32,
        observer: &'a dyn Observer,
    ) -> Result<Judge<'a>, Failure> {
        scene.edit(|parts| {
            // occlusion, and nothing else that takes time
            parts.lights.clear();
            parts.objects.iter_mut().for_each(|o| o.occlusion = None);
            parts.settings.antialias = Antialias::None;
            parts.settings.integrator = Integrator::Direct;
        })?;
        let prepared = renderer.prepare(Arc::new(scene.clone()))?;
        let mut judge = Judge {
            scene,
            prepared,
            observer,
            reference: Vec::new(),
            noise: 0.0,
        };
        let method = Occlusion::Hemisphere { rays, reach: None };
        let seed = judge.scene.settings().seed;
        let (first, hit, _) = judge.render(method, seed)?;
        let (second, _, _) = judge.render(method, seed ^ 0x5bd1_e995)?;
        let mean = |a: f32, b: f32, hit: bool| hit.then_some(0.5 * (a + b));
        judge.reference = (first.iter().zip(&second).zip(&hit))
            .map(|((a, b), hit)| mean(*a, *b, *hit))
            .collect();
        // the mean of two is off by half of what they differ by
        let off = |((a, b), _): ((&f32, &f32), &bool)| f64::from(a - b).powi(2);
        let squares: f64 = (first.iter().zip(&second).zip(&hit)).map(off).sum();
        judge.noise = 0.5 * (squares / judge.hits().max(1) as f64).sqrt();
        Ok(judge)
    }

    /// Pixels that hit something.
    pub(crate) fn hits(&self) -> usize {
        self.reference.iter().flatten().count()
    }

    /// How open a method finds each pixel, which of them hit something, and what that took.
    fn render(
        &mut self,
        method: Occlusion,
        seed: u32,
    ) -> Result<(Vec<f32>, Vec<bool>, Statistics), RenderError> {
        self.scene.edit(|parts| {
            parts.settings.occlusion = method;
            parts.settings.seed = seed;
        })?;
        self.prepared.update(Arc::new(self.scene.clone()))?;
        let planes = [Plane::Occlusion, Plane::Depth];
        let mut sums = Accumulator::new(self.scene.settings().size, Antialias::None, &planes);
        let camera = *self.scene.camera();
        let statistics = (self.prepared).sample(&camera, 0..1, &mut sums, self.observer)?;
        let film = sums.into_film();
        let hit = film.plane(Plane::Depth).iter().map(|t| t.is_finite());
        Ok((
            film.plane(Plane::Occlusion).to_vec(),
            hit.collect(),
            statistics,
        ))
    }

    /// How near a method is.
    ///
    /// # Errors
    /// See [`RenderError`].
    pub(crate) fn found(&mut self, method: Occlusion) -> Result<Found, RenderError> {
        let (open, _, statistics) = self.render(method, self.scene.settings().seed)?;
        let pairs = open.iter().zip(&self.reference);
        let squares: f64 = pairs
            .filter_map(|(a, b)| b.map(|b| f64::from(a - b).powi(2)))
            .sum();
        Ok(Found {
            method,
            rmse: (squares / self.hits().max(1) as f64).sqrt(),
            evaluations: statistics.evaluations.occlusion as f64 / self.hits().max(1) as f64,
            open,
            seconds: statistics.seconds,
        })
    }

    /// The method with the numbers that bring it nearest: those near the best of a grid around what they are.
    ///
    /// # Errors
    /// See [`RenderError`].
    pub(crate) fn fitted(&mut self, method: Occlusion) -> Result<Found, RenderError> {
        let mut best = self.found(method)?;
        let params: Vec<&Param> = (method.method().params.iter())
            .filter(|p| matches!(p.kind, Kind::Real))
            .collect();
        let has_steps = method.get("steps").is_some();
        for steps in STEPS
            .into_iter()
            .filter(|_| has_steps)
            .chain((!has_steps).then_some(0))
        {
            let mut with = method;
            with.put("steps", Value::Whole(steps));
            let start: Vec<f64> = params.iter().map(|p| folded(p, &with)).collect();
            let mut near = (start.clone(), f64::INFINITY);
            for corner in corners(params.len()) {
                let at: Vec<f64> = (params.iter().zip(&start).zip(corner))
                    .map(|((p, x), times)| scaled(p, *x, times))
                    .collect();
                let y = self.found(made(&params, &with, &at))?.rmse;
                if y < near.1 {
                    near = (at, y);
                }
            }
            let (at, _) = minimum(&near.0, 0.15, MOST, |x| {
                (self.found(made(&params, &with, x))).map(|found| found.rmse)
            })?;
            let found = self.found(made(&params, &with, &at))?;
            if found.rmse < best.rmse {
                best = found;
            }
        }
        Ok(best)
    }
}

/// All ways to choose a factor for each of `n` numbers.
fn corners(n: usize) -> impl Iterator<Item = Vec<f64>> {
    let count = GRID.len().pow(n as u32);
    (0..count).map(move |i| {
        let digit = |k: usize| GRID[i / GRID.len().pow(k as u32) % GRID.len()];
        (0..n).map(digit).collect()
    })
}

/// A parameter as a number without ends: the logarithm of a length, else the square root.
fn folded(param: &Param, method: &Occlusion) -> f64 {
    let x = match method.get(param.name) {
        Some(Value::Real(x)) => f64::from(x),
        _ => 0.0,
    };
    match param.is_logarithmic {
        true => x.max(1e-6).ln(),
        false => x.max(0.0).sqrt(),
    }
}

/// A folded number, of a parameter that is so many times as large.
fn scaled(param: &Param, x: f64, times: f64) -> f64 {
    match param.is_logarithmic {
        true => x + times.ln(),
        false => x * times.sqrt(),
    }
}

/// A method with the numbers that folded ones stand for, in their ranges, and with four digits: what is printed is what was measured.
fn made(params: &[&Param], with: &Occlusion, at: &[f64]) -> Occlusion {
    let mut method = *with;
    for (param, x) in params.iter().zip(at) {
        let x = match param.is_logarithmic {
            true => x.exp(),
            false => x * x,
        };
        let least = if param.is_logarithmic { 1e-6 } else { 0.0 };
        let x = x.clamp(param.allowed.min.max(least), param.allowed.max);
        let digits = (3.0 - x.log10().floor()).clamp(0.0, 8.0);
        let rounded = format!("{x:.0$}", digits as usize).parse().unwrap_or(x);
        method.put(param.name, Value::Real(rounded as f32));
    }
    method
}

/// A method as a scene writes it.
pub(crate) fn written(method: &Occlusion) -> String {
    let about = method.method();
    let params: Vec<String> = (about.params.iter())
        .filter_map(|p| {
            let value = method.get(p.name).filter(|v| *v != Value::Limit(None))?;
            Some(format!("{} = {}", p.name, p.written(value)))
        })
        .collect();
    format!("{}({})", about.word, params.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_as_they_were() {
        for method in Occlusion::all() {
            let params: Vec<&Param> = (method.method().params.iter())
                .filter(|p| matches!(p.kind, Kind::Real))
                .collect();
            let at: Vec<f64> = params.iter().map(|p| folded(p, method)).collect();
            assert_eq!(made(&params, method, &at), *method);
            for wild in [-50.0, 0.0, 50.0] {
                let at = vec![wild; params.len()];
                assert_eq!(made(&params, method, &at).check(u64::MAX), Ok(()));
            }
        }
        assert_eq!(corners(2).count(), 25);
        assert_eq!(corners(0).map(|c| c.len()).collect::<Vec<_>>(), [0]);
        let bent = Occlusion::named("bent").unwrap_or_default();
        assert_eq!(
            written(&bent),
            "bent(steps = 5, step = 0.1, scale = 0.5, bend = 0.2)"
        );
    }
}
