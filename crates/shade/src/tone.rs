//! Tone curves: from linear light to what a file or a screen takes.

use zeroset_number::{Real, Vec3, v3};
use zeroset_scene::settings::Tone;

/// Up to here [`Tone::Soft`] keeps light as it is.
const KNEE: f32 = 0.7;

/// What a screen shows of linear light, itself linear, 0 to 1.
#[inline(always)]
pub fn view<R: Real>(tone: Tone, light: Vec3<R>) -> Vec3<R> {
    match tone {
        Tone::Standard => light,
        Tone::Soft => light.map(soft),
        Tone::Filmic => light.map(filmic),
        Tone::Agx => agx(light),
    }
}

/// As it is up to a knee, then ever more slowly towards 1, without a corner.
#[inline(always)]
fn soft<R: Real>(x: R) -> R {
    let over = ((x - KNEE) * (1.0 / (1.0 - KNEE))).max(0.0);
    let bent = (-over).exp().one_minus() * (1.0 - KNEE) + KNEE;
    R::select(x.above(KNEE), bent, x)
}

/// The curve of the Academy's reference rendering (ACES) as Narkowicz (2016) fitted it, with his exposure of 0.6 that keeps a middle grey.
#[inline(always)]
fn filmic<R: Real>(x: R) -> R {
    let x = x.max(0.0) * 0.6;
    let top = x * (x * 2.51 + 0.03);
    let bottom = x * (x * 2.43 + 0.59) + 0.14;
    (top / bottom).min(1.0)
}

/// From linear light to the space in which AgX bends its curves, row by row, and back.
const AGX_IN: [[f32; 3]; 3] = [
    [0.842_479_06, 0.078_433_6, 0.079_223_745],
    [0.042_328_242, 0.878_468_64, 0.079_166_13],
    [0.042_375_655, 0.078_433_6, 0.879_143],
];
const AGX_OUT: [[f32; 3]; 3] = [
    [1.196_879, -0.098_020_88, -0.099_029_74],
    [-0.052_896_852, 1.151_903_1, -0.098_961_18],
    [-0.052_971_636, -0.098_043_45, 1.151_073_7],
];
/// Stops from the darkest to the brightest light that AgX tells apart.
const AGX_STOPS: [f32; 2] = [-12.473_93, 4.026_069];
/// The curve over the share of these stops, by powers from 0 on.
const AGX_CURVE: [f32; 7] = [-0.002_32, 0.119_1, 0.429_8, -6.868, 31.96, -40.14, 15.5];

/// AgX (Sobotka 2022) with the polynomial that Wrensch (2023) fitted to its curve: bright colours grow pale, as on film.
#[inline(always)]
fn agx<R: Real>(light: Vec3<R>) -> Vec3<R> {
    let inner = turned(&AGX_IN, light);
    let bent = inner.map(
        #[inline(always)]
        |x| {
            let stops = x.max(1e-10).log2();
            let share = ((stops - AGX_STOPS[0]) * (1.0 / (AGX_STOPS[1] - AGX_STOPS[0]))).clamp01();
            let mut sum = share.lit(0.0);
            for k in AGX_CURVE.iter().rev() {
                sum = sum * share + *k;
            }
            sum
        },
    );
    // the curve leads to what a screen of gamma 2.2 takes
    turned(&AGX_OUT, bent).map(
        #[inline(always)]
        |x| x.clamp01().powf(R::constant(2.2)),
    )
}

#[inline(always)]
fn turned<R: Real>(rows: &[[f32; 3]; 3], v: Vec3<R>) -> Vec3<R> {
    let row = |k: usize| v.x * rows[k][0] + v.y * rows[k][1] + v.z * rows[k][2];
    v3(row(0), row(1), row(2))
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_view_rises_from_black_to_white() {
        for tone in Tone::ALL {
            let grey = |x: f32| view(tone, v3(x, x, x));
            let mut last = -1e-3;
            for i in 0..4000 {
                let x = (f32::exp2(i as f32 * 0.005) - 1.0) * 1e-3;
                let shown = grey(x);
                assert!((shown.x - shown.y).abs() < 2e-3 && (shown.x - shown.z).abs() < 2e-3);
                assert!(shown.x >= last - 2e-4, "{tone:?} falls at {x}");
                last = shown.x;
            }
            assert!(
                grey(0.0).x.abs() < 5e-3,
                "{tone:?}: black is {}",
                grey(0.0).x
            );
            let bright = grey(1000.0).x;
            assert!(bright >= 0.97, "{tone:?}: white is {bright}");
            // a middle grey stays one
            let middle = grey(0.18).x;
            assert!((0.1..0.3).contains(&middle), "{tone:?}: {middle}");
        }
    }

    #[test]
    fn soft_has_no_corner_and_keeps_what_is_below_its_knee() {
        assert_eq!(
            view(Tone::Soft, v3(0.1, 0.69, 0.7f32)).array(),
            [0.1, 0.69, 0.7]
        );
        let slope = |x: f32| (soft(x + 1e-3) - soft(x)) / 1e-3;
        assert!((slope(KNEE) - slope(KNEE - 2e-3)).abs() < 5e-3);
        // a white floor in the sun keeps its shades
        assert!(soft(1.2f32) < 0.95 && soft(1.2f32) > soft(1.1f32) + 0.01);
    }
}
