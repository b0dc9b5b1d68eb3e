//! Tone curves: from linear light to what a file or a screen takes.

use zeroset_number::Real;

/// The sRGB value (0 to 1) of linear light (IEC 61966-2-1). What is brighter than 1 becomes 1, what is not a number 0.
#[inline(always)]
pub fn encode<R: Real>(linear: R) -> R {
    let c = linear.clamp01();
    let curved = c.powf(R::constant(1.0 / 2.4)) * 1.055 - 0.055;
    // the curve does not quite end in 1
    let curved = R::choose(c.below(1.0), curved, c);
    R::select(c.above(0.003_130_8), curved, c * 12.92)
}

/// The linear light of an sRGB value (IEC 61966-2-1).
#[inline(always)]
pub fn decode<R: Real>(coded: R) -> R {
    let curved = ((coded + 0.055) / 1.055).powf(R::constant(2.4));
    R::select(coded.above(0.040_45), curved, coded / 12.92)
}
