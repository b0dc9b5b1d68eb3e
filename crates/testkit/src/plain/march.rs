//! Primary rays and normals.

use super::{Plain, Probe, Ray, field, glam};
use glam::Vec3;
use zeroset_scene::settings::{March, Normals};
use zeroset_shade::light;
use zeroset_shade::normal::{CENTRAL, NEIGHBOURS_18, NEIGHBOURS_26, TETRAHEDRON, step};
use zeroset_shade::view::ROUNDING;

/// Where a ray ended.
pub(super) struct Found {
    pub(super) hit: Option<Ending>,
    pub(super) steps: u32,
}

/// On a surface.
#[derive(Clone, Copy)]
pub(super) struct Ending {
    pub(super) t: f32,
    /// Value of the field where it was found under the footprint, from the side that was marched; zero where it changed its
    /// sign.
    pub(super) f: f32,
    /// 1, or -1 where the ray began inside the solid.
    pub(super) side: f32,
}

/// How much farther than its steps a ray is followed before it counts as one that hits nothing.
const PATIENCE: u32 = 400;

impl Plain<'_> {
    /// Marches a ray from where it enters the scene's box, or from a surface.
    pub(super) fn march(&self, probe: &mut impl Probe, ray: &Ray) -> Found {
        let Ray { o, d, .. } = *ray;
        let (a, b) = (field(o), field(d));
        let wide = self.view.threshold;
        let start = if ray.travelled > 0.0 {
            0.0
        } else {
            self.region
                .enter(a, b, wide.slope, wide.constant)
                .max(self.view.near)
        };
        let end = self
            .region
            .leave(a, b, wide.slope, wide.at(ray.travelled))
            .min(self.view.far);
        if start >= end {
            return Found {
                hit: None,
                steps: 0,
            };
        }
        let mut steps = 1;
        let first = probe.value(o + d * start);
        let side = if first < 0.0 { -1.0 } else { 1.0 };
        let narrow = ray.narrow;
        let way = |t: f32| t + ray.travelled;
        let fractal = self.quality.fractal;
        let footprint = if fractal {
            1.0 / (self.samples() as f32).sqrt()
        } else {
            self.view.fine
        };
        let share = if fractal { 0.5 } else { 1.0 / 16.0 };
        let rounding = |t: f32| self.view.rounding.at(way(t));
        let near =
            |t: f32| (self.view.near(way(t), narrow) - rounding(t)) * footprint + rounding(t);
        let least = |t: f32| (near(t) - rounding(t)) * share + 4.0 * rounding(t);
        let behind = |t: f32| {
            let p = (o + d * t).abs();
            -0.5 * ROUNDING * (p.x + p.y + p.z)
        };
        let mut f = |t: f32| side * probe.value(o + d * t);
        let mut steady = Steady::new(self.settings.march);
        let patience = if self.settings.hit_selection {
            PATIENCE
        } else {
            1
        };
        let limit = self.quality.max_steps.saturating_mul(patience);
        let (mut t, mut r) = (start, side * first);
        // the step, whether it is a guess of where the sign changes, whether it goes towards a surface
        let (mut z, mut guess, mut towards) = (steady.step(r), false, false);
        let (mut found, mut lost) = (None, false);
        let mut arrived = fractal && r < near(t);
        while !arrived && t + r.max(0.0) < end {
            if steps >= limit {
                lost = true;
                break;
            }
            let floor = match steady.careful() {
                false => 0.0,
                true if towards && !fractal && r < 0.0 => (64.0 * rounding(t)).min(least(t)),
                true if towards && !fractal => 4.0 * rounding(t),
                true => least(t),
            };
            z = z.max(floor).min(end - t);
            let next = f(t + z);
            steps += 1;
            let crossed = next < behind(t + z) || (next < 0.0 && r < 0.0);
            let gap = steady.careful() && z > r && z > r + next && (guess || z > least(t + z));
            if crossed && (!gap || guess) {
                if fractal {
                    (t, r, arrived) = (t + z, next, true);
                    break;
                }
                found = Some([t, r.max(0.0), t + z, next]);
                break;
            }
            if gap {
                steady.fail();
                (z, guess, towards) = (r, false, true);
                continue;
            }
            steady.pass(z, r, next);
            let (fall, z_taken) = (r - next, z);
            let root = next * z / fall.max(1e-30) * 1.1 + least(t + z);
            (t, r) = (t + z, next);
            towards = fall > 0.02 * z_taken;
            z = steady.step(r);
            if steady.careful() && !fractal && z < least(t) {
                z = r;
            }
            guess = steady.careful()
                && !fractal
                && (0.0..near(t)).contains(&r)
                && fall > 0.0
                && root > z.max(least(t))
                && root < 64.0 * near(t);
            if guess {
                z = root;
            }
            arrived = fractal && r < near(t);
        }
        let found = found.map(|part| bisect(&mut f, part));
        if lost {
            // nobody knows: a surface only where the ray is within a pixel of it
            let slope = probe.gradient(o + d * t).length().max(1e-30);
            arrived = r / slope < 2.0 * self.view.near(way(t), narrow);
        }
        let hit = match found {
            Some(t) => Some(Ending { t, f: 0.0, side }),
            None => arrived.then_some(Ending { t, f: r, side }),
        };
        Found { hit, steps }
    }

    /// The normal at a hit, on the side that was marched.
    pub(super) fn normal(
        &self,
        probe: &mut impl Probe,
        p: Vec3,
        ray: &Ray,
        t: f32,
        side: f32,
    ) -> Vec3 {
        let (d, way) = (ray.d, t + ray.travelled);
        let h = step(field(p), self.view.width(way, ray.narrow));
        let mut sum = |samples: &[[f32; 3]]| {
            let part = |to: &[f32; 3]| {
                let to = Vec3::from(*to);
                to.normalize() * probe.value(p + to * h)
            };
            samples.iter().map(part).sum::<Vec3>()
        };
        let g = match self.settings.normals {
            Normals::Tetrahedron => sum(&TETRAHEDRON),
            Normals::Central => sum(&CENTRAL),
            Normals::Samples18 => sum(&NEIGHBOURS_18),
            Normals::Samples26 => sum(&NEIGHBOURS_26),
            Normals::Exact => {
                let g = probe.gradient(p);
                // on an edge the gradient may be that of the face behind it
                let before = probe.gradient(p - d * self.view.near(way, ray.narrow));
                match ((g * side).dot(d) > 0.0, (before * side).dot(d) > 0.0) {
                    (false, _) => g,
                    (true, false) => before,
                    (true, true) => g - d * g.dot(d),
                }
            }
        };
        (g * side).try_normalize().unwrap_or(-d)
    }

    /// Where a ray that starts on a surface leaves all that could darken it.
    pub(super) fn leave(&self, o: Vec3, d: Vec3, width: f32, margin: f32) -> f32 {
        self.region.leave(field(o), field(d), width, margin)
    }

    /// The direction to a light, and its distance.
    pub(super) fn towards(source: &zeroset_scene::light::Source, p: Vec3) -> (Vec3, f32) {
        let (to, distance) = light::towards(source, field(p));
        (glam(to), distance)
    }
}

