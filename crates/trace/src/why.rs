//! Why a pixel shows what it shows: its ray step by step, what sets each step, and what is proven of its end.
//!
//! The steps are those of the plain march (Hart 1996), in double precision and without what renderers do to take fewer of them: each is as long as
//! the field says that it is free there. What the ray ends at is what the picture's own marcher finds.

use crate::certify::{Prover, Verdict};
use crate::isolate::Line;
use crate::query::{Hit, Ray};
use crate::renderer::PreparedScene;
use glam::Vec3;
use zeroset_catalogue::bounds::Exactness;
use zeroset_number::at_level;
use zeroset_shade::view::View;

/// A step of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Distance along the ray.
    pub t: f64,
    /// The value of the field there, from the side that the ray is on: the length of the step.
    pub value: f64,
    /// The length of the gradient: where it is below 1, a step is shorter than the way that is free.
    pub slope: f64,
    /// The object whose surface the value is the distance to.
    pub object: Option<usize>,
}

/// How the march ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// At a surface: nearer to it than a pixel is wide.
    Surface,
    /// The ray left the box of the scene, or passed the far end of the view.
    Left,
    /// After as many steps as were allowed.
    Steps,
}

/// A pixel, explained.
#[derive(Clone, Debug, PartialEq)]
pub struct Why {
    /// Where its ray begins.
    pub origin: [f32; 3],
    /// Where it goes, of length 1.
    pub direction: [f32; 3],
    /// Whether it begins inside the solid.
    pub inside: bool,
    /// The plain march.
    pub steps: Vec<Step>,
    /// How that ended.
    pub end: End,
    /// What the picture's marcher finds.
    pub hit: Option<Hit>,
    /// What is proven of it.
    pub verdict: Verdict,
    /// The step that came nearest to a surface beside the last one, where that is within a pixel: the ray passes there.
    pub passed: Option<Step>,
    /// Half the width of a pixel where the ray ends.
    pub footprint: f64,
    /// What the field is divided by, at least 1.
    pub divided: f64,
    /// How true its distance is.
    pub exactness: Exactness,
    /// Whether it is an estimate of a fractal.
    pub is_fractal: bool,
    /// Whether it has no Lipschitz constant, so that its surface is looked for by ranges. Steps are then guesses.
    pub is_unbounded: bool,
}

impl PreparedScene {
    /// Explains the pixel `pixel` (column and row from the upper left) of a picture of this size, from the ray through its middle, in at most
    /// `most` steps.
    pub fn why(&self, size: [u32; 2], pixel: [u32; 2], most: usize) -> Why {
        let settings = self.scene.settings();
        let view = View::new(self.scene.camera(), size, settings.footprint);
        let [x, y] = pixel.map(|c| c as f32 + 0.5);
        let ray: zeroset_number::Vec3<f32> = view.ray(x, y);
        let (origin, direction) = view.split(ray);
        let narrow = view.narrow(ray);
        let mut prover = Prover::new(self, &view);
        let isolation = &mut prover.isolation;
        let mut line = Line {
            origin: origin.array(),
            direction: direction.array(),
            inside: false,
        };
        let mut t = f64::from(view.near);
        line.inside = isolation.value(&line, t) < 0.0;
        let leave = self.region.leave(origin, direction, 0.0, 0.0).min(view.far);
        let far = f64::from(if line.inside { view.far } else { leave });
        let near = |t: f64| f64::from(view.near(t as f32, narrow));
        let is_unbounded = self.program.is_unbounded();
        let mut steps: Vec<Step> = Vec::new();
        let end = loop {
            if t > far {
                break End::Left;
            }
            if steps.len() >= most {
                break End::Steps;
            }
            let value = isolation.value(&line, t);
            steps.push(Step {
                t,
                value,
                slope: isolation.slope(&line, t),
                object: None,
            });
            if value < near(t) * 1e-3 {
                break End::Surface;
            }
            t += match is_unbounded {
                // values are no bounds: a line along the gradient is all there is
                true => (value / isolation.slope(&line, t).max(1.0)).max(near(t) * 0.1),
                false => value,
            };
        };
        self.mark(&line, &mut steps);
        let along = Ray {
            origin: Vec3::from_array(line.origin),
            direction: Vec3::from_array(line.direction),
            near: view.near,
            far: view.far,
        };
        let width = 2.0 * near(t.min(far)) as f32;
        // the view's own numbers are fit for a query
        let hit = self.closest(&[along], width).ok();
        let hit = hit.and_then(|hits| hits.first().copied().flatten());
        let verdict = prover.verdict(x, y, hit.map(|hit| hit.t));
        let ending = usize::from(end == End::Surface);
        let before = &steps[..steps.len().saturating_sub(ending)];
        // a ray that comes to a surface is near it for its last steps: only where it went away again did it pass
        let passed = (before.windows(3))
            .filter(|w| w[1].value < w[0].value && w[1].value <= w[2].value)
            .map(|w| w[1])
            .filter(|step| step.value < 2.0 * near(step.t))
            .min_by(|a, b| a.value.total_cmp(&b.value));
        Why {
            origin: line.origin,
            direction: line.direction,
            inside: line.inside,
            footprint: near(steps.last().map_or(0.0, |step| step.t)),
            steps,
            end,
            hit,
            verdict,
            passed,
            divided: self.program.slope(),
            exactness: self.program.exactness(),
            is_fractal: self.program.is_fractal(),
            is_unbounded,
        }
    }

    /// Finds whose surface the steps are set by.
    fn mark(&self, line: &Line, steps: &mut [Step]) {
        let mut q = self.scratch();
        for part in steps.chunks_mut(zeroset_eval::BATCH) {
            for (i, step) in part.iter().enumerate() {
                let at = line.at(step.t).array();
                for (column, x) in q.work.points_mut().iter_mut().zip(at) {
                    column.0[i] = x.0 as f32;
                }
            }
            let marks = self.program.marks();
            at_level!(self.renderer.level, s => zeroset_eval::marks(s, marks, &mut q.work, part.len()));
            let objects = &q.work.marks().object.0;
            for (step, &object) in part.iter_mut().zip(objects) {
                step.object = (object >= 0.0).then_some(object as usize);
            }
        }
        self.give_back(q);
    }
}
