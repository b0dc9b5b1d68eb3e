//! Primary rays and normals.

use super::{Plain, Probe, field, glam};
use crate::normal::{CENTRAL, NEIGHBOURS_18, NEIGHBOURS_26, TETRAHEDRON, step};
use glam::Vec3;
use zeroset_scene::settings::{March, Normals};

/// Where a ray ended.
pub(super) struct Found {
    pub(super) hit: Option<Ending>,
    pub(super) steps: u32,
}

/// On a surface.
#[derive(Clone, Copy)]
pub(super) struct Ending {
    pub(super) t: f32,
    /// Value of the field, from the side that was marched.
    pub(super) f: f32,
    /// 1, or -1 where the ray began inside the solid.
    pub(super) side: f32,
}

impl Plain<'_> {
    /// Marches a ray from where it enters the scene's box.
    pub(super) fn march(&self, probe: &mut impl Probe, o: Vec3, d: Vec3) -> Found {
        let (a, b) = (field(o), field(d));
        let wide = self.view.threshold;
        let start = self
            .region
            .enter(a, b, wide.slope, wide.constant)
            .max(self.view.near);
        let end = self
            .region
            .leave(a, b, wide.slope, wide.constant)
            .min(self.view.far);
        if start >= end {
            return Found {
                hit: None,
                steps: 0,
            };
        }
        let mut steps = 0;
        let mut at = |t: f32| {
            steps += 1;
            probe.value(o + d * t)
        };
        let first = at(start);
        let side = if first < 0.0 { -1.0 } else { 1.0 };
        let threshold = |t: f32| wide.at(t);
        let mut ray = Ray {
            t: start,
            r: side * first,
            end,
            left: self.settings.max_steps.max(1) - 1,
            best: None,
        };
        let mut f = |t: f32| side * at(t);
        let found = match self.settings.march {
            March::Fixed { step } => ray.fixed(&mut f, step, threshold),
            March::Sphere => ray.relaxed(&mut f, 1.0, threshold),
            March::Relaxed { omega } => ray.relaxed(&mut f, omega, threshold),
            March::Enhanced { share } => ray.enhanced(&mut f, share, threshold),
            March::Auto { beta } => ray.auto(&mut f, beta, threshold),
        };
        let hit = match found {
            Way::Hit(t, f) => Some(Ending { t, f, side }),
            Way::Left => None,
            // Keinert 2014, 3.2: the candidate with the smallest sphere on the picture, or else the last place
            Way::Spent if self.settings.hit_selection => {
                ray.best.map(|(_, t, f)| Ending { t, f, side })
            }
            Way::Spent => Some(Ending {
                t: ray.t,
                f: ray.r,
                side,
            }),
        };
        Found { hit, steps }
    }

    /// The normal at a hit, on the side that was marched.
    pub(super) fn normal(
        &self,
        probe: &mut impl Probe,
        p: Vec3,
        d: Vec3,
        t: f32,
        side: f32,
    ) -> Vec3 {
        let h = step(field(p), self.view.pixel.at(t));
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
            Normals::Exact => probe.gradient(p),
        };
        (g * side).try_normalize().unwrap_or(-d)
    }

    /// Where a ray that starts on a surface leaves all that could darken it.
    pub(super) fn leave(&self, o: Vec3, d: Vec3, width: f32, margin: f32) -> f32 {
        self.region.leave(field(o), field(d), width, margin)
    }

    /// The direction to a light, and its distance.
    pub(super) fn towards(source: &zeroset_scene::light::Source, p: Vec3) -> (Vec3, f32) {
        let (to, distance) = crate::shadow::towards(source, field(p));
        (glam(to), distance)
    }
}

/// How a march came out.
enum Way {
    Hit(f32, f32),
    Left,
    Spent,
}

/// A ray on its way: the last good place, the radius there, and how far it may still go.
struct Ray {
    t: f32,
    r: f32,
    end: f32,
    left: u32,
    /// The best candidate so far: its size, its place, its value.
    best: Option<(f32, f32, f32)>,
}

impl Ray {
    /// Whether the radius at the last place ends the march.
    fn settled(&mut self, threshold: impl Fn(f32) -> f32) -> Option<Way> {
        let limit = threshold(self.t);
        let size = self.r.abs() / limit;
        if self.best.is_none_or(|(best, ..)| size < best) {
            self.best = Some((size, self.t, self.r));
        }
        if self.r < limit {
            Some(Way::Hit(self.t, self.r))
        } else if self.t + self.r >= self.end {
            Some(Way::Left)
        } else {
            None
        }
    }

