//! Ambient occlusion.

use super::light::{Surface, passes};
use super::{Plain, Probe, field, glam};
use glam::Vec3;
use zeroset_number::v3;
use zeroset_scene::settings::Occlusion;
use zeroset_shade::occlusion::{
    BLOCKED, CARE, CLOSENESS, CONES, COSINES, EMPTY, EVANS, EXTENT, FREE, FULL, GROWTH, NARROW,
    START, SURE, UP, WIDTH, directions, distances, left, ring, seen, turn, weights,
};
use zeroset_shade::sampling::{cosine_direction, point};
use zeroset_shade::secondary::{SHARE, SMOOTHING, STEEPEST};

impl Plain<'_> {
    /// Ambient visibility, the bent normal, and what colours things near by give to the light.
    pub(super) fn occlusion(
        &self,
        probe: &mut impl Probe,
        at: &Surface,
        object: f32,
        key: [u32; 2],
    ) -> (f32, Vec3, Vec3) {
        let chosen = self
            .scene
            .objects()
            .get(object.max(0.0) as usize)
            .and_then(|o| o.occlusion);
        let up = Vec3::from(UP);
        let mut f = |p: Vec3| self.distance(probe, p);
        let open = match chosen.unwrap_or(self.settings.occlusion) {
            Occlusion::None => 1.0,
            Occlusion::Quilez { steps, step, scale } => {
                let part = |k: u32| {
                    let far = k as f32 * step;
                    0.5f32.powi(k as i32) * (far - f(at.p + at.normal * far))
                };
                1.0 - (scale * (1..=steps).map(part).sum::<f32>()).clamp(0.0, 1.0)
            }
            Occlusion::Bent {
                steps,
                step,
                scale,
                bend,
            } => {
                let (mut n, mut sum) = (at.normal, 0.0);
                for k in 1..=steps {
                    let far = k as f32 * step;
                    sum += 1.1f32.powi(-(k as i32)) * (n.length() * far - f(at.p + n * far));
                    n += up * bend;
                }
                1.0 - (scale * sum).clamp(0.0, 1.0)
            }
            Occlusion::Evans { scale, step, bend } => {
                let n = at.normal + up * bend;
                let part = |(k, weight): (usize, &f32)| {
                    let far = step * (1 << k) as f32;
                    weight * (far - f(at.p + n * far))
                };
                (-scale * EVANS.iter().enumerate().map(part).sum::<f32>())
                    .min(0.0)
                    .exp()
            }
            method @ Occlusion::Skylight { .. } => return self.skylight(&mut f, at, method),
            Occlusion::Curvature { blur, strength, .. } => self.curvature(at, blur, strength),
            Occlusion::Upward { scale } => {
                1.0 - (scale * (1.0 - at.normal.dot(up))).clamp(0.0, 1.0)
            }
            Occlusion::Cones { reach, steps } => {
                let (open, bent) = self.cones(&mut f, at, reach, steps);
                return (open, bent, Vec3::ONE);
            }
            Occlusion::Hemisphere { rays, reach } => {
                self.hemisphere(probe, at, rays, reach, key, |_| 0.0)
            }
            Occlusion::Obscurance { rays, reach, tau } => {
                self.hemisphere(probe, at, rays, reach, key, |t| 1.0 - (-tau * t).exp())
            }
        };
        (open, at.normal, Vec3::ONE)
    }

    fn hemisphere(
        &self,
        probe: &mut impl Probe,
        at: &Surface,
        rays: u32,
        reach: Option<f32>,
        key: [u32; 2],
        stopped: impl Fn(f32) -> f32 + Copy,
    ) -> f32 {
        let reach = reach.unwrap_or(f32::INFINITY);
        let mut sum = 0.0;
        for i in 0..rays {
            let [u, v] = point(i, key);
            let to = glam(cosine_direction(field(at.normal), u, v));
            if at.normal.dot(to) > 0.0 {
                sum += self.hard(probe, at, to, reach, stopped);
            }
        }
        sum / rays.max(1) as f32
    }

    /// Eleven cones: how far each is clear, and what its neighbours say of those that are blocked.
    fn cones(
        &self,
        f: &mut impl FnMut(Vec3) -> f32,
        at: &Surface,
        reach: Option<f32>,
        steps: u32,
    ) -> (f32, Vec3) {
        let far = reach.unwrap_or(f32::INFINITY).min(self.view.far);
        let origin = at.p + at.normal * at.offset;
        let ball = touching(f, origin, at, far);
        if ball >= far {
            return (1.0, at.normal);
        }
        let to = directions().map(|[x, y, z]| glam(turn(field(at.normal), v3(x, y, z))));
        let clear: [f32; CONES] = std::array::from_fn(|k| {
            let cosine = COSINES[ring(k)];
            let t = (at.offset * START).max(ball * FREE * cosine);
            let end = self
                .leave(origin, to[k], SURE * FULL, at.offset)
                .min(far)
                .max(t);
            let mut along = |t: f32| f(origin + to[k] * t);
            let touch = self.quality.skins.then(|| self.touch(at));
            let sine = clearance(&mut along, t, end, cosine, steps, touch);
            EXTENT * ((sine - BLOCKED) / (FULL - BLOCKED)).clamp(0.0, 1.0)
        });
        let (distances, weights) = (distances(), weights());
        let (mut open, mut bent) = (0.0, at.normal * 1e-3);
        for (k, (&w, apart)) in to.iter().zip(&distances).enumerate() {
            let others = clear.iter().zip(apart).enumerate();
            let behind = others
                .filter(|(j, _)| *j != k)
                .map(|(_, (other, distance))| left(*other, *distance))
                .fold(-WIDTH[0], f32::max)
                .min(0.0)
                / WIDTH[0];
            let before = clear[k] / WIDTH[ring(k)];
            let close = (1.0 - before / CLOSENESS).max(0.0);
            let share = seen(before + behind * close) * weights[ring(k)];
            open += share;
            bent += w * share;
        }
        let open = (open * 1.000_002).min(1.0);
        let lack = 0.501 - 2.591 * open + 2.719 * open * open;
        (
            open + open * (1.0 - open) * lack,
            bent.normalize_or(at.normal),
        )
    }
}

