//! What the numbers of methods may be.

use super::{Check, SAMPLES, count, number};
use crate::settings::{Antialias, March, Occlusion, Shadow};
use zeroset_catalogue::{LARGE, SMALL};

/// Whether a marcher's numbers are in their ranges.
///
/// # Errors
/// Which number is wrong.
pub fn march(march: &March) -> Check {
    match *march {
        March::Fixed { step } => number("step", step, SMALL as f32, LARGE as f32),
        March::Sphere => Ok(()),
        March::Relaxed { omega } => number("omega", omega, 1.0, 1.99),
        March::Enhanced { share } => number("share", share, 0.1, 1.0),
        March::Auto { beta } => number("beta", beta, 0.01, 1.0),
    }
}

/// Whether a shadow's numbers are in their ranges.
///
/// # Errors
/// Which number is wrong.
pub fn shadow(shadow: &Shadow) -> Check {
    match *shadow {
        Shadow::None | Shadow::Hard => Ok(()),
        Shadow::Soft { sharpness } | Shadow::SoftClosest { sharpness } => {
            number("sharpness", sharpness, 1.0, 1000.0)
        }
    }
}

/// Whether an occlusion's numbers are in their ranges, with `samples` rays or steps at most, and [`SAMPLES`].
///
/// # Errors
/// Which number is wrong.
pub fn occlusion(occlusion: &Occlusion, samples: u32) -> Check {
    let most = samples.min(SAMPLES);
    let length = |name: &'static str, x: f32| number(name, x, SMALL as f32, LARGE as f32);
    let far = |reach: Option<f32>| reach.map_or(Ok(()), |x| length("reach", x));
    let strength = |x: f32| number("scale", x, 0.0, 1000.0);
    let bend = |x: f32| number("bend", x, 0.0, 10.0);
    match *occlusion {
        Occlusion::None => Ok(()),
        Occlusion::Quilez { steps, step, scale } => {
            count("steps", steps, 1, most)?;
            length("step", step)?;
            strength(scale)
        }
        Occlusion::Bent {
            steps,
            step,
            scale,
            bend: b,
        } => {
            count("steps", steps, 1, most)?;
            length("step", step)?;
            strength(scale)?;
            bend(b)
        }
        Occlusion::Evans {
            scale,
            step,
            bend: b,
        } => {
            strength(scale)?;
            length("step", step)?;
            bend(b)
        }
        Occlusion::Upward { scale } => strength(scale),
        Occlusion::Cones { reach, steps } => {
            far(reach)?;
            count("steps", steps, 1, most)
        }
        Occlusion::Hemisphere { rays, reach } => {
            count("rays", rays, 1, most)?;
            far(reach)
        }
        Occlusion::Obscurance { rays, reach, tau } => {
            count("rays", rays, 1, most)?;
            far(reach)?;
            number("tau", tau, 1e-3, 1000.0)
        }
    }
}

/// Whether the smoothing of edges is in its ranges, with `samples` rays a pixel at most, and [`SAMPLES`].
///
/// # Errors
/// Which number is wrong.
pub fn antialias(antialias: &Antialias, samples: u32) -> Check {
    match *antialias {
        Antialias::None => Ok(()),
        Antialias::Supersample { samples: n, .. } => count("samples", n, 1, samples.min(SAMPLES)),
    }
}
