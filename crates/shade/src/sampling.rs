//! Where samples go, the same in every run: low-discrepancy sequences scrambled by pixel, and the pixel's filter.

use zeroset_number::{Real, Vec3, v3};
use zeroset_scene::settings::Filter;

/// The first two dimensions of Sobol's sequence (1967), as fractions of 2^32: any 2^k first points are spread evenly over
/// all boxes of area 2^-k that halving the sides gives. Scrambling by exclusive or keeps that (Kollig and Keller 2002).
#[inline(always)]
pub fn sobol(index: u32) -> [u32; 2] {
    let (mut i, mut direction, mut second) = (index, 1 << 31, 0);
    while i != 0 {
        if i & 1 == 1 {
            second ^= direction;
        }
        i >>= 1;
        direction ^= direction >> 1;
    }
    [index.reverse_bits(), second]
}

/// The numbers of the generator: factor and summand of its congruential step.
pub const PCG: [u32; 2] = [1_664_525, 1_013_904_223];

/// What the seeds of a pixel's hits are apart: 2^32 over the golden ratio.
pub const HIT_SEEDS: u32 = 0x9e37_79b9;

/// The seed of what is random at the hit of ray number `index` of a pixel: not that of the pixel's own samples.
#[inline(always)]
pub fn hit_seed(seed: u32, index: u32) -> u32 {
    seed ^ (index + 1).wrapping_mul(HIT_SEEDS)
}

/// Two random numbers of a pixel: the generator pcg3d (Jarzynski and Olano 2020).
#[inline(always)]
pub fn scramble(x: u32, y: u32, seed: u32) -> [u32; 2] {
    let mut v = [x, y, seed];
    for c in &mut v {
        *c = c.wrapping_mul(PCG[0]).wrapping_add(PCG[1]);
    }
    for _ in 0..2 {
        v[0] = v[0].wrapping_add(v[1].wrapping_mul(v[2]));
        v[1] = v[1].wrapping_add(v[2].wrapping_mul(v[0]));
        v[2] = v[2].wrapping_add(v[0].wrapping_mul(v[1]));
        for c in &mut v {
            *c ^= *c >> 16;
        }
    }
    [v[0], v[1]]
}

/// One over the numbers that [`unit()`] tells apart: as many as single precision has.
pub const UNIT: f32 = 1.0 / 16_777_216.0;

/// A fraction of 2^32 as a number in [0, 1).
#[inline(always)]
pub fn unit(x: u32) -> f32 {
    (x >> 8) as f32 * UNIT
}

/// Sample number `index` of a pixel, in [0, 1) by [0, 1).
#[inline(always)]
pub fn point(index: u32, scramble: [u32; 2]) -> [f32; 2] {
    let [x, y] = sobol(index);
    [unit(x ^ scramble[0]), unit(y ^ scramble[1])]
}

/// The factors of [`decided`]'s hash (Burley 2020).
pub const LAINE_KARRAS: [u32; 4] = [0x6c50_b47c, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6];

/// A hash of a number whose bit k depends on lower bits alone: reversed, it exchanges the halves of an interval, the quarters in them and
/// so on at random, as Owen (1995) scrambles (Laine and Karras 2011, with the constants of Burley 2020).
#[inline(always)]
fn laine_karras(x: u32, seed: u32) -> u32 {
    let mut x = x.wrapping_add(seed);
    for factor in LAINE_KARRAS {
        x ^= x.wrapping_mul(factor);
    }
    x
}

#[inline(always)]
fn owen(x: u32, seed: u32) -> u32 {
    laine_karras(x.reverse_bits(), seed).reverse_bits()
}

/// Sample number `index` of a pixel for a decision of its own, in [0, 1) by [0, 1): as evenly spread as [`point`] is, and independent of
/// what other decisions of the pixel get, whose number `decision` is another (Burley 2020: shuffled and scrambled as Owen does).
#[inline(always)]
pub fn decided(index: u32, key: [u32; 2], decision: u32) -> [f32; 2] {
    let [a, b] = scramble(key[0], key[1], decision);
    let [c, _] = scramble(key[1], key[0], !decision);
    // shuffled within every block of 2^k samples
    let [x, y] = sobol(owen(index, c));
    [unit(owen(x, a)), unit(owen(y, b))]
}

/// The decision of [`decided`] where on the lens a ray from the eye begins: not one of those at surfaces.
pub const LENS: u32 = 0x4c65_6e73;

/// A direction around `axis` within a cone whose angle has this cosine, spread evenly, from a point of the unit square.
#[inline(always)]
pub fn cone_direction<R: Real>(axis: Vec3<R>, cosine: R, u: R, v: R) -> Vec3<R> {
    let (sin, cos) = (v * std::f32::consts::TAU).sin_cos();
    let z = (cosine.one_minus() * u).one_minus();
    let r = z.sq().one_minus().max(0.0).sqrt();
    let [a, b] = basis(axis);
    a * (r * cos) + b * (r * sin) + axis * z
}

/// A direction around `normal`, spread by the cosine law, from a point of the unit square.
#[inline(always)]
pub fn cosine_direction<R: Real>(normal: Vec3<R>, u: R, v: R) -> Vec3<R> {
    let (sin, cos) = (v * std::f32::consts::TAU).sin_cos();
    let r = u.sqrt();
    let z = u.one_minus().max(0.0).sqrt();
    let [a, b] = basis(normal);
    a * (r * cos) + b * (r * sin) + normal * z
}