/// Radius of a ball that touches the origin and is empty, `far` if it may be as large as that.
fn touching(f: &mut impl FnMut(Vec3) -> f32, origin: Vec3, at: &Surface, far: f32) -> f32 {
    let (mut large, mut t) = (0.0, (at.offset * START).min(far));
    let mut is_empty = |t: f32| f(origin + at.normal * t) > t * EMPTY;
    while is_empty(t) {
        if t >= far {
            return far;
        }
        (large, t) = (t, (t * GROWTH).min(far));
    }
    let mut least = t;
    while large > 0.0 && least > large * NARROW {
        let t = (large * least).sqrt();
        if is_empty(t) {
            large = t;
        } else {
            least = t;
        }
    }
    large
}

/// Sine of the largest clear angle around a ray from `start` to `end`, at most `FULL`; 0 if something is hit. `touch`: see
/// [`skin::touch`], where there are skins.
fn clearance(
    f: &mut impl FnMut(f32) -> f32,
    start: f32,
    end: f32,
    mut slope: f32,
    steps: u32,
    touch: Option<f32>,
) -> f32 {
    let (mut t, mut least) = (start, FULL);
    let mut last: Option<(f32, f32)> = None;
    let mut rise = 1.0f32;
    for _ in 0..steps.max(1) {
        let value = f(t);
        if let Some((step, before)) = last {
            rise = ((value - before) / step.max(1e-20)).clamp(-1.0, 1.0);
            // where the balls around two samples do not touch there may be something between them: back to where they do
            if step > before && before + value < step {
                t += before - step;
                last = Some((before, before));
                slope = -1.0;
                continue;
            }
        }
        if value <= BLOCKED * t {
            let open = touch.is_some_and(|touch| passes(f, t, end, touch));
            return if open { FULL } else { 0.0 };
        }
        least = least.min(value / t);
        if t >= end {
            return least;
        }
        if last.is_some() {
            slope += SMOOTHING * (rise - slope);
        }
        slope = slope.min(STEEPEST);
        let edge = CARE * least;
        let to_edge = 2.0 * SHARE * (value - edge * t) / (1.0 - slope + 2.0 * edge);
        let step = to_edge.max(value).min(end - t);
        last = Some((step, value));
        t += step;
    }
    // as it went last: then f / t tends to the slope
    least.min(rise.max(0.0))
}
