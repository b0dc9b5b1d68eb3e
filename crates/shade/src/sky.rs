//! What rays see that hit nothing, and what lights a scene from everywhere.

use crate::{each, parameters};
use zeroset_number::{Real, Vec3};
use zeroset_scene::light::Sky;

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

/// The sky along a direction whose height is `y`: smooth from the bottom over the horizon to the top.
#[inline(always)]
pub fn colour<R: Real>(sky: &SkyColours<R::Scalar>, y: R) -> Vec3<R> {
    let t = y.abs().min(1.0).sqrt();
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

/// What arrives of the sky at an open surface whose normal (or bent normal) has the height `y`: nearly the mean of the sky
/// over the hemisphere around it.
#[inline(always)]
pub fn ambient<R: Real>(sky: &SkyColours<R::Scalar>, y: R) -> Vec3<R> {
    let t = y * 0.5 + 0.5;
    let half = sky.ambient * 0.5;
    let low = ((sky.bottom + sky.horizon) * half).array();
    let rise = ((sky.top - sky.bottom) * half).array();
    each(
        #[inline(always)]
        |k| t * rise[k] + low[k],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3 as G;

    #[test]
    fn the_sky_is_the_scenes() {
        let s = Sky::default();
        for y in [-1.0, -0.3, 0.0, 0.01, 0.5, 1.0f32] {
            let d = G::new((1.0 - y * y).sqrt(), y, 0.0);
            let found = G::from(colour(&SkyColours::of(&s), y).array());
            assert!((found - s.colour(d)).length() < 1e-6);
        }
    }
}