/// The place between two samples where the sign changes.
fn bisect(f: &mut impl FnMut(f32) -> f32, [mut outside, _, mut inside, _]: [f32; 4]) -> f32 {
    for _ in 0..40 {
        let middle = 0.5 * (outside + inside);
        if f(middle) < 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    0.5 * (outside + inside)
}

/// What a marcher remembers of the steps before.
struct Steady {
    march: March,
    /// Omega, or the smoothed slope.
    number: f32,
    /// The last step and the radius that it began with.
    last: Option<(f32, f32)>,
}

impl Steady {
    fn new(march: March) -> Steady {
        let number = match march {
            March::Relaxed { omega } => omega,
            March::Fixed { .. } | March::Sphere | March::Enhanced { .. } | March::Auto { .. } => {
                -1.0
            }
        };
        Steady {
            march,
            number,
            last: None,
        }
    }

    /// Whether samples between which there may be a surface are taken back.
    fn careful(&self) -> bool {
        match self.march {
            March::Fixed { .. } => false,
            March::Sphere | March::Relaxed { .. } | March::Enhanced { .. } | March::Auto { .. } => {
                true
            }
        }
    }

    /// A sample was taken back.
    fn fail(&mut self) {
        match self.march {
            March::Relaxed { .. } => self.number = 1.0,
            March::Auto { .. } => self.number = -1.0,
            March::Fixed { .. } | March::Sphere | March::Enhanced { .. } => {}
        }
    }

    /// A sample was kept.
    fn pass(&mut self, z: f32, before: f32, r: f32) {
        match self.march {
            March::Auto { beta } => {
                let slope = ((r - before) / z.max(1e-20)).clamp(-1.0, 1.0);
                self.number = (self.number + (slope - self.number) * beta).min(0.98);
            }
            March::Fixed { .. }
            | March::Sphere
            | March::Relaxed { .. }
            | March::Enhanced { .. } => {}
        }
        self.last = Some((z, before));
    }

    /// The next step from a place with this radius.
    fn step(&self, r: f32) -> f32 {
        match self.march {
            March::Fixed { step } => step,
            March::Sphere => r,
            March::Relaxed { .. } => r * self.number,
            // the planar guess (Balint and Valasek 2018)
            March::Enhanced { share } => self.last.map_or(r, |(d, r0)| {
                let behind = (d + r0 - r).max(0.02 * d).max(1e-20);
                r + share * r * ((d - r0 + r) / behind).max(0.0)
            }),
            // the smoothed slope (Ban and Valasek 2023)
            March::Auto { .. } => r * (2.0 / (1.0 - self.number)).max(1.0),
        }
    }
}
