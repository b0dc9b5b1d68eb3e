//! What rays see that hit nothing, and what lights a scene from everywhere.

use crate::{each, parameters};
use zeroset_number::{Real, Vec3};
use zeroset_scene::light::{HAZE, Sky};

/// How far apart the heights are that a rough mirror shows, for each unit of the width of its distribution...
const SPREAD: f32 = 1.2;
/// ...and at most.
const FARTHEST: f32 = 0.6;

/// The share of what arrives at an open surface that is from above the horizon, over the height of its normal: even powers, and the first.
/// Fitted to the integral over the hemisphere by the cosine law, with an error of 0.0015.
const ABOVE: [f32; 4] = [0.283_25, 0.408_95, 0.080_87, 0.043_67];

/// The numbers of a sky.
#[derive(Clone, Copy, Debug)]
pub struct SkyColours<C> {
    /// Linear colour straight up.
    pub top: Vec3<C>,
    /// Linear colour at the horizon.
    pub horizon: Vec3<C>,
    /// Linear colour straight down.
    pub bottom: Vec3<C>,
    /// Share of the sky's light that reaches an open surface.
    pub ambient: C,
}

impl SkyColours<f32> {
    /// Those of a scene's sky.
    #[inline(always)]
    pub fn of(sky: &Sky) -> Self {
        SkyColours {
            top: parameters(sky.top),
            horizon: parameters(sky.horizon),
            bottom: parameters(sky.bottom),
            ambient: sky.ambient,
        }
    }
}

/// How the sky changes from the horizon, 0, to straight up or down, 1, over the height `y` of the direction: without a line where
/// they meet.
#[inline(always)]
fn height<R: Real>(y: R) -> R {
    let square = y.sq().min(1.0);
    square * (1.0 + HAZE) / (square + HAZE)
}

/// The sky along a direction whose height is `y`: smooth from the bottom over the horizon to the top.
#[inline(always)]
pub fn colour<R: Real>(sky: &SkyColours<R::Scalar>, y: R) -> Vec3<R> {
    let t = height(y);
    let down = y.negative();
    let horizon = sky.horizon.array();
    let (top, bottom) = (
        (sky.top - sky.horizon).array(),
        (sky.bottom - sky.horizon).array(),
    );
    each(
        #[inline(always)]
        |k| t * R::select(down, t.like(bottom[k]), t.like(top[k])) + horizon[k],
    )
}

/// The sky as a rough mirror shows it that looks along a direction of height `y`: the mean of three heights, farther apart the rougher
/// it is.
#[inline(always)]
pub fn glossy<R: Real>(sky: &SkyColours<R::Scalar>, y: R, roughness: R) -> Vec3<R> {
    let apart = (roughness.sq() * SPREAD).min(FARTHEST);
    let (low, high) = ((y - apart).max(-1.0), (y + apart).min(1.0));
    (colour(sky, low) + colour(sky, high)) * 0.25 + colour(sky, y) * 0.5
}

/// What arrives of the sky at an open surface whose normal (or bent normal) has the height `y`: the mean of the sky over the
/// hemisphere around it by the cosine law.
#[inline(always)]
pub fn ambient<R: Real>(sky: &SkyColours<R::Scalar>, y: R) -> Vec3<R> {
    let square = y.sq();
    let even = (square * ABOVE[3] + ABOVE[2]) * square + ABOVE[0];
    let odd = y * ABOVE[1];
    let (up, down) = (even + odd, even - odd);
    let horizon = (even * 2.0).one_minus();
    let (top, middle, bottom) = (
        (sky.top * sky.ambient).array(),
        (sky.horizon * sky.ambient).array(),
        (sky.bottom * sky.ambient).array(),
    );
    each(
        #[inline(always)]
        |k| up * top[k] + horizon * middle[k] + down * bottom[k],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{cosine_direction, point};
    use glam::Vec3 as G;
    use zeroset_number::v3;

    #[test]
    fn the_sky_is_the_scenes() {
        let s = Sky::default();
        for y in [-1.0, -0.3, 0.0, 0.01, 0.5, 1.0f32] {
            let d = G::new((1.0 - y * y).sqrt(), y, 0.0);
            let found = G::from(colour(&SkyColours::of(&s), y).array());
            assert!((found - s.colour(d)).length() < 1e-6);
        }
    }

    #[test]
    fn what_arrives_is_the_mean_by_the_cosine_law() {
        let s = SkyColours::of(&Sky {
            ambient: 1.0,
            ..Sky::default()
        });
        for y in [-1.0, -0.6, 0.0, 0.3, 0.8, 1.0f32] {
            let n = v3((1.0 - y * y).sqrt(), y, 0.0);
            let (mut mean, count) = (v3(0.0, 0.0, 0.0), 4096);
            for i in 0..count {
                let [u, v] = point(i, [0, 0]);
                let d = cosine_direction(n, u, v);
                mean = mean + colour(&s, d.y) / count as f32;
            }
            let error = (ambient(&s, y) - mean).abs().max_component();
            assert!(error < 2e-3, "{y}: {error}");
        }
    }

    #[test]
    fn the_horizon_has_no_line() {
        let s = SkyColours::of(&Sky::default());
        let steps = 2000;
        let at = |i: i32| colour(&s, i as f32 / steps as f32).x;
        for i in -steps + 1..steps - 1 {
            // the slope changes by little from one step to the next
            let bend = at(i + 1) - 2.0 * at(i) + at(i - 1);
            assert!(bend.abs() < 1e-4, "{i}: {bend}");
        }
    }
}