/// Two directions that make an orthonormal basis with a third (Duff et al. 2017).
#[inline(always)]
pub fn basis<R: Real>(n: Vec3<R>) -> [Vec3<R>; 2] {
    let sign = R::select(n.z.negative(), n.z.lit(-1.0), n.z.lit(1.0));
    let a = -(sign + n.z).recip();
    let b = n.x * n.y * a;
    [
        v3(n.x.sq() * a * sign + 1.0, sign * b, -(sign * n.x)),
        v3(b, sign + n.y.sq() * a, -n.y),
    ]
}

/// Pixels around a sample's own, on each side, that its filter reaches.
pub const fn radius(filter: Filter) -> usize {
    match filter {
        Filter::Box => 0,
        Filter::Tent => 1,
        Filter::Mitchell => 2,
    }
}

/// Weight of a sample along one axis, at `x` pixels from a pixel's middle.
#[inline(always)]
pub fn weight<R: Real>(filter: Filter, x: R) -> R {
    let x = x.abs();
    let zero = x.lit(0.0);
    match filter {
        Filter::Box => R::select(x.above(0.5), zero, x.lit(1.0)),
        Filter::Tent => x.one_minus().max(0.0),
        Filter::Mitchell => {
            // B = C = 1/3: Mitchell and Netravali 1988, equation 8
            let near = ((x * 7.0 - 12.0) * x.sq() + 16.0 / 3.0) * (1.0 / 6.0);
            let far = (((x * (-7.0 / 3.0) + 12.0) * x - 20.0) * x + 32.0 / 3.0) * (1.0 / 6.0);
            R::select(x.below(1.0), near, R::select(x.below(2.0), far, zero))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_stratified() {
        for seed in 0..50 {
            let scramble = scramble(seed, 3 * seed, 7);
            for n in [4u32, 16, 64] {
                for (wide, high) in [(1, n), (n, 1), (n.isqrt(), n.isqrt())] {
                    let mut taken = vec![false; n as usize];
                    for i in 0..n {
                        let [x, y] = point(i, scramble);
                        let (x, y) = ((x * wide as f32) as u32, (y * high as f32) as u32);
                        let cell = &mut taken[(y * wide + x) as usize];
                        assert!(!*cell, "two samples in one of {n} cells");
                        *cell = true;
                    }
                }
            }
        }
    }

    #[test]
    fn decisions_are_stratified_and_independent() {
        let n = 64u32;
        for decision in 0..40 {
            let mut taken = vec![false; n as usize];
            for i in 0..n {
                let [x, y] = decided(i, [11, 5], decision);
                let cell = &mut taken[((y * 8.0) as u32 * 8 + (x * 8.0) as u32) as usize];
                assert!(!*cell, "two samples in one of {n} cells");
                *cell = true;
            }
        }
        // correlation of every two decisions over many samples
        let n = 4096u32;
        for pair in 0..30 {
            let sum: f32 = (0..n)
                .map(|i| {
                    let [a, _] = decided(i, [7, 9], pair);
                    let [b, c] = decided(i, [7, 9], pair + 1);
                    (a - 0.5) * (b - 0.5) + (a - 0.5) * (c - 0.5)
                })
                .sum();
            // of independent numbers it has a standard deviation of 1 / (12 root n), of each of two
            let correlation = 12.0 * sum / n as f32;
            assert!(
                correlation.abs() < 6.0 / (n as f32).sqrt(),
                "{pair}: {correlation}"
            );
        }
    }

    #[test]
    fn filters_sum_to_one() {
        for filter in [Filter::Box, Filter::Tent, Filter::Mitchell] {
            let reach = radius(filter) as i32;
            for i in 0..100 {
                // a sample that is this far from its pixel's middle is seen by all pixels around with weights that sum to 1
                let x = i as f32 / 100.0 - 0.495;
                let sum: f32 = (-reach..=reach).map(|k| weight(filter, x - k as f32)).sum();
                assert!((sum - 1.0).abs() < 1e-5, "{filter:?} at {x}: {sum}");
                assert_eq!(weight(filter, x + reach as f32 + 1.01), 0.0);
            }
        }
    }

    #[test]
    fn filters_have_their_published_points() {
        for (filter, x, right) in [
            (Filter::Box, 0.49, 1.0),
            (Filter::Tent, 0.25, 0.75),
            (Filter::Tent, -0.75, 0.25),
            (Filter::Mitchell, 0.0, 8.0 / 9.0),
            (Filter::Mitchell, -0.5, 77.0 / 144.0),
            (Filter::Mitchell, 1.0, 1.0 / 18.0),
            (Filter::Mitchell, -1.5, -5.0 / 144.0),
            (Filter::Mitchell, 2.0, 0.0),
        ] {
            let found: f32 = weight(filter, x);
            assert!((found - right).abs() < 1e-6, "{filter:?} at {x}: {found}");
        }
    }

    #[test]
    fn directions_follow_the_cosine_law() {
        for normal in [v3(0.0, 1.0, 0.0), v3(0.6, 0.0, -0.8), v3(0.0, 0.0, -1.0f32)] {
            let mut mean = v3(0.0, 0.0, 0.0f32);
            for i in 0..1024 {
                let [u, v] = point(i, [1, 2]);
                let d = cosine_direction(normal, u, v);
                assert!((d.length() - 1.0).abs() < 1e-5 && d.dot(normal) >= 0.0);
                mean = mean + d / 1024.0;
            }
            // the mean cosine is 2 / 3
            assert!((mean - normal * (2.0 / 3.0)).length() < 0.01);
        }
    }
}