    /// One more sample, if any are left.
    fn sample(&mut self, f: &mut impl FnMut(f32) -> f32, z: f32) -> Option<f32> {
        self.left = self.left.checked_sub(1)?;
        Some(f(self.t + z))
    }

    /// Sphere tracing, over-relaxed until the first gap (Keinert 2014, listing 2 corrected). With `omega` 1 there are none.
    fn relaxed(
        &mut self,
        f: &mut impl FnMut(f32) -> f32,
        mut omega: f32,
        threshold: impl Fn(f32) -> f32 + Copy,
    ) -> Way {
        loop {
            if let Some(way) = self.settled(threshold) {
                return way;
            }
            let mut z = (self.r * omega).min(self.end - self.t);
            let Some(mut next) = self.sample(f, z) else {
                return Way::Spent;
            };
            if z > self.r && z > self.r + next {
                omega = 1.0;
                z = self.r.min(self.end - self.t);
                match self.sample(f, z) {
                    Some(again) => next = again,
                    None => return Way::Spent,
                }
            }
            (self.t, self.r) = (self.t + z, next);
        }
    }

    /// The planar guess (Balint and Valasek 2018).
    fn enhanced(
        &mut self,
        f: &mut impl FnMut(f32) -> f32,
        share: f32,
        threshold: impl Fn(f32) -> f32 + Copy,
    ) -> Way {
        let mut last: Option<(f32, f32)> = None;
        loop {
            if let Some(way) = self.settled(threshold) {
                return way;
            }
            let guess = last.map_or(self.r, |(d, r0)| {
                let behind = (d + r0 - self.r).max(0.02 * d).max(1e-20);
                self.r + share * self.r * ((d - r0 + self.r) / behind).max(0.0)
            });
            let mut z = guess.min(self.end - self.t);
            let Some(mut next) = self.sample(f, z) else {
                return Way::Spent;
            };
            if z > self.r && z > self.r + next {
                z = self.r.min(self.end - self.t);
                match self.sample(f, z) {
                    Some(again) => next = again,
                    None => return Way::Spent,
                }
            }
            last = Some((z, self.r));
            (self.t, self.r) = (self.t + z, next);
        }
    }

    /// The smoothed slope (Ban and Valasek 2023).
    fn auto(
        &mut self,
        f: &mut impl FnMut(f32) -> f32,
        beta: f32,
        threshold: impl Fn(f32) -> f32 + Copy,
    ) -> Way {
        let mut m = -1.0f32;
        loop {
            if let Some(way) = self.settled(threshold) {
                return way;
            }
            let z = (self.r * (2.0 / (1.0 - m)).max(1.0)).min(self.end - self.t);
            let Some(next) = self.sample(f, z) else {
                return Way::Spent;
            };
            if z > self.r && z > self.r + next {
                m = -1.0;
                continue;
            }
            let slope = ((next - self.r) / z).clamp(-1.0, 1.0);
            m = (m + (slope - m) * beta).min(0.98);
            (self.t, self.r) = (self.t + z, next);
        }
    }

    /// Constant steps, then bisection (Tomczak 2012, algorithm 2.1; Munini 2021, 3.2).
    fn fixed(
        &mut self,
        f: &mut impl FnMut(f32) -> f32,
        step: f32,
        threshold: impl Fn(f32) -> f32 + Copy,
    ) -> Way {
        loop {
            let limit = threshold(self.t);
            let size = self.r.abs() / limit;
            if self.best.is_none_or(|(best, ..)| size < best) {
                self.best = Some((size, self.t, self.r));
            }
            if self.t >= self.end {
                return Way::Left;
            }
            let z = step.min(self.end - self.t);
            let Some(next) = self.sample(f, z) else {
                return Way::Spent;
            };
            if next < 0.0 {
                return self.bisect(f, z, threshold);
            }
            (self.t, self.r) = (self.t + z, next);
        }
    }

    /// Halves the last step, in which the sign changed.
    fn bisect(
        &mut self,
        f: &mut impl FnMut(f32) -> f32,
        z: f32,
        threshold: impl Fn(f32) -> f32,
    ) -> Way {
        let (mut outside, mut inside) = (self.t, self.t + z);
        let mut value = self.r;
        while 0.5 * (inside - outside) >= 0.5 * threshold(inside) {
            self.t = 0.5 * (outside + inside);
            let Some(next) = self.sample(f, 0.0) else {
                return Way::Spent;
            };
            value = next;
            if next < 0.0 {
                inside = self.t;
            } else {
                outside = self.t;
            }
        }
        Way::Hit(self.t, value)
    }
}
